// Direct light, reflected once towards the eye. SHADOWS: 0 hard, 1 cone, 2 off.

layout(binding = 0) uniform sampler2DArray rsmDepth;
layout(binding = 1) uniform usampler2DArray rsmRadiance;  // halves; the fourth is the coverage
layout(std430, binding = 7) writeonly buffer Out { float radianceOut[]; };
uniform int lightCount;
uniform vec3 origin;
uniform float voxelSize, depthBiasTexels, flatBias, maxBiasSlope, tanHalfAperture, minSpecularAlpha;

float hardShadow(int index, vec3 world, vec3 nGeometric, vec3 toLight)
{
    Light light = lights[index];
    LightSpacePoint p = projectToLight(light, world);
    if (!p.valid || any(lessThan(p.uv, vec2(0))) || any(greaterThanEqual(p.uv, vec2(1)))) return 1.0;
    ivec3 texel = ivec3(min(ivec2(p.uv * light.layers.z), ivec2(light.layers.z) - 1), index);
    if (texelFetch(rsmRadiance, texel, 0).a == 0u) return 1.0;
    float cosine = max(1e-3, dot(nGeometric, toLight));
    float slope = sqrt(max(0.0, 1.0 - cosine * cosine)) / cosine;
    float bias = depthBiasTexels * p.texelSize * (min(slope, maxBiasSlope) + flatBias) / (light.forward.w - light.up.w) + 1.0 / 2097152.0;
#ifdef PLANT_shadow_bias
    bias = 0.0;
#endif
    return texelFetch(rsmDepth, texel, 0).r + bias < p.depth ? 0.0 : 1.0;
}

float coneShadow(vec3 world, vec3 nGeometric, vec3 toLight, float distance_)
{
    vec3 from = (world - origin) / voxelSize + nGeometric * 1.5;
    float end = min(distance_ / voxelSize, gridExit(from, toLight));
    float transmittance = 1.0, t = 1.0;
    while (t < end && transmittance > 0.01) {
        float diameter = max(1.0, 2.0 * tanHalfAperture * t);
        vec3 tap = sampleOpacity(from + toLight * t, log2(diameter));
#ifdef DIRECTIONAL
        transmittance = max(0.0, transmittance - densityAlong(tap, toLight) * 0.5 * diameter);
#else
        transmittance *= sqrt(1.0 - min(1.0, tap.x));
#endif
        t += 0.5 * diameter;
    }
    return transmittance > 0.01 ? transmittance : 0.0;
}

// GGX, height-correlated Smith, Schlick; times <n.l>.
vec3 specular(vec3 n, vec3 f0, float roughness, vec3 toLight, vec3 toEye)
{
    float nl = dot(n, toLight), nv = dot(n, toEye);
    if (!(nl > 0.0 && nv > 0.0) || f0 == vec3(0)) return vec3(0);
    vec3 h = normalize(toLight + toEye), sine = cross(n, h);
    float nh = dot(n, h), vh = max(0.0, dot(toEye, h));
    float alpha = max(roughness * roughness, minSpecularAlpha), alpha2 = alpha * alpha;
    float spread = dot(sine, sine) + alpha2 * nh * nh, d = alpha2 / (kPi * spread * spread);
    float visibility = 0.5 / (nv * sqrt(nl * nl * (1.0 - alpha2) + alpha2) + nl * sqrt(nv * nv * (1.0 - alpha2) + alpha2));
    float grazing = 1.0 - min(vh, 1.0), grazing2 = grazing * grazing;
    return (f0 + (1.0 - f0) * (grazing2 * grazing2 * grazing)) * (d * visibility * nl);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= width || at.y >= height) return;
    int i = at.y * width + at.x;
    vec3 radiance = vec3(0);
    if (gObjectId[i] != 0u) {
        vec3 world = VEC3(gPosition, i), nGeometric = VEC3(gGeometricNormal, i), n = VEC3(gNormal, i), albedo = VEC3(gAlbedo, i);
        vec3 toEye = directionToEye(world);
        for (int k = 0; k < lightCount; ++k) {
            LightSample from = sampleLight(lights[k], world);
            float nDotL = dot(n, from.toLight);
            if (from.irradiance == vec3(0)) continue;
#ifndef PLANT_unclamped
            if (nDotL <= 0.0 || dot(nGeometric, from.toLight) <= 0.0) continue;
#endif
#if SHADOWS == 0
            float visibility = hardShadow(k, world, nGeometric, from.toLight);
#elif SHADOWS == 1
            float visibility = coneShadow(world, nGeometric, from.toLight, from.distance_);
#else
            float visibility = 1.0;
#endif
            vec3 reflected = albedo * (nDotL / kPi);
#ifdef SPECULAR
            reflected += specular(n, VEC3(gSpecularColor, i), gRoughness[i], from.toLight, toEye);
#endif
            radiance += from.irradiance * reflected * visibility;
        }
    }
    for (int c = 0; c < 3; ++c) radianceOut[3 * i + c] = radiance[c];
}
