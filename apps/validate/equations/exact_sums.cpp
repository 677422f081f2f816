// Eq. 3, 4 and 7 of Sugihara, Rauwendaal, Salvi: Layered Reflective Shadow Maps for Voxel-based Indirect Illumination, HPG 2014.
#include "apps/validate/equations/exact_sums.h"

#include <cmath>

namespace lrsm {

double texelSolidAngle(double x, double y, double halfWidth, int resolution)
{
    const double u = x * halfWidth, v = y * halfWidth, edge = 2.0 * halfWidth / resolution, s = 1.0 + u * u + v * v;
    return edge * edge / (s * std::sqrt(s));
}

bool insideSample(const TexelSample& texel, const glm::dvec3& centre, double radius)
{
    return radius - glm::length(texel.position - centre) >= 0.0;
}

double weightEq4(const TexelSample& texel, const glm::dvec3& toReceiver, bool inside)
{
    if (!inside) return std::max(0.0, glm::dot(texel.toLight, toReceiver));
    const double lit = glm::dot(texel.normal, texel.toLight);
    return lit > 0.0 ? std::max(0.0, glm::dot(texel.normal, toReceiver)) / lit : 0.0;
}

glm::dvec3 radianceEq3(std::span<const TexelSample> texels, const glm::dvec3& centre, double radius, const glm::dvec3& toReceiver)
{
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (const TexelSample& texel : texels) {
        const bool inside = insideSample(texel, centre, radius);
        const double weight = texel.solidAngle * weightEq4(texel, toReceiver, inside);
        weights += weight;
        if (inside) sum += weight * texel.radiance;
    }
    return weights > 0.0 ? sum / weights : glm::dvec3(0.0);
}

double visibilityEq7(std::span<const TexelSample> texels, const glm::dvec3& centre, double radius)
{
    double inside = 0.0, all = 0.0;
    for (const TexelSample& texel : texels) {
        all += texel.solidAngle;
        if (insideSample(texel, centre, radius)) inside += texel.solidAngle;
    }
    return all > 0.0 ? inside / all : 0.0;
}

}  // namespace lrsm
