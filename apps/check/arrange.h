#pragma once

#include "apps/capture/buffer.h"
#include "core/settings/settings.h"

#include <optional>

/// From an array as somebody stored it to a buffer as the golden has it (internal to the candidate's reader).
namespace lrsm {

/// An array of a file.
struct GivenArray {
    Dtype dtype = Dtype::f4;
    Encoding encoding = Encoding::number;
    bool encodingKnown = false;  ///< the file itself says it (DDS); else integers are taken for what the golden's integers are
    std::vector<std::size_t> shape;
    std::vector<std::byte> bytes;
    std::string note = {};  ///< how it was read, where the element type does not say it
};

/// What a map may say of an array; the axes' names are the golden's.
struct Arrangement {
    std::vector<std::string> axes;      ///< their order in the file; empty: the golden's
    std::vector<std::string> flip;      ///< axes that run the other way
    std::vector<std::size_t> layers;    ///< where in the file each layer of the golden is; empty: in place
    std::vector<std::size_t> channels;  ///< where in the file each component of the golden is; empty: in place
    double scale = 1.0, offset = 0.0;   ///< value = stored * scale + offset
    std::optional<Encoding> encoding;
    bool operator==(const Arrangement&) const = default;
};

struct Arranged {
    std::vector<std::byte> bytes;
    std::vector<double> given;  ///< empty where the array's elements are the golden's own
    std::string note;
};

/// InputError at `place` where the shapes do not fit or a value cannot be of the golden's type.
Arranged arrange(const Buffer& golden, const GivenArray& array, const Arrangement& how, HalfRounding rounding, const std::string& place);

}  // namespace lrsm
