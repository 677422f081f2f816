#pragma once

#include "conetrace/frame/gather.h"

#include <string>
#include <vector>

namespace lrsm {

/// The picture, its parts, and what the passes say of themselves.
struct Frame {
    Requirements needs;
    GBuffer gbuffer;
    Image<Vec3> direct;           ///< radiance towards the eye, W/(m^2 sr)
    Image<Vec3> irradiance;       ///< indirect, before the receiver's albedo, W/m^2
    Image<Vec3> indirectDiffuse;  ///< albedo * irradiance / pi
    Image<Vec3> indirectSpecular;
    Image<Vec3> combined;  ///< direct + indirectDiffuse + indirectSpecular
    Image<float> opacity;  ///< mean opacity of the hemisphere, 0 open .. 1 closed
    std::vector<PassReport> passes;
};

struct RenderOptions {
    int width = 1280, height = 720;
    int lanes = 0;  ///< as GatherInput's
    PassWatch watch;
    World* kept = nullptr;  ///< what an earlier frame of any scene and settings left: what still holds is taken from there, and no bit changes
    GatherMethod method;    ///< instead of settings.method's, where its `gather` is set: validation gathers by rays
};

/// Once a frame, so that the passes need only assert: the scene is whole, the settings are in range (InputError); and what the scene requires.
Requirements prepare(const Scene& scene, const Settings& settings);

/// All passes once, in the order of the paper's Figure 3.
Frame renderFrame(const Scene& scene, const Camera& camera, const Settings& settings, const RenderOptions& options);

/// How one pixel came about, as text: cone by cone, step by step (alpha, level, layers, R, V, N, A, f, transmittance).
std::string explainPixel(const Scene& scene, const Camera& camera, const Settings& settings, const RenderOptions& options, int x, int y);

/// What the frame will hold, pass by pass, without rendering it.
std::vector<MemoryRow> predictMemory(const MemoryQuestion& question);

/// The one place that knows all methods.
GatherMethod methodOf(const Settings& settings);

}  // namespace lrsm
