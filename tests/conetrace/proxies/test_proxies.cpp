#include "conetrace/proxies/gather.h"
#include "conetrace/proxies/memory.h"

#include "conetrace/render.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "core/settings/settings_table.h"

#include "catch.h"

#include <cstdio>
#include <numbers>

using namespace lrsm;

namespace {

Settings smallProxies()
{
    Settings settings = preset("proxies");
    settings.rsm.resolution = 128;
    settings.proxies.count = 4000;
    settings.proxies.grid = 8;
    return settings;
}

Frame renderSmall(const Scene& scene, const Settings& settings, const PassWatch& watch = {})
{
    RenderOptions options;
    options.width = 48;
    options.height = 36;
    options.watch = watch;
    return renderFrame(scene, scene.cameras.at(0), settings, options);
}

std::vector<std::string> hashesOf(const Frame& frame)
{
    std::vector<std::string> all;
    for (const PassReport& pass : frame.passes) all.push_back(pass.name + " " + pass.sha256);
    return all;
}

}  // namespace

TEST_CASE("method proxies: the same bits for any number of threads", "[proxies]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    const std::vector<std::string> all = hashesOf(renderSmall(*scene, smallProxies()));
    const ThreadLimit one(1);
    CHECK(all == hashesOf(renderSmall(*scene, smallProxies())));
}

TEST_CASE("method proxies: a sphere lit from its centre, whose every point sees all others, has the irradiance 1/2", "[proxies]")
{
    const auto scene = makeBuiltinScene("furnace");
    Settings settings = preset("proxies");
    settings.rsm.resolution = 128;
    settings.proxies.grid = 6;
    settings.proxies.count = 20000;
    settings.proxies.rays = 256;
    settings.proxies.range = 1e6f;
    settings.proxies.radius = 2.0f;  // no ray between the discs
    const Frame frame = renderSmall(*scene, settings);
    double mean = 0.0;
    for (const Vec3& e : frame.irradiance.texels) mean += double(e.y) / double(frame.irradiance.texels.size());
    CHECK(mean == Approx(0.5).epsilon(0.02));
}

TEST_CASE("method proxies: dark surfaces that nobody sees, in the cells of lit ones, take no light away", "[proxies]")
{
    // Plates behind each wall of the Cornell box, within the cells of its own proxies.
    Scene scene = *makeBuiltinScene("cornell-box");
    Settings settings = smallProxies();
    settings.proxies.marchDivisor = 2;
    settings.proxies.radius = 2.0f;
    const auto meanOf = [&] {
        const Frame frame = renderSmall(scene, settings);
        double sum = 0.0;
        for (const Vec3& e : frame.irradiance.texels) sum += double(e.y) / double(frame.irradiance.texels.size());
        return sum;
    };
    const double without = meanOf();
    const std::vector<Mesh> own = scene.meshes;
    const Aabb box = scene.bounds;
    const std::size_t before = scene.triangleCount();
    for (const Mesh& mesh : own) {
        Mesh behind = mesh;
        for (std::size_t v = 0; v < behind.positions.size(); ++v) behind.positions[v] -= 0.03f * box.longestSide() * behind.normals[v];
        scene.meshes.push_back(behind);
    }
    updateBounds(scene);
    settings.proxies.count *= 2;  // as many on the walls
    REQUIRE(scene.triangleCount() == 2 * before);
    CHECK(meanOf() == Approx(without).epsilon(0.05));
}

TEST_CASE("method proxies: every list is in its filtered one, and without a filter light is missing", "[proxies]")
{
    const auto scene = makeBuiltinScene("cornell-box");
    VisibilityLists marched, filtered;
    PassWatch watch;
    watch.observe = [&](const std::string& pass, const PassOutput& output) {
        if (const auto* made = output.as<VisibilityLists>()) (pass == "pp march" ? marched : filtered) = *made;
    };
    renderSmall(*scene, smallProxies(), watch);
    REQUIRE(marched.size() == 12 * 9);
    for (std::size_t block = 0; block < marched.size(); ++block) {
        const auto before = marched.of(block), after = filtered.of(block);
        REQUIRE(std::includes(after.begin(), after.end(), before.begin(), before.end()));
    }
    Settings settings = smallProxies();
    settings.proxies.cellWeight = ProxyCellWeight::one;
    const Frame plain = renderSmall(*scene, settings);
    settings.proxies.filterRadius = 0;
    const Frame without = renderSmall(*scene, settings);
    double sumWith = 0.0, sumWithout = 0.0;
    for (std::size_t i = 0; i < plain.irradiance.texels.size(); ++i) {
        sumWith += double(plain.irradiance.texels[i].y);
        sumWithout += double(without.irradiance.texels[i].y);
    }
    CHECK(sumWithout < 0.95 * sumWith);
    CHECK(sumWithout > 0.2 * sumWith);
}

TEST_CASE("method proxies: --pixel names lists, cells and proxies, and ends with the pixel's own irradiance", "[proxies]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    Settings settings = smallProxies();
    settings.proxies.gatherDivisor = 1;
    const Frame frame = renderSmall(*scene, settings);
    RenderOptions options;
    options.width = 48;
    options.height = 36;
    const std::string text = explainPixel(*scene, scene->cameras[0], settings, options, 20, 30);
    for (const char* part : {"lists of the four blocks", "cells in them", "harmonics", "first proxies of the brightest near cell"})
        CHECK(text.find(part) != std::string::npos);
    char expected[128];
    const Vec3 e = frame.irradiance.at(20, 30);
    std::snprintf(expected, sizeof expected, "irradiance %.6g %.6g %.6g", double(e.x), double(e.y), double(e.z));
    CHECK(text.find(expected) != std::string::npos);
}

TEST_CASE("method proxies: what is predicted of a rendered frame is what it held, and before it no less", "[proxies]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    const Settings settings = smallProxies();
    const Frame frame = renderSmall(*scene, settings);
    MemoryQuestion question{*scene, frame.needs, settings, 48, 36};
    std::vector<MemoryRow> before = predictMemory(question);
    question.rendered = &frame.passes;
    std::vector<MemoryRow> after = predictMemory(question);
    addMeasured(before, frame.passes);
    addMeasured(after, frame.passes);
    std::size_t rows = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
        if (!after[i].pass.starts_with("pp")) continue;
        ++rows;
        CHECK(after[i].measured == after[i].predicted);
        CHECK(before[i].predicted >= *before[i].measured);
        CHECK(double(before[i].predicted) <= kListsFactor * double(*before[i].measured));
    }
    CHECK(rows == 4);
}
