#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// NumPy's array file: numpy.load(path) and nothing else is needed to read a capture.
/// Format: numpy.lib.format: magic, version, header length, a Python dict as text, the array's bytes. We write version 1.0.
namespace lrsm {

/// Little endian. The names are NumPy's: boolean, unsigned, signed, IEEE float, and the bytes of one element. Captures hold u1 ... f8; the others
/// are read.
enum class Dtype { u1, u2, u4, u8, i4, f2, f4, f8, b1, i1, i2, i8 };
std::size_t sizeOf(Dtype dtype);
bool isFloat(Dtype dtype);
/// "u1" ... "i8".
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

/// Versions 1.0 to 3.0, either byte order, C or Fortran order, one of the dtypes above, exactly as many bytes as the shape says; what comes back is
/// little endian and in C order. InputError "PLACE: why; what to do" for anything else.
NpyArray decodeNpy(std::span<const std::byte> file, const std::string& place);
NpyArray readNpy(const std::string& path);

}  // namespace lrsm
