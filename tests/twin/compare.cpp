#include "tests/twin/compare.h"

#include "core/base/formats.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace lrsm::twin {

namespace {

template <class T>
T element(const NpyArray& array, std::size_t i)
{
    T value;
    std::memcpy(&value, array.bytes.data() + i * sizeof(T), sizeof(T));
    return value;
}

/// Value, and its place among all values of its type: neighbours are one apart.
struct Element {
    double value, place;
};

Element ordered(double value, std::uint32_t magnitude, bool negative)
{
    return {value, negative ? -double(magnitude) : double(magnitude)};
}

Element elementAt(const NpyArray& array, std::size_t i, double scale)
{
    switch (array.dtype) {
    case Dtype::u1: return {double(element<std::uint8_t>(array, i)) * scale, double(element<std::uint8_t>(array, i))};
    case Dtype::u2: return {double(element<std::uint16_t>(array, i)) * scale, double(element<std::uint16_t>(array, i))};
    case Dtype::u4: return {double(element<std::uint32_t>(array, i)), double(element<std::uint32_t>(array, i))};
    case Dtype::f2: {
        const auto bits = element<std::uint16_t>(array, i);
        return ordered(double(floatFromHalf(bits)), bits & 0x7fffu, bits & 0x8000u);
    }
    default: {
        const auto value = element<float>(array, i);
        const auto bits = std::bit_cast<std::uint32_t>(value);
        return ordered(double(value), bits & 0x7fffffffu, bits & 0x80000000u);
    }
    }
}

Difference compare(const NpyArray& ours, const NpyArray& golden, const Json& description)
{
    const Json& tolerance = description["tolerance"];
    Difference d;
    d.name = description["name"];
    d.pass = description["pass"];
    d.kind = tolerance["kind"];
    d.value = tolerance["value"];
    d.allowedOutside = tolerance.value("outliers", 0.0);
    d.allowedDiffering = tolerance.value("differing", 1.0);
    const double floor = tolerance.value("floor", 0.0);
    const bool bits = description["encoding"] == "bits";
    const double scale = description["encoding"] == "unorm" ? 1.0 / (ours.dtype == Dtype::u1 ? 255.0 : 65535.0) : 1.0;
    const std::size_t count = elementCount(ours.shape, d.name);
    for (std::size_t i = 0; i < count; ++i) {
        if (bits) {
            const auto a = element<std::uint8_t>(ours, i), b = element<std::uint8_t>(golden, i);
            d.elements += std::size_t(std::popcount(unsigned(a | b)));
            d.differing += std::size_t(std::popcount(unsigned(a ^ b)));
            d.outside = d.differing;
            continue;
        }
        const Element a = elementAt(ours, i, scale), b = elementAt(golden, i, scale);
        if (a.value == 0.0 && b.value == 0.0) continue;
        ++d.elements;
        d.differing += a.place != b.place;
        double off = std::abs(a.value - b.value);
        if (d.kind == "ulp") off = std::abs(a.place - b.place);
        if (d.kind == "relative") off /= std::max(std::abs(b.value), floor);
        d.largest = std::max(d.largest, off);
        d.outside += !(off <= d.value);
    }
    return d;
}

}  // namespace

std::vector<Difference> differences(const Frame& frame)
{
    std::vector<Difference> all;
    for (const Json& description : frame.manifest()["buffers"]) {
        const std::string name = description["name"];
        const auto own = frame.outputs().find(name);
        if (own != frame.outputs().end()) all.push_back(compare(own->second, frame.golden(name), description));
    }
    return all;
}

}  // namespace lrsm::twin
