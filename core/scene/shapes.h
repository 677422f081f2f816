#pragma once

#include "core/scene/scene.h"

#include <span>

/// Building blocks of the built-in scenes and tests. Every shape gets flat normals unless it says otherwise.
namespace lrsm {

/// A planar quad a, b, c, d, counter-clockwise seen from its front.
void addQuad(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Axis-aligned box; `inward` turns its faces to the inside (a room).
void addBox(Mesh& mesh, const Vec3& min, const Vec3& max, bool inward = false);

/// Vertical prism over a horizontal polygon (counter-clockwise seen from above), closed by a top and a bottom.
void addPrism(Mesh& mesh, std::span<const Vec2> outlineXz, float yMin, float yMax);

/// Vertical column of `sides` faces with smooth normals, without caps.
void addColumn(Mesh& mesh, const Vec3& foot, float radius, float height, int sides);

/// Sphere of 8 * 4^subdivisions triangles (a subdivided octahedron) with smooth normals; `inward` turns it inside out.
void addSphere(Mesh& mesh, const Vec3& centre, float radius, int subdivisions, bool inward = false);

/// A diffuse material (metallic 0, roughness 1: no specular part).
Material diffuseMaterial(const std::string& name, const Vec3& albedo, bool doubleSided = false);

/// Lights and cameras from what a person would say; `up` is chosen by basisFromNormal (lights) or made orthogonal (cameras).
Light spotLight(const Vec3& position, const Vec3& target, const Vec3& intensity, float innerConeAngleRadians, float outerConeAngleRadians);
Light directionalLight(const Vec3& directionWorld, const Vec3& irradiance);
Camera lookAt(const Vec3& eye, const Vec3& target, const Vec3& up, float verticalFovRadians);

/// Sets Scene::bounds from the vertices that triangles use.
void updateBounds(Scene& scene);

}  // namespace lrsm
