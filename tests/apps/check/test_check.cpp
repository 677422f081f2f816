#include "apps/capture/rerun.h"
#include "apps/check/bless.h"
#include "apps/check/check.h"
#include "apps/check/texel_inputs.h"
#include "core/base/errors.h"
#include "core/base/formats.h"
#include "core/base/output_folder.h"
#include "tests/apps/capture/capture_fixture.h"
#include "tests/apps/check/check_fixture.h"

#include "catch.h"
#include "scratch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

using namespace lrsm;
using namespace lrsm::test;

namespace {

Buffer* bufferIn(Capture& capture, const std::string& name)
{
    const auto found = std::find_if(capture.buffers.begin(), capture.buffers.end(), [&](const Buffer& b) { return b.name == name; });
    REQUIRE(found != capture.buffers.end());
    return &*found;
}

const CheckedBuffer& checkedIn(const CheckReport& report, const std::string& name)
{
    for (const CheckedBuffer& b : report.buffers)
        if (b.golden->name == name) return b;
    FAIL("no buffer " << name);
    return report.buffers.front();
}

/// Changes one buffer of a copy of the golden, and holds only that buffer against it.
template <class Change>
CheckReport plantIn(const std::string& name, const Change& change)
{
    static std::vector<Candidate> kept;  // reports point into their candidates
    kept.reserve(1024);
    Capture copy = sharedGolden();
    change(*bufferIn(copy, name));
    kept.push_back(candidateOf(copy, [&](const Buffer& b) { return b.name == name; }));
    return checkCandidate(sharedGolden(), kept.back());
}

std::string firstHint(const CheckReport& report)
{
    const CheckedBuffer* wrong = report.firstWrong();
    return wrong && !wrong->hints.empty() ? wrong->hints.front() : "";
}

bool says(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// What an InputError said.
std::string errorOf(const std::function<void()>& action)
{
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

/// Some hint of the first wrong buffer says this, and is sure.
bool hinted(const CheckReport& report, const std::string& part)
{
    const CheckedBuffer* wrong = report.firstWrong();
    return wrong && std::any_of(wrong->hints.begin(), wrong->hints.end(), [&](const std::string& h) { return says(h, part) && !h.starts_with("partly"); });
}

Buffer numbers(std::vector<float> values, const Tolerance& tolerance)
{
    Buffer b;
    b.name = std::string("x");
    b.shape = {values.size()};
    b.axes = {"entry"};
    b.tolerance = tolerance;
    b.bytes.resize(values.size() * sizeof(float));
    if (!values.empty()) std::memcpy(b.bytes.data(), values.data(), b.bytes.size());
    return b;
}

}  // namespace

TEST_CASE("ruler: ordinals count representable values, with fractions between them", "[capture][compare]")
{
    Buffer half, unorm, single;
    half.dtype = Dtype::f2;
    unorm.dtype = Dtype::u2;
    unorm.encoding = Encoding::unorm;
    for (const unsigned bits : {0u, 1u, 0x3ffu, 0x400u, 0x3bffu, 0x3c00u, 0x7bffu, 0x7c00u})
        CHECK(ordinalOf(half, double(floatFromHalf(std::uint16_t(bits)))) == double(bits));
    CHECK(ordinalOf(half, -1.0) == -double(0x3c00));
    CHECK(ordinalOf(half, 1.0 + 0x1p-11) == 0x3c00 + 0.5);
    CHECK(ordinalOf(unorm, 1.0) == 65535.0);
    CHECK(ordinalOf(single, 1.0) == double(0x3f800000));
    CHECK(ordinalOf(single, double(std::numeric_limits<float>::denorm_min())) == 1.0);
    CHECK(ordinalOf(single, double(std::numeric_limits<float>::infinity())) == double(0x7f800000));
    CHECK(std::isnan(ordinalOf(half, std::nan(""))));
}

TEST_CASE("comparator: each kind of tolerance holds on its edge and breaks beyond it", "[capture][compare]")
{
    const float next = std::nextafter(1.0f, 2.0f), second = std::nextafter(next, 2.0f);
    struct Case {
        Tolerance tolerance;
        float golden, candidate;
        bool holds;
    };
    using Kind = Tolerance::Kind;
    const auto c = GENERATE_COPY(values<Case>({
        {{Kind::exact, 0, 0, 0, 1, ""}, 1.0f, 1.0f, true},
        {{Kind::exact, 0, 0, 0, 1, ""}, 1.0f, next, false},
        {{Kind::exact, 0, 0, 0, 1, ""}, 0.0f, -0.0f, false},
        {{Kind::ulp, 1, 0, 0, 1, ""}, 1.0f, next, true},
        {{Kind::ulp, 1, 0, 0, 1, ""}, 1.0f, second, false},
        {{Kind::ulp, 1, 0, 0, 1, ""}, -0x1p-149f, 0x1p-149f, false},
        {{Kind::absolute, 0.25, 0, 0, 1, ""}, 1.0f, 1.25f, true},
        {{Kind::absolute, 0.25, 0, 0, 1, ""}, 1.0f, 1.375f, false},
        {{Kind::absolute, 0.25, 0, 0, 1, ""}, 0.0f, -0.0f, true},
        {{Kind::relative, 0.25, 2.0, 0, 1, ""}, 1.0f, 1.5f, true},
        {{Kind::relative, 0.25, 2.0, 0, 1, ""}, 1.0f, 1.625f, false},
        {{Kind::relative, 0.25, 0.0, 0, 1, ""}, 4.0f, 5.0f, true},
        {{Kind::relative, 0.25, 0.0, 0, 1, ""}, 0.0f, 1e-30f, false},
        {{Kind::absolute, 1e9, 0, 1, 1, ""}, 1.0f, NAN, false},
        {{Kind::absolute, 1e9, 0, 1, 1, ""}, NAN, 1.0f, false},
        {{Kind::absolute, 0, 0, 0, 1, ""}, NAN, NAN, true},
        {{Kind::absolute, 1e9, 0, 0, 1, ""}, INFINITY, 1.0f, false},
        {{Kind::absolute, 0, 0, 0, 1, ""}, INFINITY, INFINITY, true},
    }));
    CAPTURE(nameOf(c.tolerance.kind), c.golden, c.candidate);
    CHECK(compareBuffers(numbers({c.golden}, c.tolerance), numbers({c.candidate}, c.tolerance)).holds == c.holds);
}

TEST_CASE("comparator: NaN with another payload differs", "[capture][compare]")
{
    const Tolerance none;
    const Buffer a = numbers({NAN}, none);
    Buffer b = a;
    b.bytes[0] = std::byte(1);
    CHECK(compareBuffers(a, b).notANumber == 1);
    CHECK_FALSE(compareBuffers(a, b).holds);
}

TEST_CASE("comparator: outliers are a fraction of what is not 0 on both sides", "[capture][compare]")
{
    std::vector<float> values(1000, 0.0f);
    for (std::size_t i = 0; i < 100; ++i) values[i] = 1.0f;
    const Tolerance tolerance{Tolerance::Kind::absolute, 0.1, 0.0, 0.02, 1.0, ""};
    std::vector<float> two = values, three = values;
    two[10] = two[20] = 2.0f;
    three[10] = three[20] = three[30] = 2.0f;
    const BufferComparison right = compareBuffers(numbers(values, tolerance), numbers(two, tolerance));
    CHECK(right.holds);
    CHECK(right.live == 100);
    CHECK(right.outside == 2);
    const BufferComparison wrong = compareBuffers(numbers(values, tolerance), numbers(three, tolerance));
    CHECK_FALSE(wrong.holds);
    REQUIRE(wrong.first);
    CHECK(wrong.first->element == 10);
    CHECK(says(wrong.why, "3 of 100"));
}

TEST_CASE("comparator: too many differences within the tolerance fail too", "[capture][compare]")
{
    const Tolerance tolerance{Tolerance::Kind::ulp, 1.0, 0.0, 0.0, 0.25, ""};
    const float next = std::nextafter(1.0f, 2.0f);
    CHECK(compareBuffers(numbers({1, 1, 1, 1}, tolerance), numbers({1, next, 1, 1}, tolerance)).holds);
    CHECK_FALSE(compareBuffers(numbers({1, 1, 1, 1}, tolerance), numbers({1, next, next, 1}, tolerance)).holds);
}

TEST_CASE("comparator: values given in a wider type are measured as they are", "[capture][compare]")
{
    Buffer g = numbers({}, {Tolerance::Kind::ulp, 1.0, 0.0, 0.0, 1.0, ""});
    g.dtype = Dtype::u2;
    g.encoding = Encoding::unorm;
    g.shape = {1};
    g.bytes = {std::byte(0xff), std::byte(0xff)};
    CHECK(compareBuffers(g, g, std::vector<double>{1.0}).differing == 0);
    CHECK_FALSE(compareBuffers(g, g, std::vector<double>{1.5}).holds);
    CHECK_FALSE(compareBuffers(g, g, std::vector<double>{std::nan("")}).holds);
}

TEST_CASE("check: a capture against itself is all right, with and without its own inputs", "[capture][check]")
{
    const Candidate candidate = candidateOf(sharedGolden());
    for (const bool fromGolden : {false, true}) {
        CheckOptions options;
        options.fromGolden = fromGolden;
        const CheckReport report = checkCandidate(sharedGolden(), candidate, options);
        CHECK(report.holds());
        CHECK(report.count(Verdict::ok) == report.buffers.size());
        for (const CheckedBuffer& b : report.buffers) CHECK(b.comparison().differing == 0);
    }
}

TEST_CASE("check: rerun passes give the captured bits", "[capture][check][rerun]")
{
    for (const CapturedPass& pass : sharedGolden().passes) {
        CAPTURE(pass.name);
        const Rerun rerun = rerunPass(sharedGolden(), pass.name);
        CHECK(rerun.why.empty());
        for (const Buffer& made : rerun.outputs) {
            CAPTURE(made.name);
            CHECK(made.bytes == sharedGolden().at(made.name).bytes);
        }
    }
}

TEST_CASE("check: one wrong element is reported at its pass, buffer and place", "[capture][check]")
{
    SECTION("a code of an LRSM's mip")
    {
        const std::string name = "lrsm0.depth.mip2";
        const Buffer& g = sharedGolden().at(name);
        const std::size_t at[] = {1, 3, 5, 1};
        const std::size_t element = elementAt(g, at);
        const CheckReport report = plantIn(name, [&](Buffer& b) { codesOf(b)[element] = std::uint16_t(codesOf(b)[element] ^ 0x40); });
        REQUIRE(report.firstWrong());
        CHECK(says(report.summary(), "first difference: pass \"lrsm 0\", lrsm0.depth.mip2, layer 1, row 3, column 5, component 'z2'"));
        CHECK(says(report.summary(), "64 ULP"));
        CHECK(report.firstWrong()->comparison().outside == 1);
    }
    SECTION("a NaN in a picture, though outliers are allowed")
    {
        const Buffer& g = sharedGolden().at("gbuffer.position");
        const std::size_t at[] = {4, 7, 2};
        const std::size_t element = elementAt(g, at);
        const CheckReport report = plantIn("gbuffer.position", [&](Buffer& b) { floatsOf(b)[element] = NAN; });
        CHECK(says(report.summary(), "pass \"gbuffer\", gbuffer.position, row 4, column 7, component 'z'"));
    }
    SECTION("one voxel, when bits are demanded")
    {
        Capture strict = sharedGolden();
        demandBits(strict);
        Capture copy = sharedGolden();
        bufferIn(copy, "voxel.bits")->bytes[8 * 5 + 3] ^= std::byte(16);
        const Candidate candidate = candidateOf(copy, [](const Buffer& b) { return b.name == "voxel.bits"; });
        const CheckReport report = checkCandidate(strict, candidate);
        const std::size_t rowBytes = sharedGolden().at("voxel.bits").shape[2], row = 43 / rowBytes, n = sharedGolden().at("voxel.bits").shape[1];
        const std::string place = "z " + std::to_string(row / n) + ", y " + std::to_string(row % n) + ", x " + std::to_string(43 % rowBytes * 8 + 4);
        CHECK(says(report.summary(), "pass \"voxelize\", voxel.bits, " + place));
        CHECK(checkCandidate(sharedGolden(), candidate).holds());  // within 1 % of the voxels otherwise
    }
}

TEST_CASE("check: the first wrong pass in the order of the data flow comes first, mip by mip", "[capture][check]")
{
    Capture copy = sharedGolden();
    for (const char* name : {"composite.combined", "lrsm0.normal.mip3", "lrsm0.depth.mip1", "lrsm0.radiance.mip2"})
        std::fill(bufferIn(copy, name)->bytes.begin(), bufferIn(copy, name)->bytes.end(), std::byte(0x21));
    const Candidate candidate = candidateOf(copy);
    const CheckReport report = checkCandidate(sharedGolden(), candidate);
    CHECK(report.firstWrong()->golden->name == "lrsm0.depth.mip1");
    CHECK(report.count(Verdict::wrong) == 4);
}

TEST_CASE("check: buffers that are not there are no failure, none in common is bad input", "[capture][check]")
{
    const Candidate some = candidateOf(sharedGolden(), [](const Buffer& b) { return b.pass == "direct"; });
    const CheckReport report = checkCandidate(sharedGolden(), some);
    CHECK(report.holds());
    CHECK(report.count(Verdict::missing) > 10);
    CHECK(says(report.summary(), "not in the candidate"));
    const Candidate none = candidateOf(sharedGolden(), [](const Buffer&) { return false; });
    CHECK(says(errorOf([&] { (void)checkCandidate(sharedGolden(), none); }), "no buffer in common"));
    CheckOptions options;
    options.passes = {"lrms"};
    CHECK(says(errorOf([&] { (void)checkCandidate(sharedGolden(), some, options); }), "--only lrms"));
    options.passes = {"lrsm"};
    CHECK(says(errorOf([&] { (void)checkCandidate(sharedGolden(), some, options); }), "no buffer in common"));
}

TEST_CASE("from golden: what follows a wrong pass inherits, and a second bug is told apart", "[capture][check][rerun]")
{
    // A pipeline whose LRSM's base level is wrong, and whose composite has an error of its own; everything between is right for its inputs.
    Capture copy = sharedGolden();
    recompute(*bufferIn(copy, "lrsm0.radiance.mip0"), [](const Buffer& b, std::size_t i) { return 2.0 * decodedValue(b, i); });
    for (const char* pass : {"lrsm 0", "cones", "filter", "composite"}) {
        // Each mip from the level below: as often as there are levels.
        for (int level = 0; level < (std::string(pass) == "lrsm 0" ? 12 : 1); ++level)
            for (Buffer& made : rerunPass(copy, pass).outputs)
                if (made.name != "lrsm0.radiance.mip0") bufferIn(copy, made.name)->bytes = made.bytes;
    }
    recompute(*bufferIn(copy, "composite.diffuse"), [](const Buffer& b, std::size_t i) { return 3.0 * decodedValue(b, i); });
    for (Buffer& made : rerunPass(copy, "composite").outputs)
        if (made.name == "composite.combined") bufferIn(copy, made.name)->bytes = made.bytes;

    const Candidate candidate = candidateOf(copy);
    CheckOptions options;
    options.fromGolden = true;
    const CheckReport report = checkCandidate(sharedGolden(), candidate, options);
    CHECK(report.firstWrong()->golden->name == "lrsm0.radiance.mip0");
    CHECK(checkedIn(report, "lrsm0.radiance.mip1").verdict == Verdict::inherits);
    CHECK(checkedIn(report, "lrsm0.depth.mip1").verdict == Verdict::ok);
    CHECK(checkedIn(report, "cones.irradiance").verdict == Verdict::inherits);
    CHECK(checkedIn(report, "filter.irradiance").verdict == Verdict::inherits);
    CHECK(checkedIn(report, "composite.diffuse").verdict == Verdict::wrong);
    CHECK(checkedIn(report, "composite.combined").verdict == Verdict::inherits);
    CHECK(report.count(Verdict::wrong) == 2);
    CHECK(says(report.firstWrong()->hints.front(), "2 times what is expected"));
    CHECK(says(checkedIn(report, "composite.diffuse").hints.front(), "3 times what is expected"));
}

TEST_CASE("from golden: says what is missing where a pass cannot be run anew", "[capture][check][rerun]")
{
    Capture part = sharedGolden();
    std::erase_if(part.buffers, [](const Buffer& b) { return b.pass == "rsm 0"; });
    const Candidate candidate = candidateOf(part);
    CheckOptions options;
    options.fromGolden = true;
    const CheckReport report = checkCandidate(part, candidate, options);
    CHECK(report.holds());
    CHECK(says(checkedIn(report, "lrsm0.depth.mip0").note, "rsm0"));
    CHECK(checkedIn(report, "lrsm0.depth.mip1").againstRerun.has_value());
}

TEST_CASE("hints: values in the wrong place", "[capture][hints]")
{
    const auto moved = [](const std::string& name,
                          const std::function<std::vector<std::size_t>(std::vector<std::size_t>, const std::vector<std::size_t>&)>& from) {
        return plantIn(name, [&](Buffer& b) {
            recompute(
                b, [&](const Buffer& before, std::size_t i) { return decodedValue(before, elementAt(before, from(indicesOf(before, i), extentsOf(before)))); });
        });
    };
    using Index = std::vector<std::size_t>;
    CHECK(hinted(moved("gbuffer.depth",
                       [](Index at, const Index& n) {
                           at[0] = n[0] - 1 - at[0];
                           return at;
                       }),
                 "rows are flipped"));
    CHECK(hinted(moved("rsm0.normal",
                       [](Index at, const Index&) {
                           std::swap(at[0], at[1]);
                           return at;
                       }),
                 "rows and columns are exchanged"));
    CHECK(hinted(moved("lrsm0.radiance.mip0",
                       [](Index at, const Index&) {
                           at[0] = at[0] < 2 ? 1 - at[0] : at[0];
                           return at;
                       }),
                 "layers 0 and 1 are exchanged"));
    CHECK(hinted(moved("gbuffer.albedo",
                       [](Index at, const Index&) {
                           at[2] = 2 - at[2];
                           return at;
                       }),
                 "channels 'r' and 'b' are exchanged"));
    CHECK(hinted(moved("gbuffer.position",
                       [](Index at, const Index& n) {
                           at[1] = std::min(at[1] + 1, n[1] - 1);
                           return at;
                       }),
                 "one column too far down"));
    CHECK(hinted(moved("voxel.bits",
                       [](Index at, const Index&) {
                           std::swap(at[0], at[2]);
                           return at;
                       }),
                 "z and x are exchanged"));
    CHECK(hinted(moved("cones.diffuse",
                       [](Index at, const Index&) {
                           at[0] = (at[0] + 1) % 6;
                           return at;
                       }),
                 "cones are in another order: 0 holds 1"));
    CHECK(hinted(plantIn("voxel.bits", [](Buffer& b) { recompute(b, [](const Buffer& before, std::size_t i) { return decodedValue(before, i ^ 7); }); }),
                 "bits of each byte"));
    CHECK(hinted(plantIn("filter.irradiance", [](Buffer& b) { b.bytes = sharedGolden().at("cones.irradiance").bytes; }), "it holds cones.irradiance"));
}

TEST_CASE("hints: values off by a formula", "[capture][hints]")
{
    const auto formula = [](const std::string& name, double (*f)(double)) {
        return plantIn(name, [&](Buffer& b) { recompute(b, [&](const Buffer& before, std::size_t i) { return f(decodedValue(before, i)); }); });
    };
    CHECK(hinted(formula("composite.diffuse", [](double x) { return x * 3.14159265358979; }), "pi times what is expected"));
    CHECK(hinted(formula("direct.radiance", [](double x) { return x * 1.37; }), "1.37 times what is expected"));
    CHECK(hinted(formula("gbuffer.normal", [](double x) { return -x; }), "negated"));
    CHECK(hinted(formula("gbuffer.normal", [](double x) { return 0.5 + 0.5 * x; }), "0.5 + 0.5 x"));
    CHECK(hinted(formula("composite.combined", [](double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }), "sRGB"));
    CHECK(hinted(formula("rsm0.depth", [](double x) { return 1.0 - x; }), "1 - x"));
    CHECK(hinted(formula("composite.combined", [](double x) { return double(floatFromHalf(halfFromFloat(float(x), HalfRounding::d3d))); }), "stored as half"));
    CHECK(hinted(formula("gbuffer.albedo", [](double) { return 0.0; }), "every element is 0"));
    // Only the colour is off: the hint names the components.
    CHECK(hinted(
        plantIn("rsm0.radiance",
                [](Buffer& b) { recompute(b, [](const Buffer& before, std::size_t i) { return decodedValue(before, i) * (i % 4 == 3 ? 1.0 : 0.25); }); }),
        "'r', 'g', 'b' are off by a constant factor: 1 / 4"));
}

TEST_CASE("hints: terms that were forgotten", "[capture][hints]")
{
    const auto depthAlpha = [](std::size_t i) { return decodedValue(sharedGolden().at("lrsm0.depth.mip0"), i - i % 4 + 2); };
    CHECK(hinted(plantIn("lrsm0.radiance.mip0",
                         [&](Buffer& b) {
                             recompute(
                                 b, [&](const Buffer& before, std::size_t i) { return depthAlpha(i) > 0.0 ? decodedValue(before, i) / depthAlpha(i) : 0.0; });
                         }),
                 "not multiplied by alpha"));
    CHECK(hinted(plantIn("lrsm0.depth.mip0",
                         [&](Buffer& b) {
                             recompute(b, [&](const Buffer& before, std::size_t i) {
                                 const double z = decodedValue(before, i - i % 4);
                                 return i % 4 == 1 && depthAlpha(i) > 0.0 ? z * z / depthAlpha(i) : decodedValue(before, i);
                             });
                         }),
                 "not the mean of squares"));
    CHECK(hinted(plantIn("lrsm0.depth.mip0",
                         [&](Buffer& b) {
                             const std::vector<LayerRange> ranges = sharedGolden().lights[0].storedRanges();
                             const std::size_t perLayer = b.elements() / b.shape[0];
                             recompute(b, [&](const Buffer& before, std::size_t i) {
                                 const LayerRange& r = ranges[i / perLayer];
                                 const double w = double(r.depthMax) - r.depthMin, m = r.depthMin, a = depthAlpha(i);
                                 const double z = decodedValue(before, i - i % 4), z2 = decodedValue(before, i - i % 4 + 1);
                                 return i % 4 == 0 ? z * w + m * a : i % 4 == 1 ? z2 * w * w + 2 * z * w * m + m * m * a : decodedValue(before, i);
                             });
                         }),
                 "not warped"));
    CHECK(hinted(plantIn("rsm0.radiance",
                         [](Buffer& b) {
                             recompute(b, [](const Buffer& before, std::size_t i) {
                                 const double cosine = decodedValue(sharedGolden().at("rsm0.normal"), i - i % 4 + 3);
                                 return i % 4 == 3 || cosine <= 0.0 ? decodedValue(before, i) : decodedValue(before, i) / cosine;
                             });
                         }),
                 "not multiplied by <n.l>"));
    CHECK(hinted(plantIn("composite.combined",
                         [](Buffer& b) {
                             recompute(b, [](const Buffer& before, std::size_t i) {
                                 return decodedValue(before, i) - decodedValue(sharedGolden().at("direct.radiance"), i);
                             });
                         }),
                 "direct.radiance is not in the sum"));
    CHECK(hinted(plantIn("gbuffer.depth",
                         [](Buffer& b) {
                             recompute(b, [](const Buffer& before, std::size_t i) {
                                 double square = 0.0;
                                 for (int c = 0; c < 3; ++c) {
                                     const double d = decodedValue(sharedGolden().at("gbuffer.position"), i * 3 + std::size_t(c)) -
                                                      double(sharedGolden().camera.position[c]);
                                     square += d * d;
                                 }
                                 return decodedValue(before, i) > 0.0 ? std::sqrt(square) : 0.0;
                             });
                         }),
                 "distance from the eye"));
}

TEST_CASE("hints: mips picked, of the wrong level, or rounded otherwise", "[capture][hints]")
{
    const auto mip = [](const std::string& texture, int level) -> const Buffer& {
        return sharedGolden().at("lrsm0." + texture + ".mip" + std::to_string(level));
    };
    const auto at = [](const Buffer& b, std::size_t layer, std::size_t row, std::size_t column, std::size_t c) {
        const std::size_t indices[] = {layer, row, column, c};
        return decodedValue(b, elementAt(b, indices));
    };
    CHECK(hinted(plantIn("lrsm0.radiance.mip1",
                         [&](Buffer& b) {
                             recompute(b, [&](const Buffer& before, std::size_t i) {
                                 const auto x = indicesOf(before, i);
                                 return at(mip("radiance", 0), x[0], 2 * x[1], 2 * x[2], x[3]);
                             });
                         }),
                 "texel 00 of each 2x2"));
    CHECK(hinted(plantIn("lrsm0.radiance.mip1",
                         [&](Buffer& b) {
                             recompute(b, [&](const Buffer& before, std::size_t i) {
                                 const auto x = indicesOf(before, i);
                                 return at(mip("radiance", 2), x[0], x[1] / 2, x[2] / 2, x[3]);
                             });
                         }),
                 "level off by one: it repeats lrsm0.radiance.mip2"));
    const auto mean = [&](const Buffer& below, const std::vector<std::size_t>& x) {
        double sum = 0.0;
        for (std::size_t k = 0; k < 4; ++k) sum += at(below, x[0], 2 * x[1] + k / 2, 2 * x[2] + k % 2, x[3]);
        return sum / 4;
    };
    CHECK(hinted(plantIn("lrsm0.radiance.mip1",
                         [&](Buffer& b) {
                             recompute(b, [&](const Buffer& before, std::size_t i) {
                                 return mean(mip("radiance", 0), indicesOf(before, i));
                             });  // stores nearest even
                         }),
                 "rounds to nearest even"));
    CHECK(hinted(plantIn("lrsm0.depth.mip1",
                         [&](Buffer& b) {
                             for (std::size_t i = 0; i < b.elements(); ++i)
                                 codesOf(b)[i] = std::uint16_t(mean(mip("depth", 0), indicesOf(b, i)) * 65535.0 + 1e-6);
                         }),
                 "rounds toward zero (truncates)"));
    CHECK(hinted(plantIn("lrsm0.depth.mip0",
                         [&](Buffer& b) {
                             const std::optional<Buffer> wide = wideOutput(sharedGolden(), "lrsm0.depth.mip0");
                             REQUIRE(wide);
                             for (std::size_t i = 0; i < b.elements(); ++i) codesOf(b)[i] = std::uint16_t(decodedValue(*wide, i) * 65535.0 + 1e-6);
                         }),
                 "rounds toward zero (truncates)"));
}

TEST_CASE("hints: another setting, or something missing among the inputs, found by running the pass", "[capture][hints][rerun]")
{
    const auto runWith = [](const std::string& pass, const std::string& buffer, const std::function<void(Capture&)>& change) {
        Capture other = sharedGolden();
        change(other);
        const Rerun rerun = rerunPass(other, pass);
        return plantIn(buffer, [&](Buffer& b) {
            for (const Buffer& made : rerun.outputs)
                if (made.name == buffer) b.bytes = made.bytes;
        });
    };
    CHECK(hinted(runWith("cones", "cones.diffuse", [](Capture& c) { c.settings.cones.march.voxelLevelBias += 1.0f; }), "voxel_level_bias=-1"));
    CHECK(hinted(runWith("direct", "direct.radiance", [](Capture& c) { c.settings.direct.shadows = Shadows::off; }), "shadows=off"));
    CHECK(hinted(runWith("cones", "cones.diffuse", [](Capture& c) { c.lights[0].projection.up = -c.lights[0].projection.up; }), "v flipped"));
    CHECK(hinted(runWith("cones", "cones.diffuse",
                         [](Capture& c) {
                             for (Buffer& b : c.buffers)
                                 if (b.pass == "voxelize" || b.pass == "voxel mips") std::fill(b.bytes.begin(), b.bytes.end(), std::byte{0});
                         }),
                 "nothing is occluded"));
    CHECK(hinted(runWith("lrsm 0", "lrsm0.radiance.mip0", [](Capture& c) { c.settings.layers.halfRounding = HalfRounding::nearestEven; }), "nearest"));
}

TEST_CASE("hints: nothing is said of noise, and what wrong elements share is true", "[capture][hints]")
{
    std::uint32_t state = 1;
    const CheckReport noise = plantIn("direct.radiance", [&](Buffer& b) {
        for (std::size_t i = 0; i < b.elements(); ++i) floatsOf(b)[i] *= 0.5f + static_cast<float>((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f;
    });
    CHECK_FALSE(noise.holds());
    CHECK(firstHint(noise).empty());
    const CheckReport block = plantIn("direct.radiance", [&](Buffer& b) {
        for (std::size_t row = 12; row < 16; ++row)
            for (std::size_t column = 0; column < b.shape[1]; ++column) floatsOf(b)[(row * b.shape[1] + column) * 3 + 1] = 0.0f;
    });
    CHECK(says(block.firstWrong()->where, "rows 12-15"));
    CHECK(says(block.firstWrong()->where, "component 'g'"));
    CHECK(says(block.firstWrong()->where, "the candidate is 0 in all of them"));
}

TEST_CASE("inputs: a texel's own inputs are those that its pass reads", "[capture][inputs]")
{
    const Buffer& mip = sharedGolden().at("lrsm0.depth.mip2");
    const std::size_t at[] = {1, 3, 5, 0};
    const std::vector<TexelInput> four = inputsOf(sharedGolden(), mip, elementAt(mip, at));
    REQUIRE(four.size() == 4);
    CHECK(four[0].what == "lrsm0.depth.mip1, layer 1, row 6, column 10");
    CHECK(four[3].what == "lrsm0.depth.mip1, layer 1, row 7, column 11");
    const Buffer& base = sharedGolden().at("lrsm0.normal.mip0");
    const std::vector<TexelInput> block = inputsOf(sharedGolden(), base, elementAt(base, at));
    REQUIRE(block.size() == 13);
    CHECK(block[0].what == "rsm0.depth, row 6, column 10");
    CHECK(says(block[12].what, "range of layer 1"));
    const Buffer& voxels = sharedGolden().at("voxel.mip1");
    CHECK(inputsOf(sharedGolden(), voxels, 0).size() == 8);
    const Buffer& sum = sharedGolden().at("composite.combined");
    CHECK(inputsOf(sharedGolden(), sum, 0).size() >= 4);
    const Buffer& cones = sharedGolden().at("cones.irradiance");
    CHECK(says(inputsOf(sharedGolden(), cones, 3).back().value, "--pixel 1,0"));
}

TEST_CASE("bless: takes the candidate's bytes, records why, and refuses what is another frame", "[capture][bless]")
{
    Capture changed = sharedGolden();
    bufferIn(changed, "direct.radiance")->bytes[5] ^= std::byte(1);
    const Capture next = blessed(sharedGolden(), changed, "a better light", "1.2");
    REQUIRE(next.history.size() == sharedGolden().history.size() + 1);
    CHECK(next.history.back().reason == "a better light");
    CHECK(next.history.back().version == "1.2");
    CHECK(next.history.back().buffers == std::vector<std::string>{"direct.radiance"});
    CHECK(next.at("direct.radiance").bytes == changed.at("direct.radiance").bytes);
    CHECK(blessed(sharedGolden(), sharedGolden(), "nothing", "1.2").history.size() == sharedGolden().history.size());
    CHECK(says(errorOf([&] { (void)blessed(sharedGolden(), changed, " \t", "1.2"); }), "--reason"));

    Capture other = sharedGolden();
    other.sceneHash[0] = other.sceneHash[0] == 'a' ? 'b' : 'a';
    CHECK(says(errorOf([&] { (void)blessed(sharedGolden(), other, "x", "1"); }), "another scene"));
    other = sharedGolden();
    other.width += 1;
    CHECK(says(errorOf([&] { (void)blessed(sharedGolden(), other, "x", "1"); }), "the golden"));
    other = sharedGolden();
    other.settings.cones.march.step = 0.25f;
    CHECK(says(errorOf([&] { (void)blessed(sharedGolden(), other, "x", "1"); }), "step=0.25"));
    other = sharedGolden();
    other.buffers.pop_back();
    CHECK(says(errorOf([&] { (void)blessed(sharedGolden(), other, "x", "1"); }), "has no composite.combined"));
}
