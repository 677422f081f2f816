#pragma once

#include "core/base/image.h"
#include "core/base/math.h"

/// FLIP: how visible a difference is to someone who flips between two pictures.
/// Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020; for high dynamic range "Visualizing Errors in Rendered
/// High Dynamic Range Images", Eurographics 2021. Section numbers below are the 2020 paper's.
namespace lrsm {

/// Pixels per degree of a 3840-pixel display, 0.7 m wide, seen from 0.7 m: the papers' default, 67.02.
inline constexpr double kFlipPixelsPerDegree = 0.7 * (3840 / 0.7) * (3.14159265358979323846 / 180.0);

/// Error in [0, 1] of each pixel. Both pictures are linear Rec. 709 of one size; values are clipped to [0, 1]. NaN counts as 0.
Image<float> flip(const Image<Vec3>& reference, const Image<Vec3>& test, double pixelsPerDegree = kFlipPixelsPerDegree);

/// Exposures at which HDR-FLIP looks, in stops.
struct FlipExposures {
    double start = 0.0, stop = 0.0;
    int count = 2;  ///< >= 1, evenly spaced, both ends included
    bool operator==(const FlipExposures&) const = default;
};

/// The exposures that the 2021 paper derives from the reference: its brightest pixel, and its median, reach 0.85 after tone mapping.
/// A picture without light gets 0, 0, 1.
FlipExposures automaticFlipExposures(const Image<Vec3>& reference);

/// Largest LDR error over the exposures after the ACES tone curve (Narkowicz's fit, as in the 2021 paper).
Image<float> hdrFlip(const Image<Vec3>& reference, const Image<Vec3>& test, const FlipExposures& exposures, double pixelsPerDegree = kFlipPixelsPerDegree);

/// How the errors of a picture are pooled. Weighted quantiles count each pixel by its error, so that a small, badly wrong region shows.
struct FlipPool {
    double mean = 0.0, weightedMedian = 0.0, firstWeightedQuartile = 0.0, thirdWeightedQuartile = 0.0, min = 0.0, max = 0.0;
};
FlipPool poolFlip(const Image<float>& errors);

}  // namespace lrsm
