#pragma once

#include "conetrace/frame/gbuffer.h"
#include "conetrace/lrsm/gather.h"
#include "core/settings/settings.h"
#include "lrsm/layers.h"

#include <functional>
#include <string>
#include <vector>

namespace lrsm {

/// What one pass took and made.
struct PassReport {
    std::string name;  ///< "voxelize", "voxel mips", "rsm 0", "lrsm 0", ..., "gbuffer", "direct", "cones", "filter", "composite"
    double milliseconds = 0.0;
    double cpuMilliseconds = 0.0;  ///< processor time of all threads of the process meanwhile
    std::size_t bytes = 0;         ///< held by the pass's output
    std::size_t gpuBytes = 0;      ///< the same in the GPU's formats
    std::string sha256;            ///< of the output; empty unless asked for
    std::uint64_t nonFinite = 0;   ///< NaNs and infinities in the output; the pass is broken where this is not 0
};

/// The picture, its parts, and what made it.
struct Frame {
    GBuffer gbuffer;
    Image<Vec3> direct;           ///< radiance towards the eye, W/(m^2 sr)
    Image<Vec3> irradiance;       ///< indirect, before the receiver's albedo, W/m^2
    Image<Vec3> indirectDiffuse;  ///< albedo * irradiance / pi
    Image<Vec3> indirectSpecular;
    Image<Vec3> combined;  ///< direct + indirectDiffuse + indirectSpecular
    Image<float> opacity;  ///< mean opacity of the diffuse cones, 0 open .. 1 closed
    std::vector<PassReport> passes;
    ConeCounts cones;
    std::uint64_t voxelsSet = 0;
    RasterCounts gbufferRaster;
    struct LightReport {
        RasterCounts raster;
        ConversionCounts conversions;
        std::vector<LayerRange> ranges;
        std::vector<std::uint64_t> validTexelsPerLayer;
        int layersAsked = 0;
        std::uint64_t negativeVariances = 0;
    };
    std::vector<LightReport> lights;
};

/// Is shown what the frame itself does not keep, the moment each pass has made it; functions may be empty.
struct FrameObserver {
    std::function<void(const OpacityPyramid&)> opacity;  ///< base level included
    std::function<void(std::size_t light, const Rsm&)> rsm;
    std::function<void(std::size_t light, const Lrsm&)> lrsm;
    std::function<void(const Gathered&, const ConeRecord&)> cones;  ///< before the 4x4 filter
};

struct RenderOptions {
    int width = 1280, height = 720;
    bool hashPasses = true;                                                  ///< SHA-256 of each pass's output; its time is not counted in the pass
    std::function<void(const std::string& pass, double fraction)> progress;  ///< may be empty
    /// When set, may replace what the diffuse cones brought (validation); there is no 4x4 filter then.
    std::function<void(const GBuffer&, const OpacityPyramid&, const std::vector<Lrsm>&, Gathered&)> replaceDiffuse;
    const FrameObserver* observer = nullptr;  ///< must outlive the frame; changes no bit of it
};

/// All passes once, in the order of the paper's Figure 3.
Frame renderFrame(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, const RenderOptions& options);

/// How one pixel came about, as text: cone by cone, step by step (alpha, level, layers, R, V, N, A, f, transmittance).
std::string explainPixel(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, const RenderOptions& options, int x,
                         int y);

}  // namespace lrsm
