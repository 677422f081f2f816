#pragma once

#include "conetrace/frame/gbuffer.h"
#include "conetrace/frame/memory.h"
#include "conetrace/frame/world.h"

#include <functional>

/// The seam between the frame and the methods of indirect light: a method is a plain function from world and G-buffer to gathered light.
/// docs/adding-a-method.md walks through it.
namespace lrsm {

/// What every method is given.
struct GatherInput {
    const Scene& scene;
    const Camera& camera;
    const Requirements& needs;
    const Settings& settings;
    const GBuffer& gbuffer;
    const std::vector<Rsm>& rsms;   ///< one a light, in the scene's order
    const OpacityPyramid& opacity;  ///< as far as the method reads it (WorldReads): bits alone, or with mips; else empty
    int lanes = 0;                  ///< pixels that wide kernels take at a time; 0: as many as the machine can. The bits are the same
    World* kept = nullptr;          ///< where the world outlives the frame: rsms and opacity are its, and what the method keeps beside
};

/// Indirect light at each pixel's surface; 0 where nothing was drawn.
struct Gathered {
    Image<Vec3> irradiance;   ///< W/m^2, before the receiver's albedo
    Image<Vec3> specular;     ///< mean radiance over the specular lobe, W/(m^2 sr); empty when the scene has no specular part
    Image<float> lobeWeight;  ///< where lobes are sampled: `specular` is of one direction, and counts as much (LobeDirection); else empty
    Image<float> opacity;     ///< mean opacity of the hemisphere, 0 open .. 1 closed
    bool filter4x4 = false;   ///< directions alternate over 4x4 pixels: the frame averages the irradiance over them
    Counters counters;
};

/// Pictures of the G-buffer's size, all 0.
/// `lobes`: with weights of the lobes' directions.
inline Gathered emptyGathered(const GBuffer& gbuffer, const Requirements& needs, bool lobes = false)
{
    Gathered out;
    out.irradiance = Image<Vec3>(gbuffer.width, gbuffer.height);
    out.opacity = Image<float>(gbuffer.width, gbuffer.height);
    if (needs.specular) out.specular = Image<Vec3>(gbuffer.width, gbuffer.height);
    if (needs.specular && lobes) out.lobeWeight = Image<float>(gbuffer.width, gbuffer.height);
    return out;
}

/// Irradiance with opacity, and specular with its weight: half x4 on a GPU.
template <class Visit>
void forEachArray(const Gathered& gathered, Visit&& visit)
{
    forEachArray(gathered.irradiance, visit);
    forEachArray(gathered.specular, visit);
    if (!gathered.lobeWeight.empty()) visit(gathered.lobeWeight.texels, ArrayTraits{0});
    visit(gathered.opacity.texels, ArrayTraits{0});
}

inline const Counters& countersOf(const Gathered& gathered)
{
    return gathered.counters;
}

/// One method, as the frame's switch (conetrace/render.cpp) knows it.
struct GatherMethod {
    WorldReads reads;
    /// Gathers for each pixel by itself, so that it may be given one a block (gather_divisor, conetrace/frame/reduce.h); else it is given all.
    bool pixelByPixel = true;
    std::function<Gathered(const GatherInput&, PassLog&)> gather;
    /// How one pixel came about, as text; may be empty.
    std::function<std::string(const GatherInput&, int x, int y)> explain;
    /// What the method's own passes will hold, in order; may be empty.
    std::function<std::vector<MemoryRow>(const MemoryQuestion&)> predict;
};

}  // namespace lrsm
