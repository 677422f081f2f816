// Throughput of what follows the G-buffer: cones in cone samples (steps), shadow cones, filter and composite in pixels; and a whole frame, each
// pass with its share. Rates are per second of CPU time, all threads together: of one core, and steady on a shared machine.
#include "conetrace/frame/composite.h"
#include "conetrace/frame/direct.h"
#include "conetrace/frame/irradiance_filter.h"
#include "conetrace/lrsm/gather.h"
#include "conetrace/render.h"
#include "core/scene/builtin_scenes.h"
#include "core/settings/settings_table.h"
#include "voxel/voxelize.h"

#include <benchmark/benchmark.h>

#include <map>

using namespace lrsm;

namespace {

constexpr int kWidth = 320, kHeight = 180;
const char* const kScenes[] = {"atrium", "cornell-box", "cornell-glossy"};

const Scene& sceneOf(int index)
{
    static std::map<int, Scene> scenes;
    const auto found = scenes.find(index);
    return found != scenes.end() ? found->second : scenes.emplace(index, makeBuiltinScene(kScenes[index]).value()).first->second;
}

/// `balanced`, or the paper's estimator as `literal` has it.
Settings settingsOf(Estimator estimator)
{
    return preset(estimator == Estimator::slab ? "balanced" : "literal");
}

/// What the passes after the G-buffer read.
struct Inputs {
    const Scene& scene;
    Settings settings;
    Requirements needs;
    OpacityPyramid opacity;
    std::vector<Rsm> rsms;
    std::vector<Lrsm> lrsms;
    GBuffer gbuffer;

    Inputs(int sceneIndex, const Settings& chosen)
        : scene(sceneOf(sceneIndex)),
          settings(chosen),
          needs(analyseRequirements(scene, settings.force)),
          opacity(buildPyramid(voxelize(scene, settings.voxel), settings.voxel)),
          gbuffer(renderGBuffer(scene, camera(), needs, {kWidth, kHeight}))
    {
        for (const Light& light : scene.lights) rsms.push_back(renderRsm(scene, light, needs, settings.rsm));
        for (const Rsm& rsm : rsms) lrsms.push_back(buildLrsm(rsm, settings.layers));
    }
    const Camera& camera() const { return scene.cameras.at(0); }
    Gathered gather() const { return traceCones(gbuffer, camera(), opacity, lrsms, needs, settings.cones); }
};

benchmark::Counter perSecond(double count)
{
    return benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate);
}

void cones(benchmark::State& state)
{
    const Inputs in(static_cast<int>(state.range(0)), settingsOf(Estimator(state.range(1))));
    Counters counts;
    for (auto _ : state) counts = in.gather().counters;
    state.SetItemsProcessed(state.iterations() * std::int64_t(counterSum(counts, "cone_steps")));
    state.counters["cones/s"] = perSecond(counterSum(counts, "cones"));
    state.counters["voxel taps/s"] = perSecond(counterSum(counts, "voxel_taps"));
    state.counters["layer samples/s"] = perSecond(counterSum(counts, "lrsm_samples"));
    state.counters["steps a cone"] = counterSum(counts, "cone_steps") / counterSum(counts, "cones");
    state.SetLabel(std::string(kScenes[state.range(0)]) + (state.range(1) ? ", slab (balanced)" : ", paper (literal)"));
}
BENCHMARK(cones)->ArgNames({"scene", "slab"})->ArgsProduct({{0, 1, 2}, {1, 0}})->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void shadowCones(benchmark::State& state)
{
    Inputs in(static_cast<int>(state.range(0)), preset("balanced"));
    in.settings.direct.shadows = Shadows::cone;
    for (auto _ : state)
        benchmark::DoNotOptimize(traceDirect(in.gbuffer, in.scene, in.camera(), {}, &in.opacity, in.needs, in.settings.direct).radiance.texels.data());
    state.SetItemsProcessed(state.iterations() * kWidth * kHeight);
    state.SetLabel(std::string(kScenes[state.range(0)]) + ", pixels");
}
BENCHMARK(shadowCones)->ArgName("scene")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

/// Any irradiance will do: the filter's work depends on the G-buffer alone.
void irradianceFilter(benchmark::State& state)
{
    const Scene& scene = sceneOf(static_cast<int>(state.range(0)));
    const GBuffer gbuffer = renderGBuffer(scene, scene.cameras.at(0), analyseRequirements(scene, {}), {1280, 720});
    for (auto _ : state) benchmark::DoNotOptimize(filterIrradiance(gbuffer.albedo, gbuffer).texels.data());
    state.SetItemsProcessed(state.iterations() * 1280 * 720);
    state.SetLabel(std::string(kScenes[state.range(0)]) + ", pixels");
}
BENCHMARK(irradianceFilter)->ArgName("scene")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

/// Shading of both indirect parts and the sum; with a specular part the lobe's albedo table is made too, as in every frame.
void compositePass(benchmark::State& state)
{
    const Scene& scene = sceneOf(static_cast<int>(state.range(0)));
    const Requirements needs = analyseRequirements(scene, {});
    const GBuffer gbuffer = renderGBuffer(scene, scene.cameras.at(0), needs, {1280, 720});
    const Image<Vec3>& light = gbuffer.albedo;
    const Image<Vec3> specular = needs.specular ? light : Image<Vec3>();
    for (auto _ : state) benchmark::DoNotOptimize(composite(light, shadeIndirect(gbuffer, scene.cameras.at(0), light, specular)).texels.data());
    state.SetItemsProcessed(state.iterations() * 1280 * 720);
    state.SetLabel(std::string(kScenes[state.range(0)]) + ", pixels");
}
BENCHMARK(compositePass)->ArgName("scene")->Arg(0)->Arg(2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

/// Each pass's share of the frame, in percent, summed over the iterations.
void wholeFrame(benchmark::State& state)
{
    const Scene& scene = sceneOf(static_cast<int>(state.range(0)));
    const Settings settings = settingsOf(Estimator(state.range(1)));
    const Requirements needs = analyseRequirements(scene, settings.force);
    RenderOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.watch.hashPasses = false;
    std::map<std::string, double> milliseconds;
    double total = 0.0;
    for (auto _ : state)
        for (const PassReport& pass : renderFrame(scene, scene.cameras.at(0), settings, options).passes) {
            milliseconds[pass.name] += pass.milliseconds;
            total += pass.milliseconds;
        }
    for (const auto& [name, sum] : milliseconds) state.counters["% " + name] = 100.0 * sum / total;
    state.SetItemsProcessed(state.iterations() * kWidth * kHeight);
    state.SetLabel(std::string(kScenes[state.range(0)]) + (state.range(1) ? ", balanced" : ", literal"));
}
BENCHMARK(wholeFrame)->ArgNames({"scene", "slab"})->ArgsProduct({{0, 1}, {1, 0}})->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace

BENCHMARK_MAIN();
