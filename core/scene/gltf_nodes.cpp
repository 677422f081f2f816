#include "core/scene/gltf_nodes.h"

#include "core/base/elementary.h"
#include "core/scene/animate.h"
#include "core/scene/gltf_accessor.h"

#include <numeric>
#include <optional>

namespace lrsm::gltf {
namespace {

std::optional<Property> propertyNamed(std::string_view path)
{
    constexpr std::string_view kNames[] = {"translation", "rotation", "scale", "weights"};  // in the order of Property
    const auto found = std::find(std::begin(kNames), std::end(kNames), path);
    return found == std::end(kNames) ? std::nullopt : std::optional(Property(found - std::begin(kNames)));
}

Interpolation interpolationOf(const Document& document, const std::string& name, const std::string& path)
{
    if (name.empty() || name == "LINEAR") return Interpolation::linear;
    if (name == "STEP") return Interpolation::step;
    if (name == "CUBICSPLINE") return Interpolation::cubicSpline;
    document.fail(path, "must be STEP, LINEAR or CUBICSPLINE");
}

/// Keyframes in the order of their times; those of one time stay in the file's order. False where they were so already.
bool sortKeyframes(Channel& channel)
{
    if (std::is_sorted(channel.times.begin(), channel.times.end())) return false;
    std::vector<std::size_t> order(channel.times.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return channel.times[a] < channel.times[b]; });
    const std::size_t width = channel.values.size() / order.size();
    std::vector<float> times, values;
    for (const std::size_t k : order) {
        times.push_back(channel.times[k]);
        values.insert(values.end(), channel.values.begin() + std::ptrdiff_t(k * width), channel.values.begin() + std::ptrdiff_t((k + 1) * width));
    }
    channel.times = std::move(times);
    channel.values = std::move(values);
    return true;
}

/// Floats a keyframe holds: 3, 4, or one for each morph target of the node's mesh.
std::size_t widthOf(const Document& document, Property property, int node)
{
    if (property != Property::weights) return property == Property::rotation ? 4 : 3;
    const int mesh = document.model.nodes[std::size_t(node)].mesh;
    if (mesh < 0 || document.model.meshes[std::size_t(mesh)].primitives.empty()) return 0;
    return document.model.meshes[std::size_t(mesh)].primitives[0].targets.size();
}

Channel readChannel(const Document& document, const tinygltf::Animation& animation, const tinygltf::AnimationChannel& source, Property property,
                    const std::string& animationPath, const std::string& path)
{
    if (source.sampler < 0 || std::size_t(source.sampler) >= animation.samplers.size())
        document.fail(path + ".sampler", "points to nothing: there are " + countOf(animation.samplers.size(), "sampler"));
    const tinygltf::AnimationSampler& sampler = animation.samplers[std::size_t(source.sampler)];
    const std::string samplerPath = at(animationPath + ".samplers", std::size_t(source.sampler));

    Channel channel;
    channel.node = source.target_node;
    channel.property = property;
    channel.interpolation = interpolationOf(document, sampler.interpolation, samplerPath + ".interpolation");
    const std::size_t width = widthOf(document, channel.property, channel.node);
    if (width == 0) document.fail(path + ".target", "node " + std::to_string(channel.node) + " has no morph targets");
    if (channel.property != Property::weights && !document.model.nodes[std::size_t(channel.node)].matrix.empty())
        document.fail(path + ".target", "node " + std::to_string(channel.node) + " has a matrix and cannot be animated");
    channel.width = int(width);

    requireFormat(document, sampler.input, "SCALAR f", samplerPath + ".input");
    channel.times = readFloats(document, sampler.input);
    requireFormat(document, sampler.output,
                  channel.property == Property::rotation  ? "VEC4 f ns8 nu8 ns16 nu16"
                  : channel.property == Property::weights ? "SCALAR f ns8 nu8 ns16 nu16"
                                                          : "VEC3 f",
                  samplerPath + ".output");
    channel.values = readFloats(document, sampler.output);
    const std::size_t expected = channel.times.size() * width * (channel.interpolation == Interpolation::cubicSpline ? 3 : 1);
    if (channel.values.size() != expected)
        document.fail(samplerPath + ".output", "holds " + std::to_string(channel.values.size()) + " numbers, the keyframes need " + std::to_string(expected));
    return channel;
}

/// EXT_mesh_gpu_instancing: node from instance, translation * rotation * scale.
std::vector<DMat4> readInstances(const Document& document, const Json& attributes, const std::string& path)
{
    const auto stream = [&](const char* name, std::string_view allowed) {
        const auto found = attributes.find(name);
        if (found == attributes.end()) return std::vector<float>{};
        requireFormat(document, found->get<int>(), allowed, path + "." + name);
        return readFloats(document, found->get<int>());
    };
    const std::vector<float> translations = stream("TRANSLATION", "VEC3 f"), rotations = stream("ROTATION", "VEC4 f ns8 ns16"),
                             scales = stream("SCALE", "VEC3 f");
    const std::size_t count = std::max({translations.size() / 3, rotations.size() / 4, scales.size() / 3});
    const auto fits = [&](const std::vector<float>& values, std::size_t width) { return values.empty() || values.size() == width * count; };
    if (count == 0) document.fail(path, "has none of TRANSLATION, ROTATION and SCALE");
    if (!fits(translations, 3) || !fits(rotations, 4) || !fits(scales, 3)) document.fail(path, "the attributes differ in length");

    std::vector<DMat4> instances;
    for (std::size_t i = 0; i < count; ++i) {
        LocalTransform local;
        for (std::size_t c = 0; c < 3; ++c) {
            if (!translations.empty()) local.translation[int(c)] = double(translations[3 * i + c]);
            if (!scales.empty()) local.scale[int(c)] = double(scales[3 * i + c]);
        }
        for (std::size_t c = 0; c < 4 && !rotations.empty(); ++c) local.rotation[int(c)] = double(rotations[4 * i + c]);
        const double length = std::sqrt(glm::dot(local.rotation, local.rotation));
        if (!(length > 1e-12)) document.fail(path + ".ROTATION", "element " + std::to_string(i) + " is no rotation");
        local.rotation /= length;
        instances.push_back(compose(local));
    }
    return instances;
}

DMat4 matrixOf(const std::vector<double>& values)
{
    DMat4 matrix(1.0);
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = values[std::size_t(i)];
    return matrix;
}

Node readNode(const Document& document, std::size_t i)
{
    const tinygltf::Node& source = document.model.nodes[i];
    Node node;
    node.name = source.name.empty() ? "node " + std::to_string(i) : source.name;
    node.children = source.children;
    node.mesh = source.mesh;
    node.skin = source.skin;
    node.camera = source.camera;
    node.weights.assign(source.weights.begin(), source.weights.end());
    node.hasMatrix = !source.matrix.empty();
    if (node.hasMatrix) node.matrix = matrixOf(source.matrix);
    for (int c = 0; c < 3; ++c) {
        if (!source.translation.empty()) node.translation[c] = source.translation[std::size_t(c)];
        if (!source.scale.empty()) node.scale[c] = source.scale[std::size_t(c)];
    }
    if (!source.rotation.empty()) {
        for (int c = 0; c < 4; ++c) node.rotation[c] = source.rotation[std::size_t(c)];
        const double length = std::sqrt(glm::dot(node.rotation, node.rotation));
        if (!(length > 1e-12)) document.fail(at("nodes", i) + ".rotation", "is no rotation");
        node.rotation /= length;
    }
    const Json& json = document.json["nodes"][i];
    const auto extensions = json.find("extensions");
    if (extensions == json.end()) return node;
    if (extensions->contains("KHR_lights_punctual")) node.light = (*extensions)["KHR_lights_punctual"]["light"].get<int>();
    if (extensions->contains("EXT_mesh_gpu_instancing") && node.mesh >= 0)
        node.instances =
            readInstances(document, (*extensions)["EXT_mesh_gpu_instancing"]["attributes"], at("nodes", i) + ".extensions.EXT_mesh_gpu_instancing.attributes");
    return node;
}

/// `roots` and all below them, each after its parent.
std::vector<int> parentsFirst(const std::vector<Node>& nodes, const std::vector<int>& roots)
{
    std::vector<bool> seen(nodes.size(), false);
    std::vector<int> order, open(roots.rbegin(), roots.rend());
    while (!open.empty()) {
        const int node = open.back();
        open.pop_back();
        if (seen[std::size_t(node)]) continue;
        seen[std::size_t(node)] = true;
        order.push_back(node);
        const std::vector<int>& children = nodes[std::size_t(node)].children;
        open.insert(open.end(), children.rbegin(), children.rend());
    }
    return order;
}

}  // namespace

void readNodes(const Document& document, Asset& asset)
{
    for (std::size_t i = 0; i < document.model.nodes.size(); ++i) asset.nodes.push_back(readNode(document, i));
    for (std::size_t i = 0; i < asset.nodes.size(); ++i) {
        for (std::size_t c = 0; c < asset.nodes[i].children.size(); ++c) {
            const int child = asset.nodes[i].children[c];
            int& parent = asset.nodes[std::size_t(child)].parent;
            if (parent >= 0) document.fail(at(at("nodes", i) + ".children", c), "node " + std::to_string(child) + " already has a parent");
            parent = int(i);
        }
    }
    std::vector<int> roots;
    for (std::size_t i = 0; i < asset.nodes.size(); ++i)
        if (asset.nodes[i].parent < 0) roots.push_back(int(i));
    asset.parentsFirst = parentsFirst(asset.nodes, roots);

    // With one parent at most, a node that no root reaches hangs on a loop.
    std::vector<int> reached = asset.parentsFirst;
    std::sort(reached.begin(), reached.end());
    for (std::size_t i = 0; i < asset.nodes.size(); ++i)
        if (i >= reached.size() || reached[i] != int(i)) document.fail(at("nodes", i), "is its own ancestor");

    const std::vector<tinygltf::Scene>& scenes = document.model.scenes;
    for (std::size_t k = 0; k < scenes.size(); ++k)
        for (std::size_t r = 0; r < scenes[k].nodes.size(); ++r)
            if (const int root = scenes[k].nodes[r]; asset.nodes[std::size_t(root)].parent >= 0)
                document.fail(at(at("scenes", k) + ".nodes", r), "node " + std::to_string(root) + " is another node's child");
    // The scene the file names, else its first, else (a library of nodes) everything.
    const int scene = document.json.contains("scene") ? document.json["scene"].get<int>() : 0;
    asset.sceneNodes = scenes.empty() ? asset.parentsFirst : parentsFirst(asset.nodes, scenes[std::size_t(scene)].nodes);
    if (scenes.size() > 1) asset.notes.push_back("scene " + std::to_string(scene) + " of " + std::to_string(scenes.size()) + " is shown");
}

void readSkins(const Document& document, Asset& asset)
{
    for (const tinygltf::Skin& source : document.model.skins) {
        const std::string path = at("skins", asset.skins.size());
        Skin skin;
        skin.joints = source.joints;
        if (skin.joints.empty()) document.fail(path + ".joints", "is empty");
        skin.inverseBind.assign(skin.joints.size(), DMat4(1.0));
        if (source.inverseBindMatrices >= 0) {
            requireFormat(document, source.inverseBindMatrices, "MAT4 f", path + ".inverseBindMatrices");
            const std::vector<float> values = readFloats(document, source.inverseBindMatrices);
            if (values.size() < 16 * skin.joints.size()) document.fail(path + ".inverseBindMatrices", "has fewer matrices than there are joints");
            for (std::size_t j = 0; j < skin.joints.size(); ++j)
                for (std::size_t c = 0; c < 16; ++c) skin.inverseBind[j][int(c / 4)][int(c % 4)] = double(values[16 * j + c]);
        }
        asset.skins.push_back(std::move(skin));
    }
    for (std::size_t n = 0; n < asset.nodes.size(); ++n) {
        const Node& node = asset.nodes[n];
        if (node.skin < 0 || node.mesh < 0) continue;
        const std::size_t joints = asset.skins[std::size_t(node.skin)].joints.size();
        for (const Primitive& primitive : asset.meshes[std::size_t(node.mesh)].primitives)
            for (const Influences& influences : primitive.influences)
                for (std::size_t v = 0; v < influences.joints.size(); ++v)
                    for (int k = 0; k < 4; ++k)
                        if (influences.weights[v][k] != 0.0f && influences.joints[v][std::size_t(k)] >= joints)
                            document.fail(at("nodes", n) + ".skin", "vertex " + std::to_string(v) + " uses joint " +
                                                                        std::to_string(influences.joints[v][std::size_t(k)]) + " of " + std::to_string(joints));
    }
}

void readAnimations(const Document& document, Asset& asset)
{
    std::size_t ignored = 0, sorted = 0;
    for (std::size_t a = 0; a < document.model.animations.size(); ++a) {
        const tinygltf::Animation& source = document.model.animations[a];
        const std::string path = at("animations", a);
        Animation animation{source.name.empty() ? "animation " + std::to_string(a) : source.name, {}};
        for (std::size_t c = 0; c < source.channels.size(); ++c) {
            const std::optional<Property> property = propertyNamed(source.channels[c].target_path);
            if (!property || source.channels[c].target_node < 0) {
                ++ignored;
                continue;
            }
            animation.channels.push_back(readChannel(document, source, source.channels[c], *property, path, at(path + ".channels", c)));
            sorted += sortKeyframes(animation.channels.back());
        }
        asset.animations.push_back(std::move(animation));
    }
    if (sorted > 0) asset.notes.push_back(countOf(sorted, "animation channel") + " with keyframes out of order: sorted by their times");
    if (ignored > 0) asset.notes.push_back(countOf(ignored, "animation channel") + " without a node or of unknown path ignored");
}

}  // namespace lrsm::gltf
