#include "core/imageio/image_io.h"
#include "reference/flip.h"

#include "catch.h"
#include "scenes.h"

using namespace lrsm;

// Values by the authors' own tool (version 1.6), 67.02 pixels per degree; HDR: ACES, exposures -2..4, 7 of them.

static Image<Vec3> load(const char* name)
{
    const std::string path = (scenesFolder() / "flip" / name).string();
    return rgbLayer(readImage(path), "", path);
}

static void checkPool(const FlipPool& pool, const FlipPool& published)
{
    constexpr double threeDecimals = 5e-4;
    CHECK(pool.mean == Approx(published.mean).margin(threeDecimals).epsilon(0));
    CHECK(pool.weightedMedian == Approx(published.weightedMedian).margin(threeDecimals).epsilon(0));
    CHECK(pool.firstWeightedQuartile == Approx(published.firstWeightedQuartile).margin(threeDecimals).epsilon(0));
    CHECK(pool.thirdWeightedQuartile == Approx(published.thirdWeightedQuartile).margin(threeDecimals).epsilon(0));
    CHECK(pool.min == Approx(published.min).margin(threeDecimals).epsilon(0));
    CHECK(pool.max == Approx(published.max).margin(threeDecimals).epsilon(0));
}

TEST_CASE("LDR-FLIP agrees with the authors' tool to three decimals", "[reference][flip]")
{
    LRSM_NEED_SCENES();
    const Image<Vec3> reference = load("sponza_ref.png");
    checkPool(poolFlip(flip(reference, load("sponza_noise.png"))), {0.094557, 0.108629, 0.080935, 0.140764, 0.002864, 0.330039});
    checkPool(poolFlip(flip(reference, load("sponza_shift1.png"))), {0.094474, 0.130501, 0.077496, 0.223509, 0.000113, 0.974960});
    checkPool(poolFlip(flip(reference, load("sponza_curtain.png"))), {0.043876, 0.616669, 0.443663, 0.797157, 0.000000, 0.990640});
}

TEST_CASE("HDR-FLIP agrees with the authors' tool to three decimals", "[reference][flip]")
{
    LRSM_NEED_SCENES();
    checkPool(poolFlip(hdrFlip(load("cornell_ref.exr"), load("cornell_64spp.exr"), {-2, 4, 7})), {0.060361, 0.119499, 0.076702, 0.166771, 0.000722, 0.424518});
}
