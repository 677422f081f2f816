#pragma once

#include "apps/common/progress.h"
#include "apps/sweep/axes.h"
#include "apps/sweep/measure.h"
#include "apps/sweep/row_store.h"

#include <atomic>
#include <optional>
#include <string>
#include <vector>

/// A sweep under way: renders what the folder does not hold yet, and keeps every row the moment it is there.
namespace lrsm {

/// A case with what is fixed for all its rows.
struct SweptCase {
    SceneCase scene;
    TruthFigures figures;
    std::string key;
};

struct SweepTask {
    std::size_t sceneCase = 0;
    NamedSettings named;
    RowKind kind = RowKind::axis;
    std::string base;
};

struct SweepRunOptions {
    std::string folder;
    int repeat = 3;
    double maxMemoryMegabytes = 0.0;  ///< 0: no limit
    bool quiet = false;
    const std::atomic<bool>* stop = nullptr;
};

class SweepRun {
  public:
    SweepRun(const std::vector<SweptCase>& cases, RowStore& store, const SweepRunOptions& options);

    /// What `progress` shows goes on from here; `expected` rows are wanted in all.
    void expect(std::size_t rows) { expected_ += rows; }

    /// The row that the folder holds, or a new one. Nothing when it cannot be rendered (the reason is said on standard error, once) or a stop was asked for.
    const Measurement* measure(const SweepTask& task);
    /// False when a stop was asked for.
    bool measurePathTracer(std::size_t sceneCase, std::uint64_t samples);

    bool stopped() const { return options_.stop && *options_.stop; }
    std::size_t measured() const { return measured_; }
    std::size_t found() const { return found_; }
    const std::vector<std::string>& skipped() const { return skipped_; }

  private:
    void show(const SweptCase& sceneCase, const std::string& label, double fraction);
    void keep(const SweptCase& sceneCase, const Measured& measured);
    void writeThumbnail(const SweptCase& sceneCase, const std::string& key, const Image<Vec3>& irradiance) const;

    const std::vector<SweptCase>& cases_;
    RowStore& store_;
    SweepRunOptions options_;
    Calibration calibration_;
    Progress progress_;
    std::chrono::steady_clock::time_point begun_;
    std::size_t expected_ = 0, measured_ = 0, found_ = 0;
    std::vector<std::string> skipped_;
};

/// Mean over boxes, at most `width` wide; a smaller picture is left as it is.
Image<Vec3> shrink(const Image<Vec3>& picture, int width);

}  // namespace lrsm
