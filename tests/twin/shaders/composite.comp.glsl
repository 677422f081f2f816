// Indirect light shaded, and the sum.

layout(std430, binding = 7) writeonly buffer OutDiffuse { float diffuseOut[]; };
layout(std430, binding = 9) readonly buffer Irradiance { float irradiance[]; };
layout(std430, binding = 10) readonly buffer Direct { float direct[]; };
layout(std430, binding = 11) readonly buffer Specular { float specularIn[]; };  // SPECULAR_STRIDE floats a pixel
layout(std430, binding = 12) readonly buffer SpecularAlbedo { vec2 specularAlbedo[]; };  // 16 roughnesses, 32 square roots of <n.v>
layout(std430, binding = 13) writeonly buffer OutSpecular { float specularOut[]; };
layout(std430, binding = 14) writeonly buffer OutCombined { float combinedOut[]; };
const float kPi = 3.14159265358979323846;

vec3 lobeAlbedo(vec3 f0, float nDotV, float roughness)
{
    vec2 at = vec2(sqrt(clamp(nDotV, 0.0, 1.0)) * 31.0, clamp(roughness, 0.0, 1.0) * 15.0);
    ivec2 cell = min(ivec2(at), ivec2(30, 14));
    vec2 f = at - vec2(cell);
    int i = cell.y * 32 + cell.x;
    vec2 scaleBias = mix(mix(specularAlbedo[i], specularAlbedo[i + 1], f.x), mix(specularAlbedo[i + 32], specularAlbedo[i + 33], f.x), f.y);
    return clamp(f0 * scaleBias.x + scaleBias.y, 0.0, 1.0);
}

vec3 lobeRadiance(int i)
{
    return vec3(specularIn[SPECULAR_STRIDE * i], specularIn[SPECULAR_STRIDE * i + 1], specularIn[SPECULAR_STRIDE * i + 2]);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= width || at.y >= height) return;
    int i = at.y * width + at.x;
    vec3 diffuse = vec3(0), specular = vec3(0);
    if (gObjectId[i] != 0u) {
#ifdef PLANT_albedo
        diffuse = VEC3(irradiance, i) * (1.0 / kPi);
#else
        diffuse = VEC3(gAlbedo, i) * VEC3(irradiance, i) * (1.0 / kPi);
#endif
#ifdef SPECULAR
        vec3 f0 = VEC3(gSpecularColor, i);
        if (f0 != vec3(0)) specular = lobeAlbedo(f0, dot(VEC3(gNormal, i), directionToEye(VEC3(gPosition, i))), gRoughness[i]) * lobeRadiance(i);
#endif
    }
    vec3 combined = VEC3(direct, i) + diffuse + specular;
    for (int c = 0; c < 3; ++c) {
        diffuseOut[3 * i + c] = diffuse[c];
        specularOut[3 * i + c] = specular[c];
        combinedOut[3 * i + c] = combined[c];
    }
}
