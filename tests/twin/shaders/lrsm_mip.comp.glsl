// One mip of all layers from the stored one below it.

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform TEXTURE radianceBelow;
layout(binding = 1) uniform TEXTURE normalBelow;
layout(binding = 2) uniform TEXTURE depthBelow;
layout(binding = 0, HALF_FORMAT) writeonly uniform IMAGE outRadiance;
layout(binding = 1, HALF_FORMAT) writeonly uniform IMAGE outNormal;
layout(binding = 2, UNORM_FORMAT) writeonly uniform IMAGE outDepth;
uniform int resolution, level;  // of the level made

ivec3 childOf(ivec3 at, int i)
{
#ifdef PLANT_lrsm_mip_shift
    return ivec3(min(2 * at.xy + ivec2(i & 1, i >> 1) + 1, ivec2(2 * resolution - 1)), at.z);
#else
    return ivec3(2 * at.xy + ivec2(i & 1, i >> 1), at.z);
#endif
}

vec4 box(vec4 a, vec4 b, vec4 c, vec4 d)
{
    precise vec4 mean = 0.25 * ((a + b) + (c + d));
    return mean;
}

vec4 halves(TEXTURE below, ivec3 at)
{
    vec4 c[4];
    for (int i = 0; i < 4; ++i) c[i] = FROM_HALF(texelFetch(below, childOf(at, i), level - 1));
    return box(c[0], c[1], c[2], c[3]);
}

vec4 unorms(TEXTURE below, ivec3 at)
{
    vec4 c[4];
    for (int i = 0; i < 4; ++i) c[i] = FROM_UNORM16(texelFetch(below, childOf(at, i), level - 1));
    return box(c[0], c[1], c[2], c[3]);
}

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at.xy, ivec2(resolution)))) return;
    imageStore(outRadiance, at, HALF(halves(radianceBelow, at)));
    imageStore(outNormal, at, HALF(halves(normalBelow, at)));
    imageStore(outDepth, at, UNORM16(unorms(depthBelow, at)));
}
