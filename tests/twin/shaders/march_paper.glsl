// Algorithm 1 and Eq. 1. CENTRED: layer_selection=centre. DENSITY: opacity=density. BACKFACE: 0 cosine, 1 step.

uniform float push, densityK, vRadiusScale, transmittanceCutoff;

float stepOpacity(float density, float stepLength)
{
#ifdef DENSITY
    return densityOpacity(density, stepLength, densityK);
#else
    return min(density, 1.0);
#endif
}

vec3 sampleLrsm(Light light, vec3 centre, float radius, vec3 toReceiver)
{
    LightSpacePoint p = projectToLight(light, centre);
    if (!p.valid || any(lessThan(p.uv, vec2(0))) || any(greaterThan(p.uv, vec2(1)))) return vec3(0);
    float level = lrsmLevel(2.0 * radius, p.texelSize), window = radius * vRadiusScale / (light.forward.w - light.up.w);

    vec3 outgoing = vec3(0);
    int first = int(light.layers.x), count = int(light.layers.y);
    for (int k = first; k < first + count; ++k) {
        Layer layer = layers[k];
#ifdef CENTRED
        float f = decay(layer, p.depth);
#else
        float f = layer.depthMin <= p.depth + window && layer.depthMax >= p.depth - window ? 1.0 : 0.0;
#endif
        if (!(f > 0.0)) continue;
        vec3 at = layerCoordinates(p.uv, k);
        vec4 depth = textureLod(layerDepth, at, level), normal = textureLod(layerNormal, at, level);
        if (!(depth.z > 0.0) || !(normal.w > 0.0)) continue;
#ifdef PLANT_alpha
        depth.z = normal.w = 1.0;
#endif
        float n = normalTerm(normal, toReceiver);
#if BACKFACE == 1
        n = n > 0.0 ? 1.0 : 0.0;
#endif
        if (!(n > 0.0)) continue;
        vec2 moments = depthMoments(depth.xyz);
        float range = layer.depthMax - layer.depthMin;
        float v = gaussianVisibility(moments.x, moments.y, (p.depth - layer.depthMin) / range, window / range);
        outgoing += textureLod(layerRadiance, at, level).rgb * (f * v * n);
    }
    return outgoing;
}

vec4 march(vec3 originWorld, vec3 originVoxels, vec3 direction, vec3 nGeometric, int schedule)
{
    float exit_ = gridExit(originVoxels, direction), transmittance = 1.0;
    vec3 radiance = vec3(0);
    for (int i = 0; i < MAX_STEPS; ++i) {
        Step s = stepOf(schedule, i);
        if (!(s.end > s.begin) || s.middle - s.diameter > exit_) break;
        float radius = 0.5 * s.diameter;
        vec3 offset = direction * s.middle + nGeometric * (push * radius), world = originWorld + offset * voxelSize;
        float alpha = stepOpacity(densityAlong(sampleOpacity(originVoxels + offset, s.level), direction), s.end - s.begin);
        if (alpha <= 0.0) continue;
        vec3 toReceiver = push == 0.0 ? -direction : normalize(originWorld - world), outgoing = vec3(0);
        for (int k = 0; k < lightCount; ++k) outgoing += sampleLrsm(lights[k], world, radius * voxelSize, toReceiver);
        radiance += (transmittance * alpha) * outgoing;
        transmittance *= 1.0 - alpha;
        if (transmittance < transmittanceCutoff) break;
    }
    return vec4(radiance, 1.0 - transmittance);
}
