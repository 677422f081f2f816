// Lights, and how they see the world.

struct Light {
    vec4 position;    // w: 0 directional, 1 spot, 2 cube face
    vec4 direction;   // w: range, 0 without end
    vec4 intensity;   // w: cosine of the inner cone angle
    vec4 eye;         // the projection's position; w: cosine of the outer cone angle
    vec4 right;       // w: half width
    vec4 up;          // w: depth_near
    vec4 forward;     // w: depth_far
    vec4 layers;      // first of its layers among those of all lights, how many, resolution of the RSM, cube face
};
layout(std430, binding = 8) readonly buffer Lights { Light lights[]; };

const float kPi = 3.14159265358979323846;
const vec3 kLargest = vec3(1e20);

struct LightSpacePoint {
    vec2 uv;
    float depth;      // linear
    float texelSize;  // of the RSM, metres
    bool valid;
};

LightSpacePoint projectToLight(Light light, vec3 world)
{
    vec3 d = world - light.eye.xyz;
    float x = dot(d, light.right.xyz), y = dot(d, light.up.xyz), z = dot(d, light.forward.xyz);
    bool directional = light.position.w == 0.0;
    float halfWidth = directional ? light.right.w : z * light.right.w;
    LightSpacePoint p;
    p.valid = directional || z > 0.0;
    p.depth = ((directional ? z : length(d)) - light.up.w) / (light.forward.w - light.up.w);
    p.texelSize = 2.0 * halfWidth / light.layers.z;
    p.uv = vec2(0.5 + 0.5 * x / halfWidth, 0.5 - 0.5 * y / halfWidth);
#ifdef PLANT_light_v
    p.uv.y = 1.0 - p.uv.y;
#endif
    return p;
}

vec3 directionToLight(Light light, vec3 world)
{
    vec3 to = light.eye.xyz - world;
    float distance_ = length(to);
    return light.position.w == 0.0 || !(distance_ > 0.0) ? -light.forward.xyz : to / distance_;
}

int cubeFaceOf(vec3 d)
{
    vec3 a = abs(d);
    int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + (d[axis] < 0.0 ? 1 : 0);
}

struct LightSample {
    vec3 toLight, irradiance;
    float distance_;  // metres; directional: a great many
};

LightSample sampleLight(Light light, vec3 world)
{
    if (light.position.w == 0.0) return LightSample(-light.direction.xyz, min(light.intensity.rgb, kLargest), 1e30);
    vec3 from = world - light.position.xyz;
    float distance_ = length(from);
    if (!(distance_ > 0.0)) return LightSample(-light.direction.xyz, vec3(0), 0.0);
    vec3 direction = from / distance_;
    float attenuation = 1.0 / (distance_ * distance_);
    if (light.direction.w > 0.0) {
        float ratio = distance_ / light.direction.w;
        attenuation *= clamp(1.0 - ratio * ratio * ratio * ratio, 0.0, 1.0);
    }
    if (light.position.w == 1.0) {
        float ramp = clamp((dot(direction, light.direction.xyz) - light.eye.w) / max(0.001, light.intensity.w - light.eye.w), 0.0, 1.0);
        attenuation *= ramp * ramp;
    } else if (cubeFaceOf(direction) != int(light.layers.w)) {
        attenuation = 0.0;
    }
    return LightSample(-direction, min(light.intensity.rgb * attenuation, kLargest), distance_);
}
