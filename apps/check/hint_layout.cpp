// Right values in the wrong places.
#include "apps/check/hint_trial.h"

#include <algorithm>
#include <numeric>

namespace lrsm {

namespace {

constexpr std::size_t kNowhere = ~std::size_t(0);
constexpr double kSampleFits = 0.98;

/// Which element of the expected buffer stands where each of the candidate's does, axis by axis.
struct Rearrangement {
    std::vector<std::size_t> extents, strides;
    std::vector<std::vector<std::size_t>> index;  ///< of each axis: where to read; kNowhere: from outside

    explicit Rearrangement(const Buffer& buffer) : extents(extentsOf(buffer)), strides(extents.size(), 1), index(extents.size())
    {
        for (std::size_t axis = extents.size(); axis-- > 0;) {
            if (axis + 1 < extents.size()) strides[axis] = strides[axis + 1] * extents[axis + 1];
            index[axis].resize(extents[axis]);
            std::iota(index[axis].begin(), index[axis].end(), std::size_t(0));
        }
    }
    std::size_t source(std::size_t element) const
    {
        std::size_t from = 0;
        for (std::size_t axis = extents.size(); axis-- > 0;) {
            const std::size_t i = index[axis][element % extents[axis]];
            if (i == kNowhere) return kNowhere;
            from += i * strides[axis];
            element /= extents[axis];
        }
        return from;
    }
};

class LayoutSuspicions {
  public:
    explicit LayoutSuspicions(HintTrial& trial) : trial_(trial), buffer_(trial.expected()), plain_(buffer_), names_(axisNamesOf(buffer_))
    {
        spatial_ = plain_.extents.size() - (buffer_.components.empty() ? 0 : 1);
    }

    void run()
    {
        flips();
        transposes();
        exchangedAlong();
        exchangedComponents();
        shifts();
        otherBuffers();
    }

  private:
    bool suspect(const std::string& text, const Rearrangement& r)
    {
        return trial_.suspect(text, [&](std::size_t i) {
            const std::size_t from = r.source(i);
            return from == kNowhere ? trial_.candidateAt(i) : trial_.expectedAt(from);  // what came from outside is anybody's guess
        });
    }
    bool isLine(std::size_t axis) const
    {
        return names_[axis] == "row" || names_[axis] == "column" || names_[axis] == "x" || names_[axis] == "y" || names_[axis] == "z";
    }

    void flips()
    {
        std::vector<std::size_t> lines;
        for (std::size_t axis = 0; axis < spatial_; ++axis)
            if (isLine(axis) && plain_.extents[axis] > 1) lines.push_back(axis);
        for (const std::size_t axis : lines) {
            Rearrangement r = plain_;
            std::reverse(r.index[axis].begin(), r.index[axis].end());
            suspect(names_[axis] + (names_[axis].size() > 1 ? "s are flipped" : " is flipped"), r);
        }
        if (lines.size() < 2) return;
        Rearrangement r = plain_;
        for (std::size_t i = lines.size() - 2; i < lines.size(); ++i) std::reverse(r.index[lines[i]].begin(), r.index[lines[i]].end());
        suspect(names_[lines[lines.size() - 2]] + "s and " + names_[lines.back()] + "s are both flipped", r);
    }

    void transposes()
    {
        for (std::size_t a = 0; a < spatial_; ++a)
            for (std::size_t b = a + 1; b < spatial_; ++b) {
                if (!isLine(a) || !isLine(b) || plain_.extents[a] != plain_.extents[b] || plain_.extents[a] < 2) continue;
                Rearrangement r = plain_;
                std::swap(r.strides[a], r.strides[b]);
                suspect(names_[a] + (names_[a].size() > 1 ? "s" : "") + " and " + names_[b] + (names_[b].size() > 1 ? "s" : "") + " are exchanged (transposed)",
                        r);
            }
    }

    void shifts()
    {
        for (std::size_t axis = 0; axis < spatial_; ++axis) {
            if (!isLine(axis) || plain_.extents[axis] < 4) continue;
            for (const int by : {1, -1}) {
                Rearrangement r = plain_;
                for (std::size_t i = 0; i < plain_.extents[axis]; ++i) {
                    const bool outside = by > 0 ? i == 0 : i + 1 == plain_.extents[axis];
                    r.index[axis][i] = outside ? kNowhere : by > 0 ? i - 1 : i + 1;
                }
                suspect("all is one " + names_[axis] + " too far " + (by > 0 ? "up (towards higher " : "down (towards lower ") + names_[axis] + "s)", r);
            }
        }
    }

    /// Wrong elements with index `at` along `axis` that fit what is expected at `from`.
    bool sampleFits(std::size_t axis, std::size_t at, std::size_t from) const
    {
        std::size_t tried = 0, fitting = 0;
        for (const std::size_t i : trial_.sample()) {
            if (i / plain_.strides[axis] % plain_.extents[axis] != at) continue;
            ++tried;
            fitting += trial_.fits(trial_.expectedAt(i + from * plain_.strides[axis] - at * plain_.strides[axis]), i) ? 1 : 0;
        }
        return tried > 0 && static_cast<double>(fitting) >= kSampleFits * static_cast<double>(tried);
    }
    bool anyWrong(std::size_t axis, std::size_t at) const
    {
        return std::any_of(trial_.sample().begin(), trial_.sample().end(),
                           [&](std::size_t i) { return i / plain_.strides[axis] % plain_.extents[axis] == at; });
    }

    /// What stands where another index along the axis is expected.
    struct Exchange {
        Rearrangement r;
        std::string moved;
        std::size_t count = 0;
        bool pair = false;  ///< two that hold each other:
        std::size_t low = 0, high = 0;
    };
    template <class Wrong, class Source, class Text>
    Exchange exchangesOn(std::size_t axis, const Wrong& wrong, const Source& source, const Text& text) const
    {
        Exchange found{.r = plain_, .moved = {}};
        std::vector<std::size_t>& index = found.r.index[axis];
        std::size_t last = 0;
        for (std::size_t at = 0; at < index.size(); ++at) {
            if (!wrong(at)) continue;
            for (std::size_t from = 0; from < index.size(); ++from)
                if (from != at && source(from) && sampleFits(axis, at, from)) {
                    index[at] = from;
                    found.moved += (found.moved.empty() ? "" : ", ") + text(at, from);
                    last = at;
                    ++found.count;
                    break;
                }
        }
        found.pair = found.count == 2 && index[index[last]] == last;
        found.low = std::min(last, index[last]);
        found.high = std::max(last, index[last]);
        return found;
    }

    /// Layers or cones in another order.
    void exchangedAlong()
    {
        for (std::size_t axis = 0; axis < spatial_; ++axis) {
            if (isLine(axis) || plain_.extents[axis] < 2 || plain_.extents[axis] > 256) continue;
            const Exchange x = exchangesOn(
                axis, [&](std::size_t at) { return anyWrong(axis, at); }, [](std::size_t) { return true; },
                [](std::size_t at, std::size_t from) { return std::to_string(at) + " holds " + std::to_string(from); });
            if (x.count == 0) continue;
            suspect(x.pair ? names_[axis] + "s " + std::to_string(x.low) + " and " + std::to_string(x.high) + " are exchanged"
                           : names_[axis] + "s are in another order: " + x.moved,
                    x.r);
        }
    }

    /// Channels exchanged.
    void exchangedComponents()
    {
        const std::vector<std::string>& names = buffer_.components;
        if (names.size() < 2) return;
        const Exchange x = exchangesOn(
            plain_.extents.size() - 1, [&](std::size_t at) { return trial_.wrongComponents()[at]; }, [&](std::size_t from) { return !names[from].empty(); },
            [&](std::size_t at, std::size_t from) { return "'" + names[at] + "' holds '" + names[from] + "'"; });
        if (x.count == 0) return;
        suspect(x.pair ? "channels '" + names[x.low] + "' and '" + names[x.high] + "' are exchanged" : "channels are mixed up: " + x.moved, x.r);
    }

    void otherBuffers()
    {
        for (const Buffer& other : trial_.inputs().buffers) {
            if (other.name == buffer_.name || other.bytes.size() != buffer_.bytes.size() || other.dtype != buffer_.dtype || other.shape != buffer_.shape ||
                other.encoding != buffer_.encoding)
                continue;
            trial_.suspect("it holds " + other.name, [&](std::size_t i) { return decodedValue(other, i); });
        }
    }

    HintTrial& trial_;
    const Buffer& buffer_;
    Rearrangement plain_;
    std::vector<std::string> names_;
    std::size_t spatial_ = 0;
};

/// numpy.packbits without bitorder="little".
void suspectBitOrder(HintTrial& trial)
{
    trial.suspect("the bits of each byte are in reverse order (lowest bit first is expected; numpy: bitorder=\"little\")",
                  [&](std::size_t i) { return trial.expectedAt(i ^ 7); });
}

}  // namespace

void suspectLayout(HintTrial& trial)
{
    if (trial.expected().encoding == Encoding::bits) {
        suspectBitOrder(trial);
        if (trial.expected().dtype == Dtype::u8) return;  // the same voxels as voxel.bits, which says it better
        trial.suspect("occupied and empty are exchanged", [&](std::size_t i) { return 1.0 - trial.expectedAt(i); });
    }
    if (!trial.expected().shape.empty()) LayoutSuspicions(trial).run();
}

}  // namespace lrsm
