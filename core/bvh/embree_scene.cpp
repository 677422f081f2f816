#include "core/bvh/embree_scene.h"

#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/bvh/coincident.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <vector>

namespace lrsm {

struct EmbreeScene::GeometryData {
    const Scene* scene = nullptr;
    std::uint32_t mesh = 0;
    bool singleSided = false;
    bool alphaMask = false;
    bool beyondReach = false;  ///< a triangle leads out of the scene's reach

    static void filter(const RTCFilterFunctionNArguments* arguments);
};

namespace {

[[noreturn]] void fail(RTCDevice device, const std::string& what)
{
    const RTCError code = rtcGetDeviceError(device);
    throw MachineError("Embree", what + " (error " + std::to_string(int(code)) + ")");
}

/// Does a triangle of the mesh lead out of what the scene is measured by?
bool leadsBeyondReach(const Scene& scene, const Mesh& mesh)
{
    return reachIsPart(scene) && std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& triangle) {
               return std::any_of(triangle.begin(), triangle.end(), [&](std::uint32_t v) { return !scene.reach.contains(mesh.positions[v]); });
           });
}

/// Is the triangle's plane ahead of the ray's near end? In double: over kilometres a float distance is less sure than a ray's offset.
bool planeIsAhead(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle, const RTCRay& ray)
{
    const glm::dvec3 p0(mesh.positions[triangle[0]]), origin(ray.org_x, ray.org_y, ray.org_z), direction(ray.dir_x, ray.dir_y, ray.dir_z);
    const glm::dvec3 normal = glm::cross(glm::dvec3(mesh.positions[triangle[1]]) - p0, glm::dvec3(mesh.positions[triangle[2]]) - p0);
    return glm::dot(normal, p0 - origin) / glm::dot(normal, direction) > double(ray.tnear);
}

RTCRay embreeRay(const Ray& ray)
{
    RTCRay result{};
    result.org_x = ray.origin.x;
    result.org_y = ray.origin.y;
    result.org_z = ray.origin.z;
    result.dir_x = ray.direction.x;
    result.dir_y = ray.direction.y;
    result.dir_z = ray.direction.z;
    result.tnear = ray.tNear;
    result.tfar = ray.tFar;
    result.mask = ~0u;
    result.id = static_cast<unsigned>(ray.kind);  // Embree hands it through to the filter
    return result;
}

}  // namespace

struct EmbreeScene::Memory {
    std::atomic<std::int64_t> bytes{0};
    static bool count(void* memory, ssize_t bytes, bool /*done*/)
    {
        static_cast<Memory*>(memory)->bytes += bytes;
        return true;
    }
};

/// Called for hits on geometry that is alpha-masked, leads beyond the reach, or is single-sided where fronts and backs matter; clears `valid` where the ray
/// goes on. Our rays come one by one.
void EmbreeScene::GeometryData::filter(const RTCFilterFunctionNArguments* arguments)
{
    if (arguments->valid[0] != -1) return;
    const auto& data = *static_cast<const GeometryData*>(arguments->geometryUserPtr);
    const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
    const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);

    if (data.singleSided) {
        const bool front = hit.Ng_x * ray.dir_x + hit.Ng_y * ray.dir_y + hit.Ng_z * ray.dir_z < 0.0f;
        const auto kind = static_cast<RayKind>(ray.id);
        // A ray towards the light that meets a front has met a face whose back is turned to the light.
        if ((kind == RayKind::eye && !front) || (kind == RayKind::light && front)) {
            arguments->valid[0] = 0;
            return;
        }
    }
    const Mesh& mesh = data.scene->meshes[data.mesh];
    if (data.beyondReach && !planeIsAhead(mesh, mesh.triangles[hit.primID], ray)) {
        arguments->valid[0] = 0;
        return;
    }
    if (data.alphaMask && !passesAlphaTest(*data.scene, {data.mesh, hit.primID, hit.u, hit.v})) arguments->valid[0] = 0;
}

EmbreeScene::EmbreeScene(const Scene& scene, RayKinds kinds) : scene_(&scene), data_(new GeometryData[scene.meshes.size()]), memory_(new Memory)
{
    const Aabb& extent = extentOf(scene);
    const Vec3 largest = glm::max(glm::abs(extent.min), glm::abs(extent.max));
    floor_ = extent.empty() ? 0.0f : 0x1p-22f * std::max({largest.x, largest.y, largest.z});

    // One building thread: a parallel build may order the triangles of a leaf differently, and with them which of two coincident
    // triangles is hit. (The device's own `threads=1` would hold back all of oneTBB for as long as the device lives.)
    const ThreadLimit oneBuilder(1);
    device_.reset(rtcNewDevice("isa=avx2"));
    if (!device_) fail(nullptr, "cannot be started with isa=avx2");
    rtcSetDeviceMemoryMonitorFunction(device_.get(), &Memory::count, memory_.get());
    embree_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(embree_.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree_.get(), RTC_BUILD_QUALITY_MEDIUM);

    const std::vector<std::vector<std::uint8_t>> hidden = hiddenTriangles(scene);
    for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
        const Mesh& mesh = scene.meshes[m];
        const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
        data_[m] = {.scene = &scene,
                    .mesh = m,
                    .singleSided = kinds == RayKinds::all && !material.doubleSided,
                    .alphaMask = material.alphaMask,
                    .beyondReach = leadsBeyondReach(scene, mesh)};

        RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        // Copies, not shared buffers: Embree reads 16 bytes at the last vertex, beyond the end of ours.
        void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), mesh.positions.size());
        void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(mesh.triangles[0]), mesh.triangles.size());
        if ((!vertices && !mesh.positions.empty()) || (!indices && !mesh.triangles.empty())) fail(device_.get(), "no memory for the triangles");
        std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<Vec3*>(vertices));
        auto* triangles = static_cast<std::array<std::uint32_t, 3>*>(indices);
        std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
        for (std::size_t t = 0; t < hidden[m].size(); ++t)
            if (hidden[m][t]) triangles[t] = {triangles[t][0], triangles[t][0], triangles[t][0]};  // no area: met by no ray
        if (data_[m].singleSided || data_[m].alphaMask || data_[m].beyondReach) {
            rtcSetGeometryUserData(geometry, &data_[m]);
            rtcSetGeometryIntersectFilterFunction(geometry, &GeometryData::filter);
            rtcSetGeometryOccludedFilterFunction(geometry, &GeometryData::filter);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(embree_.get(), geometry, m);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(embree_.get());
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) fail(device_.get(), "cannot build the scene's BVH");
}

EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;

std::size_t EmbreeScene::bytes() const
{
    return static_cast<std::size_t>(memory_->bytes.load());
}

void EmbreeScene::Release::operator()(RTCDeviceTy* device) const
{
    rtcReleaseDevice(device);
}

void EmbreeScene::Release::operator()(RTCSceneTy* scene) const
{
    rtcReleaseScene(scene);
}

std::optional<RayHit> EmbreeScene::closestHit(const Ray& ray) const
{
    RTCRayHit query{embreeRay(ray), {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(embree_.get(), &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(embree_.get(), &context, &query);
#endif
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const RTCHit& hit = query.hit;
    const Vec3 normal(hit.Ng_x, hit.Ng_y, hit.Ng_z);
    const bool front = glm::dot(normal, ray.direction) < 0.0f;
    return RayHit{{hit.geomID, hit.primID, hit.u, hit.v}, query.ray.tfar, front, front ? normal : -normal};
}

bool EmbreeScene::occluded(const Ray& ray) const
{
    RTCRay query = embreeRay(ray);
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(embree_.get(), &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(embree_.get(), &context, &query);
#endif
    return query.tfar < 0.0f;  // set to -infinity by a hit
}

}  // namespace lrsm
