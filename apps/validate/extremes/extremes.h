#pragma once

#include "core/report/chart.h"

#include <functional>
#include <string>
#include <vector>

/// The catalogue of extremes: named, repeatable cases at and beyond the edges of what the pipeline is made for. Each states what must hold: finite
/// values from every pass, the stated bound, or one clear line that refuses the input; and the same bits when run again.
namespace lrsm {

enum class Outcome {
    held,     ///< what must hold does
    refused,  ///< bad input, answered with one clear InputError
    skipped,  ///< not run here, and `detail` says why (more memory than the machine has)
    broken    ///< a NaN or infinity, a bound exceeded, two runs that differ, an unclear refusal, a refusal where a result is due
};

/// One case in one storage mode.
struct ExtremeResult {
    std::string name;      ///< of the case; with `storage` unique in the catalogue
    std::string group;     ///< "moments", "layers", "storage", "depth ranges", "geometry", "scale", "lights", "cones", "resolutions", "camera", "files"
    std::string what;      ///< what is done
    std::string mustHold;  ///< what must hold
    std::string storage;   ///< "gpu d3d", "gpu nearest_even", "float32", or "any" where the case stores nothing
    Outcome outcome = Outcome::broken;
    std::string detail;  ///< measured value against its bound, the refusal's line, or what broke
};

/// Where accuracy degrades: error against how extreme the input is, both on logarithmic axes; an error of 0 is reported as 1e-12.
struct ExtremeCurve {
    std::string name, xLabel, yLabel;
    std::vector<ChartSeries> series;
    double bound = 0.0;              ///< error that counts as accurate
    double degradesFrom = 0.0;       ///< x from which on some series exceeds `bound`; +infinity: nowhere in the range
    bool degradesDownwards = false;  ///< accuracy is lost towards small x: `degradesFrom` is the largest such x; 0: nowhere in the range
    std::string sentence;            ///< the same in words
};

struct ExtremesReport {
    std::vector<ExtremeResult> results;  ///< in the catalogue's order
    std::vector<ExtremeCurve> curves;
    bool held() const;  ///< no result is `broken`
};

struct ExtremesOptions {
    std::string only;                                                        ///< run the cases and curves whose group or name contains this; empty: all
    std::function<void(const std::string& name, double fraction)> progress;  ///< may be empty
};

/// Runs the catalogue, every case twice. About a minute on two cores for all of it. A case that throws anything but InputError is `broken`; nothing escapes.
ExtremesReport runExtremes(const ExtremesOptions& options = {});

}  // namespace lrsm
