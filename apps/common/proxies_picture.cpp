#include "apps/common/proxies_picture.h"

#include "core/base/parallel.h"
#include "core/scene/camera.h"

#include <algorithm>

namespace lrsm {

namespace {

constexpr int kPartGap = 4;  ///< pixels between the parts
constexpr Rgb8 kUnlit{24, 28, 64};
constexpr std::size_t kDiscRows = 8;

/// A colour for a number: the bits of Fibonacci hashing, none of them dark.
Rgb8 colourOfCell(std::uint32_t cell)
{
    const std::uint32_t bits = cell * 2654435769u;
    const auto channel = [&](int shift) { return static_cast<std::uint8_t>(48 + ((bits >> shift) & 127)); };
    return {channel(8), channel(16), channel(24)};
}

void paste(const Image<Rgb8>& part, int left, int top, Image<Rgb8>& picture)
{
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x) picture.at(left + x, top + y) = part.at(x, y);
}

Image<float> lengths(const VisibilityLists& lists, int width, int height)
{
    Image<float> out(width, height);
    const Blocks blocks{width, height, lists.divisor};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            out.at(x, y) = float(lists.of(std::size_t(y / blocks.divisor) * std::size_t(blocks.columns()) + std::size_t(x / blocks.divisor)).size());
    return out;
}

}  // namespace

Image<Rgb8> proxiesPicture(const SeenProxies& seen, const Camera& camera, int width, int height, float exposureStops)
{
    Image<Rgb8> picture(2 * width + kPartGap, 2 * height + kPartGap, {16, 16, 16});

    // Discs and cells.
    Image<Vec3> radiance(width, height);
    Image<Rgb8> cells(width, height);
    Image<std::uint8_t> unlit(width, height);
    parallelFor(std::size_t(height), kDiscRows, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < width; ++x) {
                const CameraRay ray = pixelRay(camera, width, height, float(x) + 0.5f, float(y) + 0.5f);
                const ShadowRay sight(ray.origin, ray.direction);
                const std::uint32_t cell = cellMet(seen.cells, sight);
                if (cell == kNoCell) continue;
                const std::size_t slot = nearestDisc(seen.cells, cell, sight).slot, k = slot & 3;
                const ProxyQuad& q = seen.cells.quads[slot / 4];
                radiance.at(x, y) = Vec3(q.red[k], q.green[k], q.blue[k]) / seen.cells.preExposure;
                unlit.at(x, y) = radiance.at(x, y) == Vec3(0.0f) ? 1 : 0;
                cells.at(x, y) = colourOfCell(cell);
            }
    });
    Image<Rgb8> discs = tonemap(radiance, exposureStops);
    for (std::size_t i = 0; i < discs.texels.size(); ++i)
        if (unlit.texels[i]) discs.texels[i] = kUnlit;
    paste(discs, 0, 0, picture);
    paste(cells, width + kPartGap, 0, picture);

    // Lengths of lists.
    const Image<float> before = lengths(seen.marched, width, height);
    const Image<float> after = seen.filtered.size() > 0 ? lengths(seen.filtered, width, height) : before;
    const float longest = std::max(1.0f, *std::max_element(after.texels.begin(), after.texels.end()));
    paste(falseColor(before, 0.0f, longest), 0, height + kPartGap, picture);
    paste(falseColor(after, 0.0f, longest), width + kPartGap, height + kPartGap, picture);
    return picture;
}

}  // namespace lrsm
