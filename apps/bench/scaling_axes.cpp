#include "apps/bench/scaling.h"
#include "apps/bench/scaling_scenes.h"
#include "core/base/errors.h"
#include "core/settings/settings_table.h"

#include <algorithm>

namespace lrsm {
namespace {

struct AxisSize {
    int width, height, voxels, rsm;
};
constexpr AxisSize kQuickSize{32, 18, 32, 64};

/// One axis under construction: all points share what the axis does not change.
class AxisMaker {
  public:
    AxisMaker(const ScalingBase& base, const std::string& name, const std::string& xLabel, AxisSize size) : base_(base), size_(base.quick ? kQuickSize : size)
    {
        axis_.name = name;
        axis_.xLabel = xLabel;
        axis_.camera = base.camera;
        if (base.size) {
            size_.width = base.size->x;
            size_.height = base.size->y;
        }
        whole_ = std::make_shared<const Scene>(base.scene);
    }

    /// The point of this base; the caller changes what its axis is about.
    ScalingPoint point(double x, const std::string& label) const
    {
        ScalingPoint point{x, label, whole_, base_.settings, size_.width, size_.height, base_.threads};
        point.settings.voxel.resolution = size_.voxels;
        point.settings.rsm.resolution = size_.rsm;
        for (const std::string& assignment : base_.assignments) applySetting(point.settings, assignment);
        return point;
    }
    void add(ScalingPoint point)
    {
        validate(point.settings);
        axis_.points.push_back(std::move(point));
    }
    void expect(const std::string& series, double low, double high, const std::string& why) { axis_.expected.push_back({series, low, high, why}); }
    /// x is a series of the frame, not what was asked for.
    void measureX(const std::string& series) { axis_.xSeries = series; }

    /// "atrium, 430 triangles, 320x180, ...": what stays the same; `grows` names what does not.
    ScalingAxis finish(const std::string& grows)
    {
        const ScalingPoint& p = axis_.points.front();
        axis_.fixed = base_.scene.name;
        const auto say = [&](const std::string& what, const std::string& text) {
            if (what != grows) axis_.fixed += ", " + text;
        };
        say("triangles", std::to_string(base_.scene.triangleCount()) + " triangles");
        say("lights", std::to_string(base_.scene.lights.size()) + (base_.scene.lights.size() == 1 ? " light" : " lights"));
        say("pixels", std::to_string(p.width) + "x" + std::to_string(p.height));
        say("voxels", "voxels " + std::to_string(p.settings.voxel.resolution) + "^3");
        say("rsm", "RSM " + std::to_string(p.settings.rsm.resolution) + "^2");
        say("layers", std::to_string(p.settings.layers.depthLayers) + "x" + std::to_string(p.settings.layers.normalLayers) + " layers");
        say("cones", std::to_string(p.settings.cones.count) + " cones");
        return std::move(axis_);
    }

    const ScalingBase& base() const { return base_; }
    int width() const { return size_.width; }
    int height() const { return size_.height; }
    /// The first three in a quick run.
    template <class T>
    std::vector<T> values(std::vector<T> all) const
    {
        if (base_.quick && all.size() > 3) all.resize(3);
        return all;
    }

  private:
    const ScalingBase& base_;
    AxisSize size_;
    std::shared_ptr<const Scene> whole_;
    ScalingAxis axis_;
};

ScalingAxis pixelsAxis(const ScalingBase& base)
{
    AxisMaker maker(base, "pixels", "pixels", {1280, 720, 256, 512});
    for (int halvings = base.quick ? 2 : 4; halvings >= 0; --halvings) {
        const int width = std::max(1, maker.width() >> halvings), height = std::max(1, maker.height() >> halvings);
        ScalingPoint point = maker.point(double(width) * height, std::to_string(width) + "x" + std::to_string(height));
        point.width = width;
        point.height = height;
        maker.add(point);
    }
    maker.expect("cones_cpu_ms", 1, 1, "each pixel traces the same cones");
    maker.expect("cone_steps", 1, 1, "the same");
    maker.expect("gbuffer_cpu_ms", 0, 1, "fragments grow, triangles do not");
    maker.expect("filter_cpu_ms", 1, 1, "each pixel reads its 4x4 block");
    maker.expect("frame_cpu_ms", 0, 1, "voxels and RSM do not grow");
    return maker.finish("pixels");
}

ScalingAxis conesAxis(const ScalingBase& base)
{
    AxisMaker maker(base, "cones", "diffuse cones a pixel", {160, 90, 256, 512});
    for (const int count : maker.values(std::vector<int>{1, 2, 4, 8, 16, 32, 64})) {
        ScalingPoint point = maker.point(count, std::to_string(count));
        point.settings.cones.count = count;
        maker.add(point);
    }
    maker.expect("cones_cpu_ms", 1, 1.5, "more cones are narrower ones");
    maker.expect("cone_steps", 1, 1.5, "tan of the aperture falls as 1 / sqrt(cones), and a narrow cone takes as many more steps");
    maker.expect("frame_cpu_ms", 0, 1.5, "only the cones grow");
    return maker.finish("cones");
}

ScalingAxis setsAxis(const ScalingBase& base)
{
    AxisMaker maker(base, "sets", "cone sets a pixel", {160, 90, 256, 512});
    for (const int sets : maker.values(std::vector<int>{1, 2, 4, 8, 16})) {
        ScalingPoint point = maker.point(sets, std::to_string(sets));
        point.settings.cones.setsPerPixel = sets;
        maker.add(point);
    }
    maker.expect("cones_cpu_ms", 1, 1, "more cones of the same aperture");
    maker.expect("cone_steps", 1, 1, "the same");
    maker.expect("frame_cpu_ms", 0, 1, "only the cones grow");
    return maker.finish("sets");
}

ScalingAxis layersAxis(const ScalingBase& base)
{
    AxisMaker maker(base, "layers", "layers kept", {160, 90, 128, 1024});
    for (const auto& [depth, normal] : maker.values(std::vector<std::pair<int, int>>{{1, 1}, {2, 1}, {2, 2}, {3, 2}, {4, 2}, {4, 3}, {4, 4}})) {
        ScalingPoint point = maker.point(depth * normal, std::to_string(depth) + "x" + std::to_string(normal));
        point.settings.layers.depthLayers = depth;
        point.settings.layers.normalLayers = normal;
        maker.add(point);
    }
    maker.measureX("layers_kept");
    maker.expect("lrsm_cpu_ms", 0, 1, "each layer has its own mip chain; reading the RSM does not grow");
    maker.expect("lrsm_bytes", 1, 1, "one texture array slice a layer");
    maker.expect("lrsm_samples", 0, 1, "only the layers that a cone sample touches are read");
    maker.expect("cones_cpu_ms", 0, 1, "voxel lookups do not grow");
    maker.expect("frame_cpu_ms", 0, 1, "voxels and RSM do not grow");
    return maker.finish("layers");
}

ScalingAxis lightsAxis(const ScalingBase& base)
{
    AxisMaker maker(base, "lights", "lights", {160, 90, 256, 512});
    for (const int count : maker.values(std::vector<int>{1, 2, 3, 4, 6, 8})) {
        ScalingPoint point = maker.point(count, std::to_string(count));
        point.scene = std::make_shared<const Scene>(withLightSplit(base.scene, count));
        maker.add(point);
    }
    maker.expect("rsm_cpu_ms", 1, 1, "one map a light");
    maker.expect("lrsm_cpu_ms", 1, 1, "one set of layers a light");
    maker.expect("lrsm_samples", 1, 1, "every cone sample asks every light");
    maker.expect("voxel_taps", 0, 0, "one march serves all lights");
    maker.expect("cones_cpu_ms", 0, 1, "samples grow, steps and voxel lookups do not");
    maker.expect("frame_cpu_ms", 0, 1, "voxels and G-buffer do not grow");
    return maker.finish("lights");
}

ScalingAxis voxelsAxis(const ScalingBase& base)
{
    AxisMaker maker(base, "voxels", "voxels along an edge", {160, 90, 256, 512});
    for (const int n : base.quick ? std::vector<int>{16, 32, 64} : std::vector<int>{64, 128, 256, 512, 1024}) {
        ScalingPoint point = maker.point(n, std::to_string(n) + "^3");
        point.settings.voxel.resolution = n;
        maker.add(point);
    }
    maker.expect("voxel_mips_cpu_ms", 2, 3, "3 for the volume, 2 for the bricks that hold a surface");
    maker.expect("voxel_mips_bytes", 3, 3, "a dense pyramid");
    maker.expect("voxelize_cpu_ms", 0, 3, "triangles, n^2 voxels of their surfaces, n^3 bits to clear");
    maker.expect("voxels_set", 2, 2, "surfaces");
    maker.expect("cone_steps", 0, 0.3, "spheres grow with distance: log n steps, which has no exponent; about 1 / log of the steps");
    maker.expect("cones_cpu_ms", 0, 0.5, "log n steps, and more memory than caches");
    maker.expect("frame_cpu_ms", 0, 3, "mips grow, cones hardly");
    return maker.finish("voxels");
}

ScalingAxis rsmAxis(const ScalingBase& base)
{
    AxisMaker maker(base, "rsm", "RSM texels along an edge", {160, 90, 128, 512});
    for (const int n : base.quick ? std::vector<int>{32, 64, 128} : std::vector<int>{256, 512, 1024, 2048, 4096}) {
        ScalingPoint point = maker.point(n, std::to_string(n) + "^2");
        point.settings.rsm.resolution = n;
        maker.add(point);
    }
    maker.expect("rsm_cpu_ms", 0, 2, "texels grow, triangles do not");
    maker.expect("lrsm_cpu_ms", 2, 2, "texels; dearer ones once they are more than caches hold");
    maker.expect("lrsm_bytes", 2, 2, "texels");
    maker.expect("cone_steps", 0, 0, "steps know nothing of the maps");
    maker.expect("cones_cpu_ms", 0, 0.3, "the same lookups, in more memory");
    maker.expect("frame_cpu_ms", 0, 2, "voxels and cones do not grow");
    return maker.finish("rsm");
}

/// Doublings of the edges' cuts, up to about two million triangles.
ScalingAxis trianglesAxis(const ScalingBase& base)
{
    constexpr std::size_t kMost = 2000000;
    AxisMaker maker(base, "triangles", "triangles", {160, 90, 256, 512});
    std::size_t count = base.scene.triangleCount();
    for (int doublings = 0; doublings <= 8 && (doublings == 0 || count <= kMost); ++doublings, count *= 4) {
        if (base.quick && doublings == 3) break;
        ScalingPoint point = maker.point(double(count), std::to_string(count));
        point.scene = std::make_shared<const Scene>(subdivided(base.scene, doublings));
        maker.add(point);
    }
    maker.expect("voxelize_cpu_ms", 0, 1, "few large triangles cost their voxels, many small ones themselves");
    maker.expect("rsm_cpu_ms", 0, 1, "few large triangles cost their texels, many small ones themselves");
    maker.expect("gbuffer_cpu_ms", 0, 1, "the same with pixels");
    maker.expect("cone_steps", 0, 0, "cones see voxels, and no triangle");
    maker.expect("cones_cpu_ms", 0, 0, "the same");
    maker.expect("frame_cpu_ms", 0, 1, "cones do not grow");
    return maker.finish("triangles");
}

/// 1, 2, 4 ... and all cores.
ScalingAxis threadsAxis(const ScalingBase& base)
{
    AxisMaker maker(base, "threads", "threads", {320, 180, 256, 512});
    for (int n = 1; n <= base.cores; n = n < base.cores ? std::min(2 * n, base.cores) : n + 1) {
        ScalingPoint point = maker.point(n, std::to_string(n));
        point.threads = n;
        maker.add(point);
    }
    maker.expect("frame_ms", -1, 0, "-1 where all cores are idle and every pass parallel; wall time");
    maker.expect("cones_ms", -1, -1, "tiles are independent; wall time");
    maker.expect("frame_cpu_ms", 0, 0, "the work is the same");
    return maker.finish("threads");
}

struct AxisRecipe {
    std::string name;
    ScalingAxis (*make)(const ScalingBase&);
};

const std::vector<AxisRecipe>& axisRecipes()
{
    static const std::vector<AxisRecipe> all = {{"pixels", pixelsAxis}, {"cones", conesAxis},         {"sets", setsAxis},
                                                {"layers", layersAxis}, {"lights", lightsAxis},       {"voxels", voxelsAxis},
                                                {"rsm", rsmAxis},       {"triangles", trianglesAxis}, {"threads", threadsAxis}};
    return all;
}

}  // namespace

const std::vector<std::string>& scalingAxisNames()
{
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const AxisRecipe& entry : axisRecipes()) list.push_back(entry.name);
        return list;
    }();
    return names;
}

ScalingAxis makeScalingAxis(const std::string& name, const ScalingBase& base)
{
    std::string known;
    for (const AxisRecipe& entry : axisRecipes()) {
        if (entry.name == name) return entry.make(base);
        known += (known.empty() ? "" : ", ") + entry.name;
    }
    throw InputError("axis \"" + name + "\"", "there is none of this name; the axes are " + known);
}

}  // namespace lrsm
