// The opacity pyramid through a sampler: linear in x, y, z and level, border 0.
// DIRECTIONAL: density a voxel along x, y and z; else one opacity. The level 0 is the voxels, three times where DIRECTIONAL.

layout(binding = 3) uniform sampler3D opacity;
uniform int resolution, levels;

vec3 sampleOpacity(vec3 pVoxels, float level)
{
    level = clamp(level, 0.0, float(levels - 1));
    vec3 at = pVoxels / float(resolution);
#ifdef DIRECTIONAL
    // Levels hold shares of columns: 2^-level makes them densities, up to level 3.
    int lower = int(level);
    float f = level - float(lower);
    vec3 fine = textureLod(opacity, at, float(lower)).rgb / float(1 << min(lower, 3));
    if (f == 0.0) return fine;
    vec3 coarse = textureLod(opacity, at, float(lower + 1)).rgb / float(1 << min(lower + 1, 3));
    return fine + f * (coarse - fine);
#else
    return textureLod(opacity, at, level).rrr;
#endif
}

// Density along the cone: by axis, and all.
vec3 coveredAlong(vec3 tap, vec3 direction)
{
#ifdef DIRECTIONAL
    return abs(direction) * tap;
#else
    return vec3(tap.x, 0, 0);
#endif
}
float densityAlong(vec3 tap, vec3 direction)
{
    vec3 covered = coveredAlong(tap, direction);
    return covered.x + covered.y + covered.z;
}

// Distance in voxels at which a ray leaves the grid.
float gridExit(vec3 origin, vec3 direction)
{
    float exit_ = 1e30;
    for (int k = 0; k < 3; ++k)
        if (direction[k] != 0.0) exit_ = min(exit_, ((direction[k] > 0.0 ? float(resolution) : 0.0) - origin[k]) / direction[k]);
    return exit_;
}
