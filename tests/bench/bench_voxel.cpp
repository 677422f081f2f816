// Voxelization in triangles and voxels a second, pyramid in base voxels a second, lookups a second.
// Run on one core with `taskset -c 0`; filters such as --benchmark_filter=Sample pick a part.
#include "core/scene/builtin_scenes.h"
#include "core/scene/shapes.h"
#include "voxel/sample_opacity.h"
#include "voxel/voxelize.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <random>

using namespace lrsm;

namespace {

/// A room of 12 big triangles around two spheres of 131,072 triangles each: big and small in one scene.
const Scene& detailedScene()
{
    static const Scene scene = [] {
        Scene s;
        s.materials.push_back(diffuseMaterial("grey", Vec3(0.5f)));
        Mesh mesh;
        addBox(mesh, Vec3(0), Vec3(4, 3, 4), true);
        addSphere(mesh, Vec3(1.3f, 1.4f, 1.3f), 1.1f, 7);
        addSphere(mesh, Vec3(2.9f, 1.1f, 2.6f), 0.9f, 7);
        s.meshes.push_back(mesh);
        updateBounds(s);
        return s;
    }();
    return scene;
}

const Scene& atrium()
{
    static const Scene scene = *makeBuiltinScene("atrium");
    return scene;
}

VoxelSettings settingsOf(int resolution, Voxelization mode, OpacityAxes axes = OpacityAxes::directional, Storage storage = Storage::gpu)
{
    VoxelSettings settings;
    settings.resolution = resolution;
    settings.mode = mode;
    settings.axes = axes;
    settings.storage = storage;
    return settings;
}

void voxelizeScene(benchmark::State& state, const Scene& scene)
{
    const VoxelSettings settings = settingsOf(int(state.range(0)), Voxelization(state.range(1)));
    std::uint64_t voxels = 0;
    for (auto _ : state) {
        const BitGrid bits = voxelize(scene, settings);
        benchmark::DoNotOptimize(bits.bricks.data());
        if (voxels == 0) voxels = bits.countOccupied();
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(scene.triangleCount()));
    state.counters["triangles"] = double(scene.triangleCount());
    state.counters["voxels"] = double(voxels);
    state.counters["voxels/s"] = benchmark::Counter(double(voxels), benchmark::Counter::kIsIterationInvariantRate);
}

void VoxelizeDetailed(benchmark::State& state)
{
    voxelizeScene(state, detailedScene());
}
void VoxelizeAtrium(benchmark::State& state)
{
    voxelizeScene(state, atrium());
}
BENCHMARK(VoxelizeDetailed)
    ->ArgNames({"n", "mode"})
    ->ArgsProduct({{128, 256, 512}, {0, 1, 2}})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(VoxelizeAtrium)->ArgNames({"n", "mode"})->ArgsProduct({{128, 512}, {0, 1, 2}})->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

void BuildPyramid(benchmark::State& state)
{
    const int n = int(state.range(0));
    const VoxelSettings settings = settingsOf(n, Voxelization::conservative, OpacityAxes(state.range(1)), Storage(state.range(2)));
    const BitGrid bits = voxelize(atrium(), settings);
    for (auto _ : state) {
        state.PauseTiming();
        BitGrid base = bits;
        state.ResumeTiming();
        const OpacityPyramid pyramid = buildPyramid(std::move(base), settings);
        benchmark::DoNotOptimize(pyramid.emptyLevels.data());
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(n) * n * n);
}
BENCHMARK(BuildPyramid)
    ->ArgNames({"n", "directional", "float32"})
    ->ArgsProduct({{128, 512}, {0, 1}, {0, 1}})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

struct Tap {
    Vec3 p;
    float level;
};

/// Six 60-degree cones for each pixel of 4x4 tiles near the atrium's surfaces, half a diameter a step, level bias -2: what the tracer does.
/// `scattered` turns each cone its own way: nothing that one cone reads helps the next.
std::vector<Tap> marchTaps(const BitGrid& bits, bool scattered)
{
    std::vector<Tap> taps;
    std::mt19937 random(1);
    const float n = float(bits.grid.resolution);
    const auto uniform = [&](float low, float high) { return low + (high - low) * float(random()) * 0x1p-32f; };
    const auto direction = [&] {
        const float x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
        return glm::normalize(Vec3(x, y, z));
    };
    while (taps.size() < 200000) {
        const IVec3 cell(int(uniform(2, n - 2)), int(uniform(2, n - 2)), int(uniform(2, n - 2)));
        if (!bits.occupied(cell.x, cell.y, cell.z)) continue;
        Vec3 axes[6];
        for (Vec3& axis : axes) axis = direction();
        for (int pixel = 0; pixel < 16; ++pixel) {
            const Vec3 origin = Vec3(cell) + 1.0f + 0.5f * Vec3(float(pixel % 4), float(pixel / 4), 0.0f);
            for (const Vec3& axis : axes) {
                const Vec3 along = scattered ? direction() : axis;
                for (float t = 1.5f; t < n;) {
                    const float diameter = std::max(1.0f, 1.1547f * t);
                    const Vec3 p = origin + t * along;
                    if (glm::any(glm::lessThan(p, Vec3(0))) || glm::any(glm::greaterThan(p, Vec3(n)))) break;
                    taps.push_back({p, std::log2(diameter) - 2.0f});
                    t += 0.5f * diameter;
                }
            }
        }
    }
    return taps;
}

std::vector<Tap> randomTaps(int n, int levels)
{
    std::mt19937 random(2);
    const auto uniform = [&](float high) { return high * float(random()) * 0x1p-32f; };
    std::vector<Tap> taps;
    for (int i = 0; i < 200000; ++i) {
        const float x = uniform(float(n)), y = uniform(float(n)), z = uniform(float(n));
        taps.push_back({Vec3(x, y, z), uniform(float(levels - 1))});
    }
    return taps;
}

/// Arguments: directional, float32, pattern (0: tiles of cones, 1: scattered cones, 2: random), 1: without the empty-space table.
void Sample(benchmark::State& state)
{
    constexpr int n = 512;
    const VoxelSettings settings = settingsOf(n, Voxelization::conservative, OpacityAxes(state.range(0)), Storage(state.range(1)));
    OpacityPyramid pyramid = buildPyramid(voxelize(atrium(), settings), settings);
    const std::vector<Tap> taps = state.range(2) == 2 ? randomTaps(n, pyramid.levels()) : marchTaps(pyramid.base, state.range(2) == 1);
    if (state.range(3) == 1) std::fill(pyramid.emptyLevels.begin(), pyramid.emptyLevels.end(), std::uint8_t(0));
    withOpacitySampler(pyramid, FilterFraction::exact, [&](const auto& sample) {
        std::size_t zero = 0;
        for (const Tap& tap : taps) zero += sample(tap.p, tap.level) == Vec3(0);
        state.counters["zero"] = double(zero) / double(taps.size());
        for (auto _ : state) {
            Vec3 sum(0);
            for (const Tap& tap : taps) sum += sample(tap.p, tap.level);
            benchmark::DoNotOptimize(sum);
        }
    });
    state.SetItemsProcessed(state.iterations() * std::int64_t(taps.size()));
}
BENCHMARK(Sample)->ArgNames({"directional", "float32", "pattern", "noskip"})->ArgsProduct({{0, 1}, {0, 1}, {0, 1, 2}, {0, 1}})->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
