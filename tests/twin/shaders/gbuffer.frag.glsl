// G-buffer. The object id is a whole number far below 2^24, so a float holds it.

uniform vec3 eye, forward;
uniform int perspective;
layout(location = 0) out vec4 outPosition;         // w: depth along the axis
layout(location = 1) out vec4 outGeometricNormal;  // w: object id
layout(location = 2) out vec4 outNormal;           // w: roughness
layout(location = 3) out vec4 outAlbedo;
layout(location = 4) out vec4 outSpecular;

void main()
{
    vec3 toEye = eye - vPosition;
    Surface s = surfaceOf(perspective != 0 && dot(toEye, toEye) > 0.0 ? toEye / length(toEye) : -forward);
    outPosition = vec4(s.position, dot(s.position - eye, forward));
    outGeometricNormal = vec4(s.geometricNormal, float(vMesh + 1u));
    outNormal = vec4(s.normal, s.roughness);
    outAlbedo = vec4(s.albedo, 0.0);
    outSpecular = vec4(s.specularColor, 0.0);
}
