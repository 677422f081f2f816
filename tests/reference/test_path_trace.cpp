#include "reference/path_trace.h"

#include "brute_force.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "reference/checkpoint.h"
#include "reference_scenes.h"

#include "catch.h"

using namespace lrsm;
using namespace lrsm::test;
using Clock = std::chrono::steady_clock;

static Light spot(const Vec3& position, const Vec3& target, float intensity, float inner, float outer)
{
    Light light;
    light.type = LightType::spot;
    light.position = position;
    light.direction = glm::normalize(target - position);
    light.up = std::abs(light.direction.y) > 0.9f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    light.up = glm::normalize(light.up - glm::dot(light.up, light.direction) * light.direction);
    light.intensity = Vec3(intensity, 0.8f * intensity, 0.5f * intensity);
    light.innerConeAngle = inner;
    light.outerConeAngle = outer;
    return light;
}

/// Open room, a block-like screen in it, colored walls, a spot on the right wall.
static Scene spottedRoom()
{
    Scene scene;
    scene.meshes = boxRoom(true);
    scene.meshes[3].material = 1;
    scene.meshes[4].material = 2;
    scene.meshes.push_back(rectangle({-0.2f, -1, -0.3f}, {0.7f, 0, 0.2f}, {0, 1.1f, 0}, 1));
    scene.materials = {diffuse(Vec3(0.7f)), diffuse({0.8f, 0.2f, 0.1f}), diffuse({0.2f, 0.7f, 0.3f})};
    scene.lights = {spot({-0.5f, 0.7f, 0.4f}, {1, 0.1f, -0.1f}, 4.0f, 0.2f, 0.5f)};
    for (const Mesh& mesh : scene.meshes)
        for (const Vec3& p : mesh.positions) scene.bounds.include(p);
    return scene;
}

static ReferenceState renderState(const PathTracer& tracer, SampleRange range)
{
    ReferenceState state = tracer.start(range);
    REQUIRE(tracer.advance(state, Clock::time_point::max()));
    return state;
}

TEST_CASE("a triangle far away takes no light: rays' offsets and sums are measured by the scene's reach", "[reference][extent]")
{
    const Vec3 at = GENERATE(Vec3(20000, 3, 5), Vec3(-4000, 20000, -9000), Vec3(0, -400000, 30));
    Scene plain = spottedRoom(), stray = plain;
    plain.reach = stray.reach = plain.bounds;
    stray.meshes.push_back(rectangle(at, {1, 0, 0}, {0, 1, 0}));
    stray.bounds.include(at);
    const Camera camera = lookAt(Vec3(0, 0, 2.5f), Vec3(0, 0, -1));
    const auto total = [&](const Scene& scene) {
        const ReferenceFrame frame = renderReference(scene, camera, {.width = 16, .height = 16}, 64);
        Vec3 sum(0.0f);
        for (const Vec3& e : frame.irradiance.texels) sum += e;
        for (const Vec3& e : frame.direct.texels) sum += e;
        return sum;
    };
    const Vec3 expected = total(plain), got = total(stray);
    for (int c = 0; c < 3; ++c) CHECK(got[c] == Approx(expected[c]).epsilon(1e-3));
}

TEST_CASE("a hillside of 100 km throws no shadow on itself", "[reference][extent]")
{
    Scene scene;
    const Vec3 u(1e5f, 3e3f, 100.0f), v(-200.0f, 6e4f, -8e4f);
    scene.meshes = {rectangle(-0.501f * u - 0.5f * v, u, v)};
    scene.materials = {diffuse(Vec3(0.5f))};
    const Vec3 normal = glm::normalize(glm::cross(u, v));
    scene.lights = {sun(-normal + Vec3(0.6f, 0, 0), 1.0f)};
    for (const Vec3& p : scene.meshes[0].positions) scene.bounds.include(p);
    scene.reach = {Vec3(-5), Vec3(5)};
    const ReferenceFrame frame = renderReference(scene, lookAt(3.0f * normal, Vec3(0, 0, -1)), {.width = 48, .height = 48}, 1);
    std::size_t seen = 0;
    for (const Vec3& direct : frame.direct.texels) seen += direct != Vec3(0.0f) ? 1 : 0;
    CHECK(seen == frame.direct.texels.size());
}

TEST_CASE("inside a lit sphere: irradiance rho E in one bounce, rho E / (1 - rho) in all", "[reference][furnace]")
{
    // Albedo 1/2 and E = 1 W/m^2 from the centre; the sphere is a polyhedron, which brings up to 0.3 %.
    const Scene scene = *makeBuiltinScene("furnace");
    const auto [transport, expected] = GENERATE(table<Transport, double>({{Transport::single, 0.5}, {Transport::full, 1.0}}));
    const ReferenceFrame frame = renderReference(scene, scene.cameras[0], {.transport = transport, .width = 16, .height = 9}, 1024);
    for (const Vec3& e : frame.irradiance.texels)
        for (int c = 0; c < 3; ++c) CHECK(double(e[c]) == Approx(expected).epsilon(transport == Transport::single ? 0.005 : 0.05));
    for (const float opacity : frame.opacity.texels) CHECK(opacity == 1.0f);
}

TEST_CASE("a closed box keeps its energy: all walls together collect rho Phi in one bounce and rho Phi / (1 - rho) in all",
          "[reference][statistics][closed-form]")
{
    Scene scene;
    scene.meshes = boxRoom(false);
    scene.materials = {diffuse(Vec3(0.6f))};
    scene.lights = splitPointLight({0.2f, -0.1f, 0.3f}, Vec3(1.5f), kInfinity, "lamp");
    scene.bounds = {Vec3(-1), Vec3(1)};
    const Transport transport = GENERATE(Transport::single, Transport::full);

    // Six orthographic pictures of a wall each; their pixels are a midpoint rule over it.
    constexpr int side = 16;
    double collected = 0, variance = 0, lit = 0;
    for (int wall = 0; wall < 6; ++wall) {
        Vec3 forward(0);
        forward[wall / 2] = wall % 2 ? 1.0f : -1.0f;
        Camera camera = lookAt(Vec3(0), forward);
        camera.perspective = false;
        camera.verticalExtent = 2.0f;
        const ReferenceFrame frame = renderReference(scene, camera, {.transport = transport, .width = side, .height = side}, 256);
        for (std::size_t i = 0; i < frame.irradiance.texels.size(); ++i) {
            collected += double(frame.irradiance.texels[i].g) * 4 / (side * side);
            variance += double(frame.irradianceVariance.texels[i].g) * 16 / std::pow(double(side), 4);
            lit += double(frame.direct.texels[i].g) * 3.14159265358979 / 0.6 * 4 / (side * side);
        }
    }
    const double flux = 4 * 3.14159265358979 * 1.5;
    CHECK(lit == Approx(flux).epsilon(0.005));
    const double expected = flux * (transport == Transport::single ? 0.6 : 0.6 / 0.4);
    CAPTURE(collected, expected, std::sqrt(variance));
    CHECK(std::abs(collected - expected) < 6.0 * std::sqrt(variance) + 0.005 * expected);  // 0.5 %: the midpoint rule near the edges
    CHECK(std::sqrt(variance) < 0.0025 * expected);
}

TEST_CASE("unbiased: agrees pixel by pixel with brute force from the eye's side and from the light's side", "[reference][ztest]")
{
    // 60 pixels x 3 channels, two-sided 6.2 standard errors: 180 x 6e-10 = 1e-7 a run if Gaussian; seeds are fixed.
    const Scene scene = spottedRoom();
    const Camera camera = lookAt({0.1f, 0.2f, 2.6f}, {0, -0.1f, 0}, 0.75f);
    constexpr int width = 10, height = 6;
    const PathTracer tracer(scene, camera, {.width = width, .height = height});
    const ReferenceFrame frame = tracer.resolve(renderState(tracer, {0, 4096}).sums);

    const bool fromLight = GENERATE(false, true);
    BruteForce oracle(scene);
    double largest = 0, squares = 0;
    int values = 0;
    for (std::size_t i = 0; i < frame.irradiance.texels.size(); ++i) {
        if (!tracer.primary().covered.texels[i]) continue;
        const Surface& surface = tracer.primary().surface.texels[i];
        // On the lit wall itself nothing but the screen shines back; near it the light's side has unbounded samples: leave 0.3 m.
        if (fromLight && surface.position.x > 0.5f) continue;
        DVec3 sum(0), sumSquares(0);
        constexpr int count = 8000;
        for (int s = 0; s < count; ++s) {
            const DVec3 e =
                fromLight ? oracle.lightSample(surface.position, surface.geometricNormal) : oracle.hemisphereSample(surface.position, surface.geometricNormal);
            sum += e;
            sumSquares += e * e;
        }
        for (int c = 0; c < 3; ++c) {
            const double mean = sum[c] / count, variance = (sumSquares[c] / count - mean * mean) / count + double(frame.irradianceVariance.texels[i][c]);
            if (!(variance > 0)) continue;
            const double z = (double(frame.irradiance.texels[i][c]) - mean) / std::sqrt(variance);
            largest = std::max(largest, std::abs(z));
            squares += z * z;
            ++values;
        }
    }
    CAPTURE(fromLight, values, largest, squares / values);
    CHECK(values > 60);
    CHECK(largest < 6.2);
    CHECK(squares / values < 1.9);
}

TEST_CASE("the variance falls as 1/N and says how far independent pictures lie apart", "[reference][statistics][variance]")
{
    const Scene scene = spottedRoom();
    const Camera camera = lookAt({0.1f, 0.2f, 2.6f}, {0, -0.1f, 0}, 0.75f);
    const auto meanVariance = [&](std::uint64_t samples) {
        const ReferenceFrame frame = renderReference(scene, camera, {.width = 16, .height = 9, .seed = 99}, samples);
        double sum = 0;
        for (const Vec3& v : frame.irradianceVariance.texels) sum += double(v.g);
        return sum;
    };
    CHECK(meanVariance(512) / meanVariance(2048) == Approx(4.0).epsilon(0.15));

    // 256 pictures of 64 samples: the spread of their means against the mean of the variances they store, summed over pixels.
    constexpr int runs = 256, width = 8, height = 5;
    std::vector<double> sum(width * height), squares(width * height);
    double stored = 0;
    for (std::uint64_t seed = 0; seed < runs; ++seed) {
        const ReferenceFrame frame = renderReference(scene, camera, {.width = width, .height = height, .seed = seed}, 64);
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const double e = double(frame.irradiance.texels[i].g);
            sum[i] += e;
            squares[i] += e * e;
            stored += double(frame.irradianceVariance.texels[i].g) / runs;
        }
    }
    double spread = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) spread += (squares[i] - sum[i] * sum[i] / runs) / (runs - 1);
    CHECK(stored / spread == Approx(1.0).epsilon(0.12));  // its own spread is below 2 %
}

TEST_CASE("blocks of stratified samples are less noisy than independent ones", "[reference][variance]")
{
    const Scene scene = spottedRoom();
    const Camera camera = lookAt({0.1f, 0.2f, 2.6f}, {0, -0.1f, 0}, 0.75f);
    const auto noise = [&](int blockBits) {
        const ReferenceFrame frame = renderReference(scene, camera, {.width = 16, .height = 9, .blockBits = blockBits}, 512);
        double sum = 0;
        for (const Vec3& v : frame.irradianceVariance.texels) sum += double(v.g);
        return sum;
    };
    CHECK(noise(4) < 0.7 * noise(0));
}

TEST_CASE("same bits for 1 and 2 threads, and for any way to stop and go on", "[reference][determinism]")
{
    const Scene scene = *makeBuiltinScene("cornell-glossy");
    const Transport transport = GENERATE(Transport::single, Transport::full);
    const PathTracer tracer(scene, scene.cameras[0], {.transport = transport, .width = 40, .height = 24, .specularApertureDegrees = 10.0f});
    const ReferenceState whole = renderState(tracer, {0, 53});
    {
        const ThreadLimit one(1);
        const PathTracer again(scene, scene.cameras[0], tracer.settings());
        CHECK(renderState(again, {0, 53}).sums == whole.sums);
    }

    // Interrupted whenever the clock says so, through the bytes of a checkpoint each time.
    ReferenceState state = tracer.start({0, 53});
    int interruptions = 0;
    while (!tracer.advance(state, Clock::now() + std::chrono::milliseconds(2))) {
        const std::vector<std::byte> bytes = encodeCheckpoint({{{"a", "b"}}, tracer.unit(), state});
        std::vector<unsigned char> raw(bytes.size());
        std::transform(bytes.begin(), bytes.end(), raw.begin(), [](std::byte b) { return static_cast<unsigned char>(b); });
        state = decodeCheckpoint(raw, "test").state;
        ++interruptions;
    }
    CHECK(state.sums == whole.sums);
    CHECK(state.rays == whole.rays);

    // Ranges that cut blocks, merged; and a shorter render extended.
    SampleSums merged = renderState(tracer, {21, 53}).sums;
    mergeSums(merged, renderState(tracer, {0, 21}).sums, "test");
    CHECK(merged == whole.sums);
    ReferenceState extended = renderState(tracer, {0, 30});
    tracer.extend(extended, {30, 53});
    REQUIRE(tracer.advance(extended, Clock::time_point::max()));
    CHECK(extended.sums == whole.sums);
    CHECK(extended.rays == whole.rays);
}

TEST_CASE("a stop request ends the pass at once and loses nothing", "[reference][determinism]")
{
    const Scene scene = spottedRoom();
    const PathTracer tracer(scene, lookAt({0.1f, 0.2f, 2.6f}, {0, -0.1f, 0}), {.width = 16, .height = 9});
    ReferenceState state = tracer.start({0, 32});
    const std::atomic<bool> stop = true;
    CHECK_FALSE(tracer.advance(state, Clock::time_point::max(), &stop));
    CHECK(PathTracer::progress(state) == 0.0);
    CHECK(tracer.advance(state, Clock::time_point::max()));
    CHECK(PathTracer::progress(state) == 1.0);
    CHECK(state.sums == renderState(tracer, {0, 32}).sums);
}

TEST_CASE("light scaled by a power of two scales every bit of the picture", "[reference][invariance]")
{
    const Scene scene = spottedRoom();
    Scene dim = scene;
    for (Light& light : dim.lights) light.intensity *= 0x1p-40f;
    const Camera camera = lookAt({0.1f, 0.2f, 2.6f}, {0, -0.1f, 0});
    const ReferenceFrame a = renderReference(scene, camera, {.width = 16, .height = 9}, 64), b = renderReference(dim, camera, {.width = 16, .height = 9}, 64);
    for (std::size_t i = 0; i < a.irradiance.texels.size(); ++i) REQUIRE(a.irradiance.texels[i] * 0x1p-40f == b.irradiance.texels[i]);
}

TEST_CASE("more bounces never take light away, a specular part changes no irradiance of one bounce", "[reference][invariance]")
{
    const Scene scene = *makeBuiltinScene("cornell-glossy");
    const auto mean = [](const Image<Vec3>& picture) {
        double sum = 0;
        for (const Vec3& v : picture.texels) sum += double(v.g);
        return sum;
    };
    const ReferenceFrame single = renderReference(scene, scene.cameras[0], {.width = 32, .height = 18}, 128);
    const ReferenceFrame full = renderReference(scene, scene.cameras[0], {.transport = Transport::full, .width = 32, .height = 18}, 128);
    CHECK(mean(full.irradiance) > 1.1 * mean(single.irradiance));
    CHECK(mean(full.direct) == mean(single.direct));
    CHECK(mean(single.indirectSpecular) > 0.0);
}

TEST_CASE("in a furnace of radiance L the specular cone sees L, at any aperture", "[reference][specular]")
{
    // A small glossy plate inside the lit sphere: whatever it mirrors has radiance rho E / pi.
    Scene scene = *makeBuiltinScene("furnace");
    Material glossy = diffuse(Vec3(0.5f));
    glossy.roughness = 0.3f;
    scene.materials.push_back(glossy);
    scene.meshes.push_back(rectangle({-0.02f, -0.5f, -0.02f}, {0, 0, 0.04f}, {0.04f, 0, 0}, int(scene.materials.size()) - 1));
    const Camera camera = lookAt({0.2f, -0.3f, 0}, {0, -0.5f, 0}, 0.01f);
    const float aperture = GENERATE(1.0f, 10.0f, 60.0f);
    const ReferenceFrame frame = renderReference(scene, camera, {.width = 1, .height = 1, .specularApertureDegrees = aperture}, 1024);
    const double radiance = 0.5 / 3.14159265358979;
    CHECK(double(frame.specularCone.texels[0].g) == Approx(radiance).epsilon(0.01));

    // The material's lobe reflects its directional albedo, by an independent sum over directions on a fine grid.
    const PathTracer tracer(scene, camera, {.width = 1, .height = 1});
    const Surface& surface = tracer.primary().surface.texels[0];
    const Vec3 toEye = tracer.primary().toEye.texels[0];
    double albedo = 0;
    constexpr int rings = 600, spokes = 1200;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < spokes; ++j) {
            const double cosine = (i + 0.5) / rings, sine = std::sqrt(1 - cosine * cosine), azimuth = 2 * 3.14159265358979 * (j + 0.5) / spokes;
            const Vec3 direction = basisFromNormal(surface.normal) * Vec3(float(sine * std::cos(azimuth)), float(sine * std::sin(azimuth)), float(cosine));
            albedo += double(evaluateSpecular(surface, direction, toEye).g) * 2 * 3.14159265358979 / (rings * spokes);
        }
    const double error = std::sqrt(double(frame.indirectSpecularVariance.texels[0].g));
    CHECK(std::abs(double(frame.indirectSpecular.texels[0].g) - albedo * radiance) < 6.0 * error + 0.01 * albedo * radiance);
    CHECK(error < 0.01 * albedo * radiance);
}

TEST_CASE("single-sided: the eye sees fronts, light passes backs, everything else is stopped by both", "[reference][sides]")
{
    // A sheet at z = 0 facing +z.
    const bool doubleSided = GENERATE(false, true);
    Scene scene = makeScene({rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0})}, {diffuse(Vec3(0.5f), doubleSided)}, {});
    const EmbreeScene embree(scene);
    const auto stops = [&](RayKind kind, float fromZ) { return embree.occluded({{0.1f, 0.2f, fromZ}, {0, 0, fromZ > 0 ? -1.0f : 1.0f}, 0, kInfinity, kind}); };
    CHECK(stops(RayKind::eye, 1));
    CHECK(stops(RayKind::eye, -1) == doubleSided);
    CHECK(stops(RayKind::bounce, 1));
    CHECK(stops(RayKind::bounce, -1));
    CHECK(stops(RayKind::light, 1) == doubleSided);  // the lamp is behind the sheet and sees its back
    CHECK(stops(RayKind::light, -1));                // the lamp is before the sheet
    const auto hit = embree.closestHit({{0.1f, 0.2f, -1}, {0, 0, 1}, 0, kInfinity, RayKind::bounce});
    REQUIRE(hit);
    CHECK_FALSE(hit->front);
}

TEST_CASE("light from behind the triangle is not let in by a tilted shading normal", "[reference][sides]")
{
    // A sheet facing +z whose vertex normals lean towards +x; the lamp stands at +x, below the sheet's plane.
    Scene scene = makeScene({rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0})}, {diffuse(Vec3(0.5f), false)}, {sun({-1, 0, 0.2f}, 1.0f)});
    scene.meshes[0].normals.assign(4, glm::normalize(Vec3(1, 0, 0.8f)));
    const Camera camera = lookAt({0.3f, 0, 1}, {0, 0, 0}, 0.01f);
    CHECK(renderReference(scene, camera, {.width = 1, .height = 1}, 1).direct.texels[0] == Vec3(0.0f));
    scene.lights = {sun({-1, 0, -0.2f}, 1.0f)};
    CHECK(renderReference(scene, camera, {.width = 1, .height = 1}, 1).direct.texels[0].g > 0.0f);
}

TEST_CASE("alpha-masked texels let every kind of ray through", "[reference][alpha]")
{
    Scene scene = makeScene({rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), rectangle({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, 1)},
                            {diffuse(Vec3(0.5f)), diffuse(Vec3(0.5f))}, {});
    Texture texture;
    texture.image = Image<Rgba8>(2, 1);
    texture.image.at(0, 0).a = 0;  // left half open
    texture.nearest = true;
    scene.textures = {std::make_shared<Texture>(texture)};
    scene.materials[0].alphaMask = true;
    scene.materials[0].baseColorTexture.texture = 0;
    scene.meshes[0].uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const EmbreeScene embree(scene);
    for (const RayKind kind : {RayKind::eye, RayKind::bounce, RayKind::light}) {
        const auto meshAt = [&](float x) { return embree.closestHit({{x, 0.3f, 1}, {0, 0, -1}, 0, kInfinity, kind})->surface.mesh; };
        CHECK(meshAt(-0.5f) == 1);
        CHECK(meshAt(0.5f) == 0);
        CHECK_FALSE(embree.occluded({{-0.5f, 0.3f, 1}, {0, 0, -1}, 0, 1.5f, kind}));
        CHECK(embree.occluded({{0.5f, 0.3f, 1}, {0, 0, -1}, 0, 1.5f, kind}));
    }
}

TEST_CASE("settings out of range are refused by name", "[reference][settings]")
{
    CHECK_THROWS_AS(validate(ReferenceSettings{.width = 0}), InputError);
    CHECK_THROWS_AS(validate(ReferenceSettings{.blockBits = 13}), InputError);
    CHECK_THROWS_AS(validate(ReferenceSettings{.specularApertureDegrees = std::nanf("")}), InputError);
    CHECK_NOTHROW(validate(ReferenceSettings{}));
}
