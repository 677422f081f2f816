#include "conetrace/frame/specular_albedo.h"

#include "core/base/elementary.h"
#include "core/base/parallel.h"
#include "core/scene/brdf.h"

namespace lrsm {
namespace {

constexpr int kPolar = 48, kAzimuth = 24;    // over half the lobe: it is symmetric about the plane of n and v
constexpr float kSmallestRoughness = 0.05f;  // a narrower lobe's albedo differs by less than the quadrature's own error
constexpr float kSmallestCosine = 0.002f;

/// Directional albedo for F0 = 1 and F0 = 1/2, by stratified points of the lobe's own microfacet normals: mean of f_s <n.l> / pdf,
/// pdf = D <n.h> / (4 <v.h>).
Vec2 integrateLobe(float roughness, float nDotV)
{
    Surface surface;
    surface.normal = surface.geometricNormal = Vec3(0, 0, 1);
    surface.specularColor = Vec3(1.0f, 0.5f, 0.5f);
    surface.roughness = roughness;
    const Vec3 v(std::sqrt(std::max(0.0f, 1.0f - nDotV * nDotV)), 0.0f, nDotV);
    const float alpha = roughness * roughness, a2 = alpha * alpha;
    double full = 0.0, half = 0.0;
    for (int i = 0; i < kPolar; ++i) {
        // u = 1 - rest^2 is uniform under the lobe's own density: more points, of less weight, in its long tail.
        const float rest = (static_cast<float>(i) + 0.5f) / kPolar, u = 1.0f - rest * rest, weight = 2.0f * rest;
        const float cosH = std::sqrt((1.0f - u) / (1.0f + (a2 - 1.0f) * u)), sinH = std::sqrt(std::max(0.0f, 1.0f - cosH * cosH));
        for (int k = 0; k < kAzimuth; ++k) {
            const SinCos phi = sinCos(3.14159265358979323846 * (k + 0.5) / kAzimuth);
            const Vec3 h(sinH * float(phi.cos), sinH * float(phi.sin), cosH);
            const float vDotH = glm::dot(v, h);
            const Vec3 l = 2.0f * vDotH * h - v;
            if (!(vDotH > 0.0f && l.z > 0.0f)) continue;
            const float q = cosH * cosH * (a2 - 1.0f) + 1.0f, density = a2 / (kPi * q * q);
            const float pdf = density * cosH / (4.0f * vDotH);
            const Vec3 reflected = evaluateSpecular(surface, l, v) * (weight / pdf);
            full += double(reflected.x);
            half += double(reflected.y);
        }
    }
    return Vec2(float(full / (kPolar * kAzimuth)), float(half / (kPolar * kAzimuth)));
}

}  // namespace

SpecularAlbedo::SpecularAlbedo() : table_(kRoughnessSize * kCosineSize)
{
    parallelFor(kRoughnessSize, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t r = begin; r < end; ++r) {
            const float roughness = std::max(kSmallestRoughness, static_cast<float>(r) / (kRoughnessSize - 1));
            for (int i = 0; i < kCosineSize; ++i) {
                const float root = static_cast<float>(i) / (kCosineSize - 1);
                const Vec2 albedo = integrateLobe(roughness, std::max(kSmallestCosine, root * root));
                const float scale = 2.0f * (albedo.x - albedo.y);
                table_[r * kCosineSize + std::size_t(i)] = Vec2(scale, albedo.x - scale);
            }
        }
    });
}

Vec3 SpecularAlbedo::operator()(const Vec3& specularColor, float nDotV, float roughness) const
{
    const auto unit = [](float v) { return v > 0.0f ? std::min(v, 1.0f) : 0.0f; };  // NaN becomes 0
    const float x = std::sqrt(unit(nDotV)) * (kCosineSize - 1);
    const float y = unit(roughness) * (kRoughnessSize - 1);
    const int x0 = std::min(static_cast<int>(x), kCosineSize - 2), y0 = std::min(static_cast<int>(y), kRoughnessSize - 2);
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    const Vec2* row = table_.data() + y0 * kCosineSize + x0;
    const Vec2 top = row[0] * (1.0f - fx) + row[1] * fx, bottom = row[kCosineSize] * (1.0f - fx) + row[kCosineSize + 1] * fx;
    const Vec2 scaleBias = top * (1.0f - fy) + bottom * fy;
    return glm::clamp(specularColor * scaleBias.x + scaleBias.y, 0.0f, 1.0f);
}

}  // namespace lrsm
