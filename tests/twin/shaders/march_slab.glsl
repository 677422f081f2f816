// The estimator `slab`: emission and opacity integrated over segments. EXPONENTIAL: transmittance=exponential.

uniform float densityK, transmittanceCutoff, emitterDelayTaps, emitterDelayVoxels, emitterSlantCap, normalOffsetVoxels;

float transmittanceOf(float opticalDepth)
{
#ifdef EXPONENTIAL
    return exp(-densityK * opticalDepth);
#else
    return max(0.0, 1.0 - opticalDepth);
#endif
}

float opticalDepth[MAX_STEPS];  // at each segment's end

float opticalDepthAt(int schedule, int last, float t)
{
    int i = last;
    while (i > 0 && stepOf(schedule, i).begin > t) --i;
    Step s = stepOf(schedule, i);
    float before = i > 0 ? opticalDepth[i - 1] : 0.0;
    return before + (opticalDepth[i] - before) * clamp((t - s.begin) / (s.end - s.begin), 0.0, 1.0);
}

vec3 emission(Light light, vec3 world, vec3 direction, int schedule, int index)
{
    LightSpacePoint p = projectToLight(light, world);
    if (!p.valid) return vec3(0);
    Step s = stepOf(schedule, index);
    float tap = s.tapWidth * voxelSize, segment = (s.end - s.begin) * voxelSize, range = light.forward.w - light.up.w, zc = p.depth * range;
    float window = (0.5 * segment + 1.5 * tap) / range, level = lrsmLevel(tap, p.texelSize);
    vec3 toLight = directionToLight(light, world), sum = vec3(0);
    int first = int(light.layers.x), count = int(light.layers.y);
    for (int k = first; k < first + count; ++k) {
        Layer layer = layers[k];
        if (p.depth + window < layer.depthMin || p.depth - window > layer.depthMax) continue;
        vec3 at = layerCoordinates(p.uv, k);
        vec4 depth = textureLod(layerDepth, at, level), normalSum = textureLod(layerNormal, at, level);
        if (!(depth.z > 0.0) || !(normalSum.w > 0.0)) continue;
#ifdef PLANT_alpha
        depth.z = normalSum.w = 1.0;
#endif
        vec3 normal = normalSum.xyz / normalSum.w;
        float nDotV = -dot(normal, direction);
        if (!(nDotV > 0.0)) continue;
        float rate = nDotV / max(dot(normal, toLight), 1e-3);
        float warped = depth.x / depth.z, variance = max(0.0, depth.y / depth.z - warped * warped), scale = (layer.depthMax - layer.depthMin) * range;
        float sigma = sqrt(variance * scale * scale + 0.25 * tap * tap);
        float e = zc - (layer.depthMin * range + warped * scale), h = 0.5 * rate * segment;
        if (abs(e) - h > 6.0 * sigma) continue;
        float weight = centredPhi((e + h) / sigma) - centredPhi((e - h) / sigma);
        float slant = max(nDotV / length(normal), emitterSlantCap);
        float delay = (emitterDelayTaps * s.tapWidth + emitterDelayVoxels) / slant;
        float transmittance = transmittanceOf(opticalDepthAt(schedule, index, s.middle - delay));
        if (transmittance > 0.0) sum += (transmittance * weight) * textureLod(layerRadiance, at, level).rgb;
    }
    return sum;
}

vec4 march(vec3 originWorld, vec3 originVoxels, vec3 direction, vec3 nGeometric, int schedule)
{
    float exit_ = gridExit(originVoxels, direction), depth = 0.0;
    vec3 radiance = vec3(0);
    bool wasOccupied = true;
    for (int i = 0; i < MAX_STEPS; ++i) {
        Step s = stepOf(schedule, i);
        if (!(s.end > s.begin) || s.begin - 3.0 * s.tapWidth > exit_) break;
        vec3 offset = direction * s.middle;
        float density = 0.0;
        bool occupied = true;
        if (s.readVoxels != 0.0) {
            vec3 tap = sampleOpacity(originVoxels + offset, s.level);
            density = densityAlong(tap, direction);
            occupied = tap.x + tap.y + tap.z > 0.0;
        }
        depth += density * (s.end - s.begin);
        opticalDepth[i] = depth;
        if (occupied || wasOccupied)
            for (int k = 0; k < lightCount; ++k) radiance += emission(lights[k], originWorld + offset * voxelSize, direction, schedule, i);
        wasOccupied = occupied;
        if (transmittanceOf(opticalDepthAt(schedule, i, s.settled)) < transmittanceCutoff) break;
    }
    return vec4(radiance, 1.0 - transmittanceOf(depth));
}
