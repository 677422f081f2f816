#include "apps/validate/extremes/worlds.h"
#include "core/base/errors.h"
#include "core/base/text.h"
#include "core/scene/shapes.h"
#include "core/settings/settings_table.h"
#include "voxel/voxelize.h"

#include <charconv>
#include <cmath>

// Cones of every aperture and number, grids and maps of every resolution, and each setting at both ends of its range.
namespace lrsm::extremes {
namespace {

using Assignments = std::vector<std::string>;

void apply(Settings& settings, const Assignments& assignments)
{
    for (const std::string& assignment : assignments) applySetting(settings, assignment);
}

/// The glossy room by both estimators.
Case finiteWith(const std::string& name, const std::string& what, Assignments assignments)
{
    return {name, what, "every pass finite", [=](Mode mode, Probe& probe) {
                for (Settings settings : {smallSettings(mode), smallLiteral(mode)}) {
                    apply(settings, assignments);
                    probe.frame(renderWorld(room(true), settings, 8, 6));
                }
            }};
}

/// The settings table takes none of these; nor does the pass that is given the value without asking the table.
Case refused(const std::string& name, const std::string& what, Assignments assignments, std::function<void(Settings&)> force = {})
{
    return {name, what, "refused in one line, by the table and by the frame",
            [=](Mode mode, Probe& probe) {
                for (const std::string& assignment : assignments)
                    probe.refuses(assignment, assignment.substr(0, assignment.find('=')), [&] {
                        Settings settings = smallSettings(mode);
                        applySetting(settings, assignment);
                    });
                if (!force) return;
                probe.refuses("frame", ": ", [&] {
                    Settings settings = smallSettings(mode);
                    force(settings);
                    renderWorld(room(), settings, 4, 3);
                });
                probe.refuses("cones alone", ": ", [&] {
                    Settings settings = smallSettings(mode);
                    force(settings);
                    const OpacityPyramid opacity = buildPyramid(voxelize(room().scene, smallSettings(mode).voxel), smallSettings(mode).voxel);
                    traceCones({}, {}, opacity, {}, {}, settings.cones);
                });
            },
            true};
}

/// A frame of the furnace sphere at this resolution.
void gridOf(Mode mode, Probe& probe, int resolution)
{
    for (const OpacityAxes axes : {OpacityAxes::directional, OpacityAxes::isotropic})
        for (const Voxelization kind : {Voxelization::conservative, Voxelization::thin, Voxelization::raster}) {
            Settings settings = smallSettings(mode);
            settings.voxel.resolution = resolution;
            settings.voxel.axes = axes;
            settings.voxel.mode = kind;
            const Frame frame = renderWorld(room(), settings, 4, 3);
            probe.frame(frame);
            probe.require(counterSum(frame.passes, "voxels_set") > 0.0, "no voxel is set");
        }
}

/// An axis-parallel plane through the middle of the largest grids: exactly one layer of voxels.
void largeGrid(Probe& probe, int resolution)
{
    VoxelGrid grid;
    grid.resolution = resolution;
    const auto n = static_cast<float>(resolution);
    const float y = 0.5f * n + 0.25f;
    const BitGrid bits = voxelizeTriangles(
        {Vec3(-1, y, -1), Vec3(-1, y, n + 1), Vec3(n + 1, y, n + 1), Vec3(-1, y, -1), Vec3(n + 1, y, n + 1), Vec3(n + 1, y, -1)}, grid, Voxelization::thin);
    probe.note(static_cast<double>(bits.countOccupied()));
    probe.bound("voxels set over n^2, - 1", static_cast<double>(bits.countOccupied()) / (double(n) * double(n)) - 1.0, 0.0);
}

}  // namespace

Group coneCases()
{
    Group group{"cones", {}};
    auto& cases = group.cases;
    cases.push_back(refused("aperture 0", "specular and shadow cones of no width",
                            {"specular_aperture_degrees=0", "shadow_cone_aperture_degrees=0", "aperture_scale=0"},
                            [](Settings& s) { s.cones.specular.apertureDegrees = 0.0f; }));
    cases.push_back(refused("aperture of 179 degrees", "wider than a cone can be traced", {"specular_aperture_degrees=179"},
                            [](Settings& s) { s.cones.specular.apertureDegrees = 179.0f; }));
    cases.push_back(refused("zero cones", "cone_count = 0", {"cone_count=0"}, [](Settings& s) { s.cones.set.count = 0; }));
    cases.push_back(refused("minus one cone", "cone_count = -1", {"cone_count=-1"}, [](Settings& s) { s.cones.set.count = -1; }));
    cases.push_back(refused("more steps than 1e5", "max_steps = 100001", {"max_steps=100001"}, [](Settings& s) { s.cones.march.maxSteps = 100001; }));
    cases.push_back(
        refused("step 0, NaN, negative", "no step", {"step=0", "step=nan", "step=-1", "step=1e-50"}, [](Settings& s) { s.cones.march.step = std::nanf(""); }));
    cases.push_back(refused("no sets of cones", "sets_per_pixel = 0", {"sets_per_pixel=0"}, [](Settings& s) { s.cones.set.setsPerPixel = 0; }));
    cases.push_back(finiteWith("aperture of 1e-3 degrees", "specular cone", {"specular_aperture=fixed", "specular_aperture_degrees=0.001"}));
    cases.push_back(finiteWith("aperture of 170 degrees", "specular cone", {"specular_aperture=fixed", "specular_aperture_degrees=170"}));
    cases.push_back(finiteWith("aperture of 1e-38 degrees", "specular and shadow cones of denormal width",
                               {"specular_aperture=fixed", "specular_aperture_degrees=1e-38", "shadow_cone_aperture_degrees=1e-38", "shadows=cone"}));
    cases.push_back(finiteWith("shadow cones of 90 degrees", "", {"shadows=cone", "shadow_cone_aperture_degrees=90"}));
    cases.push_back(finiteWith("diffuse cones of 1e-6 of their aperture", "", {"aperture_scale=1e-6"}));
    cases.push_back(finiteWith("diffuse cones of twice their aperture", "", {"aperture_scale=2"}));
    cases.push_back(finiteWith("1e5 steps", "a step of a 1/500 of the diameter", {"max_steps=100000", "step=0.002"}));
    cases.push_back(finiteWith("one cone", "", {"cone_count=1"}));
    cases.push_back(finiteWith("256 cones", "", {"cone_count=256"}));
    cases.push_back(finiteWith("one step", "", {"max_steps=1"}));
    cases.push_back({"a step that float32 loses", "step = 1e-30", "refused in one line: the cone would end in silence",
                     [](Mode mode, Probe& probe) {
                         Settings settings = smallSettings(mode);
                         applySetting(settings, "step=1e-30");
                         renderWorld(room(), settings, 4, 3);
                         (void)probe;
                     },
                     true, true});
    cases.push_back({"irradiance of a furnace", "the sphere lit from its centre, 64^3 voxels, by six cones and by 32", "albedo * intensity within 10 %",
                     [](Mode mode, Probe& probe) {
                         for (const int count : {6, 32}) {
                             Settings settings = smallSettings(mode);
                             settings.voxel.resolution = 64;
                             settings.cones.set.count = count;
                             const Frame frame = renderWorld(furnaceSphere(0.5f, 1.0f), settings, 8, 6);
                             probe.frame(frame);
                             probe.bound("irradiance over 0.5, - 1", meanOf(frame.irradiance, frame.gbuffer) / 0.5 - 1.0, 0.10);
                         }
                     }});
    return group;
}

Group resolutionCases()
{
    Group group{"resolutions", {}};
    auto& cases = group.cases;
    for (const int resolution : {1, 2, 4, 8, 16, 128})
        cases.push_back({"voxels " + std::to_string(resolution), "the room in this grid, three voxelizations, both kinds of opacity",
                         "every pass finite, and some voxel set", [resolution](Mode mode, Probe& probe) { gridOf(mode, probe, resolution); }});
    for (const int resolution : {512, 1024, 2048})
        cases.push_back({"voxels " + std::to_string(resolution) + ", bits", "a plane through the middle of this grid (2048: 1.1 GB)",
                         "exactly n^2 voxels; skipped where the machine lacks the memory", [resolution](Mode, Probe& probe) { largeGrid(probe, resolution); },
                         true});
    for (const int resolution : {2, 4, 1024})
        cases.push_back(finiteWith("RSM " + std::to_string(resolution), "the room's light by this map", {"rsm_resolution=" + std::to_string(resolution)}));
    cases.push_back(finiteWith("layers at their most", "16 x 8 layers, all kept", {"depth_layers=16", "normal_layers=8", "drop_empty=false"}));
    cases.push_back(finiteWith("smallest of all", "voxels 1, RSM 2, one layer, one cone, one step",
                               {"voxel_resolution=1", "rsm_resolution=2", "depth_layers=1", "normal_layers=1", "cone_count=1", "max_steps=1"}));
    cases.push_back(refused("RSM 1", "no base texel would be left", {"rsm_resolution=1", "rsm_resolution=3", "rsm_resolution=16384"}));
    cases.push_back(refused("voxels 0, 3, 4096", "no power of two in 1 .. 2048", {"voxel_resolution=0", "voxel_resolution=3", "voxel_resolution=4096"}));
    for (const int resolution : {0, -4, 3, 4096, 1 << 30})
        cases.push_back(refusal("voxelize at " + std::to_string(resolution), "the pass itself, given this",
                                [resolution](Mode, Probe&) { voxelize(room().scene, {.resolution = resolution}); }));
    for (const int resolution : {0, 1, -4, 3, 1 << 30})
        cases.push_back(refusal("renderRsm at " + std::to_string(resolution), "the pass itself, given this", [resolution](Mode, Probe&) {
            const World world = room();
            renderRsm(world.scene, world.scene.lights[0], {}, {.resolution = resolution});
        }));
    return group;
}

namespace {

/// An end of a numeric setting's range, as text: "(0, 2]" has its open end one float inside.
std::vector<std::string> endsOf(const SettingInfo& info)
{
    const std::string& a = info.allowed;
    if (a.find(" | ") != std::string::npos) return split(a, " | ");
    if (const std::size_t dots = a.find(" .. "); dots != std::string::npos) {
        const std::string last = a.substr(dots + 4, a.find(',') == std::string::npos ? std::string::npos : a.find(',') - dots - 4);
        // What a small machine can hold; the very ends are cases of their own.
        if (info.key == "voxel_resolution") return {"1", "128"};
        if (info.key == "rsm_resolution") return {"2", "512"};
        return {a.substr(0, dots), last};
    }
    float low = 0.0f, high = 0.0f;
    const std::size_t comma = a.find(", ");
    std::from_chars(a.data() + 1, a.data() + comma, low);
    std::from_chars(a.data() + comma + 2, a.data() + a.size() - 1, high);
    if (a.front() == '(') low = std::numeric_limits<float>::denorm_min();
    if (a.back() == ')') high = std::nextafter(high, 0.0f);
    const auto text = [](float v) {
        char buffer[64];
        return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, v).ptr);
    };
    return {text(low), text(high)};
}

/// Finite, or refused clearly because of what the settings are together.
void tryFrame(Probe& probe, const Settings& settings, const std::string& which)
{
    try {
        validate(settings);
        probe.frame(renderWorld(room(true), settings, 4, 3));
    } catch (const InputError& error) {
        probe.require(isClear(error.what()), which + ": unclear refusal: " + error.what());
        probe.note(std::string(error.what()));
    }
    if (probe.broken()) probe.require(false, "with " + which);
}

void bothEnds(Mode mode, Probe& probe, const SettingInfo& info)
{
    for (const std::string& value : endsOf(info))
        for (Settings settings : {smallSettings(mode), smallLiteral(mode)}) {
            applySetting(settings, info.key + "=" + value);
            tryFrame(probe, settings, info.key + "=" + value);
        }
}

/// Settings drawn from the ends of all ranges by a fixed rule: combinations that nobody thought of.
void combinations(Mode mode, Probe& probe, std::uint32_t seed)
{
    std::uint32_t state = seed;
    const auto draw = [&state](std::uint32_t below) {
        state = state * 1664525u + 1013904223u;
        return (state >> 16) % below;
    };
    for (int i = 0; i < 8; ++i) {
        Settings settings = smallSettings(mode);
        std::string which;
        for (const SettingInfo& info : describeSettings()) {
            if (info.shorthand || info.stage == "force" || info.key.find("storage") != std::string::npos || info.key.find("rounding") != std::string::npos)
                continue;
            if (info.key == "sets_per_pixel" || info.key == "cone_count" || info.key == "max_steps") continue;
            if (draw(2) == 0) continue;
            const std::vector<std::string> ends = endsOf(info);
            const std::string assignment = info.key + "=" + ends[draw(static_cast<std::uint32_t>(ends.size()))];
            applySetting(settings, assignment);
            which += assignment + " ";
        }
        if (settings.cones.march.estimator == Estimator::slab) settings.cones.gather.layerSelection = LayerSelection::touched;
        if (settings.cones.gather.layerSelection == LayerSelection::touched) settings.layers.overlap = 0.0f;
        // The least of an open range is a denormal: with it no cone moves, which has its own case.
        settings.cones.march.step = std::max(settings.cones.march.step, 0.05f);
        settings.cones.march.minDiameterVoxels = std::max(settings.cones.march.minDiameterVoxels, 0.05f);
        tryFrame(probe, settings, which);
    }
}

}  // namespace

Group settingCases()
{
    Group group{"settings", {}};
    for (const SettingInfo& info : describeSettings()) {
        if (info.shorthand || info.key.find("storage") != std::string::npos || info.key.find("rounding") != std::string::npos) continue;
        group.cases.push_back({info.key + " at each end", "allowed: " + info.allowed + "; both estimators", "every pass finite, or refused in one line",
                               [info](Mode mode, Probe& probe) { bothEnds(mode, probe, info); }});
        if (info.allowed.front() != '(' && info.allowed.front() != '[') continue;
        group.cases.push_back({info.key + " no number", "nan, inf, -inf, 1e39, empty, text", "refused in one line that names the key",
                               [info](Mode, Probe& probe) {
                                   for (const char* value : {"nan", "inf", "-inf", "1e39", "-1e39", "", "x", "1,5", "0x10", "1e", "--1"})
                                       probe.refuses(info.key + "=" + value, info.key, [&] {
                                           Settings settings;
                                           applySetting(settings, info.key + "=" + value);
                                       });
                               },
                               true});
    }
    for (std::uint32_t seed = 1; seed <= 4; ++seed)
        group.cases.push_back({"combinations " + std::to_string(seed), "8 frames with half of all settings at an end of their range, drawn by a fixed rule",
                               "every pass finite, or refused in one line", [seed](Mode mode, Probe& probe) { combinations(mode, probe, seed); }});
    return group;
}

}  // namespace lrsm::extremes
