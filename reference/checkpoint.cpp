#include "reference/checkpoint.h"

#include "core/base/errors.h"
#include "core/base/hash.h"

#include <bit>
#include <cstring>
#include <span>

namespace lrsm {
namespace {

static_assert(std::endian::native == std::endian::little, "samples.bin is little-endian; add byte swaps for this machine");

constexpr char kMagic[] = "lrsm samples 3\n";
constexpr std::size_t kHashDigits = 64;

class Writer {
  public:
    void raw(const void* data, std::size_t size)
    {
        const auto* begin = static_cast<const std::byte*>(data);
        bytes.insert(bytes.end(), begin, begin + size);
    }
    template <class T>
    void value(const T& v)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        raw(&v, sizeof v);
    }
    template <class T>
    void values(const std::vector<T>& v)
    {
        value(std::uint64_t(v.size()));
        raw(v.data(), v.size() * sizeof(T));
    }
    void text(const std::string& s)
    {
        value(std::uint64_t(s.size()));
        raw(s.data(), s.size());
    }

    std::vector<std::byte> bytes;
};

class Reader {
  public:
    Reader(std::span<const unsigned char> bytes, std::string place) : bytes_(bytes), place_(std::move(place)) {}

    void raw(void* data, std::size_t size)
    {
        if (size > bytes_.size()) throw InputError(place_, "is cut short");
        if (size > 0) std::memcpy(data, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
    }
    template <class T>
    T value()
    {
        T v{};
        raw(&v, sizeof v);
        return v;
    }
    std::size_t count(std::size_t elementSize)
    {
        const auto n = value<std::uint64_t>();
        if (n > bytes_.size() / elementSize) throw InputError(place_, "is cut short");
        return std::size_t(n);
    }
    template <class T>
    std::vector<T> values()
    {
        std::vector<T> v(count(sizeof(T)));
        raw(v.data(), v.size() * sizeof(T));
        return v;
    }
    std::string text()
    {
        std::string s(count(1), '\0');
        raw(s.data(), s.size());
        return s;
    }

  private:
    std::span<const unsigned char> bytes_;
    std::string place_;
};

void writeSums(Writer& out, const SampleSums& sums)
{
    out.value(std::int32_t(sums.channels));
    out.value(std::int32_t(sums.blockBits));
    out.value(sums.completeBlocks);
    out.values(sums.ranges);
    out.values(sums.sums);
    out.values(sums.squares);
    out.value(std::uint64_t(sums.partial.size()));
    for (const PartialBlock& block : sums.partial) {
        out.value(block.block);
        out.value(block.samples);
        out.values(block.sums);
    }
}

SampleSums readSums(Reader& in, const std::string& place)
{
    SampleSums sums;
    sums.channels = in.value<std::int32_t>();
    sums.blockBits = in.value<std::int32_t>();
    sums.completeBlocks = in.value<std::uint64_t>();
    sums.ranges = in.values<SampleRange>();
    sums.sums = in.values<Int128>();
    sums.squares = in.values<Int128>();
    const std::size_t blocks = in.count(1);
    for (std::size_t i = 0; i < blocks; ++i) {
        PartialBlock block;
        block.block = in.value<std::uint64_t>();
        block.samples = in.value<std::uint32_t>();
        block.sums = in.values<Int128>();
        if (block.sums.size() != sums.sums.size()) throw InputError(place, "is damaged: a block's size does not fit");
        sums.partial.push_back(std::move(block));
    }
    const bool fits = sums.channels >= (sums.sums.empty() ? 0 : 1) && sums.blockBits >= 0 && sums.blockBits <= 12 && sums.squares.size() == sums.sums.size() &&
                      sums.sums.size() % std::size_t(std::max(sums.channels, 1)) == 0;
    if (!fits) throw InputError(place, "is damaged: its sizes do not fit");
    return sums;
}

}  // namespace

std::vector<std::byte> encodeCheckpoint(const Checkpoint& checkpoint)
{
    Writer out;
    out.raw(kMagic, sizeof kMagic - 1);
    out.value(std::uint64_t(checkpoint.identity.size()));
    for (const auto& [name, value] : checkpoint.identity) {
        out.text(name);
        out.text(value);
    }
    const ReferenceState& state = checkpoint.state;
    out.value(checkpoint.unit);
    out.value(state.finished() ? SampleRange{} : state.target);  // what is left to do
    out.values(state.finished() ? std::vector<std::uint32_t>{} : state.tileBlocks);
    out.value(state.rays);
    out.value(state.faults);
    out.value(state.finished() ? 0.0 : state.seconds);
    writeSums(out, state.sums);
    writeSums(out, state.base);

    const std::string hash = Sha256().add(out.bytes).hex();
    out.raw(hash.data(), hash.size());
    return std::move(out.bytes);
}

Checkpoint decodeCheckpoint(const std::vector<unsigned char>& bytes, const std::string& place)
{
    const std::size_t magic = sizeof kMagic - 1;
    if (bytes.size() < magic + kHashDigits || std::memcmp(bytes.data(), kMagic, magic) != 0) throw InputError(place, "is no samples file of this version");
    const std::span<const unsigned char> body(bytes.data(), bytes.size() - kHashDigits);
    const std::string hash(reinterpret_cast<const char*>(body.data() + body.size()), kHashDigits);
    if (Sha256().add(std::as_bytes(body)).hex() != hash) throw InputError(place, "is cut short or damaged: its hash does not fit");

    Reader in(body.subspan(magic), place);
    Checkpoint checkpoint;
    const std::size_t entries = in.count(1);
    for (std::size_t i = 0; i < entries; ++i) {
        std::string name = in.text();
        checkpoint.identity.emplace_back(std::move(name), in.text());
    }
    checkpoint.unit = in.value<double>();
    checkpoint.state.target = in.value<SampleRange>();
    checkpoint.state.tileBlocks = in.values<std::uint32_t>();
    checkpoint.state.rays = in.value<RayCounts>();
    checkpoint.state.faults = in.value<SampleFaults>();
    checkpoint.state.seconds = in.value<double>();
    checkpoint.state.sums = readSums(in, place);
    checkpoint.state.base = readSums(in, place);
    return checkpoint;
}

void requireSameIdentity(const Identity& expected, const std::string& expectedPlace, const Identity& found, const std::string& place)
{
    for (std::size_t i = 0; i < std::max(expected.size(), found.size()); ++i) {
        const std::string name = i < expected.size() ? expected[i].first : found[i].first;
        const std::string left = i < expected.size() ? expected[i].second : "nothing";
        const std::string right = i < found.size() && found[i].first == name ? found[i].second : "nothing";
        if (left != right) throw InputError(place, "differs from " + expectedPlace + " in " + name + ": " + right + " against " + left);
    }
}

}  // namespace lrsm
