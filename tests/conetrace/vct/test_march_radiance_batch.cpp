// The batch kernel against the scalar march, bit for bit, at every width of this machine: random voxels, every kind of volume and setting, batches that fill
// no vector; and a picture against its pixels' cones one by one.
#include "conetrace/frame/pixel_cones.h"
#include "conetrace/render.h"
#include "conetrace/vct/gather.h"
#include "conetrace/vct/march_radiance_batch.h"
#include "core/scene/builtin_scenes.h"
#include "core/settings/settings_table.h"
#include "voxel/radiance/isotropic_volume.h"
#include "voxel/surface/voxel_index.h"
#include "voxel/voxelize.h"

#include "catch.h"
#include "tests/conetrace/cone_batches.h"

#include <cstring>
#include <memory>

using namespace lrsm;

namespace {

struct ToldNothing {};

constexpr float kPreExposure = 3.0f;

/// Bricks of which two in three are empty, the others a quarter full.
BitGrid speckled(int resolution, SearchRandom& random)
{
    BitGrid bits;
    bits.grid = {Vec3(-1.0f, 0.5f, 2.0f), 0.25f, resolution};
    bits.bricks.assign(predictBitGridBytes(resolution) / sizeof(std::uint64_t), 0);
    for (std::size_t brick = 0; brick < bits.bricks.size(); ++brick)
        if (random.word() % 3 == 0)
            for (int bit = 0; bit < 64; ++bit) {
                const IVec3 voxel = voxelOf(bits, brick, bit);
                const bool inside = voxel.x < resolution && voxel.y < resolution && voxel.z < resolution;
                if (inside && random.word() % 4 == 0) bits.bricks[brick] |= std::uint64_t(1) << bit;
            }
    return bits;
}

Vec4 randomRadiance(SearchRandom& random)
{
    return {random.uniform(0.0f, 4.0f), random.uniform(0.0f, 1.0f), random.uniform(0.0f, 2.0f), 1.0f};
}

RadianceVolume directionalVolume(const BitGrid& bits, const VctSettings& settings, SearchRandom& random)
{
    RadianceVolume volume = darkVolume(bits);
    volume.preExposure = kPreExposure;
    for (std::size_t i = 0; i < volume.base.size(); ++i) {
        if (volume.base[i].w == 0.0f) continue;
        volume.base[i] = randomRadiance(random);
        volume.normals[i] = Vec4(randomUnit(random) * random.uniform(0.0f, 1.0f), 0.0f);
    }
    buildRadianceMips(volume, settings);
    return volume;
}

IsotropicVolume isotropicVolume(const BitGrid& bits, SearchRandom& random)
{
    IsotropicVolume volume;
    volume.preExposure = kPreExposure;
    volume.maps = mapBricks(bits);
    std::vector<Vec4>& base = volume.levels.emplace_back(volume.maps[0].texelCount(), Vec4(0.0f));
    for (std::size_t place = 1; place < volume.maps[0].coordinate.size(); ++place)
        forEachBit(bits.bricks[volume.maps[0].coordinate[place]],
                   [&](int bit) { base[place * BrickMap::kTexels + std::size_t(bit)] = randomRadiance(random); });
    prefilterRadiance(volume, CacheSettings{});
    return volume;
}

struct RadianceCase {
    int resolution = 64;
    VctSettings vct = {};
    MarchSettings march = {};
};

void holdCase(const RadianceCase& c, std::uint32_t seed)
{
    CAPTURE(c.resolution, seed);
    SearchRandom random(seed);
    const BitGrid bits = speckled(c.resolution, random);
    ConeSettings cones;
    cones.march = c.march;
    cones.march.estimator = Estimator::paper;
    const MarchSchedule schedule = makeSchedule(cones, 0.4f, 1.74f * float(c.resolution));
    const RadianceVolume directional = directionalVolume(bits, c.vct, random);
    const IsotropicVolume isotropic = isotropicVolume(bits, random);
    const VctWorld world{.volume = directional, .grid = bits.grid, .cones = cones, .vct = c.vct};
    const RadianceMarch march = marchOf(world);
    const IsotropicLookup lookUp(isotropic, cones.march.filterFraction);
    const RadianceBatchWorld directionalBatch(world), isotropicBatch(isotropic, march);
    const auto scratch = std::make_unique<RadianceBatchScratch>();
    ToldNothing nobody;
    for (const int count : {1, 5, 17, kBatchCones}) {
        const auto batch = test::randomCones(bits.grid, count, random);
        const auto with = [&](const RadianceBatchWorld& what) {
            return [&](int lanes, const ConeBatch& all, ConeBatchResult& result, ConeCounts& counts) {
                marchRadianceBatch(lanes)(what, schedule, all, *scratch, result, counts);
            };
        };
        const int lit = test::holdBatch(
            *batch, [&](const ConeRay& ray, ConeCounts& counts) { return marchRadiance(world, ray, schedule, counts, nobody); }, with(directionalBatch));
        const int litAlike = test::holdBatch(
            *batch, [&](const ConeRay& ray, ConeCounts& counts) { return marchRadiance(march, lookUp, ray, schedule, counts, nobody); }, with(isotropicBatch));
        if (count == kBatchCones && c.resolution >= 16) {
            CHECK(lit > count / 2);
            CHECK(litAlike > count / 2);
        }
    }
}

std::vector<RadianceCase> allCases()
{
    std::vector<RadianceCase> cases;
    for (const TransmittanceModel transmittance : {TransmittanceModel::linear, TransmittanceModel::exponential})
        for (const StepOpacity opacity : {StepOpacity::step, StepOpacity::none})
            for (const DirectionWeights weights : {DirectionWeights::absolute, DirectionWeights::squared}) {
                RadianceCase c;
                c.march.transmittance = transmittance;
                c.vct.opacity = opacity;
                c.vct.weights = weights;
                cases.push_back(c);
            }
    for (const int resolution : {1, 2, 4, 8, 32}) cases.push_back({.resolution = resolution});
    RadianceCase rounded{.resolution = 32};
    rounded.vct.storage = Storage::float32;
    rounded.march.filterFraction = FilterFraction::fixed8;
    cases.push_back(rounded);
    RadianceCase pushed{.resolution = 32};
    pushed.vct.facing = 2.0f;
    pushed.march.push = 0.5f;
    pushed.march.transmittanceCutoff = 0.0f;
    pushed.march.voxelLevelBias = 0.0f;
    cases.push_back(pushed);
    return cases;
}

/// A picture of odd size whose first tile and one other pixel show nothing.
struct Picture {
    Scene scene = *makeBuiltinScene("cornell-glossy");
    Settings settings = preset("vct");
    Requirements needs = analyseRequirements(scene, {});
    OpacityPyramid opacity;
    std::vector<Rsm> rsms;
    GBuffer gbuffer;

    Picture(int width, int height)
    {
        settings.voxel.resolution = 32;
        settings.rsm.resolution = 64;
        settings.cones.set.setsPerPixel = 2;
        opacity.base = voxelize(scene, settings.voxel);
        for (const Light& light : scene.lights) rsms.push_back(renderRsm(scene, light, needs, settings.rsm));
        gbuffer = renderGBuffer(scene, scene.cameras.at(0), needs, {.width = width, .height = height});
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if ((width > 1 && x < kTile && y < kTile) || (x == 20 && y == 3)) gbuffer.objectId.texels[gbuffer.objectId.index(x, y)] = 0;
    }
    GatherInput input(int lanes) const
    {
        return {.scene = scene,
                .camera = scene.cameras.at(0),
                .needs = needs,
                .settings = settings,
                .gbuffer = gbuffer,
                .rsms = rsms,
                .opacity = opacity,
                .lanes = lanes};
    }
};

/// traceRadiance's picture, pixel by pixel and cone by cone.
Gathered oneByOne(const GatherInput& input, const RadianceVolume& volume, ConeRecord& record)
{
    const ConeSettings& cones = input.settings.cones;
    const GBuffer& gbuffer = input.gbuffer;
    const GatherPlan plan = planVct(cones, input.needs, volume.resolution());
    const VctWorld world{.volume = volume, .grid = input.opacity.base.grid, .cones = cones, .vct = input.settings.vct};
    Gathered out = emptyGathered(gbuffer, input.needs, plan.lobes.sampling());
    record = ConeRecord(gbuffer, input.needs, cones);
    ConeCounts counts;
    ToldNothing nobody;
    const auto march = [&](const ConeRay& ray, const MarchSchedule& schedule) { return marchRadiance(world, ray, schedule, counts, nobody); };
    for (int y = 0; y < gbuffer.height; ++y)
        for (int x = 0; x < gbuffer.width; ++x) {
            const std::size_t pixel = gbuffer.position.index(x, y);
            if (!gbuffer.covered(pixel)) continue;
            const Receiver receiver = receiverAt(gbuffer, world.grid, cones, x, y);
            ConeKeeper keeper = diffuseKeeper(&record, pixel);
            const PixelGather diffuse = gatherDiffuse(plan, cones.set.setsPerPixel, receiver, march, keeper);
            out.irradiance.texels[pixel] = diffuse.irradiance;
            out.opacity.texels[pixel] = diffuse.opacity;
            if (out.specular.empty() || gbuffer.specularColor.texels[pixel] == Vec3(0.0f)) continue;
            const float roughness = gbuffer.roughness.texels[pixel];
            const Vec3 toEye = glm::normalize(directionToEye(input.camera, receiver.position));
            const LobeDirection lobe = plan.lobes.direction(receiver.normal, toEye, roughness, receiver.rotation);
            keeper = specularKeeper(&record, pixel);
            out.specular.texels[pixel] = gatherSpecular(plan, receiver, lobe.direction, roughness, march, keeper);
            if (!out.lobeWeight.empty()) out.lobeWeight.texels[pixel] = lobe.weight;
        }
    out.counters = countersOf(counts);
    return out;
}

template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace

TEST_CASE("vct: a batch of cones has the scalar march's bits at every width, through six-direction and isotropic voxels", "[conetrace][vct][march]")
{
    std::uint32_t seed = 5200;
    for (const RadianceCase& c : allCases()) holdCase(c, seed++);
}

TEST_CASE("vct: a picture of any size has the bits of its pixels' cones one by one, at every width", "[conetrace][vct][march]")
{
    const IVec2 size = GENERATE(IVec2(1, 1), IVec2(35, 18));
    const Picture picture(size.x, size.y);
    const PassWatch nobody{.hashPasses = false, .progress = {}, .observe = {}};
    PassLog log(nobody);
    const RadianceVolume volume = buildRadiance(picture.input(0), log);
    ConeRecord expectedRecord, record;
    const Gathered expected = oneByOne(picture.input(0), volume, expectedRecord);
    for (const int lanes : laneWidths()) {
        CAPTURE(size.x, size.y, lanes);
        const Gathered made = traceRadiance(picture.input(lanes), volume, &record);
        CHECK(sameBits(made.irradiance.texels, expected.irradiance.texels));
        CHECK(sameBits(made.opacity.texels, expected.opacity.texels));
        CHECK(sameBits(made.specular.texels, expected.specular.texels));
        CHECK(sameBits(made.lobeWeight.texels, expected.lobeWeight.texels));
        CHECK(sameBits(record.diffuse, expectedRecord.diffuse));
        CHECK(sameBits(record.specular.texels, expectedRecord.specular.texels));
        for (std::size_t i = 0; i < expected.counters.size(); ++i) CHECK(made.counters[i].value == expected.counters[i].value);
    }
}
