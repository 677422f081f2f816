// One level of a radiance volume for one direction of travel. FROM_BASE: of the voxels; else of the level below.

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(binding = 0) uniform usampler3D below;    // FROM_BASE: rgb, occlusion; else level l is its level l - 1
layout(binding = 1) uniform usampler3D normals;  // FROM_BASE
layout(binding = 0, rgba16ui) writeonly uniform uimage3D target;
uniform int resolution, level, axis, backwards;  // of the level made
uniform float facing;

vec4 childAt(ivec3 at)
{
#ifdef FROM_BASE
    vec4 texel = floatFromHalf(texelFetch(below, at, 0));
    vec3 n = floatFromHalf(texelFetch(normals, at, 0)).xyz;
    float along = backwards == 1 ? -n[axis] : n[axis];
    return along > facing * length(n) ? vec4(0.0, 0.0, 0.0, texel.w) : texel;
#else
    return floatFromHalf(texelFetch(below, at, level - 2));
#endif
}

// The column at (i, j) of the other two axes, the lower one first.
vec4 column(ivec3 texel, int i, int j)
{
    ivec3 near = 2 * texel, far;
    near[axis == 0 ? 1 : 0] += i;
    near[axis == 2 ? 1 : 2] += j;
    far = near;
    if (backwards == 1)
        near[axis] += 1;
    else
        far[axis] += 1;
#ifdef PLANT_vct_front
    ivec3 kept = near;
    near = far;
    far = kept;
#endif
    vec4 f = childAt(near), b = childAt(far);
    precise vec4 seen = f + (1.0 - f.w) * b;
    return seen;
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel, ivec3(resolution)))) return;
    precise vec4 mean = 0.25 * ((column(texel, 0, 0) + column(texel, 1, 0)) + (column(texel, 0, 1) + column(texel, 1, 1)));
    imageStore(target, texel, halfFromFloat(mean));
}
