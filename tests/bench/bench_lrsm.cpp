// Throughput of the LRSM: layer split with mips in RSM texels, lookups in layer samples, Eq. 12 in evaluations (items unless a counter says else).
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "lrsm/sample.h"

#include <benchmark/benchmark.h>

#include <random>

using namespace lrsm;

namespace {

const Rsm& atriumRsm()
{
    static const Rsm rsm = [] {
        const Scene scene = makeBuiltinScene("atrium").value();
        return renderRsm(scene, scene.lights.at(0), analyseRequirements(scene, {}), RsmSettings{});
    }();
    return rsm;
}

LayerSettings layerSettings(int depthLayers, int normalLayers)
{
    LayerSettings settings;
    settings.depthLayers = depthLayers;
    settings.normalLayers = normalLayers;
    return settings;
}

void splitAndFilter(benchmark::State& state)
{
    const Rsm& rsm = atriumRsm();
    LayerSettings settings = layerSettings(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
    settings.storage = state.range(2) ? Storage::gpu : Storage::float32;
    std::size_t bytes = 0;
    int layers = 0;
    for (auto _ : state) {
        const Lrsm lrsm = buildLrsm(rsm, settings);
        benchmark::DoNotOptimize(lrsm.texels.data());
        bytes = bytesOf(lrsm);
        layers = lrsm.layers();
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(rsm.texels.texels.size()));
    state.counters["layers"] = layers;
    state.counters["MB"] = double(bytes) * 1e-6;
}
BENCHMARK(splitAndFilter)
    ->ArgNames({"depth", "normal", "gpu"})
    ->Args({1, 1, 1})
    ->Args({3, 2, 0})
    ->Args({3, 2, 1})
    ->Args({5, 3, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

/// Cone samples as a march makes them: from neighbouring points of a floor, eight steps each, radius growing with the distance.
std::vector<ConeSample> marchedSamples(const Aabb& bounds)
{
    std::vector<ConeSample> samples;
    const Vec3 direction = glm::normalize(Vec3(0.6f, 0.5f, 0.3f)), extent = bounds.extent();
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const Vec3 origin = bounds.min + extent * Vec3((float(x) + 0.5f) / 90.0f, 0.02f, (float(y) + 0.5f) / 90.0f);
            for (float t = 0.1f; t < 6.0f; t *= 1.7f) samples.push_back({origin + direction * t, 0.25f * t, -direction});
        }
    return samples;
}

std::vector<ConeSample> randomSamples(const Aabb& bounds, std::size_t count)
{
    std::mt19937 random(1);
    const auto uniform = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
    std::vector<ConeSample> samples(count);
    for (ConeSample& sample : samples) {
        sample.centre = bounds.min + bounds.extent() * Vec3{uniform(), uniform(), uniform()};
        sample.radius = 0.02f + 1.5f * uniform() * uniform();
        sample.toReceiver = glm::normalize(Vec3{uniform() - 0.5f, uniform() - 0.5f, uniform() - 0.5f} + Vec3(1e-3f));
    }
    return samples;
}

/// Algorithm 1 whole, projection included. `coherent`: as marched, else anywhere in the scene.
void algorithm1(benchmark::State& state)
{
    const Lrsm lrsm = buildLrsm(atriumRsm(), layerSettings(3, 2));
    const Aabb bounds = makeBuiltinScene("atrium").value().bounds;
    const std::vector<ConeSample> samples = state.range(0) ? marchedSamples(bounds) : randomSamples(bounds, 32768);
    ConeSettings settings;
    settings.gather.layerSelection = state.range(1) ? LayerSelection::touched : LayerSelection::centre;
    const NormalCdf phi;
    std::vector<LayerTerms> terms;
    for (const ConeSample& sample : samples) sampleLrsm(lrsm, sample, settings, phi, &terms);
    for (auto _ : state)
        for (const ConeSample& sample : samples) benchmark::DoNotOptimize(sampleLrsm(lrsm, sample, settings, phi));
    state.SetItemsProcessed(state.iterations() * std::int64_t(terms.size()));
    state.counters["cone samples/s"] = benchmark::Counter(double(samples.size()), benchmark::Counter::kIsIterationInvariantRate);
    state.counters["layers a sample"] = double(terms.size()) / double(samples.size());
}
BENCHMARK(algorithm1)->ArgNames({"coherent", "touched"})->Args({1, 1})->Args({1, 0})->Args({0, 1})->Args({0, 0})->Unit(benchmark::kMillisecond);

/// The bare lookup, footprint shared by six layers.
void layerLookup(benchmark::State& state)
{
    const Lrsm lrsm = buildLrsm(atriumRsm(), layerSettings(3, 2));
    std::mt19937 random(2);
    struct Place {
        float u, v, level;
    };
    std::vector<Place> places(16384);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto uniform = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
        if (state.range(0))
            places[i] = {0.3f + 0.2f * float(i % 128) / 128.0f, 0.3f + 0.2f * float(i / 128) / 128.0f, 1.5f + float(i % 128) / 128.0f};
        else
            places[i] = {uniform(), uniform(), 4.0f * uniform()};
    }
    for (auto _ : state)
        for (const Place& place : places) {
            const LrsmFootprint footprint = makeFootprint(lrsm, place.u, place.v, place.level, FilterFraction::exact);
            for (int layer = 0; layer < lrsm.layers(); ++layer) benchmark::DoNotOptimize(sampleLayer(lrsm, layer, footprint));
        }
    state.SetItemsProcessed(state.iterations() * std::int64_t(places.size()) * lrsm.layers());
}
BENCHMARK(layerLookup)->ArgName("coherent")->Arg(1)->Arg(0)->Unit(benchmark::kMillisecond);

/// Largest |error| of Eq. 12 against the double evaluation, over the inputs of the benchmark.
struct Window {
    float mu, sigma2, zc, rc;
};
std::vector<Window> windows()
{
    std::mt19937 random(3);
    const auto uniform = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
    std::vector<Window> result(16384);
    for (Window& w : result) {
        const float sigma = 0.005f + 0.3f * uniform() * uniform();
        w = {uniform(), sigma * sigma, uniform(), 0.5f * uniform()};
    }
    return result;
}

void gaussian(benchmark::State& state, GaussianMethod method)
{
    const NormalCdf phi(method, method == GaussianMethod::table ? static_cast<int>(state.range(0)) : 2);
    const std::vector<Window> inputs = windows();
    for (auto _ : state)
        for (const Window& w : inputs) benchmark::DoNotOptimize(gaussianVisibility(phi, w.mu, w.sigma2, w.zc, w.rc));
    double error = 0.0;
    for (const Window& w : inputs)
        error = std::max(error, std::abs(double(gaussianVisibility(phi, w.mu, w.sigma2, w.zc, w.rc)) - gaussianVisibilityExact(w.mu, w.sigma2, w.zc, w.rc)));
    state.SetItemsProcessed(state.iterations() * std::int64_t(inputs.size()));
    state.counters["max error"] = error;
    state.counters["stated bound"] = double(method == GaussianMethod::exact ? kExactCdfMaxError : gaussianVisibilityMaxError(phi));
}
BENCHMARK_CAPTURE(gaussian, table, GaussianMethod::table)->RangeMultiplier(4)->Range(64, 4096);
BENCHMARK_CAPTURE(gaussian, polynomial, GaussianMethod::polynomial);
BENCHMARK_CAPTURE(gaussian, exact, GaussianMethod::exact);

}  // namespace

BENCHMARK_MAIN();
