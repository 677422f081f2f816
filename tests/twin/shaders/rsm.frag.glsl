// Reflective shadow map: reflected radiance and coverage, normal and its cosine to the light, linear depth.

uniform int light;
layout(location = 0) out HALF4 outRadiance;
layout(location = 1) out HALF4 outNormal;
layout(location = 2) out float outDepth;

void main()
{
    Light from = lights[light];
    Surface s = surfaceOf(directionToLight(from, vPosition));
    float nDotL = clamp(dot(s.normal, directionToLight(from, vPosition)), 0.0, 1.0);
    vec3 radiance = s.albedo * sampleLight(from, s.position).irradiance * (nDotL / kPi);
#ifdef PLANT_rsm_pi
    radiance *= kPi;
#endif
    outRadiance = HALF(vec4(radiance, 1.0));
    outNormal = HALF(vec4(s.normal, nDotL));
    outDepth = clamp(projectToLight(from, s.position).depth, 0.0, 1.0);
}
