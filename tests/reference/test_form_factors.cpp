#include "reference/path_trace.h"

#include "reference_scenes.h"

#include "catch.h"

using namespace lrsm;
using namespace lrsm::test;

/// Irradiance at the point that the camera's only pixel sees, green channel, and its standard error.
static std::pair<double, double> probe(const Scene& scene, const Camera& camera, std::uint64_t samples, Transport transport = Transport::single)
{
    const ReferenceFrame frame = renderReference(scene, camera, {.transport = transport, .width = 1, .height = 1}, samples);
    return {double(frame.irradiance.texels[0].g), std::sqrt(double(frame.irradianceVariance.texels[0].g))};
}

// A receiver facing an emitter of constant radiance L collects pi F L, F the form factor from a point to the emitter. The emitter here is a
// lit diffuse sheet: a directional light of irradiance E makes it radiate rho E <n.l> / pi, seen through nothing else. Samples are drawn with
// fixed seeds; 6.5 standard errors would be exceeded by chance once in 10^10 runs (Gaussian; 4096 blocks), and the bound also asks for 1 %.

constexpr std::uint64_t kSamples = 65536;

static void checkAgainst(double expected, std::pair<double, double> measured)
{
    CAPTURE(expected, measured.first, measured.second);
    CHECK(std::abs(measured.first - expected) < 6.5 * measured.second + 1e-6 * expected);
    CHECK(measured.second < 0.01 * expected);
}

TEST_CASE("a point below a lit disk collects the disk's form factor", "[reference][statistics][closed-form]")
{
    // Disk of radius R = 1 at height h = 0.8, 256 corners (inscribed: its area is 1e-4 too small), lit from below at normal incidence.
    Mesh disk;
    constexpr int corners = 256;
    disk.positions.push_back({0, 0.8f, 0});
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * 3.14159265358979 * i / corners;
        disk.positions.push_back({float(std::cos(angle)), 0.8f, float(std::sin(angle))});
    }
    disk.normals.assign(disk.positions.size(), Vec3(0, -1, 0));
    for (std::uint32_t i = 0; i < corners; ++i) disk.triangles.push_back({0u, 1u + i, 1u + (i + 1) % corners});
    // The receiver is so small that it takes no light from the disk's: its shadow on the disk is the error, 1e-6 of the area.
    const Scene scene = makeScene({disk, rectangle({-5e-4f, 0, -5e-4f}, {0, 0, 1e-3f}, {1e-3f, 0, 0})}, {diffuse(Vec3(0.5f))}, {sun({0, 1, 0}, 3.0f)});
    const double radiance = 0.5 * 3.0 / 3.14159265358979, r2 = 1.0, h2 = 0.8 * 0.8;
    checkAgainst(3.14159265358979 * radiance * r2 / (r2 + h2), probe(scene, lookAt({0.3f, 0.3f, 0}, {0, 0, 0}, 1e-4f), kSamples));
}

/// Form factor from a point to a rectangle a x b parallel to its plane, at distance c, with one corner on the point's normal (Siegel and Howell).
static double parallelCorner(double a, double b, double c)
{
    const double x = a / c, y = b / c;
    return (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) + y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
           (2 * 3.14159265358979);
}

TEST_CASE("a point facing a parallel lit rectangle collects its form factor", "[reference][statistics][closed-form]")
{
    // Rectangle x in [-0.5, 1.5], z in [-0.4, 0.7] at y = 1.
    const Scene scene = makeScene({rectangle({-0.5f, 1, -0.4f}, {2, 0, 0}, {0, 0, 1.1f}), rectangle({-5e-4f, 0, -5e-4f}, {0, 0, 1e-3f}, {1e-3f, 0, 0})},
                                  {diffuse(Vec3(0.8f))}, {sun({0, 1, 0}, 2.0f)});
    const double factor = parallelCorner(0.5, 0.4, 1) + parallelCorner(1.5, 0.4, 1) + parallelCorner(0.5, 0.7, 1) + parallelCorner(1.5, 0.7, 1);
    checkAgainst(0.8 * 2.0 * factor, probe(scene, lookAt({0.3f, 0.3f, 0}, {0, 0, 0}, 1e-4f), kSamples));
}

TEST_CASE("a point beside a perpendicular lit rectangle collects its form factor", "[reference][statistics][closed-form]")
{
    // Wall in the plane x = 0.6, z in [0, 0.9], y in [0, 1.2], seen from the origin of the floor: F for a wall standing on the receiver's plane,
    // one edge level with the point (Howell's catalogue B-4): (atan(b/c) - c/sqrt(c^2+h^2) atan(b/sqrt(c^2+h^2))) / (2 pi).
    const Scene scene = makeScene({rectangle({0.6f, 0, 0}, {0, 0, 0.9f}, {0, 1.2f, 0}), rectangle({-5e-4f, 0, -5e-4f}, {0, 0, 1e-3f}, {1e-3f, 0, 0})},
                                  {diffuse(Vec3(0.6f))}, {sun({1, 0, 0}, 4.0f)});
    const double b = 0.9, c = 0.6, h = 1.2, slant = std::sqrt(c * c + h * h);
    const double factor = (std::atan(b / c) - c / slant * std::atan(b / slant)) / (2 * 3.14159265358979);
    checkAgainst(0.6 * 4.0 * factor, probe(scene, lookAt({-0.3f, 0.3f, 0}, {0, 0, 0}, 1e-4f), kSamples));
}
