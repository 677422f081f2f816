#include "apps/bench/scaling.h"
#include "apps/bench/scaling_scenes.h"
#include "catch.h"
#include "core/base/errors.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/shapes.h"

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

using namespace lrsm;

namespace {

ScalingBase tinyBase(const char* scene = "atrium")
{
    ScalingBase base;
    base.scene = *makeBuiltinScene(scene);
    base.camera = base.scene.cameras.front();
    base.quick = true;
    base.cores = 2;
    return base;
}

ScalingResult measured(const std::string& name, const ScalingBase& base)
{
    const ScalingAxis axis = makeScalingAxis(name, base);
    return summarizeScaling(axis, runScaling(axis, 1).samples);
}

double exponentOf(const ScalingResult& result, const std::string& series)
{
    const ScalingCurve* curve = result.find(series);
    REQUIRE(curve);
    REQUIRE(curve->slope);
    return *curve->slope;
}

double area(const Scene& scene)
{
    double sum = 0.0;
    for (const Mesh& mesh : scene.meshes)
        for (const auto& t : mesh.triangles) {
            const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
            sum += 0.5 * double(glm::length(glm::cross(b - a, c - a)));
        }
    return sum;
}

}  // namespace

TEST_CASE("scaling scenes: subdivision keeps surfaces, and neighbours' edges to the bit", "[sweep][scaling]")
{
    const Scene scene = *makeBuiltinScene("atrium");
    const Scene finer = subdivided(scene, 3);
    CHECK(finer.triangleCount() == 64 * scene.triangleCount());
    CHECK(finer.materials.size() == scene.materials.size());
    CHECK(area(finer) == Approx(area(scene)).epsilon(1e-5));
    CHECK(subdivided(scene, 0).meshes.front().positions == scene.meshes.front().positions);

    // In a closed sphere every edge has two triangles, by the bits of its ends.
    Scene ball;
    ball.meshes.emplace_back();
    addSphere(ball.meshes.front(), Vec3(0.3f, -0.7f, 11.1f), 0.77f, 1);
    const Mesh mesh = subdivided(ball, 2).meshes.front();
    using Bits = std::array<std::uint32_t, 3>;
    const auto bits = [](const Vec3& v) {
        const Vec3 plusZero = v + 0.0f;
        Bits b;
        std::memcpy(b.data(), &plusZero, sizeof b);
        return b;
    };
    std::map<std::set<Bits>, int> edges;
    for (const auto& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) ++edges[{bits(mesh.positions[t[i]]), bits(mesh.positions[t[(i + 1) % 3]])}];
        const Vec3 a = mesh.positions[t[0]], face = glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
        CHECK(glm::dot(face, mesh.normals[t[0]]) > 0.0f);  // still counter-clockwise from the front
    }
    for (const auto& [edge, count] : edges) {
        CHECK(edge.size() == 2);
        CHECK(count == 2);
    }
    for (const Vec3& normal : mesh.normals) CHECK(glm::length(normal) == Approx(1.0f).epsilon(1e-5));
    CHECK_THROWS_AS(subdivided(scene, 11), InputError);
    CHECK_THROWS_AS(subdivided(scene, -1), InputError);
}

TEST_CASE("scaling scenes: the parts of a light bring as much as the whole, from other sides", "[sweep][scaling]")
{
    for (const char* name : {"atrium", "cornell-box"}) {
        const Scene scene = *makeBuiltinScene(name);
        CHECK(withLightSplit(scene, 1).lights.front().direction == scene.lights.front().direction);
        const Scene split = withLightSplit(scene, 5);
        REQUIRE(split.lights.size() == 5);
        Vec3 sum(0.0f);
        for (std::size_t i = 0; i < 5; ++i) {
            const Light& light = split.lights[i];
            sum += light.intensity;
            CHECK(glm::length(light.direction) == Approx(1.0f));
            CHECK(std::abs(glm::dot(light.direction, light.up)) < 1e-6f);
            CHECK(glm::dot(light.direction, scene.lights.front().direction) > 0.99f);
            for (std::size_t j = 0; j < i; ++j) CHECK(glm::length(light.direction - split.lights[j].direction) > 0.05f);
        }
        CHECK(glm::length(sum - scene.lights.front().intensity) < 1e-4f * glm::length(sum));
    }
    Scene dark = *makeBuiltinScene("atrium");
    dark.lights.clear();
    CHECK_THROWS_AS(withLightSplit(dark, 2), InputError);
}

TEST_CASE("scaling: the slope is that of the textbook, and what has no logarithm or no second size has none", "[sweep][scaling]")
{
    using Values = std::vector<double>;
    for (const double exponent : {-1.0, 0.0, 0.5, 3.0}) {
        Values x = {3, 6, 12, 24}, y;
        for (const double value : x) y.push_back(0.07 * std::pow(value, exponent));
        CHECK(logLogSlope(x, y).value() == Approx(exponent).margin(1e-12));
    }
    // log2 y = 0, 1, 1, 3 over log2 x = 0, 1, 2, 3.
    CHECK(logLogSlope(Values{1, 2, 4, 8}, Values{1, 2, 2, 8}).value() == Approx(0.9));
    CHECK_FALSE(logLogSlope(Values{1, 2, 4}, Values{1, 0, 4}));
    CHECK_FALSE(logLogSlope(Values{1, 2, 4}, Values{1, std::nan(""), 4}));
    CHECK_FALSE(logLogSlope(Values{2, 2}, Values{1, 3}));
    CHECK_FALSE(logLogSlope(Values{}, Values{}));
}

TEST_CASE("scaling: work grows with pixels as theory says", "[sweep][scaling]")
{
    ScalingBase base = tinyBase();
    base.size = IVec2(96, 54);
    const ScalingResult pixels = measured("pixels", base);
    CHECK(exponentOf(pixels, "cones") == Approx(1.0).margin(0.02));
    CHECK(exponentOf(pixels, "cone_steps") == Approx(1.0).margin(0.02));
    CHECK(exponentOf(pixels, "filter_bytes") == Approx(1.0).margin(0.02));
    CHECK(exponentOf(pixels, "voxels_set") == Approx(0.0).margin(1e-12));
}

TEST_CASE("scaling: steps are linear in cones of one aperture, and more than linear in narrowing ones", "[sweep][scaling]")
{
    const ScalingResult sets = measured("sets", tinyBase());
    CHECK(exponentOf(sets, "cones") == Approx(1.0).margin(1e-12));
    CHECK(exponentOf(sets, "cone_steps") == Approx(1.0).margin(0.02));
    CHECK(exponentOf(sets, "lrsm_samples") == Approx(1.0).margin(0.05));

    ScalingBase base = tinyBase();
    ScalingAxis axis = makeScalingAxis("cones", base);
    for (std::size_t i = 0; i < axis.points.size(); ++i) {  // beyond the wide cones of small sets, where the law is sqrt
        axis.points[i].settings.cones.set.count = 32 << i;
        axis.points[i].settings.cones.march.step = 0.5f;
        axis.points[i].x = 32 << i;
    }
    const ScalingResult cones = summarizeScaling(axis, runScaling(axis, 1).samples);
    CHECK(exponentOf(cones, "cones") == Approx(1.0).margin(1e-12));
    CHECK(exponentOf(cones, "cone_steps") > 1.05);  // near the apex a segment is a voxel long, however narrow the cone
    CHECK(exponentOf(cones, "cone_steps") < 1.55);
}

TEST_CASE("scaling: steps grow with the logarithm of voxel resolution, memory with its cube", "[sweep][scaling]")
{
    ScalingBase base = tinyBase();
    base.assignments = {"start_voxels=0.5", "transmittance_cutoff=0"};  // a start that is far at low resolution hides the law
    ScalingAxis axis = makeScalingAxis("voxels", base);
    ScalingPoint finest = axis.points.back();
    finest.settings.voxel.resolution = 128;
    finest.x = 128;
    axis.points.push_back(finest);
    const ScalingResult voxels = summarizeScaling(axis, runScaling(axis, 1).samples);
    const std::vector<double>& steps = voxels.find("cone_steps")->median;
    REQUIRE(steps.size() == 4);
    // As many more steps with each doubling; a power law would have grown by its factor.
    CHECK(steps[2] - steps[1] == Approx(steps[1] - steps[0]).epsilon(0.12));
    CHECK(steps[3] - steps[2] == Approx(steps[2] - steps[1]).epsilon(0.12));
    CHECK(exponentOf(voxels, "voxel_mips_bytes") == Approx(3.0).margin(0.02));
}

TEST_CASE("scaling: lights, layers and map resolution grow as theory says", "[sweep][scaling]")
{
    const ScalingResult lights = measured("lights", tinyBase());
    CHECK(exponentOf(lights, "voxel_taps") == Approx(0.0).margin(1e-12));
    CHECK(exponentOf(lights, "lrsm_samples") == Approx(1.0).margin(0.1));
    CHECK(exponentOf(lights, "rsm_bytes") == Approx(1.0).margin(1e-12));

    const ScalingResult layers = measured("layers", tinyBase());
    CHECK(layers.x == layers.find("layers_kept")->median);
    CHECK(exponentOf(layers, "lrsm_bytes") == Approx(1.0).margin(1e-12));
    CHECK(exponentOf(layers, "cone_steps") == Approx(0.0).margin(1e-12));

    const ScalingResult maps = measured("rsm", tinyBase());
    CHECK(exponentOf(maps, "rsm_bytes") == Approx(2.0).margin(1e-12));
    CHECK(exponentOf(maps, "lrsm_bytes") == Approx(2.0).margin(0.01));
    CHECK(exponentOf(maps, "cone_steps") == Approx(0.0).margin(1e-12));
}

TEST_CASE("scaling: triangles and cores leave the cones' work alone", "[sweep][scaling]")
{
    const ScalingResult triangles = measured("triangles", tinyBase());
    CHECK(exponentOf(triangles, "cone_steps") == Approx(0.0).margin(0.01));
    CHECK(exponentOf(triangles, "triangles_drawn") > 0.5);  // those that fall between pixels are not drawn
    CHECK(exponentOf(triangles, "triangles_drawn") < 1.0);
    CHECK(exponentOf(measured("threads", tinyBase()), "cone_steps") == Approx(0.0).margin(1e-12));
}

TEST_CASE("scaling: frames go round robin, each is told as it comes, medians are of the repeats", "[sweep][scaling]")
{
    const ScalingAxis axis = makeScalingAxis("sets", tinyBase());
    std::vector<std::pair<int, std::size_t>> order;
    double last = -1.0;
    ScalingWatch watch;
    watch.each = [&](const ScalingSample& sample) { order.emplace_back(sample.repeat, sample.point); };
    watch.progress = [&](const std::string&, double fraction) {
        CHECK(fraction > last);
        last = fraction;
    };
    const ScalingRun run = runScaling(axis, 3, watch);
    CHECK(order == std::vector<std::pair<int, std::size_t>>{{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}, {2, 0}, {2, 1}, {2, 2}});
    CHECK(last < 1.0);
    for (const ScalingSample& sample : run.samples) CHECK(sample.values.size() == seriesNames(run.samples).size());

    // Stopped after two frames: those stay, and make a result.
    watch.progress = {};
    watch.stop = [&] { return order.size() >= 11; };
    const ScalingRun stopped = runScaling(axis, 3, watch);
    CHECK(stopped.samples.size() == 2);
    CHECK(summarizeScaling(axis, stopped.samples).points == std::vector<std::size_t>{0, 1});

    std::vector<ScalingSample> made = run.samples;
    const double values[3] = {30.0, 10.0, 11.0};
    for (ScalingSample& sample : made) sample.values.front() = {"frame_cpu_ms", values[sample.repeat] * double(1 << sample.point)};
    made.back().values.push_back({"invented_taps", 7.0});
    const ScalingResult result = summarizeScaling(axis, made);
    CHECK(result.find("frame_cpu_ms")->median == std::vector<double>{11.0, 22.0, 44.0});
    CHECK(result.find("frame_cpu_ms")->min == std::vector<double>{10.0, 20.0, 40.0});
    CHECK(result.find("frame_cpu_ms")->spread[0] == Approx(20.0 / 11.0));
    CHECK(exponentOf(result, "frame_cpu_ms") == Approx(1.0).margin(1e-12));
    CHECK(result.find("invented_taps") == nullptr);  // one repeat of three: its median is 0
}

TEST_CASE("scaling: the frame's times and bytes are sums of its passes", "[sweep][scaling]")
{
    const ScalingAxis axis = makeScalingAxis("lights", tinyBase());
    const ScalingRun run = runScaling(axis, 1);
    for (const ScalingSample& sample : run.samples) {
        double cpu = 0.0, wall = 0.0, bytes = 0.0;
        for (const auto& [name, value, describes] : sample.values) {
            CHECK_FALSE(describes);
            if (name == "frame_cpu_ms" || name == "frame_ms") continue;
            if (name.ends_with("_cpu_ms"))
                cpu += value;
            else if (name.ends_with("_ms"))
                wall += value;
            else if (name == "voxel_mips_bytes" || name == "rsm_bytes" || name == "lrsm_bytes" || name == "gbuffer_bytes")
                bytes += value;
        }
        CHECK(cpu == Approx(counterSum(sample.values, "frame_cpu_ms")));
        CHECK(wall == Approx(counterSum(sample.values, "frame_ms")));
        CHECK(bytes == counterSum(sample.values, "bytes"));
    }
}

TEST_CASE("scaling: x grows along every axis, and assignments go over its own base", "[sweep][scaling]")
{
    ScalingBase base = tinyBase();
    base.quick = false;
    base.assignments = {"rsm_resolution=64"};
    for (const std::string& name : scalingAxisNames()) {
        if (name == "triangles") continue;  // millions
        const ScalingAxis axis = makeScalingAxis(name, base);
        INFO(name);
        CHECK_FALSE(axis.fixed.empty());
        for (std::size_t i = 1; i < axis.points.size(); ++i) CHECK(axis.points[i].x > axis.points[i - 1].x);
        CHECK(axis.points.front().settings.rsm.resolution == (name == "rsm" ? 256 : 64));
    }
    CHECK_THROWS_AS(makeScalingAxis("pixel", base), InputError);
}
