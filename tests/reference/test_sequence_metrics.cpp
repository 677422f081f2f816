#include "reference/sequence_metrics.h"

#include "core/scene/camera.h"

#include "catch.h"

#include <algorithm>
#include <cmath>

using namespace lrsm;

namespace {

constexpr int kWidth = 40, kHeight = 25, kPixels = kWidth * kHeight;

float noise(std::uint32_t a, std::uint32_t b)
{
    std::uint32_t h = a * 0x9e3779b9u + b * 0x85ebca6bu;
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return float(h >> 16) / 65536.0f;
}

/// Grey pictures whose luminance is value(t, pixel).
template <class Value>
Image<double> picture(int t, const Value& value)
{
    Image<Vec3> grey(kWidth, kHeight);
    for (int i = 0; i < kPixels; ++i) grey.texels[std::size_t(i)] = Vec3(value(t, i));
    return luminances(grey);
}

template <class Test, class Reference>
SequenceMetrics metricsOf(int frames, const Test& test, const Reference& reference)
{
    SequenceMeter meter;
    for (int t = 0; t < frames; ++t) meter.add({picture(t, test), picture(t, reference), PixelMask(kWidth, kHeight, 1)});
    return meter.finish();
}

float stillPicture(int, int i)
{
    return 0.25f + noise(std::uint32_t(i), 7);
}

}  // namespace

TEST_CASE("a still sequence has F = F_e = V = J = 0 to the bit, however wrong it is", "[reference][sequence]")
{
    const SequenceMetrics m = metricsOf(
        12, [](int, int i) { return noise(std::uint32_t(i), 3); }, stillPicture);
    CHECK(m.flicker == 0.0);
    CHECK(m.flickerReference == 0.0);
    CHECK(m.flickerOfError == 0.0);
    CHECK(m.dance == 0.0);
    CHECK(m.jump == 0.0);
    CHECK(m.stillShare == 1.0);
    CHECK(m.followedShare == 1.0);
    CHECK(m.moments[5].rmse > 0.1);
}

TEST_CASE("a light that fades steadily has F = 0, and F_e = 0 against one that fades otherwise", "[reference][sequence]")
{
    // Steps that floats hold: 0 to the bit.
    const auto fade = [](float step) { return [=](int t, int i) { return float(1 + i % 8) * (1.0f - step * float(t)); }; };
    const SequenceMetrics m = metricsOf(9, fade(1.0f / 16), fade(1.0f / 32));
    CHECK(m.flicker == 0.0);
    CHECK(m.flickerReference == 0.0);
    CHECK(m.flickerOfError == 0.0);
    CHECK(m.jump > 0.0);
    CHECK_FALSE(m.dance.has_value());  // no pixel of the truth stands still
    CHECK(m.moments[8].meanReference == Approx(4.5 * 0.75));
}

TEST_CASE("planted: a pop of 2 % in one frame is found with its frame, of all pixels and of 1 % of them", "[reference][sequence]")
{
    for (const int share : {1, 100})
        for (const int frame : {1, 4, 8}) {
            const SequenceMetrics m = metricsOf(
                10, [&](int t, int i) { return stillPicture(t, i) * (t == frame && i % share == 0 ? 1.02f : 1.0f); }, stillPicture);
            CAPTURE(share, frame);
            CHECK(m.worstFlicker == std::size_t(frame));
            CHECK(m.worstJump == std::size_t(frame));
            CHECK(m.flickerReference == 0.0);
            // One frame of ten bends down by twice the pop, its neighbours up by one: 4 pops in the 8 that have neighbours, fewer at the ends.
            const double bends = frame == 1 || frame == 8 ? 3.0 : 4.0;
            if (share == 1) CHECK(m.flickerOfError == Approx(bends * 0.02 / 8).epsilon(1e-4));
            if (share == 1) CHECK(*m.dance == Approx(0.02 * 0.02 * 0.09).epsilon(0.5));  // p (1 - p) pop^2, times mean r^2 over that of the mean
            CHECK(m.jump > 0.02 * 0.25 / 0.75 * 0.99);
            CHECK(m.moments[std::size_t(frame)].jump == m.jump);
        }
}

TEST_CASE("F, F_e, V and J are the sums of their definitions", "[reference][sequence]")
{
    constexpr int kFrames = 7;
    const auto r = [](int t, int i) { return i % 3 == 0 ? 0.5f + noise(std::uint32_t(i), 1) : 0.5f + noise(std::uint32_t(i), std::uint32_t(t)); };
    const auto x = [&](int t, int i) { return r(t, i) + 0.1f * noise(std::uint32_t(i), std::uint32_t(100 + t)); };
    const SequenceMetrics m = metricsOf(kFrames, x, r);

    std::vector<std::vector<double>> xs, rs;
    for (int t = 0; t < kFrames; ++t) xs.push_back(picture(t, x).texels), rs.push_back(picture(t, r).texels);
    double mean = 0.0, f = 0.0, fr = 0.0, fe = 0.0, v = 0.0, worst = 0.0;
    for (const auto& frame : rs)
        for (const double value : frame) mean += value / (kFrames * kPixels);
    const auto bend = [](const auto& s, std::size_t t, std::size_t i) { return s[t - 1][i] - 2 * s[t][i] + s[t + 1][i]; };
    for (std::size_t t = 1; t + 1 < kFrames; ++t)
        for (std::size_t i = 0; i < kPixels; ++i) {
            f += std::abs(bend(xs, t, i)) / (kPixels * (kFrames - 2)) / mean;
            fr += std::abs(bend(rs, t, i)) / (kPixels * (kFrames - 2)) / mean;
            fe += std::abs(bend(xs, t, i) - bend(rs, t, i)) / (kPixels * (kFrames - 2)) / mean;
        }
    int still = 0;
    for (std::size_t i = 0; i < kPixels; i += 3, ++still) {
        double sum = 0.0, squares = 0.0;
        for (std::size_t t = 0; t < kFrames; ++t) sum += xs[t][i], squares += xs[t][i] * xs[t][i];
        v += (squares / kFrames - sum / kFrames * sum / kFrames) / (mean * mean);
    }
    for (std::size_t t = 1; t < kFrames; ++t) {
        std::vector<double> jumps;
        for (std::size_t i = 0; i < kPixels; ++i) jumps.push_back(std::abs((xs[t][i] - rs[t][i]) - (xs[t - 1][i] - rs[t - 1][i])) / mean);
        std::sort(jumps.begin(), jumps.end());
        worst = std::max(worst, jumps[kPixels - 2]);  // one of a thousand is above it
    }
    CHECK(m.meanReference == Approx(mean));
    CHECK(m.flicker == Approx(f));
    CHECK(m.flickerReference == Approx(fr));
    CHECK(m.flickerOfError == Approx(fe));
    CHECK(*m.dance == Approx(v / still));
    CHECK(m.stillShare == Approx(double(still) / kPixels));
    CHECK(m.jump == Approx(worst));
}

TEST_CASE("where the camera moves, pixels follow their place as far as object and depth agree", "[reference][sequence]")
{
    // A wall 4 m ahead with a pattern on it, a camera that slides along it by a pixel a frame; on its left half stands another object half a metre before it.
    Camera camera;
    camera.verticalFov = 1.0f;
    const float pixel = glm::length(pixelSpacing(camera, kHeight).right) * 4.0f;
    const auto moment = [&](int t, bool moves, bool known) {
        MomentPair pair{Image<double>(kWidth, kHeight), {}, PixelMask(kWidth, kHeight, 1)};
        camera.position.x = moves ? float(t) * pixel : 0.0f;
        pair.camera = camera;
        pair.position = Image<Vec3>(kWidth, kHeight);
        pair.depth = pair.object = Image<float>(kWidth, kHeight);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const CameraRay ray = pixelRay(camera, kWidth, kHeight, float(x) + 0.5f, float(y) + 0.5f);
                const Vec3 wall = ray.origin + ray.direction * (4.0f / -ray.direction.z);
                // The object is picked by the wall behind it, so that every wall place is either always seen or never.
                const bool object = wall.x < -1.0f - 0.5f * pixel && known;
                pair.position.at(x, y) = wall;
                pair.depth.at(x, y) = 4.0f;
                pair.object.at(x, y) = object ? 2.0f : 1.0f;
                pair.test.at(x, y) = 1.0 + 0.5 * double(noise(std::uint32_t(int(std::floor(wall.x / pixel + 0.25f)) + 1000), std::uint32_t(y)));
            }
        pair.reference = pair.test;
        for (double& value : pair.reference.texels) value = 0.5 * value + 0.5;
        return pair;
    };
    const auto measured = [&](bool moves, bool known) {
        SequenceMeter meter;
        for (int t = 0; t < 5; ++t) meter.add(moment(t, moves, known));
        return meter.finish();
    };
    const SequenceMetrics followed = measured(true, false), still = measured(false, false);
    CHECK(followed.flicker < 1e-6);
    CHECK(followed.flickerOfError < 1e-6);
    CHECK(followed.followedShare == Approx((kWidth - 1.0) / kWidth));
    CHECK_FALSE(followed.dance.has_value());
    CHECK(still.flicker == 0.0);
    CHECK(still.dance == 0.0);
    CHECK(measured(true, true).flicker < 1e-6);

    // Without its camera the same sequence flickers.
    SequenceMeter blind;
    for (int t = 0; t < 5; ++t) {
        MomentPair pair = moment(t, true, false);
        pair.camera.reset();
        blind.add(std::move(pair));
    }
    CHECK(blind.finish().flicker > 0.05);

    // What stands elsewhere, or is another object, is not followed.
    SequenceMeter away, other;
    for (int t = 0; t < 3; ++t) {
        MomentPair pair = moment(t, true, false);
        if (t == 1)
            for (Vec3& p : pair.position.texels) p.z -= 0.1f;
        away.add(std::move(pair));
        pair = moment(t, true, false);
        if (t == 1)
            for (float& id : pair.object.texels) id = 3.0f;
        other.add(std::move(pair));
    }
    CHECK(away.finish().followedShare == 0.0);
    CHECK(other.finish().followedShare == 0.0);
}
