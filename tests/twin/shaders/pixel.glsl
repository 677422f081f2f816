// One invocation a pixel, and what the G-buffer holds there.

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer Position { float gPosition[]; };
layout(std430, binding = 1) readonly buffer GeometricNormal { float gGeometricNormal[]; };
layout(std430, binding = 2) readonly buffer Normal { float gNormal[]; };
layout(std430, binding = 3) readonly buffer Albedo { float gAlbedo[]; };
layout(std430, binding = 4) readonly buffer ObjectId { uint gObjectId[]; };
#ifdef SPECULAR
layout(std430, binding = 5) readonly buffer SpecularColor { float gSpecularColor[]; };
layout(std430, binding = 6) readonly buffer Roughness { float gRoughness[]; };
#endif
uniform int width, height;
uniform vec3 eye, forward;
uniform int perspective;

#define VEC3(array, i) vec3(array[3 * (i)], array[3 * (i) + 1], array[3 * (i) + 2])

vec3 directionToEye(vec3 world)
{
    vec3 to = eye - world;
    float distance_ = length(to);
    return perspective == 0 || !(distance_ > 0.0) ? -forward : to / distance_;
}
