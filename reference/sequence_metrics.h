#pragma once

#include "core/scene/scene.h"
#include "reference/metrics.h"

#include <deque>
#include <optional>
#include <vector>

/// How two sequences of pictures move, and how far apart, in numbers. x: test, r: truth, e = x - r, luminances of a pixel; D2 x = x(t-1) - 2 x(t) + x(t+1),
/// which is 0 where light fades at a steady rate. Means run over pixels that count in all frames concerned, and over time; `mean r` is over all of them.
///
/// F   = mean |D2 x| / mean r          how much the picture flickers, the truth's own beside it: light that really changes its pace is in both
/// F_e = mean |D2 e| / mean r          what of it is error: the headline. A second seed of the truth in place of x is its floor
/// V   = mean Var_t x / (mean r)^2     over pixels whose r varies by less than kStillShare: what dances where nothing moves
/// J   = the largest over time of the 99.9th percentile over pixels of |e(t) - e(t-1)| / mean r: pops
namespace lrsm {

/// Standard deviation over mean in time, below which a pixel of the truth stands still.
inline constexpr double kStillShare = 0.01;
inline constexpr double kJumpPercentile = 0.999;
/// Of a depth: how far a pixel's place may be from what another frame shows where it lies there, to be the same place.
inline constexpr float kSamePlaceShare = 0.02f;

/// One moment of both.
struct MomentPair {
    Image<double> test, reference;  ///< luminance
    PixelMask valid;                ///< which pixels count; all of one size
    /// Where the camera moves, pixels follow their place: to the pixel it falls into in the other frame, if that shows the same object (where it is known) at
    /// the same place, within kSamePlaceShare of the depth, and one the same depth. Empty and none: pixels stand still.
    std::optional<Camera> camera = {};
    Image<Vec3> position = {};  ///< world
    Image<float> depth = {};    ///< along the viewing axis
    Image<float> object = {};   ///< a number each; empty: unknown
};

/// Luminance of a picture (Rec. 709), in double.
Image<double> luminances(const Image<Vec3>& picture);

/// Numbers of one moment; of what needs a moment before or after that is not there: NaN.
struct MomentMetrics {
    double meanTest = 0.0, meanReference = 0.0, rmse = 0.0;              ///< as measure()'s, of luminances; rmse over `mean r` of the sequence
    double flicker = 0.0, flickerReference = 0.0, flickerOfError = 0.0;  ///< F, the truth's, F_e at this moment
    double jump = 0.0;                                                   ///< of J, from the moment before to this
};

struct SequenceMetrics {
    double meanReference = 0.0;
    double flicker = 0.0, flickerReference = 0.0, flickerOfError = 0.0;  ///< F, the truth's, F_e
    double jump = 0.0;                                                   ///< J
    std::optional<double> dance;                                         ///< V; nothing where the camera moves or no pixel stands still
    double stillShare = 0.0;                                             ///< of the pixels: what V is over
    double followedShare = 1.0;                                          ///< of pixels and pairs of moments: what was found again
    std::vector<MomentMetrics> moments;
    std::size_t worstFlicker = 0, worstJump = 0;              ///< indices into `moments`: largest F_e, first; largest jump, first
    Image<double> flickerMap, flickerReferenceMap, danceMap;  ///< a pixel's mean |D2 e| and |D2 r| over mean r, and sqrt Var_t x / mean r (0 where r moves)
};

/// Moments in order, one at a time; three at a time are held.
class SequenceMeter {
  public:
    void add(MomentPair moment);
    /// Three moments at least.
    SequenceMetrics finish() const;

  private:
    struct Sums {
        double test = 0.0, reference = 0.0, squaredError = 0.0, flicker = 0.0, flickerReference = 0.0, flickerOfError = 0.0, jump = 0.0;
        std::uint64_t pixels = 0, bends = 0;
    };
    /// A pixel's course in time, by Welford's recurrence: sums of squared deviations are 0 to the bit where nothing changes.
    struct Course {
        double meanTest = 0.0, squaresTest = 0.0, meanReference = 0.0, squaresReference = 0.0;
        std::uint32_t count = 0;
    };
    void follow(const MomentPair& moment);
    void jumpTo(const MomentPair& before, const MomentPair& now, Sums& sums);
    void bendAt(const MomentPair& before, const MomentPair& now, const MomentPair& after, Sums& sums);

    std::deque<MomentPair> window_;
    std::vector<Sums> sums_;
    std::vector<Course> courses_;
    Image<double> bendError_, bendReference_;
    Image<double> bends_;
    bool cameraMoves_ = false;
    std::uint64_t sought_ = 0, found_ = 0;
};

}  // namespace lrsm
