#include "core/base/errors.h"
#include "core/base/memory.h"

#include "catch.h"

#include <limits>

using namespace lrsm;

TEST_CASE("memory: more than any machine has is refused before it is asked for, little is granted", "[core][memory]")
{
    CHECK(availableMemory() > std::size_t(1) << 20);
    CHECK_NOTHROW(requireMemory(1000, "grid", "lower it"));
    if (availableMemory() == std::numeric_limits<std::size_t>::max()) {
        WARN("SKIPPED: this system does not say what memory is available");
        return;
    }
    try {
        requireMemory(std::size_t(1) << 60, "grid", "lower it");
        FAIL("granted");
    } catch (const MachineError& error) {
        const std::string line = error.what();
        CHECK(line.find("grid: needs 1152921504.61 GB, and the machine has ") == 0);
        CHECK(line.find("; lower it") != std::string::npos);
    }
}
