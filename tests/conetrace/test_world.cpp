#include "conetrace/render.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/scene_hash.h"
#include "core/scene/shapes.h"
#include "core/settings/settings_table.h"
#include "voxel/voxelize.h"

#include "catch.h"

#include <algorithm>
#include <functional>

// A world that outlives its frames: whatever moves, each frame has the bits of one by itself, and what need not be made again is not.

using namespace lrsm;

namespace {

using Names = std::vector<std::string>;

Settings keptSettings(const std::string& method = "lrsm")
{
    Settings settings;
    applySetting(settings, "method=" + method);
    settings.voxel.resolution = 32;
    settings.rsm.resolution = 64;
    return settings;
}

/// The Cornell box, and a board in it that may stand elsewhere.
Scene box(const Vec3& place = Vec3(0.0f))
{
    Scene scene = *makeBuiltinScene("cornell-box");
    Mesh& moved = scene.meshes.emplace_back();
    const Vec3 at = place + Vec3(0.2f, 0.3f, 0.2f);
    addQuad(moved, at + Vec3(-0.06f, 0, 0.06f), at + Vec3(0.06f, 0, 0.06f), at + Vec3(0.06f, 0.05f, -0.06f), at + Vec3(-0.06f, 0.05f, -0.06f));
    updateBounds(scene);
    return scene;
}

Scene changed(Scene scene, const std::function<void(Scene&)>& change)
{
    change(scene);
    return scene;
}

struct Rendered {
    Frame frame;
    Names shown;
};

Rendered renderMoment(const Scene& scene, const Settings& settings, World* kept, bool observed)
{
    Rendered result;
    RenderOptions options{.width = 24, .height = 18, .watch = {}, .kept = kept, .method = {}};
    if (observed) options.watch.observe = [&](const std::string& pass, const PassOutput&) { result.shown.push_back(pass); };
    result.frame = renderFrame(scene, scene.cameras.at(0), settings, options);
    return result;
}

/// Renders the moments one after the other over one world, holds each to the same moment by itself, pass by pass, and returns what each took from earlier ones.
std::vector<Names> keptBy(const std::vector<Scene>& moments, const Settings& settings, bool observed = false)
{
    World world;
    std::vector<Names> kept;
    for (const Scene& moment : moments) {
        const Rendered run = renderMoment(moment, settings, &world, observed), alone = renderMoment(moment, settings, nullptr, observed);
        CHECK((run.frame.combined.texels == alone.frame.combined.texels));
        CHECK(run.shown == alone.shown);
        REQUIRE(run.frame.passes.size() == alone.frame.passes.size());
        kept.emplace_back();
        for (std::size_t p = 0; p < run.frame.passes.size(); ++p) {
            const PassReport &a = run.frame.passes[p], &b = alone.frame.passes[p];
            CAPTURE(kept.size(), a.name);
            CHECK(a.name == b.name);
            CHECK(a.sha256 == b.sha256);
            CHECK(a.bytes == b.bytes);
            CHECK(std::equal(a.counters.begin(), a.counters.end(), b.counters.begin(), b.counters.end(),
                             [](const Counter& x, const Counter& y) { return x.name == y.name && x.value == y.value; }));
            CHECK_FALSE(b.kept);
            if (!a.kept) continue;
            kept.back().push_back(a.name);
            CHECK(a.cpuMilliseconds == 0.0);
        }
    }
    return kept;
}

const Names kNothing, kVoxels{"voxelize", "voxel mips"}, kAll{"voxelize", "voxel mips", "rsm 0", "lrsm 0"};

void turnLight(Scene& scene)
{
    scene.lights[0].direction = glm::normalize(scene.lights[0].direction + Vec3(0.05f, 0.0f, 0.0f));
    scene.lights[0].up = glm::normalize(scene.lights[0].up - glm::dot(scene.lights[0].up, scene.lights[0].direction) * scene.lights[0].direction);
}

}  // namespace

TEST_CASE("world: under a camera that moves, voxels and maps stay", "[conetrace][world]")
{
    const Scene near = changed(box(), [](Scene& s) { s.cameras[0].position += Vec3(0.01f, 0.005f, -0.02f); });
    CHECK(keptBy({box(), near, box()}, keptSettings()) == std::vector<Names>{kNothing, kAll, kAll});
    CHECK(keptBy({box(), near}, keptSettings(), true) == std::vector<Names>{kNothing, kAll});
    CHECK(keptBy({box(), near}, keptSettings("vct")) == std::vector<Names>{kNothing, {"voxelize", "rsm 0", "vct inject", "vct mips"}});
    CHECK(keptBy({box(), near}, keptSettings("vct"), true) == std::vector<Names>{kNothing, {"voxelize", "rsm 0"}});
    CHECK(keptBy({box(), near}, keptSettings("caches")) == std::vector<Names>{kNothing, kAll});
}

TEST_CASE("world: voxel grids about the eye stay while it moves within their step, and are made anew where they jump", "[conetrace][world]")
{
    Settings settings = keptSettings();
    settings.voxel.resolution = kLeastCascadeResolution;
    settings.voxel.cascades = 2;
    const auto from = [](float along) { return changed(box(), [&](Scene& s) { s.cameras[0].position += Vec3(0.0f, 0.0f, along); }); };
    const float step = 8.0f * gridOf(box(), settings.voxel).voxelSize;
    const Names grids{"voxelize", "voxel mips", "voxelize 1", "voxel mips 1"}, maps{"rsm 0", "lrsm 0"};
    Names all = grids;
    all.insert(all.end(), maps.begin(), maps.end());
    // In the middle of the box: else the wider grid's border holds the finer one.
    const float inside = gridOf(box(), settings.voxel).origin.z + 32.0f * gridOf(box(), settings.voxel).voxelSize - box().cameras[0].position.z;
    CHECK(keptBy({from(inside), from(inside), from(inside - step), from(inside - step)}, settings) == std::vector<Names>{kNothing, all, maps, all});
}

TEST_CASE("world: under a light that moves the voxels stay, and the maps of the lights that do not", "[conetrace][world]")
{
    const Scene turned = changed(box(), turnLight);
    CHECK(keptBy({box(), turned, box()}, keptSettings()) == std::vector<Names>{kNothing, kVoxels, kVoxels});
    const auto lamp = [](Scene& s) { s.lights.push_back(box().lights[0]), s.lights.back().position += Vec3(0.02f, -0.03f, 0.01f); };
    const Scene two = changed(box(), lamp), turnedTwo = changed(turned, lamp);
    CHECK(keptBy({two, turnedTwo}, keptSettings()) == std::vector<Names>{kNothing, {"voxelize", "voxel mips", "rsm 1", "lrsm 1"}});
    // Lights come and go; one so bright that all maps are stored darker.
    const Scene bright = changed(two, [](Scene& s) { s.lights[1].intensity *= 1e6f; });
    CHECK(keptBy({box(), two, bright, two, box()}, keptSettings()) == std::vector<Names>{kNothing, kAll, kVoxels, kVoxels, kAll});
}

TEST_CASE("world: around an object that moves nothing stays whole, nor where bounds, materials or textures change", "[conetrace][world]")
{
    const std::vector<Scene> walk = {box(), box({0.03f, 0, 0}), box({0.06f, 0, 0}), box({0.06f, 0, 0}), box({0.03f, 0, 0})};
    CHECK(keptBy(walk, keptSettings()) == std::vector<Names>{kNothing, kNothing, kNothing, kAll, kNothing});
    CHECK(keptBy({walk[0], walk[1], walk[2]}, keptSettings("vct")) == std::vector<Names>(3));
    CHECK(keptBy({box(), box({1, 0, 0}), box({1.5f, 0, 0})}, keptSettings()) == std::vector<Names>(3));
    const Scene widerBounds = changed(box(), [](Scene&s) { s.bounds.max.x += 1.0f; }), part = changed(box(), [](Scene&s) {
                                                                                           s.reach = {Vec3(0.1f), Vec3(0.4f)};
                                                                                       });
    const Scene painted = changed(box(), [](Scene& s) { s.materials[0].baseColor.x *= 0.5f; });
    const auto textured = [&] {
        return changed(box(), [](Scene& s) {
            Texture texture;
            texture.image = Image<Rgba8>(1, 1, Rgba8{.r = 128});
            s.textures = {std::make_shared<Texture>(texture)};
            s.materials[0].baseColorTexture.texture = 0;
            for (Mesh& mesh : s.meshes) mesh.uv0.assign(mesh.positions.size(), Vec2(0.0f));
        });
    };
    CHECK(keptBy({box(), widerBounds, part}, keptSettings()) == std::vector<Names>(3));
    CHECK(keptBy({box(), painted}, keptSettings()) == std::vector<Names>(2));
    CHECK(keptBy({textured(), textured()}, keptSettings()) == std::vector<Names>(2));
}

TEST_CASE("world: other settings keep nothing, and a world may be handed from scene to scene", "[conetrace][world]")
{
    World world;
    const auto sameAs = [&](const Scene& scene, const Settings& settings) {
        return renderMoment(scene, settings, &world, false).frame.combined.texels == renderMoment(scene, settings, nullptr, false).frame.combined.texels;
    };
    Settings finer = keptSettings();
    finer.voxel.resolution = 64;
    CHECK(sameAs(box(), keptSettings()));
    CHECK(sameAs(box(), finer));
    CHECK(sameAs(*makeBuiltinScene("two-rooms"), finer));
    CHECK(sameAs(box(), keptSettings("vct")));
    CHECK(sameAs(box(), keptSettings("caches")));
    CHECK(sameAs(box(), keptSettings()));
}

TEST_CASE("voxels after others: those of what stands are copied, and the bits are those of voxelize", "[conetrace][world][voxels]")
{
    VoxelSettings settings;
    settings.resolution = 64;
    StandingVoxels last;
    const auto check = [&](const Scene& scene, std::size_t standing) {
        const BitGrid bits = voxelizeAfter(last, scene, keysOf(scene).meshes, gridOf(scene, settings), settings.mode), alone = voxelize(scene, settings);
        CHECK((bits.bricks == alone.bricks));
        CHECK(bits.grid == alone.grid);
        CHECK(std::size_t(std::count(last.standing.begin(), last.standing.end(), true)) == standing);
    };
    const std::size_t walls = box().meshes.size() - 1;
    check(box(), 0);  // nothing is known to stand
    check(box({0.03f, 0, 0}), walls);
    const std::vector<std::uint64_t> copied = last.bits.bricks;
    check(box({0.06f, 0, 0}), walls);
    check(box({0.06f, 0, 0}), walls);  // it rests, and may go on
    CHECK((last.bits.bricks == copied));
    check(changed(box({0.09f, 0, 0}), [](Scene& s) { s.meshes[0].positions[0].y += 0.02f; }), walls - 1);
    check(box({1, 0, 0}), 0);  // another grid
    check(changed(box({1, 0, 0}), [](Scene& s) { s.meshes.pop_back(); }), 0);
}
