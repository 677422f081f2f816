#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// NumPy's array file: numpy.load(path) and nothing else is needed to read a capture.
/// Format: numpy.lib.format, version 1.0: magic, header length, a Python dict as text, the array's bytes.
namespace lrsm {

/// Little endian. The names are NumPy's: unsigned, signed, IEEE float, and the bytes of one element.
enum class Dtype { u1, u2, u4, u8, i4, f2, f4, f8 };
std::size_t sizeOf(Dtype dtype);
/// "u1" ... "f8".
std::string_view nameOf(Dtype dtype);
/// InputError that begins with `place` for a name that is none of them.
Dtype dtypeByName(std::string_view name, const std::string& place);

/// Elements in C order: the last index runs fastest.
struct NpyArray {
    Dtype dtype = Dtype::f4;
    std::vector<std::size_t> shape;  ///< empty: a single number
    std::vector<std::byte> bytes;
};

/// Product of the extents; 1 for none. InputError at `place` where it (times 8 bytes) overflows.
std::size_t elementCount(const std::vector<std::size_t>& shape, const std::string& place);

/// As Python writes it: "(2, 3)", "(2,)".
std::string shapeText(const std::vector<std::size_t>& shape);

/// What stands before the data.
std::string npyHeader(Dtype dtype, const std::vector<std::size_t>& shape);

/// The file's bytes. The data begin at a multiple of 64, as NumPy's own writer has it. `bytes` must be as long as the shape says.
std::vector<std::byte> encodeNpy(Dtype dtype, const std::vector<std::size_t>& shape, std::span<const std::byte> bytes);

/// Strict: version 1.0, little endian, C order, one of the dtypes above, exactly as many bytes as the shape says. InputError
/// "PLACE: why; what to do" for anything else.
NpyArray decodeNpy(std::span<const std::byte> file, const std::string& place);
NpyArray readNpy(const std::string& path);

}  // namespace lrsm
