#pragma once

#include "conetrace/frame/gbuffer.h"

namespace lrsm {

/// A plane z = 0 seen head-on, one unit a pixel.
inline GBuffer flatPlane(int width, int height)
{
    GBuffer g;
    g.width = width;
    g.height = height;
    g.position = Image<Vec3>(width, height);
    g.geometricNormal = g.normal = Image<Vec3>(width, height, Vec3(0, 0, 1));
    g.objectId = Image<std::uint32_t>(width, height, 1u);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) g.position.at(x, y) = Vec3(x, y, 0);
    return g;
}

}  // namespace lrsm
