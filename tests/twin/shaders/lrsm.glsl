// The layers of all lights through a sampler: bilinear, linear between mips, border 0.
// GAUSSIAN: 0 table, 1 polynomial.

layout(binding = 0) uniform sampler2DArray layerRadiance;
layout(binding = 1) uniform sampler2DArray layerNormal;
layout(binding = 2) uniform sampler2DArray layerDepth;

struct Layer {
    float depthMin, depthMax, delta, decayAtMin, decayAtMax;
};
layout(std430, binding = 9) readonly buffer Layers { Layer layers[]; };
layout(std430, binding = 10) readonly buffer PhiTable { float phiTable[]; };
uniform float rsmLevelBias, rsmMinLevel, varianceFloor;
uniform float phiHalfWidth;
uniform int phiEntries;
uniform float phiLimit, phiNumerator[6], phiDenominator[5];

float lrsmLevel(float diameter, float texelSize)
{
    float texels = diameter / (2.0 * texelSize);
    return max(texels > 0.0 ? log2(texels) + rsmLevelBias : rsmMinLevel, rsmMinLevel);
}

vec3 layerCoordinates(vec2 uv, int layer)
{
#ifdef PLANT_texel_centre
    uv += 0.5 / vec2(textureSize(layerDepth, 0).xy);
#endif
    return vec3(uv, float(layer));
}

// Phi(x) - 1/2.
float centredPhi(float x)
{
#if GAUSSIAN == 0
    if (!(x > -phiHalfWidth)) return -0.5;
    if (!(x < phiHalfWidth)) return 0.5;
    float position = (x + phiHalfWidth) * (float(phiEntries - 1) / (2.0 * phiHalfWidth));
    int cell = min(int(position), phiEntries - 2);
    return phiTable[cell] + (position - float(cell)) * (phiTable[cell + 1] - phiTable[cell]) - 0.5;
#else
    x = clamp(x, -phiLimit, phiLimit);
    float t = x * x, p = phiNumerator[5], q = phiDenominator[4];
    for (int i = 4; i >= 0; --i) p = p * t + phiNumerator[i];
    for (int i = 3; i >= 0; --i) q = q * t + phiDenominator[i];
    return clamp(x * p / q, -0.5, 0.5);
#endif
}

// Eq. 12: the part of N(mean, variance) in [zc - rc, zc + rc].
float gaussianVisibility(float mean, float variance, float zc, float rc)
{
    float distance_ = abs(zc - mean), inner = rc - distance_;
    if (!(variance > 0.0)) return inner > 0.0 ? 1.0 : inner < 0.0 ? 0.0 : 0.5;
    float sigma = sqrt(variance);
    return clamp(centredPhi(inner / sigma) - centredPhi(-(rc + distance_) / sigma), 0.0, 1.0);
}

float smoothStep(float t)
{
    float c = clamp(t, 0.0, 1.0);
    return c * c * (3.0 - 2.0 * c);
}

// Eq. 15.
float decay(Layer layer, float zc)
{
    bool inside = zc >= layer.depthMin && (zc < layer.depthMax || (zc == layer.depthMax && layer.decayAtMax == 0.0));
    if (!inside) return 0.0;
    if (layer.decayAtMin != 0.0 && zc < layer.depthMin + layer.delta) return smoothStep((zc - layer.depthMin) / layer.delta);
    if (layer.decayAtMax != 0.0 && zc > layer.depthMax - layer.delta) return smoothStep((layer.depthMax - zc) / layer.delta);
    return 1.0;
}
