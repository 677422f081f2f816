// Direct light, reflected once towards the eye. SHADOWS: 0 hard, 1 pcf, 2 cone, 3 off.

layout(binding = 0) uniform sampler2DArray mapDepth;  // of the RSMs, or of maps of their own
layout(std430, binding = 7) writeonly buffer Out { float radianceOut[]; };
uniform int lightCount;
uniform vec3 origin;
uniform float mapResolution, pcfWidthTexels, depthBiasTexels, flatBias, maxBiasSlope, snappingTexels, grazingCosine;
uniform float voxelSize, tanHalfAperture, minSpecularAlpha;

// The ray of a place on the map, in texels; in the light's frame, 1 along its axis.
vec3 mapRay(Light light, vec2 at)
{
    float perTexel = 2.0 * light.right.w / mapResolution;
    return vec3(at.x * perTexel - light.right.w, light.right.w - at.y * perTexel, 1.0);
}

// Is what a texel holds in front of the receiver's plane, as seen through the texel's centre?
float texelShadow(int index, ivec2 texel, LightSpacePoint p, vec3 nGeometric)
{
    Light light = lights[index];
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(mapResolution)))) return 1.0;
    float stored = texelFetch(mapDepth, ivec3(texel, index), 0).r;
    if (stored >= 1.0) return 1.0;
    float range = light.forward.w - light.up.w, texelSize = p.texelSize * light.layers.z / mapResolution;
    vec3 normal = vec3(dot(nGeometric, light.right.xyz), dot(nGeometric, light.up.xyz), dot(nGeometric, light.forward.xyz));
    vec2 centre = vec2(texel) + 0.5, here = p.uv * mapResolution;
    float cosine, plane;
    if (light.position.w == 0.0) {
        cosine = -normal.z;
        plane = p.depth + (normal.x * (centre.x - here.x) - normal.y * (centre.y - here.y)) * texelSize / cosine / range;
    } else {
        vec3 ray = mapRay(light, centre), rayHere = mapRay(light, here);
        cosine = -dot(normal, ray) / length(ray);
        plane = ((p.depth * range + light.up.w) * (-dot(normal, rayHere) / length(rayHere) / cosine) - light.up.w) / range;
    }
    if (cosine < grazingCosine) return 1.0;
    float slope = sqrt(max(0.0, 1.0 - cosine * cosine)) / cosine;
    float bias = texelSize / range * (depthBiasTexels * (min(slope, maxBiasSlope) + flatBias) + snappingTexels * slope);
    bias += (1.0 + (light.position.w == 0.0 ? light.right.w : p.depth * range + light.up.w) / range) / 2097152.0;
#ifdef PLANT_shadow_bias
    bias = 0.0;
    plane = p.depth;
#endif
    return stored + bias < plane ? 0.0 : 1.0;
}

float mapShadow(int index, vec3 world, vec3 nGeometric)
{
    LightSpacePoint p = projectToLight(lights[index], world);
    if (!p.valid || any(lessThan(p.uv, vec2(0))) || any(greaterThanEqual(p.uv, vec2(1)))) return 1.0;
#if SHADOWS == 0
    return texelShadow(index, min(ivec2(p.uv * mapResolution), ivec2(mapResolution) - 1), p, nGeometric);
#else
    vec2 low = p.uv * mapResolution - 0.5 * pcfWidthTexels, high = low + pcfWidthTexels;
    float sum = 0.0;
    for (int y = int(floor(low.y)); float(y) < high.y; ++y)
        for (int x = int(floor(low.x)); float(x) < high.x; ++x) {
            vec2 overlap = min(high, vec2(x + 1, y + 1)) - max(low, vec2(x, y));
            sum += overlap.x * overlap.y * texelShadow(index, ivec2(x, y), p, nGeometric);
        }
    return min(1.0, sum / (pcfWidthTexels * pcfWidthTexels));
#endif
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
#if SHADOWS < 2
            float visibility = mapShadow(k, world, nGeometric);
#elif SHADOWS == 2
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
