#include "apps/check/hint_trial.h"

#include <algorithm>

namespace lrsm {

namespace {

constexpr std::size_t kSample = 4096;
constexpr double kSure = 0.02;   // share of wrong elements that a suspicion may leave
constexpr double kPartly = 0.4;  // the same, when no suspicion is sure
constexpr std::size_t kMostHints = 3;
constexpr double kStrictShare = 1e-6;

}  // namespace

HintTrial::HintTrial(const HintQuestion& question) : question_(question), count_(valueCount(question.expected))
{
    const Tolerance& tolerance = question.expected.tolerance;
    kind_ = tolerance.kind;
    floor_ = tolerance.floor;
    // Where nothing is outside the tolerance, too many elements differ within it: then the very bits are in question.
    const bool strict = question.comparison.outside == 0;
    if (kind_ == Tolerance::Kind::ulp)
        slack_ = strict ? 0.499 : std::max(tolerance.value, 1.0);
    else
        slack_ = strict ? kStrictShare * tolerance.value : tolerance.value;

    wrongComponents_.assign(question.expected.components.size(), false);
    std::vector<std::size_t> wrongOnes;
    for (std::size_t i = 0; i < count_; ++i) {
        if (!wrong(i)) continue;
        ++wrongCount_;
        if (!wrongComponents_.empty()) wrongComponents_[i % wrongComponents_.size()] = true;
        wrongOnes.push_back(i);
    }
    const std::size_t stride = wrongOnes.size() / kSample + 1;
    for (std::size_t i = stride / 2; i < wrongOnes.size(); i += stride) sample_.push_back(wrongOnes[i]);
}

bool HintTrial::note(const std::string& text, std::size_t left, std::size_t before)
{
    if (before == 0 || static_cast<double>(left) > kPartly * static_cast<double>(before)) return false;
    suspicions_.push_back({text, left, before});
    return static_cast<double>(left) <= kSure * static_cast<double>(before);
}

std::vector<std::string> HintTrial::spoken() const
{
    std::vector<Suspicion> sorted = suspicions_;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Suspicion& a, const Suspicion& b) { return a.share() < b.share(); });
    std::vector<std::string> texts;
    for (const Suspicion& s : sorted) {
        const bool sure = s.share() <= kSure;
        if (texts.size() == kMostHints || (!sure && !texts.empty())) break;
        const std::string explained =
            s.left == 0 ? "explains all " + std::to_string(s.before) : "explains " + std::to_string(s.before - s.left) + " of " + std::to_string(s.before);
        texts.push_back((sure ? "" : "partly: ") + s.text + " (" + explained + ")");
    }
    return texts;
}

}  // namespace lrsm
