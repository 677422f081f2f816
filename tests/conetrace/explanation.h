#pragma once

#include "conetrace/render.h"
#include "core/scene/builtin_scenes.h"

#include "catch.h"

#include <cstdio>
#include <string>

namespace lrsm {

/// --pixel of the Cornell box: every cone is named, and what they give is the pixel's own irradiance.
inline void checkExplanation(Settings settings)
{
    const auto scene = makeBuiltinScene("cornell-box");
    settings.cones.set.filter = false;
    RenderOptions options;
    options.width = 48;
    options.height = 36;
    const Frame frame = renderFrame(*scene, scene->cameras[0], settings, options);
    const std::string text = explainPixel(*scene, scene->cameras[0], settings, options, 20, 30);
    for (int cone = 0; cone < 6; ++cone) CHECK(text.find("cone " + std::to_string(cone)) != std::string::npos);
    char expected[128];
    const Vec3 e = frame.irradiance.at(20, 30);
    std::snprintf(expected, sizeof expected, "irradiance (before the 4x4 filter) %.6g %.6g %.6g", double(e.x), double(e.y), double(e.z));
    CHECK(text.find(expected) != std::string::npos);
}

}  // namespace lrsm
