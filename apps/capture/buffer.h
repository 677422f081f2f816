#pragma once

#include "apps/capture/dds.h"
#include "apps/capture/npy.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lrsm {

/// What an element's bits stand for.
enum class Encoding {
    number,  ///< the number itself: IEEE float or integer, by the dtype
    unorm,   ///< bits / (2^n - 1), n = 8 or 16
    bits,    ///< voxels, one bit each, lowest bit first
};

/// How far a candidate may be from the golden buffer, element by element; the unit is the decoded value's. For a pass on the same inputs: along
/// a chain of passes differences add up. Fractions are of the elements that are not 0 in both.
struct Tolerance {
    enum class Kind {
        exact,     ///< the same bits
        ulp,       ///< so many neighbours of the storage away: codes of a UNORM, representable halves or floats
        absolute,  ///< |c - g| <= value
        relative,  ///< |c - g| <= value * max(|g|, floor)
    };
    Kind kind = Kind::exact;
    double value = 0.0;
    double floor = 0.0;      ///< relative: below this the bound stays what it is there
    double outliers = 0.0;   ///< fraction that may lie outside: decisions (coverage, layers) that flip on their edge
    double differing = 1.0;  ///< fraction that may differ at all: tells rounding that is allowed from rounding that is wrong everywhere
    std::string reason;      ///< one sentence
    bool operator==(const Tolerance&) const = default;
};

/// Where in a DDS the buffer also is.
struct DdsPlace {
    std::string file;
    std::uint32_t mip = 0;
    DxgiFormat format = DxgiFormat::R8_UNORM;
    bool volume = false;
    bool operator==(const DdsPlace&) const = default;
};

/// One array of a capture: a texture at one mip level, a table, a list of vertices.
struct Buffer {
    std::string name;  ///< "lrsm0.radiance.mip3": letters, digits, '_' and '.'; unique in the capture
    std::string pass;  ///< that made it: "lrsm 0", as in frame.json; "scene" and "tables" hold what is given
    Dtype dtype = Dtype::f4;
    Encoding encoding = Encoding::number;
    std::vector<std::size_t> shape;       ///< C order
    std::vector<std::string> axes;        ///< a name an axis: "layer", "row", "column", "component"
    std::vector<std::string> components;  ///< of the last axis; empty: there is no component axis. An empty name is unused and not compared.
    std::string meaning, space, unit;     ///< one line each; unit "" for none
    Tolerance tolerance;
    std::string file;  ///< the .npy, in the capture's folder
    std::optional<DdsPlace> dds;
    std::string sha256;  ///< of `bytes`
    std::vector<std::byte> bytes;

    std::size_t elements() const { return elementCount(shape, name); }
    template <class T>
    std::span<const T> as() const
    {
        return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
    }
};

// Names of mips: "lrsm0.depth.mip3".
bool isMip(const std::string& name);
int levelOf(const std::string& name);         ///< 3; 0 for what is no mip. The order of the data flow within a pass.
std::string stemOf(const std::string& name);  ///< "lrsm0.depth"; what is no mip: all of it
std::string mipName(const std::string& stem, int level);

std::string_view nameOf(Encoding encoding);
Encoding encodingByName(std::string_view name, const std::string& place);
std::string_view nameOf(Tolerance::Kind kind);
Tolerance::Kind toleranceKindByName(std::string_view name, const std::string& place);

/// Values in a buffer: its elements, or its bits.
std::size_t valueCount(const Buffer& buffer);
/// Value i as a number: UNORM divided by 2^n - 1, half widened, bits 0 or 1 (lowest first). In double, which holds all but u8's exactly.
double decodedValue(const Buffer& buffer, std::size_t i);

/// The DDS files that these buffers are in, one texture a file, mips joined; without texels.
/// The buffers of a file must come in the order of their mips, level after level without a gap.
struct NamedTexture {
    std::string file;
    DdsTexture texture;
};
std::vector<NamedTexture> texturesOf(const std::vector<Buffer>& buffers);
/// Fills in the texels: channels that a buffer does not have are 0, bits become 0 and 255.
void fillTexture(NamedTexture& texture, const std::vector<Buffer>& buffers);

}  // namespace lrsm
