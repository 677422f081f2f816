// A frame with several voxel grids. The grids and their lookups: tests/voxel/test_cascades.cpp; batches: tests/conetrace/lrsm/test_march_batch.cpp.
#include "conetrace/frame/lane_widths.h"
#include "conetrace/render.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "core/settings/settings_table.h"
#include "tests/conetrace/explanation.h"

#include "catch.h"

#include <map>

using namespace lrsm;

namespace {

Settings cascadeSettings(int resolution, int cascades, Estimator estimator = Estimator::slab)
{
    Settings s;
    s.voxel.resolution = resolution;
    s.voxel.cascades = cascades;
    s.rsm.resolution = 128;
    s.cones.march.estimator = estimator;
    return s;
}

Frame renderCascades(const Scene& scene, const Settings& settings, int lanes = 0)
{
    RenderOptions options;
    options.width = 48;
    options.height = 36;
    options.lanes = lanes;
    return renderFrame(scene, scene.cameras.at(0), settings, options);
}

std::map<std::string, std::string> hashesOf(const Frame& frame)
{
    std::map<std::string, std::string> all;
    for (const PassReport& pass : frame.passes) all[pass.name] = pass.sha256;
    return all;
}

double distance(const Frame& a, const Frame& b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < a.irradiance.texels.size(); ++i) {
        const glm::dvec3 d = glm::dvec3(a.irradiance.texels[i]) - glm::dvec3(b.irradiance.texels[i]);
        sum += glm::dot(d, d);
    }
    return std::sqrt(sum);
}

}  // namespace

TEST_CASE("cascades: the widest is the lone grid, and all bits are those of any thread and width", "[conetrace][cascades][invariance]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    const Estimator estimator = GENERATE(Estimator::slab, Estimator::paper);
    const Settings settings = cascadeSettings(64, 3, estimator);
    const auto lone = hashesOf(renderCascades(*scene, cascadeSettings(64, 1, estimator)));
    std::map<std::string, std::string> all;
    {
        const ThreadLimit limit(1);
        all = hashesOf(renderCascades(*scene, settings));
    }
    CHECK(all.at("voxelize") == lone.at("voxelize"));
    CHECK(all.at("voxel mips") == lone.at("voxel mips"));
    CHECK(all.at("voxel mips 2") != all.at("voxel mips 1"));
    CHECK(all.at("cones") != lone.at("cones"));
    for (const int lanes : laneWidths()) CHECK(hashesOf(renderCascades(*scene, settings, lanes)) == all);
}

TEST_CASE("cascades: two grids come near to the one of their finer voxels", "[conetrace][cascades]")
{
    const auto scene = makeBuiltinScene("atrium");
    const Frame fine = renderCascades(*scene, cascadeSettings(256, 1)), coarse = renderCascades(*scene, cascadeSettings(128, 1)),
                nested = renderCascades(*scene, cascadeSettings(128, 2));
    CAPTURE(distance(coarse, fine), distance(nested, fine));
    CHECK(distance(nested, fine) < 0.7 * distance(coarse, fine));
}

TEST_CASE("cascades: --pixel is the frame's, memory is foretold to the byte", "[conetrace][cascades][memory]")
{
    const Settings settings = cascadeSettings(64, 3, GENERATE(Estimator::slab, Estimator::paper));
    checkExplanation(settings);
    const auto scene = makeBuiltinScene("cornell-box");
    const Frame frame = renderCascades(*scene, settings);
    std::vector<MemoryRow> rows = predictMemory({*scene, frame.needs, settings, 48, 36});
    addMeasured(rows, frame.passes);
    int voxels = 0;
    for (const MemoryRow& row : rows) {
        if (!row.structure.starts_with("voxels")) continue;
        ++voxels;
        CHECK(row.measured == row.predicted);
    }
    CHECK(voxels == 3);
}

TEST_CASE("cascades: what marches through one grid alone refuses", "[conetrace][cascades]")
{
    Settings settings = cascadeSettings(64, 2);
    validate(settings);
    settings.cones.march.visibility = Visibility::voxelRays;
    CHECK_THROWS_AS(validate(settings), InputError);
    settings.cones.march.visibility = Visibility::rays;
    validate(settings);
    for (const Method method : {Method::vct, Method::caches}) {
        settings.method = method;
        CHECK_THROWS_AS(validate(settings), InputError);
    }
    CHECK_THROWS_AS(validate(cascadeSettings(32, 2)), InputError);
}
