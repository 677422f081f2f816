#pragma once

#include "core/base/image.h"
#include "core/base/math.h"

#include <cstdint>

/// Linear, scene-referred pictures made fit to look at. The same bits on every machine.
namespace lrsm {

struct Rgb8 {
    std::uint8_t r = 0, g = 0, b = 0;
    bool operator==(const Rgb8&) const = default;
};

/// Stops that bring the 98th percentile of the luminance of the pixels that are not black to 0.8, in quarter stops, so that a small change
/// of the picture does not change the exposure. Not-finite pixels are left out. An all-black picture gets 0.
float automaticExposure(const Image<Vec3>& picture);

/// linear * 2^stops, not clipped: what FLIP and SSIM are given. A pixel that is not finite is black.
Image<Vec3> exposed(const Image<Vec3>& picture, float stops);

/// linear * 2^stops, clipped to [0, 1], sRGB encoded. A pixel that is not finite is magenta, so that it is seen.
Image<Rgb8> tonemap(const Image<Vec3>& picture, float stops);

/// min..max through a ramp that grows steadily in lightness, dark blue to yellow (viridis); clipped. Not finite: magenta.
Image<Rgb8> falseColor(const Image<float>& values, float min, float max);
/// -limit..limit: blue, white at 0, red. Not finite: black.
Image<Rgb8> signedFalseColor(const Image<float>& values, float limit);
/// Irradiance as the radiance of a white surface, E / pi, so that one exposure fits all parts of a picture.
Image<Vec3> onWhite(const Image<Vec3>& irradiance);
/// A unit vector as a colour, 0.5 + 0.5 n; the zero vector is black.
Image<Rgb8> normalColor(const Image<Vec3>& normals);

/// Rec. 709 luminance.
inline float luminance(const Vec3& c)
{
    return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

}  // namespace lrsm
