#include "apps/common/messages.h"

#include "core/scene/coarse_view.h"
#include "core/scene/light.h"
#include "lrsm/rsm.h"
#include "voxel/voxelize.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <optional>

namespace lrsm {

namespace {

std::string metres(double length)
{
    char text[32];
    std::snprintf(text, sizeof text, length < 1.0 ? "%.3g mm" : "%.4g m", length < 1.0 ? 1e3 * length : length);
    return text;
}

std::string quoted(const std::string& name)
{
    return '"' + name + '"';
}

std::string count(double number, const std::string& noun)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.0f ", number);
    return text + noun + (number == 1.0 ? "" : "s");
}

/// A note without its first quoted name: equal for notes of one kind.
std::string kindOf(const std::string& note)
{
    const std::size_t begin = note.find('"'), end = begin == std::string::npos ? begin : note.find('"', begin + 1);
    return end == std::string::npos ? note : note.substr(0, begin) + note.substr(end + 1);
}

std::vector<std::string> oneAKind(const std::vector<std::string>& notes)
{
    struct Kind {
        std::string kind, first;
        std::size_t more = 0;
    };
    std::vector<Kind> kinds;
    for (const std::string& note : notes) {
        const std::string kind = kindOf(note);
        const auto known = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.kind == kind; });
        if (known == kinds.end())
            kinds.push_back({kind, note});
        else
            ++known->more;
    }
    std::vector<std::string> lines;
    for (const Kind& kind : kinds) lines.push_back(kind.first + (kind.more ? " (and " + std::to_string(kind.more) + " more)" : ""));
    return lines;
}

/// Size of the small things in view: at least kSmallShare of what the camera meets is a mesh no larger.
std::optional<double> nearFeature(const Scene& scene, const std::vector<CoarseHit>& inView)
{
    constexpr double kSmallShare = 0.05;
    std::vector<double> sizes(scene.meshes.size(), -1.0), met;
    for (const CoarseHit& hit : inView) {
        double& size = sizes[hit.mesh];
        if (size < 0.0) {
            Aabb box;
            for (const auto& triangle : scene.meshes[hit.mesh].triangles)
                for (const std::uint32_t v : triangle) box.include(scene.meshes[hit.mesh].positions[v]);
            size = double(box.longestSide());
        }
        met.push_back(size);
    }
    if (met.empty()) return {};
    std::sort(met.begin(), met.end());
    return met[std::size_t(kSmallShare * double(met.size() - 1))];
}

/// Faces of two materials in one plane, seen by a few rays at least.
void addContested(const Scene& scene, const std::vector<CoarseHit>& inView, std::vector<std::string>& lines)
{
    constexpr std::size_t kFew = 3;
    std::vector<CoarseHit> contested;
    for (const CoarseHit& hit : inView)
        if (hit.contender) contested.push_back(hit);
    if (contested.size() < kFew) return;
    lines.push_back("meshes " + quoted(scene.meshes[contested[0].mesh].name) + " and " + quoted(scene.meshes[*contested[0].contender].name) +
                    " lie in one plane in view: rounding decides which shows, and picture and reference may differ; move one of them by a millimetre or so");
}

void addExtent(const Scene& scene, const Camera& camera, const std::vector<CoarseHit>& inView, const Settings& settings, std::vector<std::string>& lines)
{
    if (reachIsPart(scene) && settings.voxel.extent == Extent::reach)
        lines.push_back("voxel grid and light maps cover " + metres(double(scene.reach.longestSide())) + " about camera and lights, of a scene of " +
                        metres(double(scene.bounds.longestSide())) + ": beyond, " +
                        (settings.direct.shadows == Shadows::exact ? "" : "direct light has no shadows and ") +
                        "nothing occludes or reflects indirect light (--bounds scene covers all of it)");
    constexpr double kVoxelsAcross = 2.0;
    const double voxel = double(gridsOf(scene, settings.voxel, camera.position).front().voxelSize);
    if (const std::optional<double> feature = nearFeature(scene, inView); feature && kVoxelsAcross * voxel > *feature)
        lines.push_back("a voxel is " + metres(voxel) + " wide, things in view are as small as " + metres(*feature) +
                        ": indirect light cannot tell them apart; raise voxel_resolution or voxel_cascades, or cover less with --bounds");
}

/// Float32 depths over a light's range, against a tenth of a texel where it shines: a bias below that is rounding.
void addDepthSteps(const Scene& scene, const Settings& settings, std::vector<std::string>& lines)
{
    constexpr double kLeastBiasTexels = 0.1;
    std::size_t coarse = 0;
    std::string first;
    for (const Light& light : scene.lights) {
        if (!shines(light)) continue;
        const LightProjection q = projectionOf(scene, light, settings.rsm);
        const double step = 0x1p-23 * double(q.depthRange());
        const double across = light.type == LightType::directional ? double(q.halfWidth) : double(q.halfWidth) * double(q.depthFar);
        const double texel = 2.0 * across / q.resolution;
        if (step <= kLeastBiasTexels * texel) continue;
        if (coarse++ == 0)
            first = "light " + quoted(light.name) + ": depths over " + metres(double(q.depthRange())) + " come in steps of " + metres(step) +
                    ", its texels are " + metres(texel);
    }
    if (coarse > 0)
        lines.push_back(first + (coarse > 1 ? " (and " + std::to_string(coarse - 1) + " more)" : "") + ": " +
                        (settings.direct.shadows == Shadows::exact ? "indirect light may be misplaced" : "shadows may be spotted") +
                        "; cover less with --bounds");
}

/// All around the light something stands within a quarter of the scene: the distance, and the mesh met most often.
std::optional<std::string> shutIn(const Scene& scene, const Light& light)
{
    constexpr double kNear = 0.25;
    double farthest = 0.0;
    std::vector<std::size_t> met(scene.meshes.size(), 0);
    for (const Light& face : splitPointLight(light.position, light.intensity, light.range, light.name)) {
        const CoarseView view = coarseView(scene, viewpointOf(face));
        if (view.hits.size() < view.rays) return {};
        for (const CoarseHit& hit : view.hits) {
            farthest = std::max(farthest, hit.distance);
            ++met[hit.mesh];
        }
    }
    if (farthest > kNear * double(extentOf(scene).longestSide())) return {};
    const auto most = std::size_t(std::max_element(met.begin(), met.end()) - met.begin());
    return "light " + quoted(light.name) + " is inside of something solid: mesh " + quoted(scene.meshes[most].name) + " and what else is within " +
           metres(farthest) + " shut it in";
}

bool isBlack(const Image<Vec3>& picture)
{
    return std::all_of(picture.texels.begin(), picture.texels.end(), [](const Vec3& v) { return v == Vec3(0.0f); });
}

/// Does any surface in view turn its front to the light, where it shines?
bool facesAny(const SeenSurfaces& seen, const Light& light)
{
    const LightSampler sampler(light);
    for (std::size_t i = 0; i < seen.depth.texels.size(); ++i) {
        if (seen.depth.texels[i] == 0.0f) continue;
        const LightSample sample = sampler(seen.position.texels[i]);
        if (sample.irradiance != Vec3(0.0f) && glm::dot(seen.geometricNormal.texels[i], sample.toLight) > 0.0f) return true;
    }
    return false;
}

/// Why one light gives nothing to what is in view.
std::string whyDark(const Scene& scene, const SeenSurfaces& seen, const Light& light)
{
    const bool local = light.type != LightType::directional;
    if (local)
        if (const std::optional<std::string> why = shutIn(scene, light)) return *why;
    if (light.type == LightType::spot && coarseView(scene, viewpointOf(light)).hits.empty())
        return "light " + quoted(light.name) + " faces away from the scene: its cone meets nothing";
    if (!facesAny(seen, light))
        return "light " + quoted(light.name) + " does not reach what the camera sees: all of it faces away, or lies outside its cone or range";
    return "light " + quoted(light.name) + " does not reach what the camera sees: something stands in between";
}

}  // namespace

std::vector<std::string> loadMessages(const Scene& scene, bool all)
{
    std::vector<std::string> lines = all ? scene.notes : oneAKind(scene.notes);
    const auto dark = std::count_if(scene.lights.begin(), scene.lights.end(), [](const Light& light) { return !shines(light); });
    if (dark > 0) lines.push_back(count(double(dark), "light") + " of " + std::to_string(scene.lights.size()) + " with intensity 0");
    return lines;
}

std::vector<std::string> extentMessages(const Scene& scene, const Camera& camera, const Settings& settings)
{
    const std::vector<CoarseHit> inView = coarseView(scene, viewpointOf(camera)).hits;
    std::vector<std::string> lines;
    addExtent(scene, camera, inView, settings, lines);
    addDepthSteps(scene, settings, lines);
    addContested(scene, inView, lines);
    return lines;
}

std::vector<std::string> passMessages(const std::vector<PassReport>& passes)
{
    std::vector<std::string> lines;
    double dropped = 0.0;
    for (const PassReport& pass : passes)
        if (pass.name == "gbuffer") dropped = counterSum({pass}, "triangles_dropped");
    if (dropped > 0.0) lines.push_back(count(dropped, "triangle") + " dropped: a position is not finite");
    if (const double clamped = counterSum(passes, "half_saturations"); clamped > 0.0)
        lines.push_back(count(clamped, "value") +
                        " of light maps clamped to 65504, the most that half holds: light is missing there (--set rsm_storage=float32 --set "
                        "layer_storage=float32 keeps it)");
    if (const double doublings = counterSum(passes, "tile_doublings"); doublings > 0.0)
        lines.push_back("more clusters than rc_max caches: rc_tile was doubled " + count(doublings, "time") + " (--set rc_max=65536 allows more)");
    if (const double nans = counterSum(passes, "nans"); nans > 0.0) lines.push_back(count(nans, "value") + " of light maps not a number, taken as 0");
    return lines;
}

std::vector<std::string> darknessMessages(const Scene& scene, const SeenSurfaces& seen, const Image<Vec3>& direct, const Image<Vec3>& combined)
{
    if (!isBlack(direct)) return {};
    const std::string what = isBlack(combined) ? "the picture is black: " : "no direct light is in the picture: ";
    if (std::all_of(seen.depth.texels.begin(), seen.depth.texels.end(), [](float depth) { return depth == 0.0f; }))
        return {what + "the camera sees no surface"};
    if (scene.lights.empty()) return {what + "the scene has no light"};
    if (std::none_of(scene.lights.begin(), scene.lights.end(), shines)) return {what + "every light has intensity 0"};
    std::vector<std::string> reasons;
    for (const Light& light : scene.lights)
        if (shines(light)) reasons.push_back(what + whyDark(scene, seen, light));
    return oneAKind(reasons);
}

void say(const std::vector<std::string>& messages)
{
    for (const std::string& message : messages) std::cerr << "lrsm: note: " << message << "\n";
}

void SayOnce::operator()(const std::vector<std::string>& messages)
{
    const std::vector<std::string> before = said_;  // of one call all are said
    for (const std::string& message : messages) {
        std::string kind = message;
        std::erase_if(kind, [](char letter) { return (letter >= '0' && letter <= '9') || letter == '.'; });
        if (std::find(before.begin(), before.end(), kind) != before.end()) continue;
        said_.push_back(kind);
        say({message});
    }
}

}  // namespace lrsm
