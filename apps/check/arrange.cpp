#include "apps/check/arrange.h"

#include "apps/check/compare.h"
#include "core/base/errors.h"
#include "core/base/formats.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace lrsm {

namespace {

constexpr std::size_t kAbsent = ~std::size_t(0);

std::vector<std::size_t> withoutOnes(std::vector<std::size_t> shape)
{
    std::erase(shape, std::size_t(1));
    return shape;
}

/// What the file's elements are laid out along.
struct Layout {
    std::vector<std::string> axes;     ///< golden's, in the golden's order; the component's last when there is one
    std::vector<std::size_t> extents;  ///< golden's
    std::vector<std::size_t> strides;  ///< in the file, in elements
    std::size_t channels = 1;          ///< in the file
};

/// Components up to the last that is compared: a file may leave out the rest.
std::size_t neededComponents(const Buffer& golden)
{
    std::size_t needed = golden.components.size();
    while (needed > 0 && golden.components[needed - 1].empty()) --needed;
    return needed;
}

/// Axes in an order that has the file's shape, as the map says it; empty where there is none.
std::string orderThatFits(const Buffer& golden, const std::vector<std::size_t>& extents, const GivenArray& array)
{
    if (extents != golden.shape || golden.axes.size() != extents.size() || extents.size() < 2) return {};
    std::vector<std::size_t> order(extents.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    // Components first (CHW) before any other.
    std::rotate(order.begin(), order.end() - 1, order.end());
    const std::vector<std::size_t> first = order;
    do {
        std::vector<std::size_t> shape;
        for (const std::size_t axis : order) shape.push_back(extents[axis]);
        if (withoutOnes(shape) == withoutOnes(array.shape)) {
            std::string text;
            for (const std::size_t axis : order) text += (text.empty() ? "\"" : ", \"") + golden.axes[axis] + "\"";
            return text;
        }
        std::next_permutation(order.begin(), order.end());
    } while (order != first);
    return {};
}

[[noreturn]] void refuseShape(const Buffer& golden, const std::vector<std::size_t>& expected, const GivenArray& array, const std::string& place)
{
    const std::string order = orderThatFits(golden, expected, array);
    throw InputError(place, "is " + shapeText(array.shape) + " where " + golden.name + " is " + shapeText(expected) +
                                (order.empty() ? "; was it made at the golden's size and settings?"
                                               : "; it looks like {\"axes\": [" + order + "]}: say so in a map (--map)"));
}

/// Strides of the golden's axes in the file. Axes of extent 1 may be left out or added; more channels than the golden's are passed over.
Layout layOut(const Buffer& golden, const std::vector<std::size_t>& extents, const GivenArray& array, const Arrangement& how, const std::string& place)
{
    Layout layout{extents == golden.shape ? golden.axes : axisNamesOf(golden), extents, {}, 1};
    const bool components = !golden.components.empty();
    std::vector<std::size_t> order(extents.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    if (!how.axes.empty()) {
        if (how.axes.size() != order.size()) throw InputError(place, "\"axes\" must name each axis of " + golden.name + " once");
        for (std::size_t i = 0; i < order.size(); ++i) {
            const auto found = std::find(layout.axes.begin(), layout.axes.end(), how.axes[i]);
            if (found == layout.axes.end()) throw InputError(place, "\"axes\": " + golden.name + " has no axis \"" + how.axes[i] + "\"");
            order[i] = static_cast<std::size_t>(found - layout.axes.begin());
        }
        if (std::vector<std::size_t> sorted = order; std::sort(sorted.begin(), sorted.end()), std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
            throw InputError(place, "\"axes\" names an axis of " + golden.name + " twice");
    }
    // How many channels are there? What is left when all other axes are accounted for.
    std::size_t others = 1;
    for (std::size_t axis = 0; axis + (components ? 1 : 0) < extents.size(); ++axis) others *= extents[axis];
    const std::size_t held = elementCount(array.shape, place);
    layout.channels = others > 0 && held % others == 0 ? held / others : 0;
    std::vector<std::size_t> expected;
    for (const std::size_t axis : order) expected.push_back(components && axis + 1 == extents.size() ? layout.channels : extents[axis]);
    const std::size_t needed = how.channels.empty() ? (components ? neededComponents(golden) : 1) : 1;
    const bool channelsFit = components ? layout.channels >= needed : layout.channels == 1 || !how.channels.empty();
    if (!components && !how.channels.empty()) expected.push_back(layout.channels);
    if (others * layout.channels != held || !channelsFit || withoutOnes(expected) != withoutOnes(array.shape)) refuseShape(golden, extents, array, place);

    layout.strides.assign(extents.size(), 0);
    std::size_t stride = components ? 1 : layout.channels;
    for (std::size_t i = order.size(); i-- > 0;) {
        layout.strides[order[i]] = stride;
        stride *= components && order[i] + 1 == extents.size() ? layout.channels : extents[order[i]];
    }
    return layout;
}

/// Index in the file of every element of the golden (of `extents`); kAbsent for an unused component that is not there.
class Source {
  public:
    Source(const Buffer& golden, const Layout& layout, const Arrangement& how, const std::string& place) : golden_(golden), layout_(layout), how_(how)
    {
        flipped_.assign(layout.extents.size(), false);
        for (const std::string& name : how.flip) {
            const auto found = std::find(layout.axes.begin(), layout.axes.end(), name);
            if (found == layout.axes.end()) throw InputError(place, "\"flip\": " + golden.name + " has no axis \"" + name + "\"");
            flipped_[static_cast<std::size_t>(found - layout.axes.begin())] = true;
        }
        if (!how.layers.empty() && (how.layers.size() != layout.extents[0] || *std::max_element(how.layers.begin(), how.layers.end()) >= layout.extents[0]))
            throw InputError(
                place, "\"layers\" must hold, for each of the " + std::to_string(layout.extents[0]) + " layers of " + golden.name + ", its place in the file");
        const std::size_t components = std::max<std::size_t>(golden.components.size(), 1);
        if (!how.channels.empty() && (how.channels.size() > components || *std::max_element(how.channels.begin(), how.channels.end()) >= layout.channels))
            throw InputError(
                place, "\"channels\" must name at most " + std::to_string(components) + " of the file's " + std::to_string(layout.channels) + " channels");
    }

    std::size_t operator()(std::size_t element) const
    {
        std::size_t source = 0;
        for (std::size_t axis = layout_.extents.size(); axis-- > 0;) {
            std::size_t index = element % layout_.extents[axis];
            element /= layout_.extents[axis];
            const bool component = !golden_.components.empty() && axis + 1 == layout_.extents.size();
            if (component) {
                if (!how_.channels.empty()) {
                    if (index >= how_.channels.size()) return kAbsent;
                    index = how_.channels[index];
                }
                if (index >= layout_.channels) return kAbsent;
            } else {
                if (flipped_[axis]) index = layout_.extents[axis] - 1 - index;
                if (axis == 0 && !how_.layers.empty()) index = how_.layers[index];
            }
            source += index * layout_.strides[axis];
        }
        if (golden_.components.empty() && !how_.channels.empty()) source += how_.channels[0];
        return source;
    }

  private:
    const Buffer& golden_;
    const Layout& layout_;
    const Arrangement& how_;
    std::vector<bool> flipped_;
};

/// Value into the storage of `buffer` at `element`.
void storeValue(Buffer& buffer, std::size_t element, double value, HalfRounding rounding, const std::string& place)
{
    const auto put = [&]<class T>(T bits) { std::memcpy(buffer.bytes.data() + element * sizeof(T), &bits, sizeof(T)); };
    const bool unorm = buffer.encoding == Encoding::unorm;
    const auto whole = [&](double most) {
        if (!(value >= 0.0 && value <= most && value == std::floor(value)))
            throw InputError(place, "holds " + std::to_string(value) + " at " + placeText(buffer, element) + ", where " + buffer.name + " holds whole numbers");
        return value;
    };
    const auto narrow = static_cast<float>(value);
    switch (buffer.dtype) {
    case Dtype::u1: return put(unorm ? unorm8FromFloat(narrow) : static_cast<std::uint8_t>(whole(255.0)));
    case Dtype::u2: return put(unorm ? unorm16FromFloat(narrow) : static_cast<std::uint16_t>(whole(65535.0)));
    case Dtype::u4: return put(static_cast<std::uint32_t>(whole(4294967295.0)));
    case Dtype::u8: return put(static_cast<std::uint64_t>(whole(0x1p53)));
    case Dtype::i4: return put(static_cast<std::int32_t>(whole(2147483647.0)));
    case Dtype::f2: return put(halfFromFloat(narrow, rounding));
    case Dtype::f4: return put(narrow);
    case Dtype::f8: return put(value);
    case Dtype::b1:
    case Dtype::i1:
    case Dtype::i2:
    case Dtype::i8: break;  // no golden holds them
    }
    throw InputError(place, buffer.name + " is " + std::string(nameOf(buffer.dtype)) + ", which goldens do not hold");
}

/// What the array's elements stand for. `codes`: whole numbers of another width that count the golden's UNORM steps.
struct Meaning {
    Encoding encoding = Encoding::number;
    bool codes = false;
};

/// May these elements stand for the golden's, and as what? Integers for UNORM are codes, but for those that are UNORM formats of their own: 8 bits
/// for 16 and the other way round. For floats they are numbers, but for those of 8 and 16 bits, which may be UNORM or SNORM.
Meaning meaningFor(const Buffer& golden, const GivenArray& array, const Arrangement& how, const std::string& place)
{
    const Dtype given = array.dtype;
    const bool unsignedSmall = given == Dtype::u1 || given == Dtype::u2, small = unsignedSmall || given == Dtype::i1 || given == Dtype::i2;
    const bool number = isFloat(given) || given == Dtype::b1;
    if (how.encoding == Encoding::unorm && !unsignedSmall && !number) {
        if (golden.encoding == Encoding::unorm) return {Encoding::number, true};
        throw InputError(place, "holds " + std::string(nameOf(given)) + ", which is no UNORM format; give u1 or u2, or \"scale\" in the map");
    }
    if (how.encoding) return {number ? Encoding::number : *how.encoding, false};
    if (array.encodingKnown || number) return {array.encodingKnown ? array.encoding : Encoding::number, false};
    if (given == golden.dtype) return {golden.encoding, false};
    if (golden.encoding == Encoding::bits && sizeOf(given) == sizeOf(golden.dtype)) return {golden.encoding, false};
    if (!isFloat(golden.dtype) && golden.encoding == Encoding::number) return {Encoding::number, false};
    if (golden.encoding == Encoding::unorm && !unsignedSmall) return {Encoding::number, true};
    if (isFloat(golden.dtype) && !small) return {Encoding::number, false};
    throw InputError(place, "holds " + std::string(nameOf(given)) + " where " + golden.name + " is " + std::string(nameOf(golden.dtype)) + " (" +
                                std::string(nameOf(golden.encoding)) + "); give that type, or floats, or say \"encoding\": \"unorm\" in the map");
}

/// One number a voxel, 0 or not, to the golden's packing.
Arranged packVoxels(const Buffer& golden, const GivenArray& array, const Arrangement& how, const std::string& place)
{
    const std::vector<std::size_t> extents = extentsOf(golden);
    const Layout layout = layOut(golden, extents, array, how, place);
    const Source source(golden, layout, how, place);
    Buffer from;
    from.dtype = array.dtype;
    from.bytes = array.bytes;
    Arranged out;
    out.bytes.assign(golden.elements() * sizeOf(golden.dtype), std::byte{0});
    std::size_t row = 0;
    for (std::size_t z = 0; z < extents[0]; ++z)
        for (std::size_t y = 0; y < extents[1]; ++y)
            for (std::size_t x = 0; x < extents[2]; ++x, ++row) {
                if (decodedValue(from, source(row)) == 0.0) continue;
                const std::size_t indices[] = {z, y, x};
                const std::size_t bit = elementAt(golden, indices);
                out.bytes[bit / 8] |= std::byte(1u << (bit & 7));
            }
    out.note = "one " + std::string(nameOf(array.dtype)) + " a voxel";
    return out;
}

}  // namespace

Arranged arrange(const Buffer& golden, const GivenArray& array, const Arrangement& how, HalfRounding rounding, const std::string& place)
{
    if (golden.encoding == Encoding::bits && (array.encodingKnown || withoutOnes(array.shape) != withoutOnes(golden.shape) || isFloat(array.dtype) ||
                                              array.dtype == Dtype::b1 || sizeOf(array.dtype) != sizeOf(golden.dtype)))
        return packVoxels(golden, array, how, place);

    const Layout layout = layOut(golden, golden.shape, array, how, place);
    const Meaning meaning = meaningFor(golden, array, how, place);
    const Encoding encoding = meaning.encoding;
    // Packed bits have no sign: numpy's int64 holds what uint64 does.
    const bool sameType = array.dtype == golden.dtype || encoding == Encoding::bits;
    const bool asIs = sameType && encoding == golden.encoding && how.scale == 1.0 && how.offset == 0.0;
    const double step = !meaning.codes ? 1.0 : golden.dtype == Dtype::u1 ? 255.0 : 65535.0;
    Arranged out;
    if (asIs && how == Arrangement{} && layout.channels == std::max<std::size_t>(golden.components.size(), 1)) {
        out.bytes = array.bytes;
        return out;
    }
    const Source source(golden, layout, how, place);
    const std::size_t count = golden.elements(), size = sizeOf(golden.dtype);
    Buffer from;
    from.dtype = array.dtype;
    from.encoding = encoding;
    from.bytes = array.bytes;
    Buffer to = golden;
    to.bytes.assign(count * size, std::byte{0});
    if (!asIs) out.given.assign(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = source(i);
        if (at == kAbsent) continue;
        if (asIs) {
            std::memcpy(to.bytes.data() + i * size, from.bytes.data() + at * size, size);
            continue;
        }
        out.given[i] = decodedValue(from, at) / step * how.scale + how.offset;
        storeValue(to, i, out.given[i], rounding, place);
    }
    out.bytes = std::move(to.bytes);
    if (!asIs) out.note = std::string(nameOf(array.dtype)) + (encoding == Encoding::unorm ? " unorm" : meaning.codes ? " codes" : "") + " in the file";
    return out;
}

}  // namespace lrsm
