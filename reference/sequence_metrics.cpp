#include "reference/sequence_metrics.h"

#include "core/base/elementary.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace lrsm {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// All but the near plane, which hangs on what stands about.
bool sameView(const std::optional<Camera>& a, const std::optional<Camera>& b)
{
    if (!a || !b) return true;
    return a->position == b->position && a->forward == b->forward && a->up == b->up && a->perspective == b->perspective && a->verticalFov == b->verticalFov &&
           a->verticalExtent == b->verticalExtent;
}

/// Where a place falls in a camera's picture, pixels, and its depth; the inverse of pixelRay.
struct Projected {
    double x = 0.0, y = 0.0, depth = 0.0;
};

Projected project(const Camera& camera, int width, int height, const Vec3& place)
{
    const glm::dvec3 d = glm::dvec3(place) - glm::dvec3(camera.position), right = glm::cross(glm::dvec3(camera.forward), glm::dvec3(camera.up));
    const double depth = glm::dot(d, glm::dvec3(camera.forward));
    const double half = camera.perspective ? tangent(0.5 * double(camera.verticalFov)) * depth : 0.5 * double(camera.verticalExtent);
    return {0.5 * (width + height * glm::dot(d, right) / half), 0.5 * height * (1.0 - glm::dot(d, glm::dvec3(camera.up)) / half), depth};
}

/// The pixel of `to` that shows what pixel i of `from` does; nothing where none does, or what it shows does not count.
std::optional<std::size_t> followed(const MomentPair& from, std::size_t i, const MomentPair& to)
{
    if (!from.valid.texels[i]) return {};
    if (sameView(from.camera, to.camera)) return to.valid.texels[i] ? std::optional(i) : std::nullopt;
    if (from.depth.texels[i] == 0.0f) return {};
    const Vec3& place = from.position.texels[i];
    const Projected at = project(*to.camera, to.valid.width, to.valid.height, place);
    if (!(at.depth > 0.0) || !(at.x >= 0.0 && at.x < to.valid.width && at.y >= 0.0 && at.y < to.valid.height)) return {};
    const std::size_t k = to.valid.index(int(at.x), int(at.y));
    if (!to.valid.texels[k] || to.depth.texels[k] == 0.0f) return {};
    if (!from.object.empty() && !to.object.empty() && from.object.texels[i] != to.object.texels[k]) return {};
    const double allowed = double(kSamePlaceShare) * at.depth;
    if (std::abs(double(to.depth.texels[k]) - at.depth) > allowed || double(glm::length(to.position.texels[k] - place)) > allowed) return {};
    return k;
}

double error(const MomentPair& moment, std::size_t i)
{
    return moment.test.texels[i] - moment.reference.texels[i];
}

}  // namespace

Image<double> luminances(const Image<Vec3>& picture)
{
    Image<double> result(picture.width, picture.height);
    for (std::size_t i = 0; i < picture.texels.size(); ++i) {
        const glm::dvec3 c(picture.texels[i]);
        result.texels[i] = double(0.2126f) * c.x + double(0.7152f) * c.y + double(0.0722f) * c.z;  // exact products
    }
    return result;
}

void SequenceMeter::add(MomentPair moment)
{
    assert(window_.empty() || window_.back().test.texels.size() == moment.test.texels.size());
    if (!window_.empty()) cameraMoves_ |= !sameView(window_.back().camera, moment.camera);
    Sums sums;
    for (std::size_t i = 0; i < moment.test.texels.size(); ++i) {
        if (!moment.valid.texels[i]) continue;
        ++sums.pixels;
        sums.test += moment.test.texels[i];
        sums.reference += moment.reference.texels[i];
        sums.squaredError += error(moment, i) * error(moment, i);
    }
    follow(moment);
    if (!window_.empty()) jumpTo(window_.back(), moment, sums);
    if (window_.size() == 2) bendAt(window_[0], window_[1], moment, sums_.back());
    sums_.push_back(sums);
    window_.push_back(std::move(moment));
    if (window_.size() > 2) window_.pop_front();
}

void SequenceMeter::follow(const MomentPair& moment)
{
    courses_.resize(moment.test.texels.size());
    for (std::size_t i = 0; i < courses_.size(); ++i) {
        if (!moment.valid.texels[i]) continue;
        Course& c = courses_[i];
        ++c.count;
        const double x = moment.test.texels[i] - c.meanTest, r = moment.reference.texels[i] - c.meanReference;
        c.meanTest += x / c.count;
        c.meanReference += r / c.count;
        c.squaresTest += x * (moment.test.texels[i] - c.meanTest);
        c.squaresReference += r * (moment.reference.texels[i] - c.meanReference);
    }
}

void SequenceMeter::jumpTo(const MomentPair& before, const MomentPair& now, Sums& sums)
{
    std::vector<double> jumps;
    for (std::size_t i = 0; i < now.test.texels.size(); ++i) {
        sought_ += now.valid.texels[i];
        const std::optional<std::size_t> then = followed(now, i, before);
        if (!then) continue;
        ++found_;
        jumps.push_back(std::abs(error(now, i) - error(before, *then)));
    }
    if (jumps.empty()) return;
    const auto rank = std::size_t(std::ceil(kJumpPercentile * double(jumps.size()))) - 1;
    std::nth_element(jumps.begin(), jumps.begin() + std::ptrdiff_t(rank), jumps.end());
    sums.jump = jumps[rank];
}

void SequenceMeter::bendAt(const MomentPair& before, const MomentPair& now, const MomentPair& after, Sums& sums)
{
    if (bends_.empty()) bendError_ = bendReference_ = bends_ = Image<double>(now.test.width, now.test.height);
    for (std::size_t i = 0; i < now.test.texels.size(); ++i) {
        const std::optional<std::size_t> then = followed(now, i, before), next = followed(now, i, after);
        if (!then || !next) continue;
        const double x = before.test.texels[*then] - 2.0 * now.test.texels[i] + after.test.texels[*next];
        const double r = before.reference.texels[*then] - 2.0 * now.reference.texels[i] + after.reference.texels[*next];
        const double e = error(before, *then) - 2.0 * error(now, i) + error(after, *next);
        ++sums.bends;
        sums.flicker += std::abs(x);
        sums.flickerReference += std::abs(r);
        sums.flickerOfError += std::abs(e);
        bends_.texels[i] += 1.0;
        bendError_.texels[i] += std::abs(e);
        bendReference_.texels[i] += std::abs(r);
    }
}

SequenceMetrics SequenceMeter::finish() const
{
    assert(sums_.size() >= 3);
    SequenceMetrics metrics;
    Sums all;
    for (const Sums& s : sums_) {
        all.reference += s.reference;
        all.pixels += s.pixels;
        all.bends += s.bends;
        all.flicker += s.flicker;
        all.flickerReference += s.flickerReference;
        all.flickerOfError += s.flickerOfError;
    }
    const double mean = all.pixels > 0 ? all.reference / double(all.pixels) : 0.0;
    metrics.meanReference = mean;
    const auto over = [&](double sum, std::uint64_t count) { return count == 0 ? kNothing : sum == 0.0 ? 0.0 : sum / double(count) / mean; };
    metrics.flicker = over(all.flicker, all.bends);
    metrics.flickerReference = over(all.flickerReference, all.bends);
    metrics.flickerOfError = over(all.flickerOfError, all.bends);
    metrics.followedShare = sought_ > 0 ? double(found_) / double(sought_) : 0.0;

    // Moments, and the worst of them.
    for (std::size_t t = 0; t < sums_.size(); ++t) {
        const Sums& s = sums_[t];
        MomentMetrics m{.meanTest = s.test / double(s.pixels), .meanReference = s.reference / double(s.pixels)};
        m.rmse = mean > 0.0 ? std::sqrt(s.squaredError / double(s.pixels)) / mean : kNothing;
        m.flicker = over(s.flicker, s.bends);
        m.flickerReference = over(s.flickerReference, s.bends);
        m.flickerOfError = over(s.flickerOfError, s.bends);
        m.jump = t > 0 ? over(s.jump, 1) : kNothing;
        metrics.moments.push_back(m);
        // A NaN loses, and is replaced by anything.
        const auto worse = [&](std::size_t& worst, double MomentMetrics::*value) {
            if (!(m.*value <= metrics.moments[worst].*value) && !std::isnan(m.*value)) worst = t;
        };
        worse(metrics.worstFlicker, &MomentMetrics::flickerOfError);
        worse(metrics.worstJump, &MomentMetrics::jump);
    }
    metrics.jump = metrics.moments[metrics.worstJump].jump;

    // Pixels.
    metrics.flickerMap = metrics.flickerReferenceMap = metrics.danceMap = Image<double>(bends_.width, bends_.height);
    double dance = 0.0;
    std::uint64_t still = 0, seen = 0;
    for (std::size_t i = 0; i < courses_.size(); ++i) {
        if (bends_.texels[i] > 0.0 && mean > 0.0) {
            metrics.flickerMap.texels[i] = bendError_.texels[i] / bends_.texels[i] / mean;
            metrics.flickerReferenceMap.texels[i] = bendReference_.texels[i] / bends_.texels[i] / mean;
        }
        const Course& c = courses_[i];
        seen += c.count > 0 ? 1 : 0;
        if (cameraMoves_ || c.count < sums_.size() || !(mean > 0.0)) continue;
        if (!(std::sqrt(c.squaresReference / c.count) < kStillShare * c.meanReference)) continue;
        ++still;
        dance += c.squaresTest / c.count / (mean * mean);
        metrics.danceMap.texels[i] = std::sqrt(c.squaresTest / c.count) / mean;
    }
    if (still > 0) metrics.dance = dance / double(still);
    metrics.stillShare = seen > 0 ? double(still) / double(seen) : 0.0;
    return metrics;
}

}  // namespace lrsm
