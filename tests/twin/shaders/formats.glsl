// Number formats as docs/capture.md has them. Done by hand: drivers round as they please (DRIVER_FORMATS: let them).
// HALF_NEAREST_EVEN: half_rounding=nearest_even; else toward zero.
#ifdef PLANT_half_rounding
#define HALF_NEAREST_EVEN
#endif

uint halfFromFloat(float v)
{
    uint bits = floatBitsToUint(v), sign = (bits >> 16) & 0x8000u, magnitude = bits & 0x7fffffffu;
    if (magnitude > 0x7f800000u) return sign | 0x7e00u;  // NaN
    int exponent = int(magnitude >> 23) - 127;
    if (exponent < -25) return sign;
    uint half_;
    if (exponent > 15) {
        half_ = 0x7c00u;
    } else {
        bool denormal = exponent < -14;
        uint significand = denormal ? (magnitude & 0x007fffffu) | 0x00800000u : magnitude - (112u << 23);
        int shift = denormal ? -exponent - 1 : 13;
        half_ = significand >> shift;
#ifdef HALF_NEAREST_EVEN
        uint rest = significand & ((1u << shift) - 1u), tie = 1u << (shift - 1);
        if (rest > tie || (rest == tie && (half_ & 1u) != 0u)) ++half_;
#endif
    }
    return sign | min(half_, 0x7bffu);  // what is beyond 65504 becomes 65504
}

uvec4 halfFromFloat(vec4 v) { return uvec4(halfFromFloat(v.x), halfFromFloat(v.y), halfFromFloat(v.z), halfFromFloat(v.w)); }

float floatFromHalf(uint bits)
{
    uint sign = (bits & 0x8000u) << 16, magnitude = bits & 0x7fffu;
    if (magnitude >= 0x0400u) return uintBitsToFloat(sign | ((magnitude << 13) + (112u << 23)));
    float denormal = float(magnitude) * uintBitsToFloat(0x33800000u);  // 2^-24
    return sign != 0u ? -denormal : denormal;
}

vec4 floatFromHalf(uvec4 v) { return vec4(floatFromHalf(v.x), floatFromHalf(v.y), floatFromHalf(v.z), floatFromHalf(v.w)); }

uint unorm16FromFloat(float v)
{
    if (!(v > 0.0)) return 0u;
    precise float scaled = min(v, 1.0) * 65535.0;
    precise float rounded = scaled + 0.5;
    return uint(rounded);
}

uvec4 unorm16FromFloat(vec4 v) { return uvec4(unorm16FromFloat(v.x), unorm16FromFloat(v.y), unorm16FromFloat(v.z), unorm16FromFloat(v.w)); }

vec4 floatFromUnorm16(uvec4 v) { return vec4(v) / 65535.0; }

// What a texture of halves or of UNORM takes and gives.
#ifdef DRIVER_FORMATS
#define HALF4 vec4
#define HALF(v) (v)
#define UNORM16(v) (v)
#define IMAGE image2DArray
#define HALF_FORMAT rgba16f
#define UNORM_FORMAT rgba16
#define TEXTURE sampler2DArray
#define FROM_HALF(t) (t)
#define FROM_UNORM16(t) (t)
#else
#define HALF4 uvec4
#define HALF(v) halfFromFloat(v)
#define UNORM16(v) unorm16FromFloat(v)
#define IMAGE uimage2DArray
#define HALF_FORMAT rgba16ui
#define UNORM_FORMAT rgba16ui
#define TEXTURE usampler2DArray
#define FROM_HALF(t) floatFromHalf(t)
#define FROM_UNORM16(t) floatFromUnorm16(t)
#endif
