// 5x5 box of width 4 over the pixels of the same surface. LOBES: of what wide specular lobes show, each by its weight besides.

layout(std430, binding = 7) writeonly buffer Out { float filteredOut[]; };
#ifdef LOBES
layout(std430, binding = 9) readonly buffer Specular { vec4 specular[]; };
layout(std430, binding = 10) readonly buffer LobeWeight { float lobeWeight[]; };
uniform float leastSampledRoughness;
// Of pixel j in the mean of pixel i: light, and weight.
vec4 lightOf(int i, int j)
{
    bool alone = gRoughness[i] < leastSampledRoughness;
    float weight = alone ? float(i == j) : gRoughness[j] < leastSampledRoughness ? 0.0 : lobeWeight[j];
    return vec4(weight * specular[j].rgb, weight);
}
#else
layout(std430, binding = 9) readonly buffer Irradiance { float irradiance[]; };
vec4 lightOf(int i, int j)
{
    return vec4(VEC3(irradiance, j), 1.0);
}
#endif

bool sameSurface(int a, int b)
{
    if (gObjectId[b] == 0u || dot(VEC3(gNormal, a), VEC3(gNormal, b)) < 0.9) return false;
    vec3 between = VEC3(gPosition, b) - VEC3(gPosition, a);
    float limit = 0.1 * 0.1 * dot(between, between), fromA = dot(between, VEC3(gGeometricNormal, a)), fromB = dot(between, VEC3(gGeometricNormal, b));
    return fromA * fromA <= limit && fromB * fromB <= limit;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= width || at.y >= height) return;
    int i = at.y * width + at.x;
    vec4 sum = vec4(0);
    if (gObjectId[i] != 0u)
        for (int dy = -2; dy <= 2; ++dy)
            for (int dx = -2; dx <= 2; ++dx) {
                ivec2 to = at + ivec2(dx, dy);
                if (to.x < 0 || to.y < 0 || to.x >= width || to.y >= height) continue;
                int j = to.y * width + to.x;
                if (j != i && !sameSurface(i, j)) continue;
                float weight = (abs(dx) == 2 ? 0.5 : 1.0) * (abs(dy) == 2 ? 0.5 : 1.0);
#ifdef PLANT_filter_edges
                weight = 1.0;
#endif
                sum += weight * lightOf(i, j);
            }
    vec3 mean = sum.w > 0.0 ? sum.rgb / sum.w : vec3(0);
    for (int c = 0; c < 3; ++c) filteredOut[3 * i + c] = mean[c];
}
