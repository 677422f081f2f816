// Final gathering: the diffuse cones of a pixel, and its specular cone. LOBES: that one looks where a point of the lobe says.

layout(std430, binding = 7) writeonly buffer OutDiffuse { vec4 diffuseOut[]; };
layout(std430, binding = 12) writeonly buffer OutIrradiance { float irradianceOut[]; };
layout(std430, binding = 13) writeonly buffer OutOpacity { float opacityOut[]; };
layout(std430, binding = 14) writeonly buffer OutSpecular { vec4 specularOut[]; };  // LOBES: then the weights, in x
struct Ring {
    float first, count, weight, schedule;
};
layout(std430, binding = 15) readonly buffer Tables { Ring rings[RINGS]; float directions[]; };  // 16 rotations of coneCount directions
uniform int coneCount, setsPerPixel, rotation[16], specularFirst, specularClasses;
uniform float originOffset;  // voxels
uniform float lobePoints[48], leastSampledRoughness, minSpecularAlpha;

// Duff et al. 2017.
mat3 frameFromNormal(vec3 n)
{
    float sign_ = n.z < 0.0 || (n.z == 0.0 && floatBitsToUint(n.z) != 0u) ? -1.0 : 1.0;
    float a = -1.0 / (sign_ + n.z), b = n.x * n.y * a;
    return mat3(vec3(1.0 + sign_ * n.x * n.x * a, sign_ * b, -sign_ * n.x), vec3(b, sign_ + n.y * n.y * a, -n.y), n);
}

// Where a specular cone looks (xyz), and what it counts.
vec4 lobeDirection(vec3 n, vec3 toEye, float roughness, int turn)
{
    vec3 mirror = normalize(2.0 * dot(n, toEye) * n - toEye);
#ifdef LOBES
    if (roughness < leastSampledRoughness) return vec4(mirror, 1.0);
    // Heitz 2018: a visible normal of the GGX distribution.
    float alpha = max(roughness * roughness, minSpecularAlpha), alpha2 = alpha * alpha;
    mat3 frame = frameFromNormal(n);
    vec3 viewer = toEye * frame, stretched = normalize(vec3(alpha * viewer.xy, max(viewer.z, 1e-6)));
    float planar2 = dot(stretched.xy, stretched.xy);
    vec3 across = planar2 > 0.0 ? vec3(-stretched.y, stretched.x, 0.0) / sqrt(planar2) : frameFromNormal(stretched)[0], upward = cross(stretched, across);
    vec2 disk = vec2(lobePoints[3 * turn], lobePoints[3 * turn + 1]);
    disk.y = mix(sqrt(max(0.0, 1.0 - disk.x * disk.x)), disk.y, 0.5 * (1.0 + stretched.z));
    vec3 visible = disk.x * across + disk.y * upward + sqrt(max(0.0, 1.0 - dot(disk, disk))) * stretched;
    vec3 half_ = frame * normalize(vec3(alpha * visible.xy, max(0.0, visible.z))), direction = normalize(2.0 * dot(toEye, half_) * half_ - toEye);
    float nl = dot(n, direction), nv = max(dot(n, toEye), 0.0);
    if (!(nl > 0.0)) return vec4(direction, 0.0);
    float maskL = sqrt(nl * nl * (1.0 - alpha2) + alpha2), maskV = sqrt(nv * nv * (1.0 - alpha2) + alpha2);
    float point = lobePoints[3 * turn + 2];
#ifdef PLANT_lobe_weight
    point = 1.0;
#endif
    return vec4(direction, point * nl * (nv + maskV) / max(nl * maskV + nv * maskL, 1e-30));
#else
    return vec4(mirror, 1.0);
#endif
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
    int turn = rotation[4 * (at.y & 3) + (at.x & 3)];
    if (covered) {
        mat3 frame = frameFromNormal(normal);
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
    vec4 reflected = vec4(0), lobe = vec4(0);
    if (covered && VEC3(gSpecularColor, i) != vec3(0)) {
        lobe = lobeDirection(normal, directionToEye(world), gRoughness[i], turn);
        int class_ = int(clamp(gRoughness[i], 0.0, 1.0) * float(specularClasses - 1) + 0.5);
        if (dot(lobe.xyz, nGeometric) > 0.0) reflected = march(originWorld, originVoxels, lobe.xyz, nGeometric, specularFirst + class_);
    }
    specularOut[i] = reflected;
#ifdef LOBES
    specularOut[pixels + i] = vec4(lobe.w);
#endif
#endif
}
