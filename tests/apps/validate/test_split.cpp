#include "apps/validate/split.h"

#include "conetrace/frame/cones.h"
#include "conetrace/render.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "reference/path_trace.h"
#include "reference/ztest.h"

#include "catch.h"

using namespace lrsm;

namespace {

constexpr int kWidth = 32, kHeight = 18;

Settings smallSettings()
{
    Settings s;
    s.voxel.resolution = 128;
    s.rsm.resolution = 512;
    s.cones.march.startVoxels = 1.5f;
    return s;
}

Frame renderWith(const Scene& scene, const Settings& settings, const GatherMethod& method)
{
    RenderOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.watch.hashPasses = false;
    options.method = method;
    return renderFrame(scene, scene.cameras.at(0), settings, options);
}

/// With the light of what the rays meet by shadow rays.
Frame renderExact(const Scene& scene, const Settings& settings, Visibility visibility, int strata)
{
    return renderWith(scene, settings, exactRadianceMethod(visibility, strata));
}

/// With the LRSM's light; the same rays, and no filter.
Frame renderRays(const Scene& scene, Settings settings, Visibility visibility, int strata)
{
    settings.cones.march.visibility = visibility;
    settings.cones.set.count = strata;
    settings.cones.set.setsPerPixel = kRotations;
    settings.cones.set.filter = false;
    settings.cones.set.apertureScale = 0.01f;
    return renderWith(scene, settings, {});
}

ReferenceFrame truth(const Scene& scene, std::uint64_t samples)
{
    return renderReference(scene, scene.cameras.at(0), {.width = kWidth, .height = kHeight}, samples);
}

/// 1 where the rasterizer and the eye's ray see the same surface: on outlines, snapped vertices may decide otherwise.
PixelMask sameSurface(const Scene& scene, const GBuffer& gbuffer)
{
    const PathTracer tracer(scene, scene.cameras.at(0), {.width = kWidth, .height = kHeight});
    PixelMask same(kWidth, kHeight);
    const float tolerance = 1e-3f * glm::length(scene.bounds.extent());
    for (std::size_t i = 0; i < same.texels.size(); ++i) {
        const Surface& surface = tracer.primary().surface.texels[i];
        const bool seen = tracer.primary().covered.texels[i] != 0;
        const bool close = glm::distance(surface.position, gbuffer.position.texels[i]) < tolerance &&
                           glm::dot(surface.geometricNormal, gbuffer.geometricNormal.texels[i]) > 0.99f;
        same.texels[i] = seen == gbuffer.covered(i) && (!seen || close);
    }
    return same;
}

double meanOf(const Image<Vec3>& image)
{
    double sum = 0.0;
    for (const Vec3& v : image.texels) sum += double(v.x) + double(v.y) + double(v.z);
    return sum / double(3 * image.texels.size());
}

}  // namespace

TEST_CASE("exact x exact is the path tracer's picture: in the mean, pixel by pixel, and in what the rays hit", "[validation][split]")
{
    const std::string name = GENERATE("cornell-box", "two-rooms", "atrium");
    CAPTURE(name);
    const auto scene = makeBuiltinScene(name);
    const Frame frame = renderExact(*scene, smallSettings(), Visibility::rays, 64);
    const ReferenceFrame reference = truth(*scene, 1024);
    const PixelMask same = sameSurface(*scene, frame.gbuffer);
    const Metrics metrics = measure(reference.irradiance, frame.irradiance, same);
    CHECK(metrics.pixels >= same.texels.size() - 3);
    CHECK(metrics.energyRatio == Approx(1.0).epsilon(0.01));

    // Noise of the truth, plus 3 % of the mean for the 1024 fixed directions' own error.
    Image<Vec3> variance = reference.irradianceVariance;
    const auto own = float(0.03 * metrics.meanReference);
    for (Vec3& v : variance.texels) v += Vec3(own * own);
    const ZTest z = zTest(reference.irradiance, frame.irradiance, variance, same);
    CAPTURE(z.rms, z.largest, z.noise);
    CHECK(z.rms < 1.3);
    CHECK(z.largest < 9.0);

    double worst = 0.0;
    for (std::size_t i = 0; i < same.texels.size(); ++i)
        if (same.texels[i]) worst = std::max(worst, std::abs(double(frame.opacity.texels[i] - reference.opacity.texels[i])));
    CHECK(worst < 0.06);
}

TEST_CASE("exact x LRSM keeps the light's place: neither shadowed sides nor wide footprints take light from beside them", "[validation][split]")
{
    const auto scene = makeBuiltinScene(GENERATE("cornell-box", "two-rooms"));
    Settings settings = smallSettings();
    settings.voxel.resolution = 256;
    settings.rsm.resolution = 1024;
    const Frame frame = renderRays(*scene, settings, Visibility::rays, 64);
    const Metrics metrics = measure(renderExact(*scene, settings, Visibility::rays, 64).irradiance, frame.irradiance);
    CHECK(metrics.energyRatio == Approx(1.0).epsilon(0.02));
    CHECK(metrics.rmse < 0.1);
}

TEST_CASE("furnace: all four give the closed form", "[validation][split][furnace]")
{
    const Scene scene = *makeBuiltinScene("furnace");  // E = 0.5 W/m^2 on the inside of the sphere
    const Visibility visibility = GENERATE(Visibility::rays, Visibility::voxelRays);
    const bool exact = GENERATE(true, false);
    Settings settings = smallSettings();
    settings.rsm.resolution = 256;  // six maps
    const Frame frame = exact ? renderExact(scene, settings, visibility, 16) : renderRays(scene, settings, visibility, 16);
    const bool both = visibility == Visibility::rays && exact;
    CAPTURE(int(visibility), exact);
    CHECK(meanOf(frame.irradiance) == Approx(0.5).epsilon(both ? 0.005 : 0.08));
    for (const Vec3& e : frame.irradiance.texels) CHECK(double(e.y) == Approx(0.5).epsilon(both ? 0.01 : 0.2));
    if (visibility == Visibility::rays)
        for (const float opacity : frame.opacity.texels) REQUIRE(opacity == Approx(1.0f));
}

TEST_CASE("each half stands alone: the LRSM's radiance does not depend on the voxels' opacity, exact radiance not on the RSM", "[validation][split]")
{
    const auto scene = makeBuiltinScene("cornell-box");
    const Settings settings = smallSettings();

    Settings hollow = settings;  // other voxelization, filter and opacity; the same voxel size
    hollow.voxel.mode = Voxelization::raster;
    hollow.voxel.mipFilter = MipFilter::max;
    hollow.cones.march.startVoxels = 6.0f;
    CHECK(renderRays(*scene, settings, Visibility::rays, 8).irradiance.texels == renderRays(*scene, hollow, Visibility::rays, 8).irradiance.texels);

    Settings coarse = settings;
    coarse.rsm.resolution = 64;
    coarse.layers.depthLayers = 1;
    const auto voxelExact = [&](const Settings& s) { return renderExact(*scene, s, Visibility::voxelRays, 8).irradiance.texels; };
    CHECK(voxelExact(settings) == voxelExact(coarse));
    CHECK(voxelExact(settings) != voxelExact(hollow));
    CHECK(renderRays(*scene, settings, Visibility::rays, 8).irradiance.texels != renderRays(*scene, coarse, Visibility::rays, 8).irradiance.texels);
}

TEST_CASE("diffuse and combined layers follow the split, specular and direct stay", "[validation][split]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    const Settings settings = smallSettings();
    const Frame shipped = renderWith(*scene, settings, {}), exact = renderExact(*scene, settings, Visibility::rays, 8);
    CHECK(shipped.direct.texels == exact.direct.texels);
    CHECK(shipped.indirectSpecular.texels == exact.indirectSpecular.texels);
    CHECK(shipped.irradiance.texels != exact.irradiance.texels);
    for (std::size_t i = 0; i < exact.combined.texels.size(); ++i) {
        REQUIRE(exact.combined.texels[i] == exact.direct.texels[i] + exact.indirectDiffuse.texels[i] + exact.indirectSpecular.texels[i]);
        for (int c = 0; c < 3; ++c)
            REQUIRE(exact.indirectDiffuse.texels[i][c] ==
                    Approx(exact.gbuffer.albedo.texels[i][c] * exact.irradiance.texels[i][c] / kPi).epsilon(1e-5).margin(1e-9));
    }
}

TEST_CASE("split: the same bits with 1 and 2 threads", "[validation][split][determinism]")
{
    const auto scene = makeBuiltinScene("atrium");
    const bool exact = GENERATE(true, false);
    std::vector<Vec3> first;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        const Frame frame = exact ? renderExact(*scene, smallSettings(), Visibility::voxelRays, 8) : renderRays(*scene, smallSettings(), Visibility::rays, 8);
        if (first.empty()) first = frame.irradiance.texels;
        CHECK(frame.irradiance.texels == first);
    }
}
