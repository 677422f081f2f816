#include "apps/capture/npy.h"

#include "core/base/errors.h"
#include "core/base/file.h"
#include "core/base/text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <charconv>
#include <cstring>
#include <limits>

namespace lrsm {

static_assert(std::endian::native == std::endian::little, "buffers are written as they lie in memory");

namespace {

struct DtypeRow {
    std::string_view name, descr;
    std::size_t bytes;
};
constexpr std::array<DtypeRow, 12> kDtypes = {{{"u1", "|u1", 1},
                                               {"u2", "<u2", 2},
                                               {"u4", "<u4", 4},
                                               {"u8", "<u8", 8},
                                               {"i4", "<i4", 4},
                                               {"f2", "<f2", 2},
                                               {"f4", "<f4", 4},
                                               {"f8", "<f8", 8},
                                               {"b1", "|b1", 1},
                                               {"i1", "|i1", 1},
                                               {"i2", "<i2", 2},
                                               {"i8", "<i8", 8}}};

constexpr std::string_view kNpyMagic = "\x93NUMPY";
constexpr std::size_t kPreamble = 10;  // magic, version, header length; two bytes more from version 2.0 on
constexpr std::size_t kAlignment = 64;
constexpr std::size_t kMaxAxes = 8;
constexpr const char* kResave = "save it with numpy.save(file, a.astype('<f4')) or another type of numbers or booleans";

/// Reads the header's dict, which is Python text: {'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }
class HeaderText {
  public:
    HeaderText(std::string_view text, const std::string& place) : text_(text), place_(place) {}

    [[noreturn]] void fail(const std::string& why) const { throw InputError(place_, "is no readable .npy: " + why); }
    void skipSpace() { text_.remove_prefix(std::min(text_.find_first_not_of(" \t\r\n"), text_.size())); }
    bool take(std::string_view word)
    {
        skipSpace();
        if (!text_.starts_with(word)) return false;
        text_.remove_prefix(word.size());
        return true;
    }
    void expect(std::string_view word)
    {
        if (!take(word)) fail("its header lacks \"" + std::string(word) + "\"");
    }
    /// Python writes single quotes; other writers double ones.
    std::string_view quoted()
    {
        const char quote = take("\"") ? '"' : '\'';
        if (quote == '\'') expect("'");
        const std::size_t end = text_.find(quote);
        if (end == std::string_view::npos) fail("its header breaks off");
        const std::string_view word = text_.substr(0, end);
        text_.remove_prefix(end + 1);
        return word;
    }
    std::size_t number()
    {
        skipSpace();
        std::size_t value = 0;
        const auto [next, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
        if (error != std::errc()) fail("its shape holds something that is no size");
        text_.remove_prefix(static_cast<std::size_t>(next - text_.data()));
        if (text_.starts_with('L')) text_.remove_prefix(1);  // Python 2's long
        return value;
    }
    std::vector<std::size_t> tuple()
    {
        std::vector<std::size_t> values;
        expect("(");
        while (!take(")")) {
            values.push_back(number());
            if (values.size() > kMaxAxes) fail("it has more than " + std::to_string(kMaxAxes) + " axes");
            if (!take(",")) {
                expect(")");
                break;
            }
        }
        return values;
    }
    bool done()
    {
        skipSpace();
        return text_.empty();
    }

  private:
    std::string_view text_;
    const std::string& place_;
};

/// The array as the file has it: what parseHeader finds beside the dtype and the shape.
struct FileOrder {
    bool bigEndian = false, fortran = false;
};

/// "<f4": byte order, kind, bytes. Single bytes have no order, whatever the writer says.
Dtype dtypeOfDescr(std::string_view descr, FileOrder& order, const std::string& place)
{
    const bool ordered = !descr.empty() && std::string_view("<>|=").find(descr[0]) != std::string_view::npos;
    order.bigEndian = ordered && descr[0] == '>';
    const std::string_view name = descr.substr(ordered ? 1 : 0);
    for (std::size_t i = 0; i < kDtypes.size(); ++i)
        if (kDtypes[i].name == name || (name == "?" && kDtypes[i].name == "b1")) return static_cast<Dtype>(i);
    const std::string what = name.starts_with('c')                                                    ? "complex numbers"
                             : name.starts_with('O')                                                  ? "Python objects"
                             : name.starts_with('S') || name.starts_with('U')                         ? "text"
                             : name.starts_with('f') || name.starts_with('g') || name == "longdouble" ? "floats of a size that differs between machines"
                                                                                                      : "neither numbers nor booleans";
    throw InputError(place, "holds elements of type '" + std::string(descr) + "', " + what + "; " + kResave);
}

NpyArray parseHeader(std::string_view text, FileOrder& fileOrder, const std::string& place)
{
    NpyArray array;
    HeaderText header(text, place);
    bool descr = false, order = false, shape = false;
    header.expect("{");
    while (!header.take("}")) {
        const std::string_view key = header.quoted();
        header.expect(":");
        if (key == "descr" && !descr) {
            if (header.take("[")) throw InputError(place, "holds records with named fields; save each field as an array of its own: numpy.save(file, a['x'])");
            array.dtype = dtypeOfDescr(header.quoted(), fileOrder, place);
            descr = true;
        } else if (key == "fortran_order" && !order) {
            fileOrder.fortran = header.take("True");
            if (!fileOrder.fortran) header.expect("False");
            order = true;
        } else if (key == "shape" && !shape) {
            array.shape = header.tuple();
            shape = true;
        } else {
            header.fail("its header has the unexpected key \"" + std::string(key) + "\"");
        }
        header.take(",");
    }
    if (!descr || !order || !shape) header.fail("its header lacks descr, fortran_order or shape");
    if (!header.done()) header.fail("text follows its header");
    return array;
}

void swapBytes(std::vector<std::byte>& bytes, std::size_t size)
{
    for (std::size_t at = 0; at + size <= bytes.size(); at += size)
        std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
}

/// From first index fastest to last index fastest.
std::vector<std::byte> inCOrder(const std::vector<std::byte>& bytes, const std::vector<std::size_t>& shape, std::size_t size)
{
    std::vector<std::byte> result(bytes.size());
    std::vector<std::size_t> strides(shape.size(), size), index(shape.size(), 0);
    for (std::size_t axis = 1; axis < shape.size(); ++axis) strides[axis] = strides[axis - 1] * shape[axis - 1];
    std::size_t from = 0;
    for (std::size_t to = 0; to < result.size(); to += size) {
        std::memcpy(result.data() + to, bytes.data() + from, size);
        for (std::size_t axis = shape.size(); axis-- > 0;) {
            from += strides[axis];
            if (++index[axis] < shape[axis]) break;
            from -= strides[axis] * shape[axis];
            index[axis] = 0;
        }
    }
    return result;
}

}  // namespace

std::size_t sizeOf(Dtype dtype)
{
    return kDtypes[static_cast<std::size_t>(dtype)].bytes;
}

std::string_view nameOf(Dtype dtype)
{
    return kDtypes[static_cast<std::size_t>(dtype)].name;
}

bool isFloat(Dtype dtype)
{
    return dtype == Dtype::f2 || dtype == Dtype::f4 || dtype == Dtype::f8;
}

Dtype dtypeByName(std::string_view name, const std::string& place)
{
    for (std::size_t i = 0; i < kDtypes.size(); ++i)
        if (kDtypes[i].name == name) return static_cast<Dtype>(i);
    throw InputError(
        place, "\"" + std::string(name) + "\" is no element type; they are " + joined(kDtypes, [](const DtypeRow& row) { return std::string(row.name); }));
}

std::size_t elementCount(const std::vector<std::size_t>& shape, const std::string& place)
{
    constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max() / 8;
    std::size_t count = 1;
    for (const std::size_t extent : shape) {
        if (extent != 0 && count > kMost / extent) throw InputError(place, "its shape is larger than any file");
        count *= extent;
    }
    return count;
}

std::string shapeText(const std::vector<std::size_t>& shape)
{
    return "(" + joined(shape, [](std::size_t extent) { return std::to_string(extent); }) + (shape.size() == 1 ? ",)" : ")");
}

std::string npyHeader(Dtype dtype, const std::vector<std::size_t>& shape)
{
    std::string text =
        "{'descr': '" + std::string(kDtypes[static_cast<std::size_t>(dtype)].descr) + "', 'fortran_order': False, 'shape': " + shapeText(shape) + ", }";
    // Blanks and a newline bring the data to a multiple of 64.
    text.append((kAlignment - (kPreamble + text.size() + 1) % kAlignment) % kAlignment, ' ');
    text += '\n';
    const char preamble[] = {1, 0, static_cast<char>(text.size() & 255), static_cast<char>(text.size() >> 8)};
    return std::string(kNpyMagic) + std::string(preamble, sizeof preamble) + text;
}

std::vector<std::byte> encodeNpy(Dtype dtype, const std::vector<std::size_t>& shape, std::span<const std::byte> bytes)
{
    assert(bytes.size() == elementCount(shape, "npy") * sizeOf(dtype));
    const std::string header = npyHeader(dtype, shape);
    std::vector<std::byte> file(header.size() + bytes.size());
    std::memcpy(file.data(), header.data(), header.size());
    if (!bytes.empty()) std::memcpy(file.data() + header.size(), bytes.data(), bytes.size());
    return file;
}

NpyArray decodeNpy(std::span<const std::byte> file, const std::string& place)
{
    const auto* text = reinterpret_cast<const char*>(file.data());
    if (file.size() < kPreamble || std::string_view(text, kNpyMagic.size()) != kNpyMagic) throw InputError(place, "is no .npy file");
    const int major = int(file[6]), minor = int(file[7]);
    if (major < 1 || major > 3 || minor != 0)
        throw InputError(place, "is .npy of version " + std::to_string(major) + "." + std::to_string(minor) + "; 1.0, 2.0 and 3.0 are read");
    const std::size_t preamble = major == 1 ? kPreamble : kPreamble + 2;
    std::size_t headerSize = 0;
    for (std::size_t i = std::min(preamble, file.size()); i-- > kPreamble - 2;) headerSize = headerSize << 8 | static_cast<std::size_t>(file[i]);
    if (file.size() < preamble || file.size() - preamble < headerSize) throw InputError(place, "is no readable .npy: it ends within its header");

    FileOrder order;
    NpyArray array = parseHeader(std::string_view(text + preamble, headerSize), order, place);
    const std::size_t size = sizeOf(array.dtype), expected = elementCount(array.shape, place) * size, held = file.size() - preamble - headerSize;
    if (held != expected) throw InputError(place, "holds " + std::to_string(held) + " bytes of data where its shape needs " + std::to_string(expected));
    const auto data = file.subspan(preamble + headerSize);
    array.bytes.assign(data.begin(), data.end());
    if (order.bigEndian && size > 1) swapBytes(array.bytes, size);
    if (order.fortran) array.bytes = inCOrder(array.bytes, array.shape, size);
    return array;
}

NpyArray readNpy(const std::string& path)
{
    const std::vector<unsigned char> file = readFile(path);
    return decodeNpy(std::as_bytes(std::span(file)), path);
}

}  // namespace lrsm
