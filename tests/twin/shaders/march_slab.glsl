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

vec3 opticalDepth[MAX_TAPS + 1];  // F by axis at the edges of the taps

// F at distance t; `last` is the current segment.
vec3 opticalDepthAt(int schedule, int last, float t)
{
    int i = last;
    while (i > 0 && stepOf(schedule, i).begin > t) --i;
    Step s = stepOf(schedule, i);
    float width = (s.end - s.begin) / s.taps;
    float along = clamp((t - s.begin) / width, 0.0, s.taps);
    int k = min(int(along), int(s.taps) - 1), tap = int(s.firstTap) + k;
    return mix(opticalDepth[tap], opticalDepth[tap + 1], along - float(k));
}

float total(vec3 v)
{
    return v.x + v.y + v.z;
}

// What is covered in front of an emitter crossed at `crossing`, its own voxels taken back.
float depthInFront(int schedule, int index, vec3 direction, vec3 normal, float crossing)
{
    Step s = stepOf(schedule, index);
    float cosine = -dot(normal, direction);
    float delay = (emitterDelayTaps * s.tapWidth + emitterDelayVoxels) / max(cosine, emitterSlantCap);
    vec3 now = opticalDepthAt(schedule, index, crossing - 1.5 * s.tapWidth), before = opticalDepthAt(schedule, index, crossing - delay);
    vec3 own = (abs(normal) + 1.0 / min(s.tapWidth, 8.0)) / max(cosine, 0.05);
#ifdef DIRECTIONAL
    own *= abs(direction);
#else
    own = vec3(total(own), 0, 0);
#endif
    return total(now - min(max(now - before, vec3(0)), own));
}

vec3 emission(Light light, vec3 world, vec3 direction, int schedule, int index)
{
    LightSpacePoint p = projectToLight(light, world);
    if (!p.valid) return vec3(0);
    Step s = stepOf(schedule, index);
    float tap = max(0.5, 0.13 * s.diameter) * voxelSize, segment = (s.end - s.begin) * voxelSize, range = light.forward.w - light.up.w, zc = p.depth * range;
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
        float crossing = clamp(s.middle - e / (rate * voxelSize), s.begin - s.tapWidth, s.end + s.tapWidth);
        float transmittance = transmittanceOf(depthInFront(schedule, index, direction, normalize(normal), crossing));
        if (transmittance > 0.0) sum += (transmittance * weight) * textureLod(layerRadiance, at, level).rgb;
    }
    return sum;
}

vec4 march(vec3 originWorld, vec3 originVoxels, vec3 direction, vec3 nGeometric, int schedule)
{
    float exit_ = gridExit(originVoxels, direction);
    vec3 depth = vec3(0), radiance = vec3(0);
    opticalDepth[0] = depth;
    bool wasOccupied = true;
    for (int i = 0; i < MAX_STEPS; ++i) {
        Step s = stepOf(schedule, i);
        if (!(s.end > s.begin) || s.begin - 1.5 * s.tapWidth > exit_) break;
        vec3 offset = direction * s.middle;
        bool occupied = s.readVoxels == 0.0;
        float width = (s.end - s.begin) / s.taps;
        for (int k = 0; k < int(s.taps); ++k) {
            if (s.readVoxels != 0.0) {
                vec3 tap = sampleOpacity(originVoxels + direction * (s.begin + (float(k) + 0.5) * width), s.level);
                occupied = occupied || total(tap) > 0.0;
                depth += coveredAlong(tap, direction) * width;
            }
            opticalDepth[int(s.firstTap) + k + 1] = depth;
        }
        if (occupied || wasOccupied)
            for (int k = 0; k < lightCount; ++k) radiance += emission(lights[k], originWorld + offset * voxelSize, direction, schedule, i);
        wasOccupied = occupied;
        if (transmittanceOf(total(opticalDepthAt(schedule, i, s.settled))) < transmittanceCutoff) break;
    }
    return vec4(radiance, 1.0 - transmittanceOf(total(depth)));
}
