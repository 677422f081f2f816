#pragma once

#include "apps/sweep/measurement.h"
#include "core/scene/scene.h"
#include "reference/metrics.h"
#include "reference/path_trace.h"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

/// Renders a case with one setting, times it beside the calibration frame, and holds it against the truth.
namespace lrsm {

/// What the path tracer says of a case.
struct Truth {
    Image<Vec3> irradiance, variance;  ///< single bounce; variance of the mean
    PixelMask covered;                 ///< pixels that show a surface
    std::uint64_t samples = 0;
    std::string sha256;  ///< of the samples' identity and number: part of the case's key
};
/// From the sums' picture and what the tracer's eye saw. InputError naming `place` where a variance is missing (fewer than two blocks).
Truth truthOf(const ReferenceFrame& frame, const PixelMask& covered, const std::string& sha256, const std::string& place);

/// A scene seen by one camera at one size, with its truth.
struct SceneCase {
    std::string name;
    Scene scene;
    Camera camera;
    int width = 0, height = 0;
    Truth truth;
    std::string sceneSha256 = {};  ///< hashScene(scene), which takes a while for a large one; where empty it is computed by every caseKeyOf
};
std::string caseKeyOf(const SceneCase& sceneCase);
std::string rowKeyOf(const std::string& caseKey, const Settings& settings);
std::string rowKeyOf(const std::string& caseKey, std::uint64_t pathTracerSamples);

/// The noise floor and the exposure that FLIP uses, once a case.
struct TruthFigures {
    double noise = 0.0;  ///< RMSE of the truth itself over its mean
    float exposureStops = 0.0f;
};
TruthFigures figuresOf(const Truth& truth);
PictureError errorOf(const Truth& truth, const TruthFigures& figures, const Image<Vec3>& irradiance);

/// A fixed frame (built-in Cornell box, 96 x 54, settings written out here and nowhere else), rendered beside every measurement: the unit of
/// cost. What slows the machine for a while slows both.
class Calibration {
  public:
    /// Renders it twice, so that what only a first frame pays is paid.
    Calibration();
    static Settings settings();
    /// Renders it once: processor time and wall time of its passes, ms.
    struct Times {
        double cpu = 0.0, wall = 0.0;
    };
    Times run() const;

  private:
    Scene scene_;
};

struct MeasureOptions {
    int repeat = 1;  ///< frames timed; the calibration frame runs before each
    std::function<void(double fraction)> progress = {};
    const std::atomic<bool>* stop = nullptr;  ///< ends the path tracer between two pictures
};

struct Measured {
    Measurement row;  ///< label, kind and base are the caller's to fill in
    Image<Vec3> irradiance;
};
/// Nothing of the frame is hashed but the irradiance. The calibration frame runs before each frame and after the last. Throws what renderFrame throws.
Measured measureSettings(const SceneCase& sceneCase, const TruthFigures& figures, const Settings& settings, const Calibration& calibration,
                         const MeasureOptions& options);

/// The path tracer at 1, 2, 4 ... `maxSamples` paths a pixel, with other random numbers than the truth's: one run, each picture with all the time so far,
/// the BVH's and the primary rays' included. `bytes` is 0: Embree does not say. Each row is handed to `made` at once; stopped, the rest is missing.
std::vector<Measured> measurePathTracer(const SceneCase& sceneCase, const TruthFigures& figures, std::uint64_t maxSamples, const Calibration& calibration,
                                        const MeasureOptions& options, const std::function<void(const Measured&)>& made = {});

}  // namespace lrsm
