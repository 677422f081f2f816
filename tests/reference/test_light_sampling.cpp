#include "core/base/elementary.h"
#include "core/scene/builtin_scenes.h"
#include "reference/light_map.h"
#include "reference/light_technique.h"
#include "reference/path_trace.h"
#include "reference/search.h"
#include "reference/ztest.h"
#include "reference_scenes.h"

#include "catch.h"

// Finding lit points from the lights' side: its densities, and that nothing but the noise changes.

using namespace lrsm;
using namespace lrsm::test;

namespace {

Light spotAt(const Vec3& position, const Vec3& target, float intensity, float outer)
{
    Light light;
    light.type = LightType::spot;
    light.position = position;
    light.direction = glm::normalize(target - position);
    light.intensity = Vec3(intensity);
    light.innerConeAngle = 0.8f * outer;
    light.outerConeAngle = outer;
    return light;
}

Scene roomWith(std::initializer_list<Mesh> furniture, std::vector<Light> lights)
{
    Scene scene;
    scene.meshes = boxRoom(true);
    scene.meshes.insert(scene.meshes.end(), furniture);
    scene.materials = {diffuse(Vec3(0.7f)), diffuse({0.8f, 0.2f, 0.1f})};
    scene.lights = std::move(lights);
    for (const Mesh& mesh : scene.meshes)
        for (const Vec3& p : mesh.positions) scene.bounds.include(p);
    return scene;
}

/// The six walls of a box, thin as paper.
std::vector<Mesh> paperBox(const Vec3& low, const Vec3& size, bool open)
{
    const Vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    std::vector<Mesh> walls = {rectangle(low, x, y, 1), rectangle(low + z, x, y, 1), rectangle(low, y, z, 1), rectangle(low + x, y, z, 1),
                               rectangle(low + y, x, z, 1)};
    if (!open) walls.push_back(rectangle(low, x, z, 1));
    return walls;
}

Scene lampInBox(bool open)
{
    Scene scene = roomWith({}, splitPointLight({0.1f, 0.45f, 0.1f}, Vec3(2.0f), kInfinity, "lamp"));
    const std::vector<Mesh> box = paperBox({-0.1f, 0.3f, -0.1f}, {0.4f, 0.3f, 0.4f}, open);
    scene.meshes.insert(scene.meshes.end(), box.begin(), box.end());
    return scene;
}

/// One lamp lights the room through a screen's edge, one is behind a wall.
Scene oneLampHidden()
{
    return roomWith({rectangle({-0.2f, -1, -0.3f}, {0.7f, 0, 0.2f}, {0, 1.1f, 0}, 1)},
                    {spotAt({-0.5f, 0.7f, 0.4f}, {1, 0.1f, -0.1f}, 4.0f, 0.5f), spotAt({0, 0, -3}, {0, 0, -1}, 50.0f, 0.4f)});
}

/// A rough metal wall, whose caustics paths find often enough for a z-test, and a floor of both lobes.
Scene satinRoom()
{
    Scene scene =
        roomWith({rectangle({-0.2f, -0.7f, -0.5f}, {0.6f, 0, 0.2f}, {0, 0.8f, 0}, 1)}, {spotAt({-0.5f, 0.7f, 0.6f}, {0.2f, -0.4f, -0.4f}, 4.0f, 0.6f)});
    scene.materials[0].roughness = 0.5f;
    scene.materials[1].metallic = 1.0f;
    scene.materials[1].roughness = 0.45f;
    return scene;
}

/// Sun through a slit in the ceiling onto the floor.
Scene slit()
{
    Scene scene = roomWith({}, {sun({0.3f, -1, 0.1f}, 10.0f)});
    scene.meshes[1] = rectangle({-1, 1, -1}, {0.9f, 0, 0}, {0, 0, 2});
    scene.meshes.push_back(rectangle({0.05f, 1, -1}, {0.95f, 0, 0}, {0, 0, 2}));
    return scene;
}

/// Sun through a square hole at (x, z) of a closed room's ceiling; a ground of 40 m around it.
Scene sunThroughHole(const glm::vec2& at, float side)
{
    Scene scene = roomWith({}, {sun({0.1f, -1, 0.05f}, 10.0f)});
    scene.meshes = boxRoom(false);
    const float x = at.x, z = at.y;
    scene.meshes[1] = rectangle({-1, 1, -1}, {x + 1, 0, 0}, {0, 0, 2});
    scene.meshes.push_back(rectangle({x + side, 1, -1}, {1 - x - side, 0, 0}, {0, 0, 2}));
    scene.meshes.push_back(rectangle({x, 1, -1}, {side, 0, 0}, {0, 0, z + 1}));
    scene.meshes.push_back(rectangle({x, 1, z + side}, {side, 0, 0}, {0, 0, 1 - z - side}));
    scene.meshes.push_back(rectangle({-20, -1.1f, -20}, {0, 0, 40}, {40, 0, 0}));
    for (const Mesh& mesh : scene.meshes)
        for (const Vec3& p : mesh.positions) scene.bounds.include(p);
    return scene;
}

const Camera kIntoTheRoom = lookAt({0.1f, 0.2f, 2.6f}, {0, -0.1f, 0}, 0.75f);

struct Sides {
    ReferenceFrame eye, both;
    PixelMask covered;
};

/// The same picture by the paths' own rays alone, and with the lights' side: different seeds, so that all is independent.
Sides renderBoth(const Scene& scene, const Camera& camera, ReferenceSettings settings, std::uint64_t eyeSamples, std::uint64_t samples)
{
    settings.blockBits = 4;
    settings.fromLights = false;
    const ReferenceFrame eye = renderReference(scene, camera, settings, eyeSamples);
    settings.fromLights = true;
    settings.seed = 1;
    return {eye, renderReference(scene, camera, settings, samples), PathTracer(scene, camera, settings).primary().covered};
}

double meanVariance(const Image<Vec3>& variance)
{
    double sum = 0.0;
    for (const Vec3& v : variance.texels) sum += double(v.x) + double(v.y) + double(v.z);
    return sum;
}

/// Blocks of 4 x 4 pixels: Gaussian by then, so that the p-value of the largest z (Sidak) means what it says. Pixels of a tile share points, so their errors
/// may add up: the variance of a block's mean is up to 16 times that of independent pixels; kShared is more than was measured.
void requireSameMean(const Image<Vec3>& eye, const Image<Vec3>& eyeVariance, const Image<Vec3>& both, const Image<Vec3>& bothVariance, const PixelMask& covered)
{
    constexpr float kShared = 4.0f;
    Image<Vec3> variance = eyeVariance;
    for (std::size_t i = 0; i < variance.texels.size(); ++i) variance.texels[i] += kShared * bothVariance.texels[i];
    const BlockMeans means = averageBlocks(eye, both, variance, 4, covered);
    const ZTest z = zTest(means.reference, means.test, means.variance);
    CAPTURE(z.values, z.rms, z.largest, z.pValue, z.certain);
    REQUIRE(z.values >= 48);
    CHECK(z.pValue > 1e-6);
    CHECK(z.rms < 1.25);
    CHECK(z.certain == 0);
}

}  // namespace

TEST_CASE("light map: rays, coordinates and densities of one light belong together", "[reference][light-map]")
{
    Light light = spotAt({0.3f, 0.2f, -0.1f}, {1, -0.5f, 0.4f}, 1.0f, 0.7f);
    const int kind = GENERATE(0, 1, 2);
    if (kind == 1) light = splitPointLight({0.3f, 0.2f, -0.1f}, Vec3(1.0f), kInfinity, "lamp")[3];
    if (kind == 2) light = sun({0.4f, -1, 0.2f}, 1.0f);
    const LightMap map(light, {Vec3(-1), Vec3(1)});

    // Forth and back; and by differences: the rays of a small square cover 1 / (density across the ray) of the square's own size.
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) {
            const UnitPoint at{0.14f + 0.09f * float(i), 0.14f + 0.09f * float(j)};
            const auto ray = map.ray(at, 0.0f);
            if (!ray) continue;
            const auto pointAt = [&](float du, float dv) {
                const auto r = map.ray({at.u + du, at.v + dv}, 0.0f);
                return r ? glm::dvec3(r->origin) + 1.5 * glm::dvec3(r->direction) : glm::dvec3(std::nan(""));
            };
            const auto there = map.coordinates(Vec3(pointAt(0, 0)));
            REQUIRE(there);
            CHECK(double(there->at.u) == Approx(double(at.u)).margin(2e-6));
            CHECK(double(there->at.v) == Approx(double(at.v)).margin(2e-6));
            constexpr float step = 2e-3f;
            const glm::dvec3 du = (pointAt(step, 0) - pointAt(-step, 0)) / (2.0 * double(step)),
                             dv = (pointAt(0, step) - pointAt(0, -step)) / (2.0 * double(step));
            const double area = std::abs(glm::dot(glm::cross(du, dv), glm::dvec3(ray->direction)));
            if (std::isfinite(area)) CHECK(there->perArea * area == Approx(1.0).epsilon(2e-3));
        }
    if (kind == 1) CHECK_FALSE(map.coordinates(Vec3(0.3f, 0.9f, -0.1f)));  // behind the face, which looks down
}

TEST_CASE("light density: integrates to 1, draws by itself, over cuts that crowd where points are", "[reference][light-density]")
{
    std::vector<LightPoint> points;
    for (int i = 0; i < 500; ++i) points.push_back({1, {0.4f + 0.0001f * float(i), 0.7f}});
    const auto grids = std::make_shared<LightGrids>(2, 8, points);
    std::vector<float> weights(grids->texels());
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = float(i % 7);
    const LightDensity density(grids, weights);

    double integral = 0.0;
    std::vector<double> expected(grids->texels()), drawn(grids->texels());
    for (std::size_t i = 0; i < grids->texels(); ++i) {
        const LightPoint middle = grids->pointIn(i, {0.5f, 0.5f});
        REQUIRE(grids->texelOf(middle) == i);
        integral += expected[i] = double(density(middle)) / double(grids->perArea(i));
    }
    CHECK(integral == Approx(1.0).epsilon(1e-5));
    CHECK(grids->perArea(grids->texelOf({1, {0.42f, 0.7f}})) > 4.0f * grids->perArea(grids->texelOf({0, {0.42f, 0.7f}})));

    constexpr int bits = 16;
    const SobolBlock block(philox({1, 2, 3, 4}, {5, 6}), bits);
    for (std::uint32_t i = 0; i < 1u << bits; ++i) drawn[grids->texelOf(density.draw(block.point(i)))] += 1.0 / (1 << bits);
    for (std::size_t i = 0; i < drawn.size(); ++i) CHECK(drawn[i] == Approx(expected[i]).margin(2e-3));
}

namespace {

/// 2^bits rays of a lamp in a room.
LightPool roomPool(int bits)
{
    const Scene scene = roomWith({}, splitPointLight({0.2f, -0.1f, 0.3f}, Vec3(1.5f), kInfinity, "lamp"));
    const EmbreeScene embree(scene);
    const std::vector<LightSampler> lights(scene.lights.begin(), scene.lights.end());
    std::vector<LightMap> maps;
    for (const Light& light : scene.lights) maps.emplace_back(light, scene.bounds);
    const auto grids = std::make_shared<LightGrids>(lights.size(), 4);
    std::vector<float> weights(grids->texels());
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = 1.0f + float(i % 5);
    Tracer tracer(embree, lights);
    return drawPool(tracer, maps, {{grids, weights}, {}}, SobolBlock(philox({7, 0, 0, 1}, {2, 3}), bits), 0, 1u << bits, Transport::single);
}

}  // namespace

TEST_CASE("a search without branches is upper_bound", "[reference][light-pool]")
{
    for (std::size_t size = 0; size < 40; ++size) {
        std::vector<double> values(size);
        for (std::size_t i = 0; i < size; ++i) values[i] = double(i / 3);  // runs of equals
        for (double x = -1.0; x < 15.0; x += 0.5)
            CHECK(countUpTo(std::span<const double>(values), x) == std::size_t(std::upper_bound(values.begin(), values.end(), x) - values.begin()));
    }
}

TEST_CASE("counts spread by a tent of 3 x 3 that the square's border cuts", "[reference][light-pool]")
{
    const LightGrids grids(2, 4);
    const int tent[3] = {1, 2, 1};
    for (const std::uint32_t at : {0u, 5u, 7u, 15u, 16u, 30u}) {
        SpreadCounts counts(grids);
        counts.add({at, 10, 3, 1}, 2);
        counts.spread();
        for (std::uint32_t i = 0; i < 32; ++i) {
            const int rows = int(i / 4) - int(at / 4), columns = int(i % 4) - int(at % 4);
            const bool near = i / 16 == at / 16 && std::abs(rows) <= 1 && std::abs(columns) <= 1;
            const auto share = std::uint32_t(near ? tent[rows + 1] * tent[columns + 1] : 0);
            CHECK(counts.light[i] == 20 * share);
            CHECK(counts.tried[i] == 6 * share);
            CHECK(counts.reached[i] == 2 * share);
        }
    }
}

TEST_CASE("a pool's points are drawn in proportion to their weights, subset by subset", "[reference][light-pool]")
{
    // Weights by connection(), which takes one point at a time; the rootless ones of weighDiffuse round differently.
    LightPool pool = roomPool(7);
    const LightReceiver receiver{{0.5f, -0.3f, -0.2f}, glm::normalize(Vec3(0.2f, 1.0f, 0.3f)), glm::normalize(Vec3(0.1f, 1.0f, 0.4f))};
    const CosineResponse cosine{receiver.normal};
    const auto weightOf = [&](std::size_t j) {
        Vec3 direction;
        const Vec3 answer = connection(pool, j, receiver, 16.0f, cosine, direction);
        return double(pool.points[j].brightness) * double(answer.x + answer.y + answer.z);
    };
    std::size_t unseen = 0;
    for (const std::size_t subsets : {1u, 3u, 5u})
        for (std::size_t subset = 0; subset < subsets; ++subset)
            for (const bool diffuse : {false, true}) {
                if (diffuse && subsets > 1) continue;
                CAPTURE(subsets, subset, diffuse);
                layOut(pool, subsets);
                PoolWeights weights;
                if (diffuse)
                    weights.weighDiffuse(pool, receiver, 16.0f);
                else
                    weights.weigh(pool, receiver, 16.0f, cosine, subset);
                double sum = 0.0, below = 0.0;
                for (std::size_t j = subset; j < pool.size(); j += subsets) sum += weightOf(j);
                REQUIRE(sum > 0.0);
                for (std::size_t j = subset; j < pool.size(); j += subsets) {
                    const double weight = weightOf(j);
                    unseen += weight == 0.0;
                    below += weight;
                    if (!(weight > 1e-4 * sum)) continue;
                    const Choice choice = weights.choose(float((below - 0.5 * weight) / sum));
                    CHECK(choice.index == j);
                    CHECK(double(choice.overDensity) == Approx(double(subsets) * sum / (double(pool.drawn) * weight)).epsilon(1e-5));
                }
            }
    CHECK(unseen > 20);
}

TEST_CASE("light pool: flux through a wall, by the pool's own densities", "[reference][light-pool]")
{
    // Sum of E / density over the points that strike a wall is the flux that it receives: the lamp's, over what it covers of the sphere.
    const LightPool pool = roomPool(14);
    REQUIRE(pool.drawn == 1u << 14);

    double flux = 0.0;
    for (std::size_t i = 0; i < pool.size(); ++i)
        if (pool.points[i].hit.mesh == 2)
            flux += double(pool.points[i].radianceTowards(Vec3(0.0f)).g) * 3.14159265358979 / 0.7 / double(pool.points[i].density) / double(pool.drawn);
    // Solid angle of the wall z = -1 from 1.3 m in front of it, as four right-angled corners atan(a b / (d sqrt(a^2 + b^2 + d^2))).
    double angle = 0.0;
    for (const double a : {0.8, 1.2})
        for (const double b : {1.1, 0.9}) angle += std::atan(a * b / (1.3 * std::sqrt(a * a + b * b + 1.69)));
    CHECK(flux == Approx(1.5 * angle).epsilon(0.004));
}

TEST_CASE("from the lights' side, too: the same mean in every layer, and less noise", "[reference][statistics][light-sampling]")
{
    struct Case {
        const char* name;
        Scene scene;
        Camera camera;
        double mostVariance;  ///< over that of the paths' own rays
    };
    const auto builtin = [](const char* name, double most) {
        const Scene scene = *makeBuiltinScene(name);
        return Case{name, scene, scene.cameras[0], most};
    };
    const int which = GENERATE(0, 1, 2, 3, 4, 5, 6, 7, 8);
    const Case one = which == 0   ? builtin("cornell-box", 0.15)
                     : which == 1 ? builtin("cornell-glossy", 0.2)
                     : which == 2 ? builtin("two-rooms", 0.4)
                     : which == 3 ? builtin("atrium", 0.3)
                     : which == 4 ? Case{"lamp in a closed box", lampInBox(false), kIntoTheRoom, 1.0}
                     : which == 5 ? Case{"lamp in a thin box", lampInBox(true), kIntoTheRoom, 0.3}
                     : which == 6 ? Case{"one lamp hidden", oneLampHidden(), kIntoTheRoom, 0.3}
                     : which == 7 ? Case{"slit", slit(), kIntoTheRoom, 0.2}
                                  : Case{"satin", satinRoom(), kIntoTheRoom, 0.3};
    CAPTURE(one.name);
    const Sides sides = renderBoth(one.scene, one.camera, {.width = 32, .height = 24, .specularApertureDegrees = 20.0f}, 1024, 512);
    if (which == 4) {  // nothing leaves the box: black, both ways
        CHECK(meanVariance(sides.both.irradiance) == 0.0);
        CHECK(meanVariance(sides.eye.irradiance) == 0.0);
        return;
    }
    requireSameMean(sides.eye.irradiance, sides.eye.irradianceVariance, sides.both.irradiance, sides.both.irradianceVariance, sides.covered);
    CHECK(meanVariance(sides.both.irradianceVariance) * 512 < one.mostVariance * meanVariance(sides.eye.irradianceVariance) * 1024);
    if (which != 1 && which != 8) return;
    requireSameMean(sides.eye.combined, sides.eye.combinedVariance, sides.both.combined, sides.both.combinedVariance, sides.covered);
}

TEST_CASE("from the lights' side, too: the same mean with all bounces", "[reference][statistics][light-sampling]")
{
    const int which = GENERATE(0, 1, 2);
    const Scene scene = which == 0 ? lampInBox(true) : which == 1 ? *makeBuiltinScene("cornell-box") : satinRoom();
    const Camera camera = which == 1 ? scene.cameras[0] : kIntoTheRoom;
    const Sides sides = renderBoth(scene, camera, {.transport = Transport::full, .width = 32, .height = 24}, 512, 512);
    requireSameMean(sides.eye.irradiance, sides.eye.irradianceVariance, sides.both.irradiance, sides.both.irradianceVariance, sides.covered);
    CHECK(meanVariance(sides.both.irradianceVariance) < 0.6 * meanVariance(sides.eye.irradianceVariance));
    requireSameMean(sides.eye.combined, sides.eye.combinedVariance, sides.both.combined, sides.both.combinedVariance, sides.covered);
}

TEST_CASE("the first block is like any other: no sample has helped to make the density that it is drawn by", "[reference][statistics][light-sampling]")
{
    // Sun through a small hole onto the floor of a room, in a wide ground: about one ray of the pilot finds it, or none, and all is left to technique a. Were
    // those rays samples too, then where the pilot has found nothing, they would find nothing either.
    constexpr int scenes = 96, others = 3, bits = 8;
    double sum = 0.0, squares = 0.0, all = 0.0;
    for (int i = 0; i < scenes; ++i) {
        const Scene scene = sunThroughHole({-0.6f + 0.1f * float(i % 12), -0.5f + 0.1f * float(i / 12)}, 0.12f);
        const PathTracer tracer(scene, lookAt({0, 0.3f, 0.9f}, {0, 0.5f, -1}, 1.0f), {.width = 4, .height = 4, .blockBits = bits});
        const auto mean = [&](std::uint64_t first, std::uint64_t last) {
            ReferenceState state = tracer.start({first << bits, last << bits});
            tracer.advance(state, std::chrono::steady_clock::time_point::max());
            double light = 0.0;
            for (const Vec3& e : tracer.resolve(state.sums).irradiance.texels) light += double(e.g);
            return light;
        };
        const double later = mean(1, 1 + others), difference = mean(0, 1) - later;
        all += later;
        sum += difference;
        squares += difference * difference;
    }
    REQUIRE(all > 0.0);
    CAPTURE(sum / all, std::sqrt(squares) / all);
    CHECK(std::abs(sum) < 4.9 * std::sqrt(squares));
}

TEST_CASE("the pilot is a function of scene, view and size: not of seed or threads", "[reference][light-sampling]")
{
    const Scene scene = oneLampHidden();
    const auto hash = [&](const ReferenceSettings& settings) { return PathTracer(scene, kIntoTheRoom, settings).guide().sha256; };
    const std::string first = hash({.width = 40, .height = 24});
    CHECK(first.size() == 64);
    CHECK(hash({.width = 40, .height = 24, .seed = 5}) == first);
    CHECK(hash({.width = 40, .height = 25}) != first);
}

TEST_CASE("of coincident triangles the one that a path's ray finds counts, however the point was found", "[reference][light-sampling]")
{
    // A floor and a copy of it that looks down: light passes its back, a path's ray may meet either.
    Scene scene = roomWith({}, {spotAt({0, 0.9f, 0}, {0.1f, -1, 0}, 5.0f, 0.6f)});
    for (Material& material : scene.materials) material.doubleSided = false;
    Mesh below = scene.meshes[0];
    for (auto& triangle : below.triangles) std::swap(triangle[1], triangle[2]);
    for (Vec3& normal : below.normals) normal = -normal;
    scene.meshes.push_back(below);
    const Sides sides = renderBoth(scene, kIntoTheRoom, {.width = 32, .height = 24}, 512, 512);
    requireSameMean(sides.eye.irradiance, sides.eye.irradianceVariance, sides.both.irradiance, sides.both.irradianceVariance, sides.covered);
}
