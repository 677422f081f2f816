// A cone through radiance in voxels. SQUARED: vct_weights=squared. STEPWISE: vct_opacity=step. EXPONENTIAL: transmittance=exponential.

layout(binding = 0) uniform sampler3D base;
layout(binding = 1) uniform sampler3D normals;
layout(binding = 2) uniform sampler3D faces[6];  // +x, -x, +y ...; level l is its level l - 1
uniform int resolution, levels;
uniform float push, transmittanceCutoff, facing, preExposure;

// Distance in voxels at which a ray leaves the grid.
float gridExit(vec3 origin, vec3 direction)
{
    float exit_ = 1e30;
    for (int k = 0; k < 3; ++k)
        if (direction[k] != 0.0) exit_ = min(exit_, ((direction[k] > 0.0 ? float(resolution) : 0.0) - origin[k]) / direction[k]);
    return exit_;
}

// Each of the eight is dark where it faces away: no sampler does that.
vec4 baseAt(vec3 p, vec3 direction)
{
    vec3 place = p - 0.5, low = floor(place), f = place - low;
    vec4 c[8];
    for (int k = 0; k < 8; ++k) {
        ivec3 at = ivec3(low) + ivec3(k & 1, (k >> 1) & 1, k >> 2);
        bool inside = all(greaterThanEqual(at, ivec3(0))) && all(lessThan(at, ivec3(resolution)));
        c[k] = inside ? texelFetch(base, at, 0) : vec4(0);
        vec3 n = inside ? texelFetch(normals, at, 0).xyz : vec3(0);
#ifndef PLANT_vct_facing
        if (dot(n, direction) > facing * length(n)) c[k].rgb = vec3(0);
#endif
    }
    return mix(mix(mix(c[0], c[1], f.x), mix(c[2], c[3], f.x), f.y), mix(mix(c[4], c[5], f.x), mix(c[6], c[7], f.x), f.y), f.z);
}

vec4 volumeAt(vec3 p, vec3 direction, int level)
{
    if (level == 0) return baseAt(p, direction);
    vec3 at = p / float(resolution);
    float lod = float(level - 1);
    vec4 x = direction.x < 0.0 ? textureLod(faces[1], at, lod) : textureLod(faces[0], at, lod), y = direction.y < 0.0 ? textureLod(faces[3], at, lod) : textureLod(faces[2], at, lod),
         z = direction.z < 0.0 ? textureLod(faces[5], at, lod) : textureLod(faces[4], at, lod);
#ifdef PLANT_vct_direction
    x = textureLod(faces[0], at, lod);
#endif
#ifdef SQUARED
    vec3 w = direction * direction;
#else
    vec3 w = abs(direction);
#endif
    vec4 sum = w.x * x + w.y * y + w.z * z;
    return sum.w > 1.0 ? sum / sum.w : sum;
}

vec4 volumeLookup(vec3 p, vec3 direction, float level)
{
    level = clamp(level, 0.0, float(levels - 1));
    int lower = int(level);
    float f = level - float(lower);
    vec4 fine = volumeAt(p, direction, lower);
    return f > 0.0 ? mix(fine, volumeAt(p, direction, lower + 1), f) : fine;
}

vec4 march(vec3 originWorld, vec3 originVoxels, vec3 direction, vec3 nGeometric, int schedule)
{
    float exit_ = gridExit(originVoxels, direction), transmittance = 1.0;
    vec3 radiance = vec3(0);
    for (int i = 0; i < MAX_STEPS; ++i) {
        Step s = stepOf(schedule, i);
        if (!(s.end > s.begin) || s.middle - 3.0 * s.tapWidth > exit_) break;
        vec3 offset = direction * s.middle + nGeometric * (push * 0.5 * s.diameter);
        vec4 seen = volumeLookup(originVoxels + offset, direction, s.level);
        if (!(seen.w > 0.0)) continue;
#ifdef STEPWISE
        float x = (s.end - s.begin) / s.tapWidth;
#else
        float x = 1.0;
#endif
#ifdef EXPONENTIAL
        float behind = seen.w >= 1.0 ? 0.0 : transmittance * exp2(x * log2(1.0 - seen.w));
#else
        float behind = max(0.0, transmittance - seen.w * x);
#endif
        radiance += seen.rgb * ((transmittance - behind) / seen.w);
        transmittance = behind;
        if (transmittance < transmittanceCutoff) break;
    }
    return vec4(radiance / preExposure, 1.0 - transmittance);
}
