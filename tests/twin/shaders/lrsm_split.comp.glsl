// 2x2 texels of the RSM to one texel of each layer that holds any of them, premultiplied by the layer's coverage.

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform usampler2D rsmRadiance;  // halves
layout(binding = 1) uniform usampler2D rsmNormal;
layout(binding = 2) uniform sampler2D rsmDepth;
layout(binding = 0, HALF_FORMAT) writeonly uniform IMAGE outRadiance;
layout(binding = 1, HALF_FORMAT) writeonly uniform IMAGE outNormal;
layout(binding = 2, UNORM_FORMAT) writeonly uniform IMAGE outDepth;

struct Layer {
    vec4 depth;   // min, max; 1 for the first and for the last slice of depth
    vec4 nDotL;   // likewise
};
layout(std430, binding = 0) readonly buffer Layers { Layer layers[]; };
uniform int baseResolution;

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at.xy, ivec2(baseResolution)))) return;
    Layer layer = layers[at.z];

    vec4 radiance[4], normal[4], depth[4];
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = 2 * at.xy + ivec2(i & 1, i >> 1);
        vec4 r = floatFromHalf(texelFetch(rsmRadiance, texel, 0)), n = floatFromHalf(texelFetch(rsmNormal, texel, 0));
        float z = texelFetch(rsmDepth, texel, 0).r;
        bool here = r.a > 0.0 && (layer.depth.z != 0.0 || z >= layer.depth.x) && (layer.depth.w != 0.0 || z < layer.depth.y) &&
                    (layer.nDotL.z != 0.0 || n.w >= layer.nDotL.x) && (layer.nDotL.w != 0.0 || n.w < layer.nDotL.y);
        float warped = (z - layer.depth.x) / (layer.depth.y - layer.depth.x);
        radiance[i] = here ? vec4(r.rgb, 0.0) : vec4(0);
        normal[i] = here ? vec4(n.xyz, 1.0) : vec4(0);
        depth[i] = here ? vec4(warped, warped * warped, 1.0, 0.0) : vec4(0);
    }
    precise vec4 r = 0.25 * ((radiance[0] + radiance[1]) + (radiance[2] + radiance[3]));
    precise vec4 n = 0.25 * ((normal[0] + normal[1]) + (normal[2] + normal[3]));
    precise vec4 z = 0.25 * ((depth[0] + depth[1]) + (depth[2] + depth[3]));
    ivec3 to = at;
#ifdef PLANT_swapped_layer
    to.z = at.z ^ 1;
#endif
    imageStore(outRadiance, to, HALF(r));
    imageStore(outNormal, to, HALF(n));
    imageStore(outDepth, to, UNORM16(z));
}
