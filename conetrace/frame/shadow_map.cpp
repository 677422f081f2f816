#include "conetrace/frame/shadow_map.h"

#include <algorithm>

namespace lrsm {
namespace {

constexpr float kDepthRounding = 0x1p-21f;  // of the range, where depth is stored in float32 ...
constexpr float kPlaceRounding = 0x1p-21f;  // ... and of the distance that it is worked out from: a few roundings are no occluder

/// The plane of one receiver as the texels of a map see it.
class ReceiverPlane {
  public:
    ReceiverPlane(const LightProjection& projection, const ShadowReceiver& receiver, const LightSpacePoint& p, float biasTexels)
        : q_(projection),
          normal_(glm::dot(receiver.geometricNormal, projection.right), glm::dot(receiver.geometricNormal, projection.up),
                  glm::dot(receiver.geometricNormal, projection.forward)),
          perTexel_(2.0f * projection.halfWidth / float(projection.resolution)),
          x_(p.u * float(projection.resolution)),
          y_(p.v * float(projection.resolution)),
          depth_(p.depth),
          texelSize_(p.texelSize / projection.depthRange()),
          biasTexels_(biasTexels),
          distance_(projection.type == LightType::directional ? projection.halfWidth : depth_ * projection.depthRange() + projection.depthNear)
    {
        if (q_.type == LightType::directional) return;
        const Vec3 ray = rayThrough(x_, y_);
        cosine_ = glm::dot(normal_, ray) / glm::length(ray);
    }

    /// Is the surface that texel (x, y) holds in front of the plane, as seen through the texel's centre?
    bool occludedAt(int x, int y, float stored) const
    {
        const float cx = float(x) + 0.5f, cy = float(y) + 0.5f;
        return q_.type == LightType::directional ? occludedAlongAxis(cx, cy, stored) : occludedFromPoint(cx, cy, stored);
    }

  private:
    /// In the light's frame (right, up, forward), 1 along the axis.
    Vec3 rayThrough(float x, float y) const { return Vec3(x * perTexel_ - q_.halfWidth, q_.halfWidth - y * perTexel_, 1.0f); }

    bool occludedAlongAxis(float x, float y, float stored) const
    {
        const float cosine = -normal_.z;
        if (cosine < kGrazingCosine) return false;
        // n . (d right, d up, d forward) = 0 along the plane; v grows downwards.
        const float shift = (normal_.x * (x - x_) - normal_.y * (y - y_)) * perTexel_ / cosine;
        return nearer(stored, depth_ + shift / q_.depthRange(), cosine);
    }

    bool occludedFromPoint(float x, float y, float stored) const
    {
        const Vec3 ray = rayThrough(x, y);
        const float cosine = -glm::dot(normal_, ray) / glm::length(ray);
        if (cosine < kGrazingCosine) return false;
        // Both rays meet one plane: distance times cosine is its distance from the light.
        const float distance = distance_ * (-cosine_ / cosine);
        return nearer(stored, (distance - q_.depthNear) / q_.depthRange(), cosine);
    }

    bool nearer(float stored, float plane, float cosine) const
    {
        const float rounding = kDepthRounding + kPlaceRounding * distance_ / q_.depthRange();
        const float slope = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)) / cosine;
        const float bias = texelSize_ * (biasTexels_ * (std::min(slope, kMaxBiasSlope) + kFlatBias) + kSnappingTexels * slope);
        return stored + bias + rounding < plane;
    }

    const LightProjection& q_;
    Vec3 normal_;  ///< in the light's frame
    float perTexel_;
    float x_, y_, depth_;  ///< of p: texels, and linear depth
    float texelSize_;      ///< linear depth
    float biasTexels_;
    float distance_;       ///< of p from the light, metres; directional: the map's half width
    float cosine_ = 0.0f;  ///< between the normal and the light's ray to p: negative
};

struct Lookup {
    const DepthMapView& map;
    ReceiverPlane plane;

    float visibility(int x, int y) const
    {
        const int n = map.projection.resolution;
        if (x < 0 || y < 0 || x >= n || y >= n) return 1.0f;
        const float stored = map.depthLinear.at(x, y);
        return stored < 1.0f && plane.occludedAt(x, y, stored) ? 0.0f : 1.0f;
    }
};

bool inMap(const LightSpacePoint& p)
{
    return p.valid && p.u >= 0.0f && p.u < 1.0f && p.v >= 0.0f && p.v < 1.0f;
}

}  // namespace

float shadowFromMap(const DepthMapView& map, const ShadowReceiver& receiver, float biasTexels)
{
    const LightProjection& q = map.projection;
    const LightSpacePoint p = projectToLight(q, receiver.position);
    if (!inMap(p)) return 1.0f;
    const int last = q.resolution - 1;
    const int x = std::min(last, static_cast<int>(p.u * float(q.resolution))), y = std::min(last, static_cast<int>(p.v * float(q.resolution)));
    return Lookup{map, {q, receiver, p, biasTexels}}.visibility(x, y);
}

float shadowFromMapFiltered(const DepthMapView& map, const ShadowReceiver& receiver, float biasTexels, float widthTexels)
{
    const LightProjection& q = map.projection;
    const LightSpacePoint p = projectToLight(q, receiver.position);
    if (!inMap(p)) return 1.0f;
    const Lookup lookup{map, {q, receiver, p, biasTexels}};
    const float left = p.u * float(q.resolution) - 0.5f * widthTexels, top = p.v * float(q.resolution) - 0.5f * widthTexels;
    const float right = left + widthTexels, bottom = top + widthTexels;
    const auto overlap = [](int texel, float from, float to) { return std::min(to, float(texel + 1)) - std::max(from, float(texel)); };

    float sum = 0.0f;
    for (int y = static_cast<int>(std::floor(top)); float(y) < bottom; ++y)
        for (int x = static_cast<int>(std::floor(left)); float(x) < right; ++x)
            sum += overlap(x, left, right) * overlap(y, top, bottom) * lookup.visibility(x, y);
    return std::min(1.0f, sum / (widthTexels * widthTexels));
}

}  // namespace lrsm
