#include "apps/validate/extremes/worlds.h"
#include "core/report/table.h"
#include "core/scene/shapes.h"
#include "voxel/voxelize.h"

#include <cmath>

// Triangles that should not be, and scenes of every size.
namespace lrsm::extremes {
namespace {

/// One more triangle in the room's first mesh.
void addTriangle(Scene& scene, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal = Vec3(0, 1, 0))
{
    Mesh& mesh = scene.meshes[0];
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : {a, b, c}) {
        mesh.positions.push_back(p);
        mesh.normals.push_back(normal);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    updateBounds(scene);
}

/// A triangle that covers no pixel and no new voxel: every pass gives what it gives without.
Case invisible(const std::string& name, const std::string& what, const Vec3& a, const Vec3& b, const Vec3& c)
{
    return {name, what, "the same bits as without it, from every pass", [=](Mode mode, Probe& probe) {
                World world = room();
                const Frame without = renderWorld(world, smallSettings(mode));
                addTriangle(world.scene, a, b, c);
                const Frame with = renderWorld(world, smallSettings(mode));
                probe.frame(with);
                for (std::size_t i = 0; i < with.passes.size(); ++i)
                    probe.require(with.passes[i].sha256 == without.passes[i].sha256, "changes pass " + with.passes[i].name);
            }};
}

/// Only that every pass stays finite.
Case finite(const std::string& name, const std::string& what, const World& world)
{
    return {name, what, "every pass finite", [=](Mode mode, Probe& probe) {
                probe.frame(renderWorld(world, smallSettings(mode)));
                probe.frame(renderWorld(world, smallLiteral(mode)));
            }};
}

Case refusedScene(const std::string& name, const std::string& what, const World& world)
{
    return refusal(name, what, [=](Mode mode, Probe& probe) { probe.frame(renderWorld(world, smallSettings(mode))); });
}

World withTriangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal = Vec3(0, 1, 0))
{
    World world = room();
    addTriangle(world.scene, a, b, c, normal);
    return world;
}

/// The floor alone, at height y.
World floorOnly(float y, float size)
{
    World world = room();
    world.scene.meshes.resize(1);
    world.scene.meshes[0] = Mesh();
    addQuad(world.scene.meshes[0], Vec3(-size, y, size), Vec3(size, y, size), Vec3(size, y, -size), Vec3(-size, y, -size));
    updateBounds(world.scene);
    return world;
}

/// All geometry transformed by p -> f(p), light and camera left.
template <class Map>
World mapped(Map&& map)
{
    World world = room();
    for (Mesh& mesh : world.scene.meshes)
        for (Vec3& p : mesh.positions) p = map(p);
    updateBounds(world.scene);
    return world;
}

template <class Change>
World changed(Change&& change)
{
    World world = room();
    change(world.scene);
    return world;
}

template <class Change>
World withNormals(Change&& change)
{
    return changed([&](Scene& s) {
        for (Mesh& m : s.meshes)
            for (std::size_t i = 0; i < m.normals.size(); ++i) m.normals[i] = change(m.normals[i], i);
    });
}

/// A wall on a voxel face: 28 voxels of 32 span the scene, so coordinates k/14 of a 2 m cube lie on faces.
void onVoxelFaces(Mode mode, Probe& probe)
{
    for (const Voxelization kind : {Voxelization::conservative, Voxelization::thin, Voxelization::raster}) {
        World world = room();
        addQuad(world.scene.meshes[0], Vec3(-1.0f, 0.0f, -1.0f), Vec3(1.0f, 0.0f, -1.0f), Vec3(1.0f, 0.0f, 1.0f), Vec3(-1.0f, 0.0f, 1.0f));
        Settings settings = smallSettings(mode);
        settings.voxel.mode = kind;
        settings.voxel.resolution = 16;  // 12 voxels over 2 m, y = 0 on a face
        const BitGrid bits = voxelize(world.scene, settings.voxel);
        probe.output("voxelize", bits);
        for (int x = 2; x < 14; ++x)
            for (int z = 2; z < 14; ++z) probe.require(bits.occupied(x, 7, z) || bits.occupied(x, 8, z), "a hole in a wall on voxel faces");
        probe.frame(renderWorld(world, settings));
    }
}

}  // namespace

Group geometryCases()
{
    const Vec3 p(0.3f, -1.0f, 0.2f);  // on the floor
    Group group{"geometry", {}};
    auto& cases = group.cases;
    cases.push_back(invisible("a point", "a triangle whose corners are one point of the floor", p, p, p));
    cases.push_back(invisible("a segment", "a triangle whose corners lie on a line in the floor", p, p + Vec3(0.1f, 0, 0), p + Vec3(0.05f, 0, 0)));
    cases.push_back(invisible("a segment twice the same corner", "two corners are one", p, p, p + Vec3(0.1f, 0, 0)));
    cases.push_back(invisible("a vertex that is NaN", "one coordinate NaN: dropped and counted", p, Vec3(kNan, 0, 0), p + Vec3(0.1f, 0, 0)));
    cases.push_back(invisible("all vertices NaN", "dropped and counted", Vec3(kNan), Vec3(kNan), Vec3(kNan)));
    cases.push_back(invisible("a needle in the floor", "1e-7 m wide, 1.5 m long", p, p + Vec3(-1.0f, 0, 0), p + Vec3(-1.0f, 0, 1e-7f)));
    cases.push_back(
        finite("a needle in the air", "1e-6 m wide, 1.8 m long, slanted", withTriangle(Vec3(-0.9f), Vec3(0.9f, 0.8f, 0.7f), Vec3(0.9f, 0.8f, 0.700001f))));
    cases.push_back(finite("denormal triangle", "corners 1e-40 m apart about the origin", withTriangle(Vec3(0.0f), Vec3(1e-40f, 0, 0), Vec3(0, 1e-40f, 0))));
    cases.push_back(finite("ten thousand coplanar triangles", "the same floor triangle over and over", [&] {
        World world = room();
        for (int i = 0; i < 10000; ++i) addTriangle(world.scene, p, p + Vec3(0.2f, 0, -0.2f), p + Vec3(0.2f, 0, 0.2f));
        return world;
    }()));
    cases.push_back(finite("a fan of slivers", "1000 triangles about one point, aspect 1000", [&] {
        World world = room();
        for (int i = 0; i < 1000; ++i) {
            const auto a = float(i) * 1e-3f;
            addTriangle(world.scene, Vec3(0.0f), Vec3(0.5f, a, -0.2f), Vec3(0.5f, a + 1e-3f, -0.2f), Vec3(0, 0, 1));
        }
        return world;
    }()));
    cases.push_back({"walls on voxel faces", "a plane exactly between two voxel slices, three voxelizations", "no hole; every pass finite", onVoxelFaces});
    cases.push_back(finite("far larger than all else", "one triangle of 1e6 m in the room's floor", [&] {
        World world = withTriangle(Vec3(-1e6f, -1, -1e6f), Vec3(0, -1, 1e6f), Vec3(1e6f, -1, -1e6f));
        world.camera.nearPlane = 0.2f;  // 1e6 m at 1 cm would be refused
        return world;
    }()));
    cases.push_back({"larger than the grid", "triangles of 1e0 .. 1e14 voxels through a grid of 32, three voxelizations",
                     "the plane through the grid is filled, nothing else is",
                     [](Mode, Probe& probe) {
                         for (float size = 100.0f; size < 1e15f; size *= 100.0f)
                             for (const Voxelization kind : {Voxelization::conservative, Voxelization::thin, Voxelization::raster}) {
                                 const float y = 16.5f;
                                 const BitGrid bits =
                                     voxelizeTriangles({Vec3(-size, y, -size), Vec3(0, y, 3.0f * size), Vec3(size, y, -size)}, {Vec3(0.0f), 1.0f, 32}, kind);
                                 probe.output("voxelize", bits);
                                 probe.bound("voxels set over 32^2, - 1", static_cast<double>(bits.countOccupied()) / 1024.0 - 1.0, 0.0);
                             }
                     },
                     true});
    cases.push_back(finite("normals 0", "all vertex normals are 0", withNormals([](const Vec3&, std::size_t) { return Vec3(0.0f); })));
    cases.push_back(finite("normals NaN", "all vertex normals are NaN", withNormals([](const Vec3&, std::size_t) { return Vec3(kNan); })));
    cases.push_back(finite("normals infinite", "all vertex normals are infinite", withNormals([](const Vec3&, std::size_t) { return Vec3(kInfinity); })));
    cases.push_back(finite("normals the wrong way", "all vertex normals point into the walls", withNormals([](const Vec3& n, std::size_t) { return -n; })));
    cases.push_back(finite("normals that cancel", "the vertices of each triangle have normals x, -x, x",
                           withNormals([](const Vec3&, std::size_t i) { return Vec3(i % 2 ? 1.0f : -1.0f, 0, 0); })));
    cases.push_back(finite("vertex colours NaN and huge", "colours NaN, 1e38, -1",
                           changed([](Scene& s) { s.meshes[0].colors.assign(s.meshes[0].positions.size(), Vec4(kNan, 1e38f, -1.0f, 1.0f)); })));
    cases.push_back(finite("texture coordinates NaN and huge", "a textured, normal-mapped, masked material with uv of NaN, 1e38, 1e-40", changed([](Scene& s) {
                               Texture texture;
                               texture.image = Image<Rgba8>(2, 2);
                               s.textures = {std::make_shared<Texture>(texture)};
                               Material& m = s.materials[0];
                               m.baseColorTexture.texture = m.metallicRoughnessTexture.texture = m.normalTexture.texture = 0;
                               m.alphaMask = true;
                               for (std::size_t i = 0; i < s.meshes[0].positions.size(); ++i)
                                   s.meshes[0].uv0.push_back(i % 3 == 0 ? Vec2(kNan, 1e38f) : i % 3 == 1 ? Vec2(-1e38f, 1e-40f) : Vec2(0.3f));
                               s.meshes[0].tangents.assign(s.meshes[0].positions.size(), Vec4(0.0f));
                           })));
    cases.push_back(finite("nothing", "no mesh at all", changed([](Scene& s) {
                               s.meshes.clear();
                               s.bounds = {};
                           })));
    cases.push_back(finite("meshes without triangles", "vertices that nothing uses", changed([](Scene& s) {
                               for (Mesh& m : s.meshes) m.triangles.clear();
                               updateBounds(s);
                           })));
    cases.push_back(finite("one triangle", "and nothing else", changed([](Scene& s) {
                               s.meshes.resize(1);
                               s.meshes[0].triangles.resize(1);
                               updateBounds(s);
                           })));
    cases.push_back(finite("all in one point", "every vertex at (0.1, 0.2, 0.3): no extent", mapped([](const Vec3&) { return Vec3(0.1f, 0.2f, 0.3f); })));
    cases.push_back(finite("all on one line", "every vertex on the y axis", mapped([](const Vec3& q) { return Vec3(0, q.y, 0); })));
    cases.push_back(finite("flat in x", "the room pressed into the plane x = 0", mapped([](const Vec3& q) { return Vec3(0, q.y, q.z); })));
    cases.push_back(finite("flat in y", "the room pressed into the plane y = -1", mapped([](const Vec3& q) { return Vec3(q.x, -1, q.z); })));
    cases.push_back(finite("almost flat", "the room pressed to a height of 1e-30 m", mapped([](const Vec3& q) { return Vec3(q.x, 1e-30f * q.y, q.z); })));
    for (const float y : {0.0f, -1.0f, 0.1f, 123.456f})
        cases.push_back(finite("a floor alone at y = " + std::to_string(y).substr(0, 7), "one quad, flat in y", floorOnly(y, 1.0f)));
    cases.push_back(finite("a mirrored, collapsed block", "the block scaled by (-1, 0, 1)", changed([](Scene& s) {
                               for (Vec3& q : s.meshes[1].positions) q = Vec3(-q.x, 0, q.z);
                           })));
    cases.push_back(refusedScene("an infinite vertex", "one coordinate is infinity", withTriangle(p, Vec3(kInfinity, 0, 0), p + Vec3(0.1f, 0, 0))));
    cases.push_back(refusedScene("a vertex at 1e30", "squares of coordinates would leave float32", withTriangle(p, Vec3(1e30f, 0, 0), p + Vec3(0.1f, 0, 0))));
    cases.push_back(refusedScene("a vertex at 3e38", "the largest floats", withTriangle(p, Vec3(3e38f), Vec3(-3e38f))));
    cases.push_back(
        refusedScene("an index past the end", "a triangle uses a vertex that is not there", changed([](Scene& s) { s.meshes[0].triangles[0][2] = 100000; })));
    cases.push_back(refusedScene("streams of different length", "one normal too few", changed([](Scene& s) { s.meshes[0].normals.pop_back(); })));
    cases.push_back(refusedScene("a material that is not there", "mesh of material 7 of 2", changed([](Scene& s) { s.meshes[0].material = 7; })));
    for (const float roughness : {kNan, -1.0f, 2.0f, kInfinity})
        cases.push_back(refusedScene("roughness " + std::to_string(roughness), "a material of this roughness",
                                     changed([=](Scene& s) { s.materials[0].roughness = roughness; })));
    for (const float roughness : {0.0f, 1e-30f, 1e-3f, 1.0f})
        cases.push_back(finite("metal of roughness " + std::to_string(roughness), "the whole room a metal", changed([=](Scene& s) {
                                   for (Material& m : s.materials) m.metallic = 1.0f, m.roughness = roughness;
                               })));
    return group;
}

Group scaleCases()
{
    Group group{"scale", {}};
    const auto scaled = [](double factor, double bound) {
        return [factor, bound](Mode mode, Probe& probe) {
            for (const bool literal : {false, true}) {
                const Settings settings = literal ? smallLiteral(mode) : smallSettings(mode);
                const Frame unit = renderWorld(room(), settings), frame = renderWorld(scaledRoom(factor), settings);
                probe.frame(frame);
                probe.bound(literal ? "irradiance (literal) against 2 m" : "irradiance against 2 m", relativeDifference(frame.irradiance, unit.irradiance),
                            bound);
                probe.bound("direct light against 2 m", relativeDifference(frame.direct, unit.direct), bound);
            }
        };
    };
    for (const int exponent : {-33, -20, -13, -4, 4, 20, 33})
        group.cases.push_back({"times 2^" + std::to_string(exponent), "the room, its light and camera scaled by a power of two", "the same picture to the bit",
                               scaled(std::ldexp(1.0, exponent), 0.0)});
    for (const double factor : {1e-10, 1e-4, 1e-2, 1e2, 1e4, 1e6, 1e12}) {
        group.cases.push_back({"times " + numberText(6, factor), "the room, its light and camera scaled",
                               "irradiance and direct light differ from those of 2 m by less than 1 % of the mean (coordinates round differently)",
                               scaled(factor, 0.01)});
    }
    for (const double offset : {1e1, 1e2, 1e3})
        group.cases.push_back({"moved by " + std::to_string(int(offset)) + " m", "the room moved along (1, -0.7, 0.4)",
                               "irradiance within 5 % of the mean of the same room at the origin", [offset](Mode mode, Probe& probe) {
                                   const Frame unit = renderWorld(room(), smallSettings(mode)),
                                               frame = renderWorld(movedRoom(glm::dvec3(offset, -0.7 * offset, 0.4 * offset)), smallSettings(mode));
                                   probe.frame(frame);
                                   probe.bound("irradiance against the origin", relativeDifference(frame.irradiance, unit.irradiance), 0.05);
                               }});
    for (const double offset : {1e5, 1e7, 1e10, 9e14})
        group.cases.push_back(
            {"moved by " + std::to_string(static_cast<long long>(offset)) + " m",
             "the room so far off that float32 places its walls in steps of centimetres and more", "every pass finite, or refused; see the curve for the error",
             [offset](Mode mode, Probe& probe) { probe.frame(renderWorld(movedRoom(glm::dvec3(offset, -0.7 * offset, 0.4 * offset)), smallSettings(mode))); }});
    for (const double factor : {1e-14, 1e-40})
        group.cases.push_back(refusedScene(factor < 1e-30 ? "denormal" : "times 1e-14", "the room smaller than 1e-12 m", scaledRoom(factor)));
    group.cases.push_back(refusedScene("times 1e16", "the room larger than 1e15 m", scaledRoom(1e16)));
    return group;
}

}  // namespace lrsm::extremes
