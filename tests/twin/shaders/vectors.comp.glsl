// The equations one by one: a case an invocation, its inputs in a row, its results in another (tests/twin/vectors.cpp).
// SET_name says which; GAUSSIAN as lrsm.glsl has it: the polynomial's result is the first, the table's the second. Of a result that is asked for exactly and as a GPU may make it,
// the latter.

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer In { float inputs[]; };
layout(std430, binding = 1) buffer Out { float outputs[]; };
uniform int cases, inputCount, outputCount;

float in1(int i) { return inputs[int(gl_GlobalInvocationID.x) * inputCount + i]; }
vec3 in3(int i) { return vec3(in1(i), in1(i + 1), in1(i + 2)); }
void out1(int i, float v) { outputs[int(gl_GlobalInvocationID.x) * outputCount + i] = v; }
void out3(int i, vec3 v) { out1(i, v.x); out1(i + 1, v.y); out1(i + 2, v.z); }

#ifdef SET_membership
bool within(float x, int low, int high, float last)
{
    return x >= in1(low) && (x < in1(high) || (x == in1(high) && in1(high) == last));
}
#endif

void evaluate()
{
#if defined(SET_front_to_back)
    float transmittance = 1.0;
    vec3 radiance = vec3(0);
    for (int i = 0; i < 16; ++i) {
        radiance += (transmittance * in1(i)) * in3(16 + 3 * i);
        transmittance *= 1.0 - in1(i);
    }
    out3(0, radiance);
    out1(3, 1.0 - transmittance);
#elif defined(SET_step_opacity)
    out1(1, densityOpacity(in1(0), in1(1), in1(2)));
#elif defined(SET_transmittance)
    out1(0, exp(-in1(0) * in1(1)));
#elif defined(SET_reflected_radiance)
    out1(0, in1(0) * in1(1) * in1(2) / kPi);
#elif defined(SET_direct_sum)
    vec3 centre = in3(208), v = in3(212), sum = vec3(0);
    float weights = 0.0, inside = 0.0, all = 0.0;
    for (int i = 0; i < 16; ++i) {
        vec3 n = in3(48 + 3 * i), l = in3(96 + 3 * i);
        float omega = in1(192 + i);
        bool here = distance(in3(3 * i), centre) <= in1(211);
        float weight = here ? max(0.0, dot(n, v)) / dot(n, l) : max(0.0, dot(l, v));
        weights += weight * omega;
        all += omega;
        if (here) sum += weight * omega * in3(144 + 3 * i);
        if (here) inside += omega;
        out1(3 + i, weight);
    }
    out3(0, weights > 0.0 ? sum / weights : vec3(0));
    out1(19, inside / all);
#elif defined(SET_product)
    out1(0, in1(0) * in1(1) * in1(2));
#elif defined(SET_layer_texel)
    vec3 radiance = vec3(0), normal = vec3(0), depth = vec3(0);
    for (int i = 0; i < 16; ++i) {
        if (in1(112 + i) == 0.0) continue;
        float z = (in1(96 + i) - in1(128)) / (in1(129) - in1(128));
        radiance += in3(3 * i);
        normal += in3(48 + 3 * i);
        depth += vec3(z, z * z, 1.0);
    }
    out3(0, radiance / 16.0);
    out3(3, normal / 16.0);
    out3(6, depth / 16.0);
#elif defined(SET_normal_term)
    out1(0, normalTerm(vec4(in3(0), in1(3)), in3(4)));
#elif defined(SET_depth_moments)
    vec2 moments = depthMoments(in3(0));
    out1(0, moments.x);
    out1(1, moments.y);
#elif defined(SET_normal_cdf)
    out1(GAUSSIAN == 1 ? 0 : 1, centredPhi(in1(0)) + 0.5);
#elif defined(SET_visibility)
    out1(GAUSSIAN == 1 ? 0 : 1, gaussianVisibility(in1(0), in1(1), in1(2), in1(3)));
#elif defined(SET_sampler_weights)
    // A layer a texel, 1 there alone.
    for (int i = 0; i < 85; ++i) {
        float weight = textureLod(layerRadiance, vec3(in1(0), in1(1), float(i)), in1(2)).r;
        out1(85 + i, weight);
    }
#elif defined(SET_membership)
    for (int l = 0; l < 4; ++l) out1(l, within(in1(0), 2 + l, 6 + l, in1(9)) && within(in1(1), 10 + l, 14 + l, in1(17)) ? 1.0 : 0.0);
#elif defined(SET_layer_sum)
    vec3 sum = vec3(0);
    for (int l = 0; l < 4; ++l) sum += (in1(l) * in1(4 + l)) * in3(8 + 3 * l);
    out3(0, sum);
#elif defined(SET_decay)
    out1(0, decay(Layer(in1(0), in1(1), in1(2), 1.0, 1.0), in1(3)));
#elif defined(SET_lrsm_level)
    // rsmLevelBias and rsmMinLevel are uniforms, the same for all cases there.
    out1(0, max(log2(in1(0) / (2.0 * in1(1))) + in1(2), in1(3)));
#elif defined(SET_projection)
    Light light;
    light.position.w = in1(3);
    light.eye.xyz = in3(4);
    light.right = vec4(in3(7), in1(16));
    light.up = vec4(in3(10), in1(17));
    light.forward = vec4(in3(13), in1(18));
    light.layers.z = in1(19);
    LightSpacePoint p = projectToLight(light, in3(0));
    out3(0, vec3(p.uv, p.depth));
    out1(3, p.texelSize);
#elif defined(SET_half)
#ifdef HALF_NEAREST_EVEN
    out1(1, floatFromHalf(halfFromFloat(in1(0))));
#else
    out1(0, floatFromHalf(halfFromFloat(in1(0))));
#endif
#elif defined(SET_half_bits)
    out1(0, floatFromHalf(uint(in1(0))));
#elif defined(SET_unorm16)
    out1(0, float(unorm16FromFloat(in1(0))));
#elif defined(SET_log2)
    out1(1, log2(in1(0)));
#elif defined(SET_exp2)
    out1(1, exp2(in1(0)));
#endif
}

void main()
{
    if (int(gl_GlobalInvocationID.x) < cases) evaluate();
}
