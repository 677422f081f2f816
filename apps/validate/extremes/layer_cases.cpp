#include "apps/validate/extremes/synthetic_map.h"
#include "apps/validate/extremes/worlds.h"
#include "core/report/table.h"

#include <cmath>

// Sec. 4.3 and Table 1: layers, their edges and their storage, on maps made by hand.
namespace lrsm::extremes {
namespace {

/// Half keeps 11 bits, UNORM16 of a full texel 16: what a uniform map may lose. float32: roundings.
double uniformBound(Mode mode)
{
    return mode == Mode::float32 ? 1e-6 : 2e-3;
}

MapTexel slope(int x, int n)
{
    return {.depth = (static_cast<float>(x) + 0.5f) / static_cast<float>(n)};
}

/// Eq. 15's weights of all layers that hold z sum to 1 at each edge and its neighbours.
void edges(Mode mode, Probe& probe)
{
    const Rsm rsm = syntheticMap(64, [](int x, int) { return slope(x, 64); });
    for (const int layers : {1, 2, 3, 7, 16})
        for (const float overlap : {0.0f, 0.1f, 0.5f}) {
            const Lrsm lrsm = buildLrsm(rsm, layerSettings(mode, layers, 1, overlap));
            probe.output("lrsm", lrsm);
            double worst = 0.0;
            for (const LayerRange& range : lrsm.ranges)
                for (const float edge : {range.depthMin, range.depthMax, range.depthMin + range.delta, range.depthMax - range.delta})
                    for (int ulps = -2; ulps <= 2; ++ulps) {
                        float z = edge;
                        for (int i = 0; i < std::abs(ulps); ++i) z = std::nextafter(z, ulps < 0 ? -kInfinity : kInfinity);
                        if (z < lrsm.ranges.front().depthMin || z > lrsm.ranges.back().depthMax) continue;
                        double sum = 0.0;
                        for (const LayerRange& other : lrsm.ranges) sum += double(decay(other, z));
                        worst = std::max(worst, std::abs(sum - 1.0));
                    }
            probe.bound("sum of weights - 1", worst, 1e-6);
        }
}

/// One texel of n^2 holds light: at the top of the chain alpha is 1 / n^2.
void loneTexel(Mode mode, Probe& probe)
{
    const int n = 64;
    const FilteredTexel top = topOfLoneTexel(mode, n, &probe);
    // 16 of 65535: alpha itself is right to half a step of UNORM16.
    probe.bound("alpha over 1/4096, - 1", double(top.depthAlpha) * n * n - 1.0, mode == Mode::float32 ? 1e-6 : 0.04);
    probe.bound("A R over 1/4096, - 1", double(top.radiance.x) * n * n - 1.0, uniformBound(mode));
}

/// A map whose texels are all the same sends R where the sphere holds the surface.
void uniform(Mode mode, Probe& probe, int resolution)
{
    const Rsm rsm = flatMap(plainProjection(resolution), {});
    for (const bool dropEmpty : {true, false}) {
        LayerSettings settings = layerSettings(mode, 3, 2);
        settings.dropEmpty = dropEmpty;
        const Lrsm lrsm = buildLrsm(rsm, settings);
        probe.output("lrsm", lrsm);
        const Vec3 out = sampleAt(lrsm, 0.5f, 0.5f, 0.5f, 0.25f, paperCones());
        // The map's border is part of every footprint of a 1x1 base level taken at the centre: none of it there.
        probe.bound("R - 1", double(out.x) - 1.0, uniformBound(mode));
    }
}

void nothing(Mode mode, Probe& probe)
{
    const Rsm rsm = flatMap(plainProjection(32), {.coverage = 0.0f});
    for (const bool dropEmpty : {true, false}) {
        LayerSettings settings = layerSettings(mode, 16, 8);
        settings.dropEmpty = dropEmpty;
        const Lrsm lrsm = buildLrsm(rsm, settings);
        probe.output("lrsm", lrsm);
        probe.require(lrsm.layers() == (dropEmpty ? 0 : 128), "number of layers kept");
        probe.require(sampleAt(lrsm, 0.5f, 0.5f, 0.5f, 0.25f, paperCones()) == Vec3(0.0f), "light from an empty map");
    }
}

/// Depths in two clusters of three asked slices: the one between is empty.
void gap(Mode mode, Probe& probe)
{
    const Rsm rsm = syntheticMap(64, [](int x, int) { return MapTexel{.depth = x < 32 ? 0.1f : 0.9f}; });
    LayerSettings dropping = layerSettings(mode, 3, 1), keeping = dropping;
    keeping.dropEmpty = false;
    const Lrsm dropped = buildLrsm(rsm, dropping), kept = buildLrsm(rsm, keeping);
    probe.output("lrsm", dropped);
    probe.output("lrsm", kept);
    probe.require(dropped.layers() == 2 && kept.layers() == 3, "number of layers kept");
    for (const float z : {0.05f, 0.1f, 0.5f, 0.9f})
        probe.require(sampleAt(dropped, 0.3f, 0.5f, z, 0.1f, paperCones()) == sampleAt(kept, 0.3f, 0.5f, z, 0.1f, paperCones()),
                      "dropping an empty layer changed a sample");
    probe.require(sampleAt(dropped, 0.3f, 0.5f, 0.5f, 0.1f, paperCones()) == Vec3(0.0f), "light from between the clusters");
}

/// Neighbouring texels face opposite ways: the mean normal is 0.
void opposingNormals(Mode mode, Probe& probe)
{
    const Rsm rsm = syntheticMap(32, [](int x, int y) { return MapTexel{.normal = Vec3(0, 0, (x + y) % 2 ? 1 : -1)}; });
    const Lrsm lrsm = buildLrsm(rsm, layerSettings(mode));
    probe.output("lrsm", lrsm);
    for (const Backface backface : {Backface::cosine, Backface::step}) {
        ConeSettings cones = paperCones();
        cones.gather.backface = backface;
        probe.require(sampleAt(lrsm, 0.5f, 0.5f, 0.5f, 0.25f, cones) == Vec3(0.0f), "light from normals that cancel");
    }
}

/// All depths equal, at the range's ends and between.
void oneDepth(Mode mode, Probe& probe)
{
    for (const float depth : {0.0f, 1.0f, 0.5f, 0x1p-24f, std::nextafter(1.0f, 0.0f)}) {
        const Rsm rsm = flatMap(plainProjection(32), {.depth = depth, .nDotL = 1.0f});
        for (const int layers : {1, 2, 16}) {
            const Lrsm lrsm = buildLrsm(rsm, layerSettings(mode, layers, 8));
            probe.output("lrsm", lrsm);
            probe.require(lrsm.layers() == 1, "more layers than depths");
            ConeSettings cones = paperCones();
            cones.gather.layerSelection = LayerSelection::touched;
            probe.bound("R - 1", double(sampleAt(lrsm, 0.5f, 0.5f, depth, 0.1f, cones).x) - 1.0, uniformBound(mode));
        }
    }
}

/// Radii and places at the ends of float.
void strangeSamples(Mode mode, Probe& probe)
{
    const Rsm rsm = syntheticMap(32, [](int x, int) { return slope(x, 32); });
    const Lrsm lrsm = buildLrsm(rsm, layerSettings(mode, 3, 2, 0.1f));
    probe.output("lrsm", lrsm);
    const float nan = std::nanf("");
    for (const float radius : {0.0f, 1e-45f, 1e-38f, 1e-10f, 1.0f, 1e10f, 1e30f})
        for (const float u : {0.5f, 0.0f, 1.0f, -1e-7f, 1e20f, nan})
            for (const float z : {0.5f, 0.0f, 1.0f, -5.0f, 1e20f, nan}) {
                const Vec3 out = sampleAt(lrsm, u, 0.5f, z, radius, paperCones());
                probe.require(isFinite(out) && out.x >= 0.0f && out.x <= 1.01f, "a sample outside [0, R]");
                probe.note(double(out.x));
            }
    ConeSettings all = paperCones();
    all.gather.layerSelection = LayerSelection::touched;
    const Lrsm parted = buildLrsm(rsm, layerSettings(mode, 3, 2));
    probe.bound("sum over layers of a sphere far larger than the scene, - 1", double(sampleAt(parted, 0.5f, 0.5f, 0.5f, 1e10f, all).x) - 1.0,
                uniformBound(mode));
}

}  // namespace

Group layerCases()
{
    return {
        "layers",
        {{"z_c on layer edges", "1 to 16 depth layers, overlap 0, 0.1, 0.5; z_c at each edge and 2 ULPs to either side", "Eq. 15's weights sum to 1", edges},
         {"one lit texel of 4096", "the chain's top holds alpha = 1/4096", "A R and alpha are right to the storage's step", loneTexel},
         {"one texel", "an RSM of 2x2: one base texel, no mips", "a uniform map sends R", [](Mode mode, Probe& probe) { uniform(mode, probe, 2); }},
         {"four texels", "an RSM of 4x4", "a uniform map sends R", [](Mode mode, Probe& probe) { uniform(mode, probe, 4); }},
         {"all layers empty", "nothing drawn; 16 x 8 layers, empty ones dropped and kept", "no layer, no light, no NaN", nothing},
         {"an empty layer", "two depth clusters in three slices", "dropping the middle one changes no sample", gap},
         {"mean normal 0", "neighbouring texels face opposite ways", "N is 0: no light, no NaN", opposingNormals},
         {"one depth", "all texels at depth 0, 1, 0.5, 2^-24, 1 - 2^-24; 1 to 16 layers", "one layer, and it sends R", oneDepth},
         {"radii and places at the ends of float", "r_c 0 to 1e30; u, z outside, 1e20, NaN", "finite, in [0, R]; a huge sphere sees all of the map",
          strangeSamples}}};
}

namespace {

void radianceOf(Mode mode, Probe& probe, double radiance)
{
    const double error = radianceError(mode, radiance, &probe);
    // Half: 11 bits within its normal range; below 6e-8 nothing is left, above 65504 all is 65504. Then less light, never more.
    const bool representable = mode == Mode::float32 || (radiance >= 6.2e-5 && radiance <= 65504.0);
    if (representable)
        probe.bound("relative error", error, uniformBound(mode));
    else
        probe.require(error <= 2e-3 || radiance < 6.2e-5, "more light than went in");
}

void frameOfIntensity(Mode mode, Probe& probe, float factor)
{
    World world = room();
    const Frame plain = renderWorld(world, smallSettings(mode));
    for (Light& light : world.scene.lights) light.intensity *= factor;
    const Frame scaled = renderWorld(world, smallSettings(mode));
    probe.frame(scaled);
    if (mode == Mode::float32 && factor > 1e-20f && factor < 1e20f)
        probe.bound("irradiance over the factor, relative difference", relativeDifference(scaled.irradiance, plain.irradiance, 1.0 / double(factor)), 1e-5);
}

void albedo(Mode mode, Probe& probe, float value)
{
    const World world = furnaceSphere(value, 1.0f, 3);
    const Frame frame = renderWorld(world, smallSettings(mode));
    probe.frame(frame);
    if (value == 0.0f) {
        probe.require(allZero(frame.irradiance) && allZero(frame.combined), "a black world gives light");
        return;
    }
    // A sphere's irradiance is albedo * intensity; 32^3 voxels of it are worth a few percent.
    probe.bound("irradiance over albedo * intensity, - 1", meanOf(frame.irradiance, frame.gbuffer) / double(value) - 1.0, 0.15);
}

}  // namespace

Group storageCases()
{
    Group group{"storage", {}};
    for (const double radiance : {1e-8, 6e-8, 6.1e-5, 1e-3, 1.0, 65504.0, 65519.0, 65520.0, 1e5, 1e8}) {
        group.cases.push_back({"radiance " + numberText(6, radiance), "a uniform map of this radiance, stored and sampled",
                               "within half's 2e-3 where half can hold it (6.2e-5 .. 65504), float32 always; outside never infinite, never NaN",
                               [radiance](Mode mode, Probe& probe) { radianceOf(mode, probe, radiance); }});
    }
    for (const float factor : {0.0f, 1e-38f, 1e-8f, 1e8f, 1e26f, 1e38f / 4.0f}) {
        group.cases.push_back({"light times " + numberText(6, double(factor)), "the room's light, scaled; a whole frame",
                               "every pass finite; float32 storage scales the picture",
                               [factor](Mode mode, Probe& probe) { frameOfIntensity(mode, probe, factor); }});
    }
    group.cases.push_back(
        {"albedo 0", "the furnace, black", "no light but none wrong: all pictures exactly 0", [](Mode mode, Probe& probe) { albedo(mode, probe, 0.0f); }});
    group.cases.push_back(
        {"albedo 1", "the furnace, white", "irradiance = intensity within 15 % (32^3 voxels)", [](Mode mode, Probe& probe) { albedo(mode, probe, 1.0f); }});
    group.cases.push_back({"albedo denormal", "the furnace of albedo 1e-40", "every pass finite",
                           [](Mode mode, Probe& probe) { probe.frame(renderWorld(furnaceSphere(1e-40f, 1.0f, 3), smallSettings(mode))); }});
    return group;
}

Group depthCases()
{
    Group group{"depth ranges", {}};
    for (int exponent = -6; exponent <= 6; ++exponent)
        group.cases.push_back({"depth range 1e" + std::to_string(exponent) + " m",
                               "a slope over this range; spheres of a tenth of it along it, against a range of 1 m",
                               "V is that of a range of 1 m: depths are warped, so the unit does not matter", [exponent](Mode mode, Probe& probe) {
                                   const auto range = float(std::pow(10.0, exponent));
                                   const auto texel = [](int x, int) { return slope(x, 64); };
                                   const Lrsm unit = buildLrsm(syntheticMap(64, texel), layerSettings(mode)),
                                              lrsm = buildLrsm(syntheticMap(64, texel, range), layerSettings(mode));
                                   probe.output("lrsm", lrsm);
                                   ConeSettings cones = paperCones();
                                   cones.gather.rsmMinLevel = 16.0f;  // the chain's top for both: spheres of kilometres and of millimetres read the same texel
                                   double worst = 0.0;
                                   for (float z = 0.05f; z < 1.0f; z += 0.05f)
                                       worst = std::max(worst, std::abs(double(sampleAt(lrsm, 0.5f, 0.5f, z * range, 0.1f * range, cones).x) -
                                                                        double(sampleAt(unit, 0.5f, 0.5f, z, 0.1f, cones).x)));
                                   probe.bound("difference of f A R V N", worst, 1e-4);
                               }});
    for (int exponent = 0; exponent <= 7; ++exponent)
        group.cases.push_back(
            {"depth offset 1e" + std::to_string(exponent) + " m", "the same slope of 1 m, this far from the light's origin: z^2 must not cancel",
             "V is that of no offset within what float32 leaves of a metre there", [exponent](Mode mode, Probe& probe) {
                 const auto offset = float(std::pow(10.0, exponent));
                 const auto texel = [](int x, int) { return slope(x, 64); };
                 const Lrsm unit = buildLrsm(syntheticMap(64, texel), layerSettings(mode)),
                            lrsm = buildLrsm(syntheticMap(64, texel, 1.0f, offset), layerSettings(mode));
                 probe.output("lrsm", lrsm);
                 ConeSettings cones = paperCones();
                 cones.gather.rsmMinLevel = 3.0f;
                 double worst = 0.0;
                 for (float z = 0.05f; z < 1.0f; z += 0.05f)
                     worst =
                         std::max(worst, std::abs(double(sampleAt(lrsm, 0.5f, 0.5f, z, 0.1f, cones).x) - double(sampleAt(unit, 0.5f, 0.5f, z, 0.1f, cones).x)));
                 // dV/dz <= phi(0) / sigma; sigma of the slope's footprint is at least 0.02 m.
                 probe.bound("difference of f A R V N", worst, 1e-5 + 40.0 * double(offset) * 0x1p-24);
             }});
    return group;
}

}  // namespace lrsm::extremes
