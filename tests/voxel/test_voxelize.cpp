#include "voxel/voxelize.h"

#include "catch.h"
#include "core/base/parallel.h"
#include "voxel_oracles.h"

#include <string>

using namespace lrsm;

namespace {

using Triangle = std::array<Vec3, 3>;

struct Case {
    std::string name;
    std::vector<Triangle> triangles;  // voxels
};

float onGrid(float voxels, float unit)
{
    return std::round(voxels / unit) * unit;
}

/// Triangles of every awkward kind for a grid of n^3, in voxel coordinates.
std::vector<Case> awkwardTriangles(int n, unsigned seed, int count)
{
    std::mt19937 random(seed);
    const auto uniform = [&](float low, float high) { return low + (high - low) * float(random()) * 0x1p-32f; };
    const auto point = [&](float low, float high) { return Vec3(uniform(low, high), uniform(low, high), uniform(low, high)); };
    const float edge = float(n);
    std::vector<Case> cases = {{"scene-sized", {}},    {"small", {}},       {"sliver", {}},         {"on voxel corners", {}},
                               {"axis-aligned", {}},   {"edge-on", {}},     {"segment", {}},        {"point", {}},
                               {"partly outside", {}}, {"far outside", {}}, {"on half voxels", {}}, {"grazing corners", {}}};
    for (int i = 0; i < count; ++i) {
        const Vec3 a = point(0, edge), b = point(0, edge), c = point(0, edge);
        cases[0].triangles.push_back({a, b, c});
        cases[1].triangles.push_back({a, a + point(-2, 2), a + point(-2, 2)});
        cases[2].triangles.push_back({a, b, b + point(-0.01f, 0.01f)});
        const auto rounded = [](const Vec3& p, float unit) { return Vec3(onGrid(p.x, unit), onGrid(p.y, unit), onGrid(p.z, unit)); };
        cases[3].triangles.push_back({rounded(a, 1), rounded(b, 1), rounded(c, 1)});
        Triangle flat = {rounded(a, 0.25f), rounded(b, 0.25f), rounded(c, 0.25f)};
        for (Vec3& v : flat) v[i % 3] = std::floor(a.x);
        cases[4].triangles.push_back(flat);
        Triangle upright = {a, b, c};  // parallel to one axis
        upright[2] = a;
        upright[2][i % 3] = c[i % 3];
        cases[5].triangles.push_back(upright);
        const Vec3 p = rounded(a, 0.5f), step = rounded(point(-3, 3), 0.25f);
        cases[6].triangles.push_back({p, p + step * float(random() % 4), p + step * float(random() % 4)});
        cases[7].triangles.push_back({rounded(a, i % 2 ? 1.0f : 0.125f), {}, {}});
        cases[7].triangles.back()[1] = cases[7].triangles.back()[2] = cases[7].triangles.back()[0];
        cases[8].triangles.push_back({point(-edge, 2 * edge), point(-edge, 2 * edge), point(-edge, 2 * edge)});
        cases[9].triangles.push_back({point(-2000, 2000), point(-2000, 2000), point(-2000, 2000)});
        cases[10].triangles.push_back({rounded(a, 0.5f), rounded(b, 0.5f), rounded(c, 0.5f)});
        // One unit of the fixed-point grid off a corner: the smallest miss there is.
        const auto graze = [&](const Vec3& q) {
            const float dx = float(random() % 3) - 1, dy = float(random() % 3) - 1, dz = float(random() % 3) - 1;
            return rounded(q, i % 2 ? 1.0f : 0.5f) + Vec3(dx, dy, dz) / 4096.0f;
        };
        for (int k = 0; k < 4; ++k) {
            const Vec3 ga = graze(point(0, edge)), gb = graze(point(0, edge)), gc = graze(point(0, edge));
            cases[11].triangles.push_back({ga, gb, gc});
        }
    }
    return cases;
}

VoxelGrid unitFrame(int n)
{
    VoxelGrid grid;
    grid.resolution = n;
    return grid;
}

BitGrid voxelizeOne(const Triangle& t, const VoxelGrid& grid, Voxelization mode)
{
    return voxelizeTriangles({t[0], t[1], t[2]}, grid, mode);
}

template <class Visit>
void forVoxels(int n, const Visit& visit)
{
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) visit(x, y, z);
}

bool subset(const BitGrid& a, const BitGrid& b)
{
    for (std::size_t i = 0; i < a.bricks.size(); ++i)
        if ((a.bricks[i] & ~b.bricks[i]) != 0) return false;
    return true;
}

/// Which voxels of the grid, widened by one empty layer, are reached from its corner through `connectivity` neighbours.
bool reaches(const BitGrid& bits, int connectivity, const IVec3& target)
{
    const int n = bits.grid.resolution + 2;
    std::vector<std::uint8_t> seen(std::size_t(n) * std::size_t(n) * std::size_t(n), 0);
    const auto index = [n](const IVec3& p) { return (std::size_t(p.z) * std::size_t(n) + std::size_t(p.y)) * std::size_t(n) + std::size_t(p.x); };
    std::vector<IVec3> open = {IVec3(0)};
    seen[0] = 1;
    while (!open.empty()) {
        const IVec3 p = open.back();
        open.pop_back();
        for (int k = 0; k < 27; ++k) {
            const IVec3 d(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            const int steps = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
            if (steps == 0 || (connectivity == 6 && steps > 1)) continue;
            const IVec3 q = p + d;
            if (q.x < 0 || q.y < 0 || q.z < 0 || q.x >= n || q.y >= n || q.z >= n) continue;
            if (seen[index(q)] || bits.occupied(q.x - 1, q.y - 1, q.z - 1)) continue;
            seen[index(q)] = 1;
            open.push_back(q);
        }
    }
    return seen[index(target + IVec3(1))] != 0;
}

}  // namespace

TEST_CASE("conservative sets exactly the voxels whose closed box the closed triangle overlaps", "[voxel][conservative]")
{
    const int n = GENERATE(1, 2, 4, 16);
    const VoxelGrid grid = unitFrame(n);
    for (const Case& c : awkwardTriangles(n, 7u + unsigned(n), n == 16 ? 25 : 60)) {
        for (const Triangle& t : c.triangles) {
            const BitGrid bits = voxelizeOne(t, grid, Voxelization::conservative);
            const std::array<oracle::Point, 3> exact = {oracle::snapped(t[0], grid), oracle::snapped(t[1], grid), oracle::snapped(t[2], grid)};
            int wrong = 0;
            forVoxels(n, [&](int x, int y, int z) { wrong += bits.occupied(x, y, z) != oracle::boxOverlap(exact, x, y, z); });
            INFO(c.name << " in " << n << "^3");
            REQUIRE(wrong == 0);
        }
    }
}

TEST_CASE("triangles as large as the scene are exact too, though their rows are shared out among threads", "[voxel][conservative]")
{
    const int n = 256;
    const VoxelGrid grid = unitFrame(n);
    std::mt19937 random(21);
    const Triangle triangles[] = {{Vec3(3.3f, 7.1f, 40.2f), Vec3(250.7f, 20.9f, 90.4f), Vec3(60.1f, 251.3f, 200.8f)},
                                  {Vec3(-4000, -4000, -3793.6f), Vec3(4000, -4000, 3406.4f), Vec3(0, 4000, 206.4f)},
                                  {Vec3(-4000, -3901, 3500), Vec3(4000, -2301, 3500), Vec3(0, 3549, -3500)}};
    for (const Triangle& t : triangles) {
        const BitGrid bits = voxelizeOne(t, grid, Voxelization::conservative);
        REQUIRE(bits.countOccupied() > 10000);
        const std::array<oracle::Point, 3> exact = {oracle::snapped(t[0], grid), oracle::snapped(t[1], grid), oracle::snapped(t[2], grid)};
        int wrong = 0;
        for (int i = 0; i < 150; ++i) {
            const int x = int(random() % 256u), y = int(random() % 256u);
            for (int z = 0; z < n; ++z) {
                wrong += bits.occupied(x, y, z) != oracle::boxOverlap(exact, x, y, z);
                wrong += bits.occupied(z, x, y) != oracle::boxOverlap(exact, z, x, y);
            }
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("thin is a subset of conservative and holds every voxel whose crosshair the triangle meets", "[voxel][thin]")
{
    const int n = GENERATE(4, 16);
    const VoxelGrid grid = unitFrame(n);
    std::uint64_t thinVoxels = 0, conservativeVoxels = 0;
    for (const Case& c : awkwardTriangles(n, 70u + unsigned(n), 25)) {
        for (const Triangle& t : c.triangles) {
            const BitGrid thin = voxelizeOne(t, grid, Voxelization::thin);
            const BitGrid conservative = voxelizeOne(t, grid, Voxelization::conservative);
            INFO(c.name << " in " << n << "^3");
            REQUIRE(subset(thin, conservative));
            const std::array<oracle::Point, 3> exact = {oracle::snapped(t[0], grid), oracle::snapped(t[1], grid), oracle::snapped(t[2], grid)};
            int missing = 0;
            forVoxels(n, [&](int x, int y, int z) { missing += oracle::crosshairHit(exact, x, y, z) && !thin.occupied(x, y, z); });
            REQUIRE(missing == 0);
            thinVoxels += thin.countOccupied();
            conservativeVoxels += conservative.countOccupied();
        }
    }
    CHECK(double(thinVoxels) < 0.75 * double(conservativeVoxels));
}

TEST_CASE("raster sets the one voxel at the plane's depth below each covered sample", "[voxel][raster]")
{
    const int n = 16;
    const VoxelGrid grid = unitFrame(n);
    for (const Case& c : awkwardTriangles(n, 99, 25)) {
        for (const Triangle& t : c.triangles) {
            const BitGrid raster = voxelizeOne(t, grid, Voxelization::raster);
            INFO(c.name);
            REQUIRE(subset(raster, voxelizeOne(t, grid, Voxelization::conservative)));

            // Each column along the dominant axis holds at most one voxel, and the sample at its centre hits the triangle there.
            const std::array<oracle::Point, 3> v = {oracle::snapped(t[0], grid), oracle::snapped(t[1], grid), oracle::snapped(t[2], grid)};
            const oracle::Point normal = oracle::cross(oracle::minus(v[1], v[0]), oracle::minus(v[2], v[0]));
            const auto size = [&](std::size_t axis) { return normal[axis] < 0 ? -normal[axis] : normal[axis]; };
            const std::size_t w = size(2) >= size(0) && size(2) >= size(1) ? 2 : size(1) >= size(0) ? 1 : 0;
            if (size(w) == 0) {
                REQUIRE(raster.countOccupied() == 0);  // a rasterizer drops what has no area
                continue;
            }
            const std::size_t a = (w + 1) % 3, b = (w + 2) % 3;
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    const oracle::Int pa = (2 * i + 1) * 2048, pb = (2 * j + 1) * 2048;
                    int strictlyInside = 0, onEdge = 0;
                    for (std::size_t k = 0; k < 3; ++k) {
                        const oracle::Point &p = v[k], &q = v[(k + 1) % 3];
                        const oracle::Int side = ((q[a] - p[a]) * (pb - p[b]) - (q[b] - p[b]) * (pa - p[a])) * (normal[w] > 0 ? 1 : -1);
                        strictlyInside += side > 0;
                        onEdge += side == 0;
                    }
                    const oracle::Int numerator = oracle::dot(normal, v[0]) - normal[a] * pa - normal[b] * pb;
                    const long double depth = (long double)(numerator) / (long double)(normal[w]) / 4096.0L;
                    int set = 0, at = -1;
                    for (int k = 0; k < n; ++k) {
                        IVec3 p;
                        p[int(a)] = i, p[int(b)] = j, p[int(w)] = k;
                        if (raster.occupied(p.x, p.y, p.z)) ++set, at = k;
                    }
                    if (set > 0) {
                        REQUIRE(set == 1);
                        REQUIRE(strictlyInside + onEdge == 3);
                        REQUIRE(std::floor(depth) == at);
                    } else if (strictlyInside == 3) {
                        REQUIRE((depth < 0 || depth >= n));
                    }
                }
            }
        }
    }
}

TEST_CASE("raster's top-left rule covers a shared edge once and a fan's centre once", "[voxel][raster]")
{
    // The diagonal of the square runs through pixel centres. Sloped differently, the two halves' voxels lie in different layers, so that
    // a centre drawn twice would show as two voxels in a column.
    const VoxelGrid grid = unitFrame(8);
    const Triangle lower = {Vec3(0, 0, 0.5f), Vec3(8, 0, 0.5f), Vec3(8, 8, 0.5f)};
    const Triangle upper = {Vec3(0, 0, 4.5f), Vec3(8, 8, 4.5f), Vec3(0, 8, 4.5f)};
    const BitGrid a = voxelizeOne(lower, grid, Voxelization::raster);
    const BitGrid b = voxelizeOne(upper, grid, Voxelization::raster);
    CHECK(a.countOccupied() + b.countOccupied() == 64);
    forVoxels(8, [&](int x, int y, int z) {
        if (z == 0) CHECK(a.occupied(x, y, 0) != b.occupied(x, y, 4));
    });
}

TEST_CASE("raster has holes where conservative has none: that is why it exists", "[voxel][raster]")
{
    const VoxelGrid grid = unitFrame(8);
    const Triangle splinter = {Vec3(1.1f, 1.1f, 1.1f), Vec3(1.3f, 1.2f, 1.1f), Vec3(1.1f, 1.3f, 1.2f)};
    CHECK(voxelizeOne(splinter, grid, Voxelization::raster).countOccupied() == 0);
    CHECK(voxelizeOne(splinter, grid, Voxelization::conservative).countOccupied() == 1);
}

TEST_CASE("closed meshes separate inside from outside: conservative for 26 neighbours, thin for 6", "[voxel][separation]")
{
    const int n = 48;
    const float c = float(n) / 2;
    const Vec3 centre(c + 0.1f, c - 0.2f, c + 0.3f);
    const Vec3 a(0.8f, 0.6f, 0.0f), b(-0.36f, 0.48f, 0.8f), d(0.48f, -0.64f, 0.6f);
    const std::vector<std::pair<std::string, std::vector<Vec3>>> meshes = {
        {"sphere", oracle::sphereMesh(centre, 0.42f * float(n), 17, 23)},
        {"small sphere", oracle::sphereMesh(centre, 3.2f, 9, 12)},
        {"rotated box", oracle::boxMesh(centre, 0.2f * float(n) * a, 0.15f * float(n) * b, 0.17f * float(n) * d)},
        {"thin slab", oracle::boxMesh(centre, 0.35f * float(n) * a, 0.35f * float(n) * b, 2.4f * d)},
        {"box on voxel boundaries", oracle::boxMesh(Vec3(c), Vec3(10, 0, 0), Vec3(0, 8, 0), Vec3(0, 0, 12))},
        {"box on voxel centres", oracle::boxMesh(Vec3(c + 0.5f), Vec3(10, 0, 0), Vec3(0, 8, 0), Vec3(0, 0, 12))},
        {"sheared along diagonals", oracle::boxMesh(Vec3(c), Vec3(8, 8, 0), Vec3(-8, 8, 0), Vec3(4, 0, 12))},
    };
    const IVec3 inside = IVec3(centre);
    for (const auto& [name, corners] : meshes) {
        INFO(name);
        const BitGrid conservative = voxelizeTriangles(corners, unitFrame(n), Voxelization::conservative);
        const BitGrid thin = voxelizeTriangles(corners, unitFrame(n), Voxelization::thin);
        REQUIRE_FALSE(conservative.occupied(inside.x, inside.y, inside.z));
        CHECK_FALSE(reaches(conservative, 26, inside));
        CHECK_FALSE(reaches(thin, 6, inside));
        CHECK(subset(thin, conservative));
        CHECK(thin.countOccupied() <= conservative.countOccupied());
    }
    // The flood fill itself: a leak is found.
    BitGrid leaky = voxelizeTriangles(meshes[0].second, unitFrame(n), Voxelization::conservative);
    for (int x = 0; x < inside.x; ++x) leaky.bricks[leaky.brickIndex(x, inside.y, inside.z)] = 0;
    CHECK(reaches(leaky, 6, inside));
}

TEST_CASE("a wall on a voxel boundary belongs to both sides in conservative", "[voxel][conservative]")
{
    const Triangle wall = {Vec3(-100, -100, 3), Vec3(100, -100, 3), Vec3(0, 200, 3)};
    const BitGrid bits = voxelizeOne(wall, unitFrame(8), Voxelization::conservative);
    forVoxels(8, [&](int x, int y, int z) { CHECK(bits.occupied(x, y, z) == (z == 2 || z == 3)); });
}

TEST_CASE("shifting the grid by whole voxels shifts the voxels, scaling the world by 2^k changes none", "[voxel][invariance]")
{
    const auto mode = GENERATE(Voxelization::conservative, Voxelization::thin, Voxelization::raster);
    const int n = 32;
    std::vector<Vec3> corners;
    std::mt19937 random(3);
    for (int i = 0; i < 90; ++i) {
        const auto k = [&] { return 4.0f + float(random() % 65536) * (16.0f / 65536.0f); };
        const float x = k(), y = k(), z = k();
        corners.emplace_back(x, y, z);
    }
    const BitGrid bits = voxelizeTriangles(corners, unitFrame(n), mode);

    const IVec3 shift(3, -2, 5);
    VoxelGrid shifted = unitFrame(n);
    shifted.origin = -Vec3(shift);
    const BitGrid moved = voxelizeTriangles(corners, shifted, mode);
    int different = 0;
    forVoxels(n, [&](int x, int y, int z) {
        const bool was = bits.occupied(x - shift.x, y - shift.y, z - shift.z);
        different += moved.occupied(x, y, z) != was;
    });
    CHECK(different == 0);

    std::vector<Vec3> scaledCorners;
    for (const Vec3& p : corners) scaledCorners.push_back(0x1p-9f * p);
    VoxelGrid scaled = unitFrame(n);
    scaled.voxelSize = 0x1p-9f;
    CHECK(voxelizeTriangles(scaledCorners, scaled, mode).bricks == bits.bricks);
}

TEST_CASE("doubling the resolution refines: each fine voxel lies in a set coarse one, each coarse one holds a fine one", "[voxel][invariance]")
{
    const std::vector<Vec3> corners = oracle::sphereMesh(Vec3(0.1f, 0.2f, -0.1f), 0.7f, 20, 30);
    VoxelGrid coarseFrame{Vec3(-1), 2.0f / 16, 16}, fineFrame{Vec3(-1), 2.0f / 32, 32};
    const BitGrid coarse = voxelizeTriangles(corners, coarseFrame, Voxelization::conservative);
    const BitGrid fine = voxelizeTriangles(corners, fineFrame, Voxelization::conservative);
    int wrong = 0;
    forVoxels(16, [&](int x, int y, int z) {
        bool any = false;
        for (int k = 0; k < 8; ++k) any = any || fine.occupied(2 * x + (k & 1), 2 * y + ((k >> 1) & 1), 2 * z + (k >> 2));
        wrong += any != coarse.occupied(x, y, z);
    });
    CHECK(wrong == 0);
}

TEST_CASE("triangle order and thread count change no bit", "[voxel][determinism]")
{
    const auto mode = GENERATE(Voxelization::conservative, Voxelization::thin, Voxelization::raster);
    const VoxelGrid grid = unitFrame(256);
    std::vector<Vec3> corners = oracle::sphereMesh(Vec3(128), 100.0f, 60, 80);
    for (const Case& c : awkwardTriangles(256, 5, 12))
        for (const Triangle& t : c.triangles) corners.insert(corners.end(), t.begin(), t.end());
    BitGrid serial;
    {
        const ThreadLimit one(1);
        serial = voxelizeTriangles(corners, grid, mode);
    }
    for (const int threads : {2, 8}) {
        const ThreadLimit limit(threads);
        CHECK(voxelizeTriangles(corners, grid, mode).bricks == serial.bricks);
    }
    std::vector<Vec3> reversed(corners.rbegin(), corners.rend());  // other triangle order, other winding, other first vertex
    CHECK(voxelizeTriangles(reversed, grid, mode).bricks == serial.bricks);
}

TEST_CASE("triangles with a non-finite vertex are dropped, huge ones still cut the grid where they pass", "[voxel][robust]")
{
    const VoxelGrid grid = unitFrame(8);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float bad : {nan, kInfinity, -kInfinity})
        for (int axis = 0; axis < 3; ++axis) {
            Triangle t = {Vec3(1), Vec3(6, 1, 1), Vec3(1, 6, 1)};
            t[1][axis] = bad;
            CHECK(voxelizeOne(t, grid, Voxelization::conservative).countOccupied() == 0);
        }

    for (const float far : {5e3f, 1e9f, 1e20f, 3e38f}) {
        INFO("reach " << far);
        const Triangle floor = {Vec3(-far, 3.5f, -far), Vec3(far, 3.5f, -far), Vec3(0, 3.5f, far)};
        for (const auto mode : {Voxelization::conservative, Voxelization::thin, Voxelization::raster})
            CHECK(voxelizeOne(floor, grid, mode).countOccupied() == 64);
        const Triangle beside = {Vec3(-far, 9.5f, -far), Vec3(far, 9.5f, -far), Vec3(0, 9.5f, far)};
        CHECK(voxelizeOne(beside, grid, Voxelization::conservative).countOccupied() == 0);
    }
}

TEST_CASE("the frame is a cube about the scene with two voxels to spare on the longest side", "[voxel][frame]")
{
    Aabb bounds;
    bounds.include(Vec3(-1.0f, 0.0f, 2.0f));
    bounds.include(Vec3(5.0f, 1.5f, 3.0f));
    for (const int resolution : {8, 64, 2048}) {
        const VoxelGrid grid = fitVoxelGrid(bounds, resolution);
        const Vec3 low = grid.voxelsFromWorld(bounds.min), high = grid.voxelsFromWorld(bounds.max);
        CHECK(low.x == Approx(2.0f).margin(2e-3));
        CHECK(high.x == Approx(float(resolution - 2)).margin(2e-3));
        for (int axis = 0; axis < 3; ++axis) CHECK(low[axis] + high[axis] == Approx(float(resolution)).margin(4e-3));
    }
    for (const int resolution : {1, 2, 4}) {
        const VoxelGrid grid = fitVoxelGrid(bounds, resolution);
        CHECK(grid.voxelSize * float(resolution) == Approx(12.0f));  // half of the cube's edge is margin
    }
    CHECK(fitVoxelGrid(Aabb{}, 16).voxelSize > 0.0f);
    Aabb point;
    point.include(Vec3(3));
    CHECK(fitVoxelGrid(point, 16).voxelSize > 0.0f);
}

TEST_CASE("frames that cannot be are refused", "[voxel][frame]")
{
    Aabb bounds;
    bounds.include(Vec3(0));
    bounds.include(Vec3(1));
    for (const int resolution : {-1, 0, 3, 100, 4096}) CHECK_THROWS(fitVoxelGrid(bounds, resolution));
    bounds.include(Vec3(kInfinity, 0, 0));
    CHECK_THROWS(fitVoxelGrid(bounds, 16));
    Aabb wide;
    wide.include(Vec3(-3e38f));
    wide.include(Vec3(3e38f));
    CHECK_NOTHROW(fitVoxelGrid(wide, 2048));
    CHECK_THROWS(fitVoxelGrid(wide, 1));
    Aabb tiny;
    tiny.include(Vec3(0));
    tiny.include(Vec3(1e-40f));
    CHECK_THROWS(fitVoxelGrid(tiny, 16));
}

TEST_CASE("a scene's meshes all reach the grid", "[voxel]")
{
    Scene scene;
    for (const float x : {0.0f, 10.0f}) {
        Mesh mesh;
        mesh.positions = {Vec3(x, 0, 0), Vec3(x, 10, 0), Vec3(x, 0, 10), Vec3(1e6f)};  // the last one is unused
        mesh.triangles = {{0, 1, 2}};
        scene.meshes.push_back(mesh);
        for (int k = 0; k < 3; ++k) scene.bounds.include(mesh.positions[std::size_t(k)]);
    }
    VoxelSettings settings;
    settings.resolution = 16;
    const BitGrid bits = voxelize(scene, settings);
    CHECK(bits.grid == fitVoxelGrid(scene.bounds, 16));
    CHECK(bits.occupied(2, 3, 3));
    CHECK(bits.occupied(13, 3, 3));
    CHECK_FALSE(bits.occupied(7, 3, 3));
    CHECK(bits.countOccupied() > 100);
}
