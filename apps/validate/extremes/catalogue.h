#pragma once

#include "apps/validate/extremes/extremes.h"
#include "conetrace/lrsm/gather.h"
#include "conetrace/render.h"
#include "core/base/hash.h"

#include <initializer_list>

/// How the catalogue is written and run; only its own files and its tests include this.
namespace lrsm::extremes {

enum class Mode { gpuD3d, gpuNearestEven, float32, any };
const char* nameOf(Mode mode);
inline constexpr Mode kStorageModes[] = {Mode::gpuD3d, Mode::gpuNearestEven, Mode::float32};

/// What one run of a case finds: values against bounds, what broke, and a hash of everything it saw, so that two runs can be compared.
class Probe {
  public:
    /// |value| <= bound; NaN breaks it.
    void bound(const std::string& name, double value, double bound);
    void require(bool holds, const std::string& what);
    /// Into the hash alone.
    void note(double value) { values_.push_back(value); }
    void note(const std::string& text) { texts_ += text + "\n"; }
    /// A pass's output: no NaN or infinity in it.
    template <class Output>
    void output(const std::string& pass, const Output& made)
    {
        checkFinite(pass, countNonFinite(made));
        note(hashOf(made));
    }
    /// All passes of a frame, and its pictures.
    void frame(const Frame& frame);
    /// `run` must end with an InputError of one clear line that contains `says`.
    void refuses(const std::string& what, const std::string& says, const std::function<void()>& run);
    void skip(const std::string& why) { skipped_ = why; }
    void refused(const std::string& line);

    bool broken() const { return !broken_.empty(); }
    ExtremeResult result() const;
    std::string fingerprint() const;

  private:
    void checkFinite(const std::string& pass, std::uint64_t count);

    std::vector<double> values_;
    std::string texts_, broken_, worst_, refusal_, skipped_;
    double worstShare_ = -1.0;  ///< of its bound
    int bounds_ = 0, refusals_ = 0, passes_ = 0;
};

struct Case {
    std::string name, what, mustHold;
    std::function<void(Mode, Probe&)> run;
    bool storesNothing = false;  ///< one run for all modes
    bool mustRefuse = false;     ///< an InputError is what must come; else it breaks the case
};

/// A case that an InputError must end.
inline Case refusal(const std::string& name, const std::string& what, const std::function<void(Mode, Probe&)>& run)
{
    return {name, what, "refused in one line", run, true, true};
}

struct Group {
    std::string name;
    std::vector<Case> cases;
};

/// A clear line: one line, a place, a colon, a reason.
bool isClear(const std::string& line);

/// Runs the case twice in this mode; nothing escapes.
ExtremeResult runCase(const Group& group, const Case& entry, Mode mode);

/// A point of a curve: y for this x.
struct CurvePlan {
    std::string name, xLabel, yLabel;
    std::vector<double> x;
    std::vector<Mode> modes;
    std::function<double(Mode, double x)> y;
    double bound = 0.0;
    bool degradesDownwards = false;
    std::string subject;  ///< begins the sentence: "Irradiance of a translated room"
};
ExtremeCurve drawCurve(const CurvePlan& plan);

Group momentCases();
Group layerCases();
Group storageCases();
Group depthCases();
Group geometryCases();
Group scaleCases();
Group lightCases();
Group cameraCases();
Group coneCases();
Group resolutionCases();
Group settingCases();
Group fileCases();
std::vector<CurvePlan> curvePlans();

}  // namespace lrsm::extremes
