// The surface under a fragment, as seen along `toViewer`.

layout(std430, binding = 5) readonly buffer Materials { float materials[]; };  // 9 a material

in vec3 vPosition, vNormal;
flat in vec3 vGeometricNormal;
flat in uint vMesh, vMaterial;

struct Surface {
    vec3 position, geometricNormal, normal, albedo, specularColor;
    float roughness;
};

Surface surfaceOf(vec3 toViewer)
{
    uint m = 9u * vMaterial;
    Surface s;
    s.position = vPosition;
    s.albedo = vec3(materials[m], materials[m + 1u], materials[m + 2u]);
    s.specularColor = vec3(materials[m + 3u], materials[m + 4u], materials[m + 5u]);
    s.roughness = materials[m + 6u];
    bool doubleSided = materials[m + 7u] != 0.0;

    s.geometricNormal = vGeometricNormal;
    s.normal = dot(vNormal, vNormal) > 0.0 ? normalize(vNormal) : vGeometricNormal;
#ifdef PLANT_normal_length
    s.normal = vNormal * 0.9;
#endif
    bool fromBehind = dot(s.geometricNormal, toViewer) < 0.0;
    if (doubleSided) {
        if (fromBehind) s.geometricNormal = -s.geometricNormal;
        if (dot(s.normal, s.geometricNormal) < 0.0) s.normal = -s.normal;
    } else if (fromBehind) {
        return s;
    }
    // A shading normal that faces away from the viewer is pushed to the plane across his direction.
    float facing = dot(s.normal, toViewer);
    if (facing < 0.0) {
        vec3 across = s.normal - toViewer * (facing / dot(toViewer, toViewer));
        s.normal = dot(across, across) > 1e-12 ? normalize(across) : s.geometricNormal;
    }
    return s;
}
