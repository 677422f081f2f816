#include "conetrace/specular_albedo.h"

#include "core/base/elementary.h"
#include "core/base/parallel.h"
#include "core/scene/brdf.h"

namespace lrsm {
namespace {

constexpr int kPolar = 24, kAzimuth = 24;
constexpr float kSmallestRoughness = 0.05f;  // a narrower lobe's albedo differs by less than the quadrature's own error

/// Integrates the lobe by stratified points of its own microfacet normals: sum of f_s <n.l> / pdf, pdf = D <n.h> / (4 <v.h>).
float integrateLobe(const Surface& surface, float nDotV)
{
    const Vec3 v(std::sqrt(std::max(0.0f, 1.0f - nDotV * nDotV)), 0.0f, nDotV);
    const float alpha = surface.roughness * surface.roughness, a2 = alpha * alpha;
    double sum = 0.0;
    for (int i = 0; i < kPolar; ++i) {
        const float u = (static_cast<float>(i) + 0.5f) / kPolar;
        const float cosH = std::sqrt((1.0f - u) / (1.0f + (a2 - 1.0f) * u)), sinH = std::sqrt(std::max(0.0f, 1.0f - cosH * cosH));
        for (int k = 0; k < kAzimuth; ++k) {
            const SinCos phi = sinCos(2.0 * 3.14159265358979323846 * (k + 0.5) / kAzimuth);
            const Vec3 h(sinH * float(phi.cos), sinH * float(phi.sin), cosH);
            const float vDotH = glm::dot(v, h);
            const Vec3 l = 2.0f * vDotH * h - v;
            if (!(vDotH > 0.0f && l.z > 0.0f)) continue;
            const float q = cosH * cosH * (a2 - 1.0f) + 1.0f, density = a2 / (kPi * q * q);
            const float pdf = density * cosH / (4.0f * vDotH);
            sum += double(evaluateSpecular(surface, l, v).x / pdf);
        }
    }
    return static_cast<float>(sum / (kPolar * kAzimuth));
}

}  // namespace

SpecularAlbedo::SpecularAlbedo() : table_(kSize * kSize)
{
    parallelFor(kSize, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t r = begin; r < end; ++r) {
            for (int i = 0; i < kSize; ++i) {
                Surface surface;
                surface.normal = surface.geometricNormal = Vec3(0, 0, 1);
                surface.roughness = std::max(kSmallestRoughness, static_cast<float>(r) / (kSize - 1));
                const float nDotV = std::max(0.02f, static_cast<float>(i) / (kSize - 1));
                surface.specularColor = Vec3(1.0f);
                const float full = integrateLobe(surface, nDotV);
                surface.specularColor = Vec3(0.5f);
                const float half = integrateLobe(surface, nDotV);
                table_[r * kSize + std::size_t(i)] = Vec2(2.0f * (full - half), full - 2.0f * (full - half));
            }
        }
    });
}

Vec3 SpecularAlbedo::operator()(const Vec3& specularColor, float nDotV, float roughness) const
{
    const float x = std::clamp(nDotV, 0.0f, 1.0f) * (kSize - 1), y = std::clamp(roughness, 0.0f, 1.0f) * (kSize - 1);
    const int x0 = std::min(static_cast<int>(x), kSize - 2), y0 = std::min(static_cast<int>(y), kSize - 2);
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    const Vec2* row = table_.data() + y0 * kSize + x0;
    const Vec2 top = row[0] * (1.0f - fx) + row[1] * fx, bottom = row[kSize] * (1.0f - fx) + row[kSize + 1] * fx;
    const Vec2 scaleBias = top * (1.0f - fy) + bottom * fy;
    return glm::clamp(specularColor * scaleBias.x + scaleBias.y, 0.0f, 1.0f);
}

}  // namespace lrsm
