// Throughput of the rasterizer and of the passes on it. Items are triangles unless a counter says fragments.
#include "conetrace/frame/direct.h"
#include "conetrace/frame/gbuffer.h"
#include "core/base/parallel.h"
#include "core/raster/draw_scene.h"
#include "core/scene/shapes.h"
#include "lrsm/rsm.h"

#include <benchmark/benchmark.h>

#include <cmath>

using namespace lrsm;

namespace {

/// A bumpy floor of 2 n^2 triangles with a few spheres on it: about 260,000 triangles for n = 256.
Scene makeScene(int n)
{
    Scene scene;
    scene.materials.push_back(diffuseMaterial("floor", Vec3(0.7f, 0.6f, 0.5f)));
    Mesh floor;
    for (int z = 0; z <= n; ++z)
        for (int x = 0; x <= n; ++x) {
            const float u = float(x) / float(n), v = float(z) / float(n);
            floor.positions.push_back({20 * u - 10, 0.4f * std::sin(25 * u) * std::cos(19 * v), 10 - 20 * v});
            floor.normals.push_back({0, 1, 0});
        }
    for (int z = 0; z < n; ++z)
        for (int x = 0; x < n; ++x) {
            const auto a = static_cast<std::uint32_t>(z * (n + 1) + x), b = a + 1, c = b + static_cast<std::uint32_t>(n) + 1, d = c - 1;
            floor.triangles.push_back({a, b, c});
            floor.triangles.push_back({a, c, d});
        }
    scene.meshes.push_back(floor);
    for (int i = 0; i < 4; ++i) {
        Mesh ball;
        addSphere(ball, Vec3(-6 + 4 * i, 1.5f, -2 + i), 1.4f, 6);
        scene.meshes.push_back(ball);
    }
    updateBounds(scene);
    scene.lights = {spotLight({2, 14, 6}, {0, 0, 0}, Vec3(100), 0.4f, 0.8f)};
    return scene;
}

const Requirements kDiffuse{false, false, false, false, false, {}};

Camera camera()
{
    return lookAt({0, 6, 13}, {0, 0, 0}, {0, 1, 0}, 0.9f);
}

std::int64_t coveredPixels(const Image<Fragment>& fragments)
{
    std::int64_t covered = 0;
    for (const Fragment& f : fragments.texels) covered += f.triangle != kNoTriangle;
    return covered;
}

void rasterizeOnly(benchmark::State& state)
{
    const Scene scene = makeScene(static_cast<int>(state.range(0)));
    const Mat4 clip = clipFromWorld(fitLightProjection(scene.lights[0], scene.bounds, 1024));
    std::int64_t pixels = 0;
    for (auto _ : state) {
        const SceneFragments drawn = drawScene(scene, clip, kDiffuse, 1024, 1024);
        benchmark::DoNotOptimize(drawn.fragments.texels.data());
        if (pixels == 0) pixels = coveredPixels(drawn.fragments);
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(scene.triangleCount()));
    state.counters["triangles"] = double(scene.triangleCount());
    state.counters["fragments/s"] = benchmark::Counter(double(pixels), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(rasterizeOnly)->Arg(32)->Arg(256)->Arg(1024)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

/// Full-screen triangles: what a covered fragment costs, front to back (all but the first fail the depth test) or back to front.
void fillRate(benchmark::State& state)
{
    const bool frontToBack = state.range(0) != 0;
    constexpr int kLayers = 16;
    std::vector<Vec4> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i < kLayers; ++i) {
        const float z = float(frontToBack ? i : kLayers - i) / (kLayers + 1);
        positions.insert(positions.end(), {Vec4(-1, -1, z, 1), Vec4(3, -1, z, 1), Vec4(-1, 3, z, 1)});
        triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    for (auto _ : state) benchmark::DoNotOptimize(rasterize({positions, triangles, {}}, 1024, 1024).fragments.texels.data());
    state.SetItemsProcessed(state.iterations() * kLayers * 1024 * 1024);
    state.SetLabel(frontToBack ? "fragments, front to back" : "fragments, back to front");
}
BENCHMARK(fillRate)->Arg(1)->Arg(0)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

void rsmPass(benchmark::State& state)
{
    const Scene scene = makeScene(256);
    RsmSettings settings;
    settings.resolution = static_cast<int>(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(renderRsm(scene, scene.lights[0], kDiffuse, settings).texels.texels.data());
    state.SetItemsProcessed(state.iterations() * std::int64_t(scene.triangleCount()));
}
BENCHMARK(rsmPass)->Arg(512)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

void gbufferPass(benchmark::State& state)
{
    const Scene scene = makeScene(256);
    const GBufferSettings settings{1280, 720};
    for (auto _ : state) benchmark::DoNotOptimize(renderGBuffer(scene, camera(), kDiffuse, settings).position.texels.data());
    state.SetItemsProcessed(state.iterations() * std::int64_t(scene.triangleCount()));
}
BENCHMARK(gbufferPass)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

void directPass(benchmark::State& state)
{
    const Scene scene = makeScene(256);
    const GBuffer gbuffer = renderGBuffer(scene, camera(), kDiffuse, {1280, 720});
    const std::vector<Rsm> maps{renderRsm(scene, scene.lights[0], kDiffuse, {})};
    const std::vector<DepthMapView> depths(maps.begin(), maps.end());
    constexpr const char* kNames[] = {"pixels, exact", "pixels, hard", "pixels, pcf", "", "pixels, off"};
    DirectSettings settings;
    settings.shadows = static_cast<Shadows>(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(traceDirect(gbuffer, scene, camera(), depths, nullptr, kDiffuse, settings).radiance.texels.data());
    state.SetItemsProcessed(state.iterations() * 1280 * 720);
    state.SetLabel(kNames[state.range(0)]);
}
BENCHMARK(directPass)->Arg(0)->Arg(1)->Arg(2)->Arg(4)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

}  // namespace

BENCHMARK_MAIN();
