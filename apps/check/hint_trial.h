#pragma once

#include "apps/check/hints.h"
#include "core/base/parallel.h"

#include <cmath>

/// The court of suspicions (internal to the hints).
namespace lrsm {

/// Collects suspicions and how many wrong elements each leaves.
class HintTrial {
  public:
    explicit HintTrial(const HintQuestion& question);

    const HintQuestion& question() const { return question_; }
    const Buffer& expected() const { return question_.expected; }
    const Capture& inputs() const { return question_.inputs; }
    std::size_t count() const { return count_; }
    double expectedAt(std::size_t i) const { return decodedValue(question_.expected, i); }
    double candidateAt(std::size_t i) const
    {
        return question_.candidate.given.empty() ? decodedValue(question_.candidate.buffer, i) : question_.candidate.given[i];
    }
    /// Elements that are wrong now, at most some thousands, evenly drawn.
    const std::vector<std::size_t>& sample() const { return sample_; }
    /// Which components have wrong elements; empty without a component axis.
    const std::vector<bool>& wrongComponents() const { return wrongComponents_; }
    std::size_t components() const { return std::max<std::size_t>(question_.expected.components.size(), 1); }

    /// Is the candidate's element what `predicted` would be in its storage?
    bool fits(double predicted, std::size_t i) const
    {
        const double c = candidateAt(i);
        if (std::isnan(predicted) || std::isnan(c)) return std::isnan(predicted) == std::isnan(c);
        if (predicted == c) return true;
        switch (kind_) {
        case Tolerance::Kind::exact: return std::abs(predicted - c) <= kExactSlack * std::abs(predicted);
        case Tolerance::Kind::ulp: return std::abs(ordinalOf(expected(), predicted) - ordinalOf(expected(), c)) <= slack_;
        case Tolerance::Kind::absolute: return std::abs(predicted - c) <= slack_;
        case Tolerance::Kind::relative: break;
        }
        return std::abs(predicted - c) <= slack_ * std::max(std::abs(predicted), floor_);
    }
    bool wrong(std::size_t i) const { return compared(expected(), i) && !fits(expectedAt(i), i); }

    /// Tests `predict(i)` on the sample, and if that looks well on all elements. NaN: no prediction, taken as what is expected.
    template <class Predict>
    bool suspect(const std::string& text, const Predict& predict)
    {
        std::size_t explained = 0;
        for (const std::size_t i : sample_) explained += fits(predict(i), i) ? 1 : 0;
        if (explained * 2 < sample_.size() || sample_.empty()) return false;
        std::vector<std::size_t> left((count_ + kChunk - 1) / kChunk, 0);
        parallelFor(left.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t chunk = begin; chunk < end; ++chunk)
                for (std::size_t i = chunk * kChunk; i < std::min(count_, (chunk + 1) * kChunk); ++i)
                    left[chunk] += compared(expected(), i) && !fits(predict(i), i) ? 1 : 0;
        });
        std::size_t total = 0;
        for (const std::size_t each : left) total += each;
        return note(text, total, wrongCount_);
    }

    /// A suspicion tested elsewhere: it leaves `left` of `before` wrong elements. Was it good enough to be spoken?
    bool note(const std::string& text, std::size_t left, std::size_t before);

    std::vector<std::string> spoken() const;

  private:
    static constexpr std::size_t kChunk = 1 << 16;
    static constexpr double kExactSlack = 1e-7;

    struct Suspicion {
        std::string text;
        std::size_t left = 0, before = 0;
        double share() const { return static_cast<double>(left) / static_cast<double>(before); }
    };

    const HintQuestion& question_;
    std::size_t count_ = 0, wrongCount_ = 0;
    Tolerance::Kind kind_ = Tolerance::Kind::exact;
    double slack_ = 0.0, floor_ = 0.0;
    std::vector<std::size_t> sample_;
    std::vector<bool> wrongComponents_;
    std::vector<Suspicion> suspicions_;
};

// The suspicions, family by family. Each adds to the trial what it finds.
void suspectLayout(HintTrial& trial);    ///< flipped, transposed, shifted, layers or channels exchanged, another buffer
void suspectValues(HintTrial& trial);    ///< factors, offsets, signs, encodings, clipping
void suspectMips(HintTrial& trial);      ///< picked instead of averaged, the wrong level
void suspectRounding(HintTrial& trial);  ///< truncated, nearest even, toward zero
void suspectFormulas(HintTrial& trial);  ///< what a pass may have forgotten: alpha, <n.l>, albedo, the layer's range
void suspectPass(HintTrial& trial);      ///< other settings and other inputs, by running the pass

}  // namespace lrsm
