// Algorithm 1 and Eq. 1 term by term.

// Eq. 8, of filtered alpha n and alpha.
float normalTerm(vec4 normal, vec3 toReceiver)
{
    return max(0.0, dot(normal.xyz, toReceiver)) / normal.w;
}

// Eq. 10 and 11, of filtered alpha z, alpha z^2 and alpha: mean, and variance above the floor.
vec2 depthMoments(vec3 depth)
{
    float mean = depth.x / depth.z;
    return vec2(mean, max(depth.y / depth.z - mean * mean, varianceFloor));
}

// Opacity of a step, opacity=density.
float densityOpacity(float density, float stepLength, float k)
{
    float a = min(density, 1.0);
    return a > 0.0 && a < 1.0 ? 1.0 - exp2(k * stepLength * log2(1.0 - a)) : a;
}
