// One level of the opacity pyramid. FROM_BITS: of the voxels themselves; else of the level below.
// DIRECTIONAL: three values a texel. FILTER: 0 mean, 1 coverage, 2 max.

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(std430, binding = 0) readonly buffer Bits { uint words[]; };
layout(binding = 0) uniform usampler3D below;  // level l is its level l - 1
#ifdef DIRECTIONAL
layout(binding = 0, rgba8ui) writeonly uniform uimage3D target;
#else
layout(binding = 0, r8ui) writeonly uniform uimage3D target;
#endif
uniform int resolution, level;

uint bitAt(ivec3 p)
{
    int byte_ = (p.z * resolution + p.y) * ((resolution + 7) / 8) + p.x / 8;
    return (words[byte_ >> 2] >> (8 * (byte_ & 3) + (p.x & 7))) & 1u;
}

uvec4 childAt(ivec3 p)
{
#ifdef PLANT_mip_shift
    p = min(p + 1, ivec3((resolution >> (level - 1)) - 1));
#endif
#ifdef FROM_BITS
    return uvec4(255u * bitAt(p));
#else
    return texelFetch(below, p, level - 2);
#endif
}

uvec4 filtered(ivec3 texel)
{
    uvec4 sum = uvec4(0), most = uvec4(0);
    for (int k = 0; k < 8; ++k) {
        uvec4 child = childAt(2 * texel + ivec3(k & 1, (k >> 1) & 1, k >> 2));
        sum += child;
        most = max(most, child);
    }
#if FILTER == 0
    return (sum + 4u) >> 3;
#elif FILTER == 1
    return min((sum + 2u) >> 2, uvec4(255));
#else
    return most;
#endif
}

// Share of the block's columns along `axis` that hold any voxel.
uint coverage(ivec3 texel, int axis)
{
    int edge = 1 << level;
    uint columns = 0u;
    for (int b = 0; b < edge; ++b)
        for (int a = 0; a < edge; ++a) {
            uint any_ = 0u;
            for (int c = 0; c < edge; ++c) {
                ivec3 inBlock = axis == 0 ? ivec3(c, a, b) : axis == 1 ? ivec3(a, c, b) : ivec3(a, b, c);
                ivec3 p = texel * edge + inBlock;
#ifdef PLANT_mip_shift
                p = min(p + 1, ivec3(resolution - 1));
#endif
                any_ |= bitAt(p);
            }
            columns += any_;
        }
    int shift = 2 * level;
    return (columns * 255u + ((1u << shift) >> 1)) >> shift;
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel, ivec3(resolution >> level)))) return;
#if defined(DIRECTIONAL) && defined(FROM_BITS)
    imageStore(target, texel, uvec4(coverage(texel, 0), coverage(texel, 1), coverage(texel, 2), 0));
#else
    imageStore(target, texel, filtered(texel));
#endif
}
