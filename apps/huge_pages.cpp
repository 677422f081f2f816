// Large buffers on huge pages: a frame's time is up to a quarter page faults and address translation otherwise (docs/performance.md).
//
// Linux gives them where a range is advised (/sys/kernel/mm/transparent_hugepage/enabled: madvise, always); anywhere else this changes nothing. All large
// buffers are std::vector's, so the program's operator new is the one place where advising does not touch every type. Sanitizers bring their own
// (apps/CMakeLists.txt).

#include <sys/mman.h>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t kHugePage = std::size_t(2) << 20;

/// The whole huge pages within [memory, memory + size). What the system answers is of no consequence.
void advise(void* memory, std::size_t size)
{
    const auto first = (reinterpret_cast<std::uintptr_t>(memory) + kHugePage - 1) / kHugePage * kHugePage;
    const auto end = (reinterpret_cast<std::uintptr_t>(memory) + size) / kHugePage * kHugePage;
    if (first < end) ::madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}

}  // namespace

void* operator new(std::size_t size)
{
    for (;;) {
        if (void* memory = std::malloc(size == 0 ? 1 : size)) {
            if (size >= 2 * kHugePage) advise(memory, size);
            return memory;
        }
        const std::new_handler handler = std::get_new_handler();
        if (!handler) throw std::bad_alloc();
        handler();
    }
}

void operator delete(void* memory) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}
