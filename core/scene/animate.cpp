#include "core/scene/animate.h"

#include "core/base/elementary.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace lrsm::gltf {
namespace {

/// The keyframes about a time and how far it is between them; outside the range both are the end.
struct Span {
    std::size_t k0 = 0, k1 = 0;
    double t = 0.0, duration = 0.0;
};

Span spanAt(const std::vector<float>& times, float time)
{
    const auto next = std::upper_bound(times.begin(), times.end(), time);
    if (next == times.begin()) return {};
    if (next == times.end()) return {times.size() - 1, times.size() - 1};
    const auto k1 = std::size_t(next - times.begin()), k0 = k1 - 1;
    const double duration = double(times[k1]) - double(times[k0]);
    return {.k0 = k0, .k1 = k1, .t = (double(time) - double(times[k0])) / duration, .duration = duration};
}

void normalize(std::span<double> quaternion)
{
    double length2 = 0.0;
    for (const double c : quaternion) length2 += c * c;
    if (!(length2 > 1e-30)) {  // a spline can pass through 0; any rotation is as good
        std::fill(quaternion.begin(), quaternion.end(), 0.0);
        quaternion[3] = 1.0;
        return;
    }
    const double scale = 1.0 / std::sqrt(length2);
    for (double& c : quaternion) c *= scale;
}

void applyChannel(const Channel& channel, float time, LocalTransform& local, std::vector<float>& weights)
{
    std::vector<double> value(std::size_t(channel.width));
    sampleChannel(channel, time, value);
    switch (channel.property) {
    case Property::translation: local.translation = {value[0], value[1], value[2]}; break;
    case Property::scale: local.scale = {value[0], value[1], value[2]}; break;
    case Property::rotation: local.rotation = {value[0], value[1], value[2], value[3]}; break;
    case Property::weights: weights.assign(value.begin(), value.end()); break;
    }
}

/// Unit axes of a matrix; one that has no length is made from the other two, or is its own.
glm::dmat3 axesOf(const DMat4& matrix)
{
    glm::dmat3 axes;
    std::array<bool, 3> known{};
    for (int c = 0; c < 3; ++c) {
        const DVec3 axis(matrix[c]);
        const double length = std::sqrt(glm::dot(axis, axis));
        known[std::size_t(c)] = length > 1e-150 && std::isfinite(length);
        if (known[std::size_t(c)]) axes[c] = axis / length;
    }
    if (!known[0] && known[1] && known[2]) axes[0] = glm::cross(axes[1], axes[2]);
    if (known[0] && !known[1] && known[2]) axes[1] = glm::cross(axes[2], axes[0]);
    if (known[0] && known[1] && !known[2]) axes[2] = glm::cross(axes[0], axes[1]);
    return axes;
}

}  // namespace

DMat4 compose(const LocalTransform& local)
{
    const double x = local.rotation.x, y = local.rotation.y, z = local.rotation.z, w = local.rotation.w;
    const DVec3 c0(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w));
    const DVec3 c1(2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w));
    const DVec3 c2(2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y));
    return DMat4(glm::dvec4(c0 * local.scale.x, 0.0), glm::dvec4(c1 * local.scale.y, 0.0), glm::dvec4(c2 * local.scale.z, 0.0),
                 glm::dvec4(local.translation, 1.0));
}

glm::dvec4 slerp(const glm::dvec4& from, glm::dvec4 to, double t)
{
    double cosine = glm::dot(from, to);
    if (cosine < 0.0) {
        to = -to;
        cosine = -cosine;
    }
    const glm::dvec4 across = to - from * cosine;
    const double sine = std::sqrt(glm::dot(across, across));
    if (sine < 1e-9) return from + (to - from) * t;  // the chord; its length differs from 1 by less than 1e-18
    const double angle = arcTangent2(sine, cosine);
    const SinCos part = sinCos(t * angle);
    return from * part.cos + across * (part.sin / sine);
}

void sampleChannel(const Channel& channel, float time, std::span<double> value)
{
    assert(value.size() == std::size_t(channel.width));
    const std::size_t width = value.size();
    const Span s = spanAt(channel.times, time);
    const bool cubic = channel.interpolation == Interpolation::cubicSpline;
    // part: 0 in-tangent, 1 value, 2 out-tangent for splines.
    const auto key = [&](std::size_t k, std::size_t part, std::size_t c) { return double(channel.values[cubic ? (3 * k + part) * width + c : k * width + c]); };
    const bool rotation = channel.property == Property::rotation;

    if (s.k0 == s.k1 || channel.interpolation == Interpolation::step) {
        for (std::size_t c = 0; c < width; ++c) value[c] = key(s.k0, 1, c);
    } else if (cubic) {
        const double t = s.t, t2 = t * t, t3 = t2 * t;
        for (std::size_t c = 0; c < width; ++c)
            value[c] = (2.0 * t3 - 3.0 * t2 + 1.0) * key(s.k0, 1, c) + s.duration * (t3 - 2.0 * t2 + t) * key(s.k0, 2, c) +
                       (3.0 * t2 - 2.0 * t3) * key(s.k1, 1, c) + s.duration * (t3 - t2) * key(s.k1, 0, c);
    } else if (rotation) {
        std::array<double, 4> ends[2];
        for (std::size_t c = 0; c < 4; ++c) ends[0][c] = key(s.k0, 1, c), ends[1][c] = key(s.k1, 1, c);
        normalize(ends[0]);
        normalize(ends[1]);
        const glm::dvec4 q = slerp({ends[0][0], ends[0][1], ends[0][2], ends[0][3]}, {ends[1][0], ends[1][1], ends[1][2], ends[1][3]}, s.t);
        for (int c = 0; c < 4; ++c) value[std::size_t(c)] = q[c];
    } else {
        for (std::size_t c = 0; c < width; ++c) value[c] = key(s.k0, 1, c) + (key(s.k1, 1, c) - key(s.k0, 1, c)) * s.t;
    }
    if (rotation) normalize(value);
}

bool Pose::sameAs(const Pose& other) const
{
    const auto same = [](const auto& a, const auto& b) {
        return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
    };
    return same(worldFromNode, other.worldFromNode) && same(turned, other.turned) &&
           std::equal(weights.begin(), weights.end(), other.weights.begin(), other.weights.end(), same);
}

Pose poseNodes(const Asset& asset, int animation, float time, const DVec3& origin, const std::optional<DMat4>& placement)
{
    Pose pose;
    std::vector<LocalTransform> locals;
    for (const Node& node : asset.nodes) {
        locals.push_back({.translation = node.translation, .scale = node.scale, .rotation = node.rotation});
        pose.weights.push_back(!node.weights.empty() || node.mesh < 0 ? node.weights : asset.meshes[std::size_t(node.mesh)].weights);
    }
    if (animation >= 0)
        for (const Channel& channel : asset.animations[std::size_t(animation)].channels)
            applyChannel(channel, time, locals[std::size_t(channel.node)], pose.weights[std::size_t(channel.node)]);

    pose.worldFromNode.assign(asset.nodes.size(), DMat4(1.0));
    pose.turned.assign(asset.nodes.size(), glm::dmat3(1.0));
    for (const int i : asset.parentsFirst) {
        const Node& node = asset.nodes[std::size_t(i)];
        DMat4 local = node.hasMatrix ? node.matrix : compose(locals[std::size_t(i)]);
        if (node.parent < 0 && placement) local = *placement * local;
        if (node.parent < 0) local[3] -= glm::dvec4(origin, 0.0);
        pose.worldFromNode[std::size_t(i)] = node.parent < 0 ? local : pose.worldFromNode[std::size_t(node.parent)] * local;

        const LocalTransform unscaled{.translation = DVec3(0.0), .scale = DVec3(1.0), .rotation = locals[std::size_t(i)].rotation};
        glm::dmat3 turn = node.hasMatrix ? axesOf(node.matrix) : glm::dmat3(compose(unscaled));
        if (node.parent < 0 && placement) turn = axesOf(*placement) * turn;
        pose.turned[std::size_t(i)] = node.parent < 0 ? turn : pose.turned[std::size_t(node.parent)] * turn;
    }
    return pose;
}

}  // namespace lrsm::gltf
