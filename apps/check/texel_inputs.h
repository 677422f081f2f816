#pragma once

#include "apps/capture/capture.h"

/// What a texel is computed from: the texels of the pass before it.
namespace lrsm {

struct TexelInput {
    std::string what;   ///< "lrsm0.depth.mip1, layer 1, row 6, column 14"; or a constant's name
    std::string value;  ///< "0.25, 0.0625, 1": all components; in the capture that the pass read
};

/// For element `element` of `buffer`: a mip's children, an LRSM texel's 2x2 RSM block and its layer's range, a pixel's G-buffer and so on. Buffers
/// that `inputs` does not have are left out. Also, last, how to see more: the command that explains a pixel.
std::vector<TexelInput> inputsOf(const Capture& inputs, const Buffer& buffer, std::size_t element);

/// All components of the texel that `element` is of, as text.
std::string texelText(const Buffer& buffer, std::size_t element);

}  // namespace lrsm
