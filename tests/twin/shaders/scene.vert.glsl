// The scene's triangles through a world-to-clip matrix.

layout(std430, binding = 0) readonly buffer Positions { float positions[]; };
layout(std430, binding = 1) readonly buffer Triangles { uint triangles[]; };
layout(std430, binding = 2) readonly buffer Normals { float normals[]; };
layout(std430, binding = 3) readonly buffer TriangleMeshes { uint meshOfTriangle[]; };
layout(std430, binding = 4) readonly buffer Meshes { uint meshes[]; };  // 6 a mesh, material first
uniform mat4 clipFromWorld;

out vec3 vPosition, vNormal;
flat out vec3 vGeometricNormal;
flat out uint vMesh, vMaterial;

vec3 positionOf(uint vertex) { return vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]); }

void main()
{
    uint triangle = uint(gl_VertexID / 3), vertex = triangles[gl_VertexID];
    vec3 a = positionOf(triangles[3u * triangle]), b = positionOf(triangles[3u * triangle + 1u]), c = positionOf(triangles[3u * triangle + 2u]);
    vPosition = positionOf(vertex);
    vNormal = vec3(normals[3u * vertex], normals[3u * vertex + 1u], normals[3u * vertex + 2u]);
    vGeometricNormal = normalize(cross(b - a, c - a));
    vMesh = meshOfTriangle[triangle];
    vMaterial = meshes[6u * vMesh];
    gl_Position = clipFromWorld * vec4(vPosition, 1.0);
#ifndef PLANT_rsm_v
    gl_Position.y = -gl_Position.y;  // row 0 is the first, and the top
#endif
}
