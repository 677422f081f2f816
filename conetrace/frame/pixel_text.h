#pragma once

#include "conetrace/frame/receiver.h"
#include "core/scene/scene.h"

#include <cstdio>
#include <string>

/// What `--pixel` says of a pixel, whatever the method.
namespace lrsm {

/// printf into a string; one line at most.
template <class... Values>
std::string formatted(const char* pattern, Values... values)
{
    char line[512];
    std::snprintf(line, sizeof line, pattern, values...);
    return line;
}

std::string nothingDrawnText(int x, int y);
/// Where the pixel's surface is, what it is like, and its rotation of the cones.
std::string receiverText(const GBuffer& gbuffer, const Receiver& receiver, int x, int y);
/// Heads the steps of each cone: its direction, weight and aperture.
std::string coneText(int cone, const Vec3& direction, float weight, float tanHalf);
/// I and opacity of a cone.
std::string resultText(const Vec3& radiance, float opacity);
/// What the diffuse cones give.
std::string irradianceText(const Vec3& irradiance, float opacity);
std::string specularText(const Vec3& radiance);
/// Empty unless the scene has an origin of its own.
std::string originText(const Scene& scene);

}  // namespace lrsm
