#include "conetrace/render.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/light.h"
#include "core/scene/shapes.h"

#include "catch.h"
#include "tests/conetrace/explanation.h"

#include <cfenv>
#include <cmath>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

using namespace lrsm;

namespace {

/// A frame small enough for a test: everything on, little of it.
Settings smallSettings(Estimator estimator = Estimator::slab)
{
    Settings s;
    s.voxel.resolution = 64;
    s.rsm.resolution = 128;
    s.cones.march.estimator = estimator;
    return s;
}

Frame renderSmall(const Scene& scene, const Settings& settings, int width = 48, int height = 36)
{
    RenderOptions options;
    options.width = width;
    options.height = height;
    return renderFrame(scene, scene.cameras.at(0), settings, options);
}

double mean(const Image<Vec3>& image)
{
    double sum = 0;
    for (const Vec3& v : image.texels) sum += double(v.x + v.y + v.z) / 3;
    return sum / double(image.texels.size());
}

std::vector<std::string> hashes(const Frame& frame)
{
    std::vector<std::string> all;
    for (const PassReport& pass : frame.passes) all.push_back(pass.name + " " + pass.sha256);
    return all;
}

}  // namespace

TEST_CASE("frame: the same bits with 1, 2 and 8 threads, pass by pass", "[conetrace][invariance]")
{
    const auto scene = makeBuiltinScene(GENERATE("cornell-glossy", "atrium"));
    const Settings settings = smallSettings(GENERATE(Estimator::slab, Estimator::paper));
    std::vector<std::string> first;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        const auto now = hashes(renderSmall(*scene, settings));
        if (first.empty()) first = now;
        CHECK(now == first);
    }
    CHECK(first.size() >= 8);
}

TEST_CASE("frame: the host's rounding and flush-to-zero change no bit, and are left as they were", "[conetrace][invariance]")
{
    auto scene = makeBuiltinScene("cornell-box");
    for (Light& light : scene->lights) light.intensity *= 1e-36f;  // radiances among the denormals
    Settings settings = smallSettings();
    settings.rsm.storage = settings.layers.storage = settings.voxel.storage = Storage::float32;
    const std::vector<std::string> expected = hashes(renderSmall(*scene, settings));

    std::fenv_t before;
    std::fegetenv(&before);
    std::fesetround(FE_UPWARD);
#ifdef __SSE__
    _mm_setcsr(_mm_getcsr() | 0x8040u);  // flush to zero, denormals are zero
    const unsigned control = _mm_getcsr() & ~0x3fu;
#endif
    const std::vector<std::string> found = hashes(renderSmall(*scene, settings));
#ifdef __SSE__
    const bool kept = (_mm_getcsr() & ~0x3fu) == control;
#else
    const bool kept = std::fegetround() == FE_UPWARD;
#endif
    std::fesetenv(&before);
    CHECK(found == expected);
    CHECK(kept);
}

TEST_CASE("frame: light scaled by 2^k scales the picture exactly (float32), or to half's precision (gpu)", "[conetrace][invariance]")
{
    auto scene = makeBuiltinScene(GENERATE("cornell-glossy", "atrium"));
    Settings settings = smallSettings(GENERATE(Estimator::slab, Estimator::paper));
    const Storage storage = GENERATE(Storage::float32, Storage::gpu);
    settings.rsm.storage = settings.layers.storage = storage;
    const Frame before = renderSmall(*scene, settings);
    for (Light& light : scene->lights) light.intensity *= 8.0f;
    const Frame after = renderSmall(*scene, settings);
    for (std::size_t i = 0; i < before.combined.texels.size(); ++i) {
        const Vec3 scaled = 8.0f * before.irradiance.texels[i], now = after.irradiance.texels[i];
        if (storage == Storage::float32) {
            REQUIRE(now == scaled);
            REQUIRE(after.combined.texels[i] == 8.0f * before.combined.texels[i]);
        } else {
            // Half's denormals, below 6e-5, are the only values that do not scale.
            for (int c = 0; c < 3; ++c) REQUIRE(now[c] == Approx(scaled[c]).epsilon(1e-3).margin(1e-4));
        }
    }
    CHECK(mean(before.irradiance) > 0);
}

TEST_CASE("frame: what the scene analysis leaves out changes no bit", "[conetrace][requirements]")
{
    const auto scene = makeBuiltinScene(GENERATE("cornell-box", "cornell-glossy", "atrium"));
    Settings settings = smallSettings();
    const Frame lean = renderSmall(*scene, settings);
    settings.force.everything = true;
    settings.layers.dropEmpty = false;
    const Frame full = renderSmall(*scene, settings);
    CHECK(lean.combined.texels == full.combined.texels);
    CHECK(lean.irradiance.texels == full.irradiance.texels);
    CHECK(lean.indirectSpecular.texels == full.indirectSpecular.texels);
}

TEST_CASE("furnace: constant radiance in, the closed form out", "[conetrace][furnace]")
{
    // Inside a sphere lit from its centre E = rho I / r^2 = 0.5 everywhere.
    const auto scene = makeBuiltinScene("furnace");
    Settings settings = smallSettings();
    const int resolution = GENERATE(32, 64, 128);
    settings.voxel.resolution = resolution;
    const Frame frame = renderSmall(*scene, settings);
    CAPTURE(resolution);
    double least = 1e9, most = 0, sum = 0;
    for (const Vec3& e : frame.irradiance.texels) {
        least = std::min(least, double(e.x));
        most = std::max(most, double(e.x));
        sum += double(e.x);
    }
    CAPTURE(least, most);
    CHECK(sum / double(frame.irradiance.texels.size()) == Approx(0.5).epsilon(0.08));
    CHECK(least > 0.40);
    CHECK(most < 0.60);
    CHECK(mean(frame.direct) == Approx(0.5 / double(kPi)).epsilon(0.02));
}

TEST_CASE("frame: moving the voxel grid, or doubling voxels or RSM, changes the mean by no more than a few percent", "[conetrace][invariance]")
{
    const auto scene = makeBuiltinScene("cornell-box");
    const Settings settings = smallSettings();
    const double base = mean(renderSmall(*scene, settings).irradiance);

    Settings finerRsm = settings;
    finerRsm.rsm.resolution *= 2;
    CHECK(mean(renderSmall(*scene, finerRsm).irradiance) == Approx(base).epsilon(0.02));

    Settings finerVoxels = settings;
    finerVoxels.voxel.resolution *= 2;
    CHECK(mean(renderSmall(*scene, finerVoxels).irradiance) == Approx(base).epsilon(0.08));

    // A far speck widens the bounds on one side and so shifts the grid by a fraction of a voxel.
    Scene shifted = *scene;
    shifted.bounds.max += Vec3(0.004f, 0.003f, 0.005f);
    CHECK(mean(renderSmall(shifted, settings).irradiance) == Approx(base).epsilon(0.04));
}

TEST_CASE("an invented method: only what it reads is built, and its pass reports itself like any other", "[conetrace][seam]")
{
    // Light that is nowhere but in this test: the albedo, from a pass of its own over an invented grid of 4x3 cells.
    const auto scene = makeBuiltinScene("cornell-glossy");
    const Settings settings = smallSettings();
    RenderOptions options{.width = 8, .height = 6, .watch = {}, .method = {}};
    std::vector<std::string> seen;
    options.watch.observe = [&](const std::string& pass, const PassOutput& output) {
        seen.push_back(pass);
        if (pass == "invented grid") CHECK(output.as<Image<float>>()->texels.size() == 12);
    };
    options.method.reads = {.bits = GENERATE(false, true), .mips = false};
    options.method.gather = [](const GatherInput& input, PassLog& log) {
        CHECK(input.opacity.levels() == 0);
        log.run("invented grid", kWorldPass, [] { return Image<float>(4, 3, 1.0f); });
        return log.run("invented gather", kPicturePass, [&] {
            Gathered gathered;
            gathered.irradiance = input.gbuffer.albedo;
            gathered.specular = Image<Vec3>(8, 6, Vec3(1.0f));
            gathered.opacity = Image<float>(8, 6);
            gathered.counters = {{"invented_taps", 48.0}};
            return gathered;
        });
    };
    const Frame frame = renderFrame(*scene, scene->cameras.at(0), settings, options);
    std::vector<std::string> passes;
    for (const PassReport& pass : frame.passes) passes.push_back(pass.name);
    std::vector<std::string> expected = {"rsm 0", "gbuffer", "direct", "invented grid", "invented gather", "composite"};
    if (options.method.reads.bits) expected.insert(expected.begin(), "voxelize");
    CHECK(passes == expected);
    CHECK(seen == expected);
    CHECK(counterSum(frame.passes, "invented_taps") == 48.0);
    CHECK(frame.irradiance.texels == frame.gbuffer.albedo.texels);
    for (const PassReport& pass : frame.passes) {
        if (pass.name != "invented grid") continue;
        CHECK(pass.bytes == 12 * sizeof(float));
        CHECK(pass.sha256 == hashOf(Image<float>(4, 3, 1.0f)));
        CHECK(pass.traits.resident);
    }
    CHECK_THROWS_AS(explainPixel(*scene, scene->cameras.at(0), settings, options, 1, 1), InputError);
}

TEST_CASE("frame: two-rooms keeps most of the light in the lit room", "[conetrace][leak]")
{
    const auto scene = makeBuiltinScene("two-rooms");
    const Frame frame = renderSmall(*scene, smallSettings(), 64, 24);
    double left = 0, right = 0;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 64; ++x) (x < 32 ? left : right) += double(frame.irradiance.at(x, y).x);
    CAPTURE(right / left);
    CHECK(left > 0);
    CHECK(right < 0.25 * left);
}

TEST_CASE("pixel: the explanation names every cone and ends with the pixel's own irradiance", "[conetrace][pixel]")
{
    checkExplanation(smallSettings(GENERATE(Estimator::slab, Estimator::paper)));
}
