#pragma once

#include "core/scene/requirements.h"
#include "core/scene/scene.h"
#include "core/settings/settings.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// The error ladder: which approximation of the paper costs how much, on cone samples taken from a real frame.
///
/// A rung is one evaluation of the same quantity; each switches on one approximation more, all else exact. What a rung adds is its
/// difference to the rung above. Rungs above `mips` are written in double and share no code with the passes (docs/validation.md).
namespace lrsm {

/// Outgoing radiance L of a cone sample, from Eq. 2 itself down to what the frame computes.
enum class RadianceRung { eq2, eq3, eq5, eq12, eq14, eq15, mips, table1, algorithm1 };
inline constexpr int kRadianceRungs = 9;

/// Opacity of a cone up to the far end of the sample's segment: 1 - product of (1 - alpha) in Eq. 1.
enum class VisibilityRung { rays, voxelRays, boxMips, cone };
inline constexpr int kVisibilityRungs = 4;

/// What the slab estimator adds for a segment of a cone in clear air (its w A R, in place of Eq. 1's alpha L).
enum class EmissionRung { beam, texels, segment };
inline constexpr int kEmissionRungs = 3;

/// Name of a rung ("Eq. 3, 4") and what it switches on, one line.
struct RungInfo {
    std::string name, meaning;
};
std::vector<RungInfo> radianceRungs();    ///< kRadianceRungs of them
std::vector<RungInfo> visibilityRungs();  ///< kVisibilityRungs
std::vector<RungInfo> emissionRungs();    ///< kEmissionRungs

struct LadderOptions {
    int width = 256, height = 144;  ///< of the frame that is sampled: `--size` of a render that shall show the same pixels
    int samples = 1500;             ///< cone samples taken, or as many as there are
    int raysPerSample = 400;        ///< of Eq. 2, and of the bundle that measures opacity; rounded up to a square
    int worstPerRung = 3;           ///< worst cases kept for each rung
    std::uint64_t seed = 1;
    std::function<void(const std::string& stage, double fraction)> progress;  ///< may be empty
};

/// One cone sample and what each rung says of it. Radiances are means of the three channels, W/(m^2 sr).
struct LadderSample {
    int x = 0, y = 0;             ///< pixel
    int cone = 0, step = 0;       ///< numbered as `lrsm render --pixel` prints them; the specular cone comes last
    Vec3 centre{0.0f};            ///< x_c, world
    Vec3 toReceiver{0.0f};        ///< v_c
    float radius = 0.0f;          ///< r_c, metres
    float distance = 0.0f;        ///< from the cone's apex, metres
    double weight = 0.0;          ///< share of L in the weighted mean of its pixel's cones: cone weight * transmittance * alpha
    double emissionWeight = 0.0;  ///< the same without alpha, for what a segment emits
    // Of the light that gives the sample most (the first where none gives any).
    double level = 0.0;        ///< LRSM level of the footprint, before clamping
    double slope = 1.0;        ///< mean <n.l> of the RSM texels inside the sphere; of all in its footprint where none is inside
    double lightCosine = 0.0;  ///< l . v_c at x_c: below 0 the receiver looks from behind at what faces the light
    int layers = 0;            ///< layers that rung Eq. 15 samples and finds light in
    double voxelLevel = 0.0;   ///< mip level of the step's voxel lookup
    bool hasSurface = false;   ///< some ray of Eq. 2 met a surface inside the sphere: L is defined
    double noise = 0.0;        ///< estimated standard deviation of the rung Eq. 2
    double radiance[kRadianceRungs] = {};
    double opacity[kVisibilityRungs] = {};
    double emission[kEmissionRungs] = {};  ///< estimator=slab; else 0
};

/// Statistics of a difference over the samples (each counts once): signed mean, and the rest of its absolute value.
struct DifferenceStatistics {
    double mean = 0.0;  ///< signed
    double rms = 0.0;
    double p50 = 0.0, p95 = 0.0, p99 = 0.0, max = 0.0;  ///< percentiles of |difference|
    double weightedMean = 0.0;           ///< signed, each sample counted by LadderSample::weight (emissionWeight): what the picture's energy sees
    std::vector<double> quantiles;       ///< signed difference at ladderProbabilities()
    std::vector<std::size_t> histogram;  ///< counts of the signed difference in the bins of `LadderScene`'s edges for this ladder
};
/// 0, .01, .05, .1, .25, .5, .75, .9, .95, .99, 1.
const std::vector<double>& ladderProbabilities();

struct RungStatistics {
    std::string name, meaning;
    double mean = 0.0;                    ///< of the rung's value
    double weightedMean = 0.0;            ///< the same by LadderSample::weight
    DifferenceStatistics toAbove, toTop;  ///< rung minus the rung above; minus the top rung (Eq. 2, exact rays). All 0 for the top itself
    double share = 0.0;                   ///< toAbove.rms^2 over the sum of all rungs' : how much of the error enters here
};

/// One bin of a curve: the samples whose variable lies in [low, high).
struct CurveBin {
    double low = 0.0, high = 0.0;
    std::size_t count = 0;
    std::vector<double> meanToAbove, rmsToAbove, meanToTop, rmsToTop;  ///< one entry a rung
};
/// Error against one property of the sample. Bins hold about equal counts, or one value each for small integers; none is empty.
struct LadderCurve {
    std::string variable, unit;  ///< radiance: "r_c", "level", "slope", "l.v", "layers"; visibility: "distance", "r_c", "voxel level"
    std::vector<CurveBin> bins;
};

/// A sample at which a rung differs most from the rung above (or, for toTop, the last rung from the top).
struct WorstCase {
    std::string rung;
    bool toTop = false;
    double difference = 0.0;  ///< signed
    std::size_t sample = 0;   ///< index into LadderScene::samples
};

struct Ladder {
    std::vector<RungStatistics> rungs;   ///< top first
    std::vector<double> histogramEdges;  ///< symmetric about 0; the first and last bins also hold what lies beyond
    std::vector<LadderCurve> curves;
    std::vector<WorstCase> worst;  ///< worstPerRung for each rung, then worstPerRung of the whole way
    std::size_t samples = 0;       ///< that the statistics are over
    std::string verdict;           ///< one sentence: where most of the error enters, with its figures
};

struct LadderScene {
    std::string scene;
    int width = 0, height = 0;          ///< as sampled
    Ladder radiance;                    ///< over the samples that have a surface
    Ladder visibility;                  ///< over all samples
    Ladder emission;                    ///< over all samples with estimator=slab; else without rungs
    std::vector<LadderSample> samples;  ///< in order of pixel, cone, step
    std::uint64_t lookups = 0;          ///< LRSM lookups of the frame: each was taken with probability samples.size() / lookups
    std::size_t withoutSurface = 0;     ///< samples in whose sphere no ray of Eq. 2 meets a surface: L is undefined and they are in no radiance statistic
    double lightFromNothing = 0.0;      ///< their part in the weighted sum of the last rung's L: light that the frame takes from empty spheres
    double noise = 0.0;                 ///< rms over samples of LadderSample::noise
    std::vector<std::string> notes;     ///< what the settings make different from the paper's ladder, one sentence each

    std::string verdict;  ///< the scene's name and all ladders' verdicts
};

/// Samples the gather of the frame that `renderFrame` makes of the same arguments and climbs both ladders at each sample.
///
/// The samples are drawn from all (pixel, cone, step) at which the frame looks light up, each with the same probability, without replacement:
/// those with the smallest Philox keys of (pixel, cone, step, seed). Same result for any number of threads, on one machine.
/// Throws InputError when the scene has no light or the frame makes no lookup, MachineError from Embree.
LadderScene climbLadder(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, const LadderOptions& options);

}  // namespace lrsm
