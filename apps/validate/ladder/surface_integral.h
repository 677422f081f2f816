#pragma once

#include "conetrace/lrsm/march.h"
#include "core/bvh/embree_scene.h"
#include "reference/integrator.h"

/// What rays through the triangles say: the tops of both ladders.
namespace lrsm {

/// Seeds the rays of one cone sample; independent of threads.
struct SampleKey {
    std::uint32_t pixel = 0, coneAndStep = 0;
    std::uint64_t seed = 0;
};

struct SurfaceIntegral {
    Vec3 radiance{0.0f};    ///< L of Eq. 2, summed over lights; 0 where there is no surface
    double coverage = 0.0;  ///< fraction of the disk's rays that meet a surface inside the sphere
    double noise = 0.0;     ///< of the mean of the three channels: half the difference of two halves of the rays, an upper estimate
};

/// Eq. 2 for a sphere: `side`^2 rays along -v_c, stratified over the disk that the sphere shows to the receiver, each from where it enters the sphere to where
/// it leaves. Equal areas of the disk are equal w V(x, v) <n.v> dA (w a box over the sphere), so the ratio of the integrals is the mean radiance over the
/// rays that meet a surface; V(x, v) is visibility within the sphere. The back of a single-sided surface hides what is behind it and is no surface itself: its
/// <n.v> is clamped to 0.
SurfaceIntegral integrateSurface(Tracer& tracer, const ConeSample& sphere, int side, const SampleKey& key);

/// A stretch of a cone taken as a cylinder: `begin` is the middle of the end nearest to the receiver.
struct Beam {
    Vec3 begin{0.0f}, direction{0.0f, 0.0f, 1.0f};  ///< direction unit, away from the receiver
    float radius = 0.0f, length = 0.0f;
};

/// Mean over `side`^2 stratified rays along the beam of the radiance of the first surface met, 0 where there is none.
Vec3 integrateBeam(Tracer& tracer, const Beam& beam, int side, const SampleKey& key);

/// Directions that fill a cone's solid angle evenly: `side`^2 of them, stratified.
std::vector<Vec3> coneBundle(const Vec3& axis, float tanHalf, int side, const SampleKey& key);

}  // namespace lrsm
