#include "apps/validate/extremes/worlds.h"
#include "core/scene/defaults.h"
#include "core/scene/gltf.h"
#include "core/scene/view_file.h"

#include <unistd.h>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

// What files can say: views and glTF documents at the edge of sense.
namespace lrsm::extremes {
namespace {

std::string viewText(const std::string& camera, const std::string& light)
{
    return "{\"camera\": {" + camera + "}, \"lights\": [{" + light + "}]}";
}
const std::string kCamera = "\"eye\": [0.3, 0.1, 0.95], \"target\": [0, -0.2, -1]";
const std::string kSpot = "\"type\": \"spot\", \"position\": [0.1, 0.9, 0], \"target\": [0.2, -1, 0]";

/// The room seen through this view.
void showView(Mode mode, Probe& probe, const std::string& text)
{
    World world = room();
    const View view = parseView(text, "view.json");
    if (view.camera) {
        world.camera = *view.camera;
        world.camera.nearPlane = nearPlaneFor(world.camera, world.scene.bounds);  // as loadScene does
    }
    if (view.lights) world.scene.lights = *view.lights;
    probe.frame(renderWorld(world, smallSettings(mode)));
}

Case goodView(const std::string& name, const std::string& camera, const std::string& light)
{
    return {"view: " + name, "camera {" + camera + "}, light {" + light + "}", "every pass finite",
            [=](Mode mode, Probe& probe) { showView(mode, probe, viewText(camera, light)); }, true};
}
Case badView(const std::string& name, const std::string& camera, const std::string& light)
{
    return refusal("view: " + name, "camera {" + camera + "}, light {" + light + "}",
                   [=](Mode mode, Probe& probe) { showView(mode, probe, viewText(camera, light)); });
}
Case badText(const std::string& name, const std::string& text)
{
    return refusal("view: " + name, text.substr(0, 80), [=](Mode mode, Probe& probe) { showView(mode, probe, text); });
}

std::string base64(const std::vector<float>& values)
{
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<unsigned char> bytes(values.size() * sizeof(float));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    while (bytes.size() % 3) bytes.push_back(0);
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const unsigned word = unsigned(bytes[i]) << 16 | unsigned(bytes[i + 1]) << 8 | bytes[i + 2];
        for (int k = 18; k >= 0; k -= 6) text += kDigits[word >> k & 63];
    }
    return text;
}

/// A document of one mesh: triangles in a row of positions; the rest as given.
struct Document {
    std::vector<float> positions = {-1, 0, -1, -1, 0, 1, 1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0, -1};
    std::string node, material, extra, extensions;
    std::vector<float> normals;

    std::string text() const
    {
        const std::size_t vertices = positions.size() / 3, bytes = positions.size() * 4;
        std::vector<float> all = positions;
        all.insert(all.end(), normals.begin(), normals.end());
        std::string views = "{\"buffer\": 0, \"byteLength\": " + std::to_string(bytes) + "}", attributes = "\"POSITION\": 0";
        std::string accessors = "{\"bufferView\": 0, \"componentType\": 5126, \"type\": \"VEC3\", \"count\": " + std::to_string(vertices) + "}";
        if (!normals.empty()) {
            views += ", {\"buffer\": 0, \"byteOffset\": " + std::to_string(bytes) + ", \"byteLength\": " + std::to_string(bytes) + "}";
            accessors += ", {\"bufferView\": 1, \"componentType\": 5126, \"type\": \"VEC3\", \"count\": " + std::to_string(vertices) + "}";
            attributes += ", \"NORMAL\": 1";
        }
        return "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{\"nodes\": [0]}], \"nodes\": [{\"mesh\": 0" + node +
               "}], \"meshes\": [{\"primitives\": [{\"attributes\": {" + attributes + "}, \"material\": 0}]}], \"materials\": [{" + material +
               "}], \"accessors\": [" + accessors + "], \"bufferViews\": [" + views + "], \"buffers\": [{\"byteLength\": " + std::to_string(all.size() * 4) +
               ", \"uri\": \"data:application/octet-stream;base64," + base64(all) + "\"}]" + extra + extensions + "}";
    }
};

/// Writes, loads, renders, removes.
void showDocument(Mode mode, Probe& probe, const std::string& text)
{
    struct File {
        std::filesystem::path path;
        ~File()
        {
            std::error_code ignored;
            std::filesystem::remove(path, ignored);
        }
    };
    const File file{std::filesystem::temp_directory_path() / ("lrsm-extreme-" + std::to_string(getpid()) + ".gltf")};
    std::ofstream(file.path, std::ios::binary) << text;
    World world;
    world.scene = loadGltf(file.path.string(), {});
    world.camera = world.scene.cameras.at(0);
    probe.frame(renderWorld(world, smallSettings(mode)));
}

Case good(const std::string& name, const std::string& what, Document document)
{
    return {"glTF: " + name, what, "every pass finite", [=](Mode mode, Probe& probe) { showDocument(mode, probe, document.text()); }, true};
}
Case bad(const std::string& name, const std::string& what, Document document)
{
    return refusal("glTF: " + name, what, [=](Mode mode, Probe& probe) { showDocument(mode, probe, document.text()); });
}

Document withNode(const std::string& node)
{
    return {.node = ", " + node, .material = {}, .extra = {}, .extensions = {}, .normals = {}};
}
Document withMaterial(const std::string& material)
{
    return {.node = {}, .material = material, .extra = {}, .extensions = {}, .normals = {}};
}
Document withPositions(std::vector<float> positions)
{
    return {.positions = std::move(positions), .node = {}, .material = {}, .extra = {}, .extensions = {}, .normals = {}};
}
Document withNormals(float value)
{
    Document document = withNode("\"name\": \"n\"");
    document.normals.assign(document.positions.size(), value);
    return document;
}
Document withLight(const std::string& light)
{
    Document document = withNode("\"extensions\": {\"KHR_lights_punctual\": {\"light\": 0}}");
    document.extensions = ", \"extensionsUsed\": [\"KHR_lights_punctual\"], \"extensions\": {\"KHR_lights_punctual\": {\"lights\": [{" + light + "}]}}";
    return document;
}
Document withCamera(const std::string& camera)
{
    Document document = withNode("\"camera\": 0");
    document.extra = ", \"cameras\": [{" + camera + "}]";
    return document;
}

}  // namespace

Group fileCases()
{
    const float nan = std::nanf("");
    return {
        "files",
        {goodView("field of view 0.1", kCamera + ", \"verticalFovDegrees\": 0.1", kSpot),
         goodView("field of view 179", kCamera + ", \"verticalFovDegrees\": 179", kSpot),
         goodView("spot of 1 degree", kCamera, kSpot + ", \"outerConeAngleDegrees\": 0.5"),
         goodView("spot of 170 degrees", kCamera, kSpot + ", \"outerConeAngleDegrees\": 85"),
         goodView("intensity 0", kCamera, kSpot + ", \"intensity\": 0"),
         goodView("intensity 1e12 of colour 1e15", kCamera, kSpot + ", \"intensity\": 1e12, \"color\": [1e15, 0, 1e-30]"),
         goodView("sun straight down", kCamera, "\"type\": \"directional\", \"direction\": [0, -1, 0]"),
         goodView("sun of denormal direction", kCamera, "\"type\": \"directional\", \"direction\": [0, -1e-11, 0]"),
         goodView("eye 1e14 m away", "\"eye\": [0, 0, 1e14], \"target\": [0, 0, 0]", kSpot),
         goodView("up all but along the view", "\"eye\": [0, 0.5, 0], \"target\": [0, -1, 0], \"up\": [0.001, 1, 0]", kSpot),
         badView("eye = target", "\"eye\": [1, 1, 1], \"target\": [1, 1, 1]", kSpot),
         badView("eye = target in float32", "\"eye\": [1, 1, 1], \"target\": [1.00000001, 1, 1]", kSpot),
         badView("up along the view", "\"eye\": [0, 1, 0], \"target\": [0, 0, 0]", kSpot),
         badView("up 0", kCamera + ", \"up\": [0, 0, 0]", kSpot),
         badView("field of view 0", kCamera + ", \"verticalFovDegrees\": 0", kSpot),
         badView("field of view 180", kCamera + ", \"verticalFovDegrees\": 180", kSpot),
         badView("eye 1e300", "\"eye\": [1e300, 0, 0], \"target\": [0, 0, 0]", kSpot),
         badView("intensity -1", kCamera, kSpot + ", \"intensity\": -1"),
         badView("intensity 1e30", kCamera, kSpot + ", \"intensity\": 1e30"),
         badView("colour negative", kCamera, kSpot + ", \"color\": [1, -1, 1]"),
         badView("inner beyond outer", kCamera, kSpot + ", \"innerConeAngleDegrees\": 50, \"outerConeAngleDegrees\": 40"),
         badView("outer of 90 degrees", kCamera, kSpot + ", \"outerConeAngleDegrees\": 90"),
         badView("light at its target", kCamera, "\"type\": \"spot\", \"position\": [1, 1, 1], \"target\": [1, 1, 1]"),
         badView("sun of no direction", kCamera, "\"type\": \"directional\", \"direction\": [0, 0, 0]"),
         badView("range 0", kCamera, kSpot + ", \"range\": 0"),
         badText("NaN", "{\"camera\": {\"eye\": [NaN, 0, 0], \"target\": [0, 0, 0]}}"),
         badText("1e400", "{\"camera\": {\"eye\": [1e400, 0, 0], \"target\": [0, 0, 0]}}"),
         badText("no lights", "{\"lights\": []}"),
         badText("empty", ""),
         badText("deeply nested", std::string(100000, '[')),
         good("as it is", "a quad of 2 m under the default sun", withNode("\"name\": \"plain\"")),
         good("scale (1, 0, 1)", "a flattening node over a flat quad", withNode("\"scale\": [1, 0, 1]")),
         good("scale (-1, 1, 1)", "a mirroring node", withNode("\"scale\": [-1, 1, 1]")),
         good("scale 1e-8", "", withNode("\"scale\": [1e-8, 1e-8, 1e-8]")),
         good("scale 1e12", "", withNode("\"scale\": [1e12, 1e12, 1e12]")),
         good("translation 1e6", "", withNode("\"translation\": [1e6, -1e6, 1e6]")),
         good("matrix of rank 2", "", withNode("\"matrix\": [1,0,0,0, 0,0,0,0, 0,0,1,0, 0,0,0,1]")),
         bad("scale 0", "no triangle has an area", withNode("\"scale\": [0, 0, 0]")),
         bad("scale 1e30", "larger than 1e15 m", withNode("\"scale\": [1e30, 1e30, 1e30]")),
         bad("scale 1e300", "world positions are not finite", withNode("\"scale\": [1e300, 1e300, 1e300]")),
         bad("scale 1e-30", "smaller than 1e-12 m", withNode("\"scale\": [1e-30, 1e-30, 1e-30]")),
         bad("translation 1e30", "beyond 1e15 m", withNode("\"translation\": [1e30, 0, 0]")),
         bad("rotation 0", "", withNode("\"rotation\": [0, 0, 0, 0]")),
         bad("positions NaN", "", withPositions({nan, 0, 0, 1, 0, 0, 0, 1, 0})),
         bad("positions infinite", "", withPositions({kInfinity, 0, 0, 1, 0, 0, 0, 1, 0})),
         bad("positions all equal", "", withPositions({1, 1, 1, 1, 1, 1, 1, 1, 1})),
         bad("positions collinear", "", withPositions({0, 0, 0, 1, 1, 1, 2, 2, 2})),
         good("positions of the largest size", "triangle of 1e14 m", withPositions({0, 0, 0, 1e14f, 0, 0, 0, 0, -1e14f})),
         good("a sliver", "1 m by 1e-5 m", withPositions({0, 0, 0, 1, 0, 0, 1, 0, -1e-5f})),
         good("normals 0", "", withNormals(0.0f)),
         bad("normals NaN", "", withNormals(nan)),
         good("roughness 0, metallic 1", "", withMaterial("\"pbrMetallicRoughness\": {\"metallicFactor\": 1, \"roughnessFactor\": 0}")),
         bad("roughness 2", "", withMaterial("\"pbrMetallicRoughness\": {\"roughnessFactor\": 2}")),
         bad("base colour negative", "", withMaterial("\"pbrMetallicRoughness\": {\"baseColorFactor\": [-1, 0, 0, 1]}")),
         good("all cut away", "alpha mask above every alpha", withMaterial("\"alphaMode\": \"MASK\", \"alphaCutoff\": 2")),
         good("light on the surface", "a point light in the quad", withLight("\"type\": \"point\", \"intensity\": 1e12")),
         good("spot with the widest angle", "90 degrees, reduced to 89", withLight("\"type\": \"spot\", \"spot\": {\"outerConeAngle\": 1.5707963}")),
         bad("spot inner beyond outer", "", withLight("\"type\": \"spot\", \"spot\": {\"innerConeAngle\": 0.7, \"outerConeAngle\": 0.5}")),
         bad("light intensity negative", "", withLight("\"type\": \"directional\", \"intensity\": -1")),
         good("light range 0", "as writers spell no limit", withLight("\"type\": \"point\", \"range\": 0")),
         bad("light range -1", "", withLight("\"type\": \"point\", \"range\": -1")),
         good("camera in the surface", "", withCamera("\"type\": \"perspective\", \"perspective\": {\"yfov\": 1, \"znear\": 0.01}")),
         good("camera orthographic", "", withCamera("\"type\": \"orthographic\", \"orthographic\": {\"xmag\": 1, \"ymag\": 1, \"znear\": 0, \"zfar\": 10}")),
         bad("camera yfov 0", "", withCamera("\"type\": \"perspective\", \"perspective\": {\"yfov\": 0, \"znear\": 0.01}")),
         bad("camera yfov pi", "", withCamera("\"type\": \"perspective\", \"perspective\": {\"yfov\": 3.14159265, \"znear\": 0.01}")),
         bad("camera znear 0", "", withCamera("\"type\": \"perspective\", \"perspective\": {\"yfov\": 1, \"znear\": 0}")),
         bad("camera znear 1e-30", "nearer than depths can tell apart",
             withCamera("\"type\": \"perspective\", \"perspective\": {\"yfov\": 1, \"znear\": 1e-30}")),
         bad("camera mag 0", "", withCamera("\"type\": \"orthographic\", \"orthographic\": {\"xmag\": 0, \"ymag\": 0, \"znear\": 0, \"zfar\": 10}"))}};
}

}  // namespace lrsm::extremes
