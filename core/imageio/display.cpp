#include "core/imageio/display.h"

#include "core/base/elementary.h"
#include "core/base/formats.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace lrsm {

namespace {

constexpr Rgb8 kMagenta{255, 0, 255};

float gainOf(float stops)
{
    return static_cast<float>(exp2Exact(std::clamp(double(stops), -120.0, 120.0)));
}

/// srgb8FromLinear for whole pictures: the same codes, by the least value of each.
class SrgbEncoder {
  public:
    SrgbEncoder()
    {
        // Codes grow with the value, and positive floats with their bits: bisect the bits.
        for (std::size_t code = 1; code < least_.size(); ++code) {
            std::uint32_t below = 0, reached = std::bit_cast<std::uint32_t>(1.0f);
            while (reached - below > 1) {
                const std::uint32_t middle = below + (reached - below) / 2;
                (srgb8FromLinear(std::bit_cast<float>(middle)) >= code ? reached : below) = middle;
            }
            least_[code] = std::bit_cast<float>(reached);
        }
    }
    std::uint8_t operator()(float linear) const
    {
        std::size_t code = 0;  // the last whose least value is not above `linear`
        for (std::size_t step = least_.size() / 2; step > 0; step /= 2)
            if (least_[code + step] <= linear) code += step;
        return static_cast<std::uint8_t>(code);
    }

  private:
    std::array<float, 256> least_{};
};

/// Piecewise linear through equally spaced sRGB colours; t in [0, 1].
Rgb8 ramp(std::span<const std::array<float, 3>> colors, float t)
{
    const float position = std::clamp(t, 0.0f, 1.0f) * static_cast<float>(colors.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(position), colors.size() - 2);
    const float fraction = position - static_cast<float>(below);
    const auto mix = [&](std::size_t channel) {
        const float value = colors[below][channel] + fraction * (colors[below + 1][channel] - colors[below][channel]);
        return static_cast<std::uint8_t>(value + 0.5f);
    };
    return {mix(0), mix(1), mix(2)};
}

// Ten samples of matplotlib's viridis (CC0).
constexpr std::array<std::array<float, 3>, 10> kViridis = {{{68, 1, 84},
                                                            {72, 40, 120},
                                                            {62, 74, 137},
                                                            {49, 104, 142},
                                                            {38, 130, 142},
                                                            {31, 158, 137},
                                                            {53, 183, 121},
                                                            {110, 206, 88},
                                                            {181, 222, 43},
                                                            {253, 231, 37}}};

constexpr std::array<std::array<float, 3>, 5> kBlueWhiteRed = {{{5, 48, 97}, {67, 147, 195}, {247, 247, 247}, {214, 96, 77}, {103, 0, 31}}};

template <class Source, class Convert>
Image<Rgb8> convertEach(const Image<Source>& source, const Convert& convert)
{
    Image<Rgb8> result(source.width, source.height);
    for (std::size_t i = 0; i < source.texels.size(); ++i) result.texels[i] = convert(source.texels[i]);
    return result;
}

}  // namespace

float automaticExposure(const Image<Vec3>& picture)
{
    std::vector<float> values;
    values.reserve(picture.texels.size());
    for (const Vec3& color : picture.texels)
        if (const float value = luminance(color); std::isfinite(value) && value > 0.0f) values.push_back(value);
    if (values.empty()) return 0.0f;

    const auto percentile = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * 98 / 100);
    std::nth_element(values.begin(), percentile, values.end());
    const double stops = log2Exact(0.8 / std::max(double(*percentile), 1e-30));
    return static_cast<float>(std::floor(4.0 * stops + 0.5) / 4.0);
}

Image<Vec3> exposed(const Image<Vec3>& picture, float stops)
{
    Image<Vec3> result = picture;
    const float gain = gainOf(stops);
    for (Vec3& v : result.texels) v = isFinite(v) ? v * gain : Vec3(0.0f);
    return result;
}

Image<Rgb8> tonemap(const Image<Vec3>& picture, float stops)
{
    const float gain = gainOf(stops);
    const SrgbEncoder codeOf;
    return convertEach(picture, [&](const Vec3& color) {
        if (!isFinite(color)) return kMagenta;
        const auto encode = [&](float value) { return codeOf(std::clamp(value * gain, 0.0f, 1.0f)); };
        return Rgb8{encode(color.x), encode(color.y), encode(color.z)};
    });
}

Image<Rgb8> falseColor(const Image<float>& values, float min, float max)
{
    const float scale = max > min ? 1.0f / (max - min) : 0.0f;
    return convertEach(values, [&](float value) { return std::isfinite(value) ? ramp(kViridis, (value - min) * scale) : kMagenta; });
}

Image<Rgb8> signedFalseColor(const Image<float>& values, float limit)
{
    const float scale = limit > 0.0f ? 0.5f / limit : 0.0f;
    return convertEach(values, [&](float value) { return std::isfinite(value) ? ramp(kBlueWhiteRed, 0.5f + value * scale) : Rgb8{}; });
}

Image<Rgb8> normalColor(const Image<Vec3>& normals)
{
    return convertEach(normals, [](const Vec3& n) {
        if (!isFinite(n)) return kMagenta;
        if (n == Vec3(0.0f)) return Rgb8{};
        const auto encode = [](float value) { return unorm8FromFloat(0.5f + 0.5f * value); };
        return Rgb8{encode(n.x), encode(n.y), encode(n.z)};
    });
}

Image<Vec3> onWhite(const Image<Vec3>& irradiance)
{
    Image<Vec3> radiance = irradiance;
    for (Vec3& value : radiance.texels) value *= 1.0f / kPi;
    return radiance;
}

}  // namespace lrsm
