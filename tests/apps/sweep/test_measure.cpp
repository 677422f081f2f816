#include "apps/sweep/measure.h"

#include "apps/sweep/axes.h"
#include "conetrace/render.h"
#include "core/base/hash.h"
#include "core/scene/builtin_scenes.h"
#include "core/settings/settings_table.h"
#include "voxel/radiance/radiance_volume.h"

#include "catch.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

using namespace lrsm;

namespace {

constexpr int kWidth = 32, kHeight = 18;

SceneCase smallCase(std::uint64_t samples = 128, std::uint64_t seed = 0)
{
    SceneCase one{"cornell-box", makeBuiltinScene("cornell-box").value(), {}, kWidth, kHeight, {}};
    one.camera = one.scene.cameras.at(0);
    const PathTracer tracer(one.scene, one.camera, {.width = kWidth, .height = kHeight, .blockBits = 4, .seed = seed});
    ReferenceState state = tracer.start({0, samples});
    tracer.advance(state, std::chrono::steady_clock::time_point::max());
    one.truth = truthOf(tracer.resolve(state.sums), tracer.primary().covered, "truth " + std::to_string(samples), "test");
    return one;
}

Settings smallSettings()
{
    Settings s;
    s.voxel.resolution = 32;
    s.rsm.resolution = 64;
    return s;
}

const Calibration& calibration()
{
    static const Calibration one;
    return one;
}

}  // namespace

TEST_CASE("a row holds the frame that renderFrame makes: bits, work, bytes, and the passes' times", "[sweep][measure]")
{
    const SceneCase one = smallCase();
    const TruthFigures figures = figuresOf(one.truth);
    const Measured measured = measureSettings(one, figures, smallSettings(), calibration(), {.repeat = 2});
    const Measurement& row = measured.row;

    RenderOptions options;
    options.width = kWidth;
    options.height = kHeight;
    const Frame frame = renderFrame(one.scene, one.camera, smallSettings(), options);
    CHECK(measured.irradiance.texels == frame.irradiance.texels);
    CHECK(row.irradianceSha256 == Sha256().add(frame.irradiance.texels).hex());
    CHECK(counterSum(row.counters, "cone_steps") == counterSum(frame.passes, "cone_steps"));
    CHECK(counterSum(row.counters, "cone_steps") > 0.0);
    std::size_t bytes = 0;
    for (const PassReport& pass : frame.passes)
        if (pass.name == "voxel mips" || pass.name == "rsm 0" || pass.name == "lrsm 0" || pass.name == "gbuffer") bytes += pass.bytes;
    CHECK(row.bytes == bytes);

    double passes = 0.0;
    for (const PassTime& pass : row.passes) {
        CHECK(pass.time.min <= pass.time.median);
        passes += pass.time.min;
    }
    CHECK(row.passes.size() == frame.passes.size());
    CHECK(passes <= row.frame.min * (1 + 1e-9));
    CHECK(row.cost == row.frameCpu / row.calibrationCpu);
    CHECK(row.frameCpu > 0.0);
    CHECK(row.key == rowKeyOf(row.caseKey, smallSettings()));
    CHECK(row.caseKey == caseKeyOf(one));

    // The error by its definition, in the plainest loop.
    double sumTruth = 0.0, sum = 0.0, squares = 0.0, values = 0.0, variances = 0.0;
    for (std::size_t i = 0; i < frame.irradiance.texels.size(); ++i)
        for (int c = 0; c < 3 && one.truth.covered.texels[i]; ++c) {
            const double r = double(one.truth.irradiance.texels[i][c]), t = double(frame.irradiance.texels[i][c]);
            sumTruth += r;
            sum += t;
            squares += (t - r) * (t - r);
            variances += double(one.truth.variance.texels[i][c]);
            ++values;
        }
    CHECK(row.error.energy == Approx(sum / sumTruth));
    CHECK(row.error.rmse == Approx(std::sqrt(squares / values) / (sumTruth / values)));
    CHECK(row.error.noise == Approx(std::sqrt(variances / values) / (sumTruth / values)));
    CHECK(row.error.flip > 0.0);
    CHECK(row.error.flip < 1.0);
}

TEST_CASE("methods are an axis like any other: rows of both, with the passes, bytes and GPU bytes of each", "[sweep][measure][vct]")
{
    const SceneCase one = smallCase();
    const TruthFigures figures = figuresOf(one.truth);
    const std::vector<NamedSettings> product = combine(smallSettings(), {parseAxis("method=lrsm,vct"), parseAxis("voxel_resolution=16,32")});
    REQUIRE(product.size() == 4);
    std::set<std::string> irradiances;
    for (const NamedSettings& named : product) {
        CAPTURE(named.label);
        const Measurement row = measureSettings(one, figures, named.settings, calibration(), {.repeat = 1}).row;
        irradiances.insert(row.irradianceSha256);
        const bool vct = named.settings.method == Method::vct;
        const auto has = [&](const std::string& pass) {
            return std::any_of(row.passes.begin(), row.passes.end(), [&](const auto& p) { return p.family == pass; });
        };
        CHECK(has("vct cones") == vct);
        CHECK(has("lrsm") == !vct);
        const Requirements needs = analyseRequirements(one.scene, named.settings.force);
        std::size_t bytes = 0;
        for (const MemoryRow& memory : predictMemory({one.scene, needs, named.settings, kWidth, kHeight})) bytes += memory.predicted;
        CHECK(row.bytes == bytes);
        // What a GPU needs beyond the other method's frame: the paper's dense grid.
        if (vct) CHECK(row.gpuBytes > RadianceVolume::predictGpuBytes(named.settings.voxel.resolution));
    }
    CHECK(irradiances.size() == 4);
}

TEST_CASE("the noise floor is what an independent truth differs by, over sqrt 2", "[sweep][measure]")
{
    const SceneCase one = smallCase(256, 0), other = smallCase(256, 7);
    const TruthFigures figures = figuresOf(one.truth);
    const double difference = errorOf(one.truth, figures, other.truth.irradiance).rmse;
    CHECK(difference / std::sqrt(2.0) == Approx(figures.noise).epsilon(0.25));
}

TEST_CASE("the path tracer converges towards the truth by other random numbers, its time and rays grow, and it can be stopped", "[sweep][measure]")
{
    const SceneCase one = smallCase(1024);
    const TruthFigures figures = figuresOf(one.truth);
    int shown = 0;
    const std::vector<Measured> rows = measurePathTracer(one, figures, 48, calibration(), {}, [&](const Measured&) { ++shown; });
    REQUIRE(rows.size() == 7);
    CHECK(shown == 7);
    const std::vector<std::uint64_t> samples{1, 2, 4, 8, 16, 32, 48};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        CHECK(rows[i].row.samples == samples[i]);
        CHECK(rows[i].row.kind == RowKind::pathTracer);
        if (i == 0) continue;
        CHECK(rows[i].row.frame.median > rows[i - 1].row.frame.median);
        CHECK(rows[i].row.rays > rows[i - 1].row.rays);
        CHECK(rows[i].row.key != rows[i - 1].row.key);
    }
    CHECK(rows.back().row.error.net() < 0.5 * rows.front().row.error.net());
    CHECK(rows.back().row.error.energy == Approx(1.0).margin(0.02));
    CHECK(rows.back().row.error.rmse > figures.noise);

    const std::atomic<bool> stop = true;
    CHECK(measurePathTracer(one, figures, 48, calibration(), {.stop = &stop}).empty());
}

TEST_CASE("keys: one a case, setting and number of samples, the hash of the scene may be given", "[sweep][measure]")
{
    SceneCase one = smallCase(32);
    const std::string key = caseKeyOf(one);
    CHECK(key.size() == 16);
    SceneCase renamed = one, larger = one, moved = one, better = one, other = one;
    renamed.name = "x";
    CHECK(caseKeyOf(renamed) == key);
    larger.width = 33;
    moved.camera.position.x += 1e-3f;
    better.truth.sha256 = "more";
    other.scene.lights.at(0).intensity *= 2.0f;
    for (const SceneCase* changed : {&larger, &moved, &better, &other}) CHECK(caseKeyOf(*changed) != key);
    Settings settings;
    const std::string row = rowKeyOf(key, settings);
    settings.cones.set.count = 7;
    CHECK(rowKeyOf(key, settings) != row);
    CHECK(rowKeyOf(key, std::uint64_t(1)) != rowKeyOf(key, std::uint64_t(2)));
    CHECK(rowKeyOf(caseKeyOf(larger), Settings()) != row);
}

TEST_CASE("the calibration frame is no preset's: its settings are pinned", "[sweep][measure]")
{
    // A change here changes the unit of every cost on record.
    const Settings s = Calibration::settings();
    const std::map<std::string, std::string> pinned = {{"voxel_resolution", "128"}, {"rsm_resolution", "256"}, {"cone_count", "6"}, {"step", "0.5"},
                                                       {"start_voxels", "3"},       {"depth_layers", "2"}};
    std::map<std::string, std::string> found;
    for (const SettingDifference& change : differences(preset("balanced"), s)) found[change.key] = change.b;
    auto json = settingsToJson(s);
    for (const auto& [key, value] : pinned) CHECK(std::stod(value) == json.at(key).get<double>());
    CHECK(json.at("method") == "lrsm");
    CHECK(json.at("visibility") == "cones");
    CHECK(json.at("filter_passes") == 0);
    for (const char* later : {"method", "visibility", "filter_passes", "gather_divisor", "voxel_cascades", "rsm_snap", "specular_direction"})
        json.erase(later);  // settings that came after the pin
    // Of other methods: the frame reads none of them.
    for (const SettingInfo& info : describeSettings())
        if (info.stage == "vct" || info.stage == "caches" || info.stage == "vpl" || info.stage == "proxies" || info.stage == "ism" || info.key == "vox_weight")
            json.erase(info.key);
    CHECK(Sha256().add(json.dump()).hex() == "99b51297c12113da2199da0dd4a796b5c1b057a6f51f21a7539f7e0931234d84");
    CHECK(calibration().run().cpu > 0.0);
}
