// Final gathering: the diffuse cones of a pixel, and its specular cone.

layout(std430, binding = 7) writeonly buffer OutDiffuse { vec4 diffuseOut[]; };
layout(std430, binding = 12) writeonly buffer OutIrradiance { float irradianceOut[]; };
layout(std430, binding = 13) writeonly buffer OutOpacity { float opacityOut[]; };
layout(std430, binding = 14) writeonly buffer OutSpecular { vec4 specularOut[]; };
struct Ring {
    float first, count, weight, schedule;
};
layout(std430, binding = 15) readonly buffer Tables { Ring rings[RINGS]; float directions[]; };  // 16 rotations of coneCount directions
uniform int coneCount, setsPerPixel, rotation[16], specularFirst, specularClasses;
uniform float originOffset;  // voxels

// Duff et al. 2017.
mat3 frameFromNormal(vec3 n)
{
    float sign_ = n.z < 0.0 || (n.z == 0.0 && floatBitsToUint(n.z) != 0u) ? -1.0 : 1.0;
    float a = -1.0 / (sign_ + n.z), b = n.x * n.y * a;
    return mat3(vec3(1.0 + sign_ * n.x * n.x * a, sign_ * b, -sign_ * n.x), vec3(b, sign_ + n.y * n.y * a, -n.y), n);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= width || at.y >= height) return;
    int i = at.y * width + at.x, pixels = width * height;
    bool covered = gObjectId[i] != 0u;
    vec3 nGeometric = VEC3(gGeometricNormal, i), normal = VEC3(gNormal, i), world = VEC3(gPosition, i);
    vec3 originWorld = world + nGeometric * (originOffset * voxelSize), originVoxels = (originWorld - origin) / voxelSize;

    vec4 sum = vec4(0);
    if (covered) {
        mat3 frame = frameFromNormal(normal);
        int turn = rotation[4 * (at.y & 3) + (at.x & 3)];
        for (int s = 0; s < setsPerPixel; ++s) {
            int set_ = (turn + s * 16 / setsPerPixel) & 15;
            for (int r = 0; r < RINGS; ++r) {
                Ring ring = rings[r];
                for (int c = int(ring.first); c < int(ring.first + ring.count); ++c) {
                    vec3 direction = frame * VEC3(directions, set_ * coneCount + c);
                    vec4 cone = march(originWorld, originVoxels, direction, nGeometric, int(ring.schedule));
                    diffuseOut[(s * coneCount + c) * pixels + i] = cone;
                    sum += ring.weight * cone;
                }
            }
        }
    }
    float perSet = 1.0 / float(setsPerPixel);
#ifdef PLANT_irradiance_pi
    perSet /= kPi;
#endif
    for (int c = 0; c < 3; ++c) irradianceOut[3 * i + c] = sum[c] * (kPi * perSet);
    opacityOut[i] = sum.w * perSet;

#ifdef SPECULAR
    vec4 mirrored = vec4(0);
    if (covered && VEC3(gSpecularColor, i) != vec3(0)) {
        vec3 toEye = directionToEye(world), mirror = 2.0 * dot(normal, toEye) * normal - toEye;
        int class_ = int(clamp(gRoughness[i], 0.0, 1.0) * float(specularClasses - 1) + 0.5);
        if (dot(mirror, nGeometric) > 0.0) mirrored = march(originWorld, originVoxels, normalize(mirror), nGeometric, specularFirst + class_);
    }
    specularOut[i] = mirrored;
#endif
}
