#include "apps/validate/equations/oracle.h"
#include "apps/validate/extremes/catalogue.h"
#include "lrsm/sample.h"

#include <cmath>

// Eq. 10-12 at the ends of their arguments, against long double arithmetic and the C library's erfc.
namespace lrsm::extremes {
namespace {

struct Input {
    float mu, sigma2, zc, rc;
};

void compare(Probe& probe, const std::vector<Input>& inputs)
{
    struct Method {
        GaussianMethod method;
        const char* name;
    };
    for (const Method& m : {Method{GaussianMethod::table, "table"}, Method{GaussianMethod::polynomial, "polynomial"}, Method{GaussianMethod::exact, "exact"}}) {
        const NormalCdf phi(m.method, 1024);
        double worst = 0.0;
        for (const Input& in : inputs) {
            const float v = gaussianVisibility(phi, in.mu, in.sigma2, in.zc, in.rc);
            probe.require(v >= 0.0f && v <= 1.0f, std::string(m.name) + ": V outside [0, 1]");
            probe.note(double(v));
            worst = std::max(worst, static_cast<double>(std::abs(static_cast<long double>(v) - oracle::visibility(in.mu, in.sigma2, in.zc, in.rc))));
        }
        probe.bound(std::string("error of V, ") + m.name, worst, double(gaussianVisibilityMaxError(phi)));
    }
}

/// Samples inside, outside and at both edges of [mu - rc, mu + rc], the edges with their neighbours.
std::vector<Input> around(float sigma2, float mu = 0.5f, float rc = 0.125f)
{
    std::vector<Input> inputs;
    for (const float edge : {mu - rc, mu + rc})
        for (const float zc : {edge, std::nextafter(edge, kInfinity), std::nextafter(edge, -kInfinity)}) inputs.push_back({mu, sigma2, zc, rc});
    for (const float zc : {mu, mu + 0.5f * rc, mu - 2.0f * rc, mu + 1000.0f * rc}) inputs.push_back({mu, sigma2, zc, rc});
    return inputs;
}

Case visibilityCase(const std::string& name, const std::string& what, std::vector<Input> inputs)
{
    return {name, what, "V of Eq. 12 in [0, 1], within gaussianVisibilityMaxError of exact arithmetic, by table, polynomial and exact",
            [inputs = std::move(inputs)](Mode, Probe& probe) { compare(probe, inputs); }, true};
}

std::vector<Input> radii(const std::vector<float>& all)
{
    std::vector<Input> inputs;
    for (const float rc : all)
        for (const float sigma2 : {0.0f, 2.5e-5f, 0.01f, 1.0f})
            for (const float zc : {0.5f, 0.500001f, 0.4f, 2.0f}) inputs.push_back({0.5f, sigma2, zc, rc});
    return inputs;
}

std::vector<Input> farPlaces()
{
    std::vector<Input> inputs;
    for (float offset = 1.0f; offset < 2e7f; offset *= 10.0f)
        for (const float sigma : {1e-3f, 1.0f, 100.0f})
            for (const float shift : {0.0f, 0.5f, -3.0f}) inputs.push_back({offset, sigma * sigma, offset + shift, 1.0f});
    return inputs;
}

void momentsOfNothing(Mode, Probe& probe)
{
    FilteredTexel texel;
    const float denormal = 1e-42f;
    for (const float alpha : {0.0f, denormal, std::numeric_limits<float>::min(), 1e-20f, 1.0f}) {
        texel.depthAlpha = texel.normalAlpha = alpha;
        texel.depth = 0.5f * alpha;
        texel.depthSquared = 0.25f * alpha;
        const DepthMoments moments = depthMoments(texel);
        // A denormal alpha has few bits, so its mean has few, too: half of the denormal's last place.
        const double tolerance = alpha < std::numeric_limits<float>::min() ? 0.01 : 1e-6;
        probe.bound("mean of depths at 0.5", alpha > 0.0f ? double(moments.mean) - 0.5 : double(moments.mean), tolerance);
        probe.require(moments.variance >= 0.0f && moments.variance <= 1.0f, "variance outside [0, 1]");
        const float facing = normalTerm(texel, Vec3(0, 0, 1));
        probe.require(facing == 0.0f, "a normal of length 0 faces somewhere");
    }
}

}  // namespace

Group momentCases()
{
    const float least = std::numeric_limits<float>::denorm_min(), smallest = std::numeric_limits<float>::min(), largest = std::numeric_limits<float>::max();
    return {"moments",
            {visibilityCase("variance exactly 0", "sigma^2 = 0: a step", around(0.0f)),
             visibilityCase("variance negative", "sigma^2 = -1e-3, as UNORM16 moments give", around(-1e-3f)),
             visibilityCase("variance minus zero and tiny negative", "sigma^2 = -1e-45", around(-least)),
             visibilityCase("variance denormal", "sigma^2 = 1e-45", around(least)),
             visibilityCase("variance the least normal float", "sigma^2 = 1.2e-38", around(smallest)),
             visibilityCase("variance of one ULP of depth", "sigma = 6e-8", around(3.6e-15f)),
             visibilityCase("variance at its floor", "sigma^2 = 2.5e-5", around(kVarianceFloor)),
             visibilityCase("variance huge", "sigma^2 = 1e30", around(1e30f)),
             visibilityCase("variance the largest float", "sigma^2 = 3.4e38", around(largest)),
             visibilityCase("r_c to 0", "r_c = 0, 1e-45, 1e-38, 1e-20, 1e-8", radii({0.0f, least, smallest, 1e-20f, 1e-8f})),
             visibilityCase("r_c larger than the scene", "r_c = 1, 1e3, 1e10, 1e30", radii({1.0f, 1e3f, 1e10f, 1e30f})),
             visibilityCase("depths far from 0", "mu = 1 .. 1e7, differences of a metre", farPlaces()),
             {"alpha to 0", "depthMoments and N of a texel whose alpha is 0, denormal or tiny",
              "mean of equal depths is that depth; N of a normal of length 0 is 0; all finite", momentsOfNothing, true}}};
}

}  // namespace lrsm::extremes
