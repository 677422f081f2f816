#include "apps/check/compare.h"

#include "core/base/parallel.h"

#include <cassert>
#include <cmath>
#include <cstring>

namespace lrsm {

namespace {

constexpr std::size_t kElementsPerChunk = 1 << 18;

/// What of `description` one bit of a packed buffer is; false for buffers that hold numbers.
bool isVoxels(const Buffer& description)
{
    return description.encoding == Encoding::bits && description.shape.size() == 3;
}
bool isBricks(const Buffer& description)
{
    return isVoxels(description) && description.dtype == Dtype::u8;
}

/// |x| counted in representable values of a binary format from 0 on.
double floatOrdinal(double x, int mantissaBits, int minExponent)
{
    if (std::isnan(x)) return x;
    const double a = std::abs(x);
    double ordinal = 0.0;
    if (std::isinf(a)) {
        ordinal = std::ldexp(double(2 * (1 - minExponent) + 1), mantissaBits);  // one beyond the largest finite value
    } else if (a < std::ldexp(1.0, minExponent)) {
        ordinal = std::ldexp(a, mantissaBits - minExponent);
    } else {
        int exponent = 0;
        const double m = std::frexp(a, &exponent);  // in [1/2, 1): a = 2m 2^(exponent - 1)
        ordinal = std::ldexp(double(exponent - 1 - minExponent) + 2.0 * m, mantissaBits);
    }
    return x < 0.0 ? -ordinal : ordinal;
}

struct ElementState {
    bool live = false, differs = false, outside = false, notANumber = false;
    double size = 0.0;
};

/// The comparison of single elements.
class Comparer {
  public:
    Comparer(const Buffer& golden, const Buffer& candidate, std::span<const double> given)
        : golden_(golden), candidate_(candidate), given_(given), bytes_(golden.encoding == Encoding::bits ? 0 : sizeOf(golden.dtype))
    {
    }

    double goldenValue(std::size_t i) const { return decodedValue(golden_, i); }
    double candidateValue(std::size_t i) const { return given_.empty() ? decodedValue(candidate_, i) : given_[i]; }

    ElementState operator()(std::size_t i) const
    {
        const double g = goldenValue(i), c = candidateValue(i);
        ElementState state;
        state.live = g != 0.0 || c != 0.0;
        const bool same = sameBits(i, g, c);
        if (same) return state;
        state.notANumber = std::isnan(g) || std::isnan(c);
        state.differs = true;
        if (state.notANumber) {
            state.outside = true;
            state.size = std::nan("");
            return state;
        }
        if (g == c && golden_.tolerance.kind != Tolerance::Kind::exact) return ElementState{state.live, false, false, false, 0.0};
        const Tolerance& t = golden_.tolerance;
        switch (t.kind) {
        case Tolerance::Kind::exact:
            state.size = std::abs(c - g);
            state.outside = true;
            break;
        case Tolerance::Kind::ulp: state.size = std::abs(ordinalOf(golden_, c) - ordinalOf(golden_, g)); break;
        case Tolerance::Kind::absolute: state.size = std::abs(c - g); break;
        case Tolerance::Kind::relative: state.size = std::abs(c - g) / std::max(std::abs(g), t.floor); break;
        }
        if (t.kind != Tolerance::Kind::exact) state.outside = !(state.size <= t.value);
        return state;
    }

  private:
    bool sameBits(std::size_t i, double g, double c) const
    {
        if (bytes_ == 0) return g == c;
        if (std::memcmp(golden_.bytes.data() + i * bytes_, candidate_.bytes.data() + i * bytes_, bytes_) != 0) return false;
        // Given in another type: rounded it has the golden's bits, but what was rounded may have been out of range or NaN.
        return given_.empty() || g == c || std::abs(ordinalOf(golden_, c) - ordinalOf(golden_, g)) < 1.0;
    }

    const Buffer& golden_;
    const Buffer& candidate_;
    std::span<const double> given_;
    std::size_t bytes_;
};

void addElement(BufferComparison& sum, std::optional<ElementDifference>& firstOutside, const Comparer& comparer, std::size_t i)
{
    const ElementState state = comparer(i);
    ++sum.elements;
    sum.live += state.live ? 1 : 0;
    if (!state.differs) return;
    ++sum.differing;
    sum.outside += state.outside ? 1 : 0;
    sum.notANumber += state.notANumber ? 1 : 0;
    const ElementDifference difference{i, comparer.goldenValue(i), comparer.candidateValue(i), state.size};
    if (!sum.first) sum.first = difference;
    if (state.outside && !firstOutside) firstOutside = difference;
    const bool worse = !sum.worst || (!std::isnan(sum.worst->size) && !(state.size <= sum.worst->size));
    if (worse) sum.worst = difference;
}

std::string share(std::size_t count, std::size_t of)
{
    return std::to_string(count) + " of " + std::to_string(of);
}

std::string percent(double fraction)
{
    return numberText(3, 100.0 * fraction) + " %";
}

void judge(BufferComparison& c, const Tolerance& tolerance)
{
    const double live = static_cast<double>(c.live);
    if (c.notANumber > 0)
        c.why = share(c.notANumber, c.elements) + " NaN";
    else if (static_cast<double>(c.outside) > tolerance.outliers * live)
        c.why = share(c.outside, c.live) + " outside the tolerance" +
                (tolerance.outliers > 0.0 ? " (" + percent(static_cast<double>(c.outside) / live) + ", " + percent(tolerance.outliers) + " allowed)" : "");
    else if (static_cast<double>(c.differing) > tolerance.differing * live)
        c.why = share(c.differing, c.live) + " differ (" + percent(static_cast<double>(c.differing) / live) + ", " + percent(tolerance.differing) + " allowed)";
    c.holds = c.why.empty();
}

}  // namespace

std::vector<std::size_t> extentsOf(const Buffer& description)
{
    if (!isVoxels(description)) return description.shape;
    // Voxels fill a cube; 8 a byte along x, or 4 a side of a brick.
    if (isBricks(description)) return {description.shape[0] * 4, description.shape[1] * 4, description.shape[2] * 4};
    return {description.shape[0], description.shape[1], description.shape[2] * 8};
}

std::vector<std::string> axisNamesOf(const Buffer& description)
{
    if (isVoxels(description)) return {"z", "y", "x"};
    return description.axes;
}

std::vector<std::size_t> indicesOf(const Buffer& description, std::size_t element)
{
    if (isBricks(description)) {
        const std::size_t brick = element / 64, bit = element % 64, nx = description.shape[2], ny = description.shape[1];
        return {brick / (nx * ny) * 4 + bit / 16, brick / nx % ny * 4 + bit / 4 % 4, brick % nx * 4 + bit % 4};
    }
    const std::vector<std::size_t> extents = extentsOf(description);
    std::vector<std::size_t> indices(extents.size());
    for (std::size_t axis = extents.size(); axis-- > 0;) {
        indices[axis] = element % extents[axis];
        element /= extents[axis];
    }
    return indices;
}

std::size_t elementAt(const Buffer& description, std::span<const std::size_t> indices)
{
    if (isBricks(description)) {
        const std::size_t brick = (indices[0] / 4 * description.shape[1] + indices[1] / 4) * description.shape[2] + indices[2] / 4;
        return brick * 64 + indices[2] % 4 + indices[1] % 4 * 4 + indices[0] % 4 * 16;
    }
    const std::vector<std::size_t> extents = extentsOf(description);
    std::size_t element = 0;
    for (std::size_t axis = 0; axis < extents.size(); ++axis) element = element * extents[axis] + indices[axis];
    return element;
}

std::string placeText(const Buffer& description, std::size_t element)
{
    const std::vector<std::size_t> indices = indicesOf(description, element);
    const std::vector<std::string> names = axisNamesOf(description);
    std::string text;
    for (std::size_t axis = 0; axis < indices.size(); ++axis) {
        text += text.empty() ? "" : ", ";
        const bool component = axis + 1 == indices.size() && !description.components.empty();
        text += component ? "component '" + description.components[indices[axis]] + "'"
                          : (axis < names.size() ? names[axis] : "axis " + std::to_string(axis)) + " " + std::to_string(indices[axis]);
    }
    return text.empty() ? "its only element" : text;
}

bool compared(const Buffer& description, std::size_t element)
{
    return description.components.empty() || !description.components[element % description.components.size()].empty();
}

double ordinalOf(const Buffer& description, double value)
{
    const bool unorm = description.encoding == Encoding::unorm;
    switch (description.dtype) {
    case Dtype::u1: return unorm ? value * 255.0 : value;
    case Dtype::u2: return unorm ? value * 65535.0 : value;
    case Dtype::f2: return floatOrdinal(value, 10, -14);
    case Dtype::f4: return floatOrdinal(value, 23, -126);
    case Dtype::f8: return floatOrdinal(value, 52, -1022);
    default: return value;
    }
}

BufferComparison compareBuffers(const Buffer& golden, const Buffer& candidate, std::span<const double> given)
{
    assert(golden.bytes.size() == candidate.bytes.size());
    const std::size_t count = valueCount(golden);
    assert(given.empty() || given.size() == count);
    struct Part {
        BufferComparison sum;
        std::optional<ElementDifference> firstOutside;
    };
    const Comparer comparer(golden, candidate, given);
    std::vector<Part> parts((count + kElementsPerChunk - 1) / kElementsPerChunk);
    parallelFor(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t chunk = begin; chunk < end; ++chunk)
            for (std::size_t i = chunk * kElementsPerChunk; i < std::min(count, (chunk + 1) * kElementsPerChunk); ++i)
                if (compared(golden, i)) addElement(parts[chunk].sum, parts[chunk].firstOutside, comparer, i);
    });

    BufferComparison all;
    std::optional<ElementDifference> firstOutside;
    for (const Part& part : parts) {
        all.elements += part.sum.elements;
        all.live += part.sum.live;
        all.differing += part.sum.differing;
        all.outside += part.sum.outside;
        all.notANumber += part.sum.notANumber;
        if (!all.first) all.first = part.sum.first;
        if (!firstOutside) firstOutside = part.firstOutside;
        if (part.sum.worst && (!all.worst || (!std::isnan(all.worst->size) && !(part.sum.worst->size <= all.worst->size)))) all.worst = part.sum.worst;
    }
    if (firstOutside) all.first = firstOutside;
    judge(all, golden.tolerance);
    return all;
}

std::string sizeText(const Buffer& golden, double size)
{
    switch (golden.tolerance.kind) {
    case Tolerance::Kind::ulp: return numberText(4, size) + " ULP";
    case Tolerance::Kind::relative: return percent(size);
    default: return numberText(3, size);
    }
}

std::string toleranceText(const Tolerance& tolerance)
{
    std::string whole = "exact";
    if (tolerance.kind == Tolerance::Kind::ulp) whole = numberText(4, tolerance.value) + " ULP";
    if (tolerance.kind == Tolerance::Kind::absolute) whole = numberText(3, tolerance.value);
    if (tolerance.kind == Tolerance::Kind::relative) whole = percent(tolerance.value) + " of max(|golden|, " + numberText(3, tolerance.floor) + ")";
    if (tolerance.outliers > 0.0) whole += ", but for " + percent(tolerance.outliers);
    if (tolerance.differing < 1.0) whole += ", at most " + percent(tolerance.differing) + " differing";
    return whole;
}

}  // namespace lrsm
