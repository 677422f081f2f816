#include "catch.h"
#include "scratch.h"

#include "apps/validate/equations/check_equations.h"
#include "apps/validate/vectors/judge.h"
#include "apps/validate/vectors/make_vectors.h"
#include "apps/validate/vectors/vector_files.h"
#include "core/base/errors.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

using namespace lrsm;

namespace {

const std::vector<VectorSet>& sets()
{
    static const std::vector<VectorSet> made = makeVectors();
    return made;
}

struct Found {
    const VectorSet* set;
    const VectorOutput* output;
};
Found find(const std::string& name)
{
    for (const VectorSet& set : sets())
        for (const VectorOutput& output : set.outputs)
            if (output.exact.name == name) return {&set, &output};
    FAIL("there is no output " << name);
    return {};
}

/// A case's inputs by name.
class Row {
  public:
    Row(const VectorSet& set, std::size_t index) : set_(set), index_(index) {}
    double operator()(const std::string& name, std::size_t i = 0) const
    {
        for (const VectorArray& input : set_.inputs)
            if (input.name == name) return input.values.at(index_ * input.perCase() + i);
        FAIL("there is no input " << name);
        return 0.0;
    }

  private:
    const VectorSet& set_;
    std::size_t index_;
};

/// Somebody's slip: value i of a case, from its inputs and what is right.
using Slip = std::function<double(const Row&, std::size_t i, double right)>;
struct Planted {
    const char *output, *what;
    Slip slip;
};

double dot(const Row& row, const char* a, std::size_t ai, const char* b, std::size_t bi)
{
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) sum += row(a, 3 * ai + c) * row(b, 3 * bi + c);
    return sum;
}
double phi(double x)
{
    return 0.5 * std::erfc(-x * std::sqrt(0.5));
}

std::vector<Planted> plantedSlips()
{
    return {
        {"eq1.radiance", "the first sphere hides itself", [](const Row& r, std::size_t, double right) { return right * (1.0 - r("alpha", 0)); }},
        {"eq1.opacity", "transmittance in place of opacity", [](const Row&, std::size_t, double right) { return 1.0 - right; }},
        {"eq1.step_opacity", "k left out", [](const Row& r, std::size_t, double) { return 1.0 - std::pow(1.0 - std::min(r("a"), 1.0), r("length")); }},
        {"eq1.step_opacity_gpu", "the length left out", [](const Row& r, std::size_t, double) { return 1.0 - std::pow(1.0 - std::min(r("a"), 1.0), r("k")); }},
        {"eq1.transmittance", "2 for e", [](const Row& r, std::size_t, double) { return std::exp2(-r("k") * r("f")); }},
        {"eq2.reflected_radiance", "pi left out", [](const Row&, std::size_t, double right) { return right * 3.14159265358979; }},
        {"eq3.radiance", "not divided by the weights' sum", [](const Row&, std::size_t, double right) { return right * 16.0; }},
        {"eq4.weight", "the cosine to the light left out",
         [](const Row& r, std::size_t i, double right) { return right * std::min(1.0, dot(r, "normal", i, "to_light", i)); }},
        {"eq5.radiance", "V left out", [](const Row& r, std::size_t, double) { return r("r") * r("n"); }},
        {"eq5.radiance", "N squared", [](const Row& r, std::size_t, double right) { return right * r("n"); }},
        {"eq6.radiance", "mean over the layer's texels, not all",
         [](const Row& r, std::size_t, double right) {
             double held = 0.0;
             for (std::size_t i = 0; i < 16; ++i) held += r("in_layer", i);
             return held > 0.0 ? right * 16.0 / held : right;
         }},
        {"eq7.visibility", "texels on the sphere left out", [](const Row& r, std::size_t, double right) { return r("radius") == 0.5 ? 0.0 : right; }},
        {"eq8.mean_normal", "the wrong sign", [](const Row&, std::size_t, double right) { return -right; }},
        {"eq8.normal_term", "alpha not divided by", [](const Row& r, std::size_t, double right) { return right * r("alpha"); }},
        {"eq8.normal_term", "the mean normal made unit",
         [](const Row& r, std::size_t, double right) {
             const double length = std::sqrt(dot(r, "alpha_n", 0, "alpha_n", 0)) / r("alpha");
             return length > 0.0 ? right / length : right;
         }},
        {"eq8.normal_term", "negative not clamped", [](const Row& r, std::size_t, double) { return dot(r, "alpha_n", 0, "v", 0) / r("alpha"); }},
        {"eq9.weights", "texel centres at whole numbers",
         [](const Row& r, std::size_t i, double right) { return i < 64 ? right * (1.0 - std::fmod(r("u"), 0.125)) : right; }},
        {"eq9.weights_sampler", "nearest for linear", [](const Row&, std::size_t, double right) { return right > 0.5 ? 1.0 : 0.0; }},
        {"eq10.alpha_z", "not warped to the layer",
         [](const Row& r, std::size_t, double right) { return right * (r("depth_max") - r("depth_min")) + r("depth_min"); }},
        {"eq10.mean", "alpha not divided by", [](const Row& r, std::size_t, double) { return r("alpha_z"); }},
        {"eq11.alpha_z2", "square of the mean", [](const Row&, std::size_t, double right) { return right * right; }},
        {"eq11.variance", "the square of the mean added",
         [](const Row& r, std::size_t, double) { return r("alpha_z2") / r("alpha") + std::pow(r("alpha_z") / r("alpha"), 2); }},
        {"eq11.variance", "no floor", [](const Row& r, std::size_t, double) { return r("alpha_z2") / r("alpha") - std::pow(r("alpha_z") / r("alpha"), 2); }},
        {"eq12.phi", "erf without the root of 2", [](const Row& r, std::size_t, double) { return 0.5 * std::erfc(-r("x")); }},
        {"eq12.phi_table", "a table of 64",
         [](const Row& r, std::size_t, double right) {
             const double h = 10.0 / 63.0, x = r("x"), left = std::floor((x + 5.0) / h) * h - 5.0;
             return std::abs(x) < 5.0 ? phi(left) + (x - left) / h * (phi(left + h) - phi(left)) : right;
         }},
        {"eq12.visibility", "the nearer end alone",
         [](const Row& r, std::size_t, double right) {
             return r("sigma2") > 0.0 ? phi((r("r_c") - std::abs(r("z_c") - r("mu"))) / std::sqrt(r("sigma2"))) : right;
         }},
        {"eq12.visibility_table", "the variance for its root",
         [](const Row& r, std::size_t, double right) {
             if (!(r("sigma2") > 0.0)) return right;
             const double d = r("z_c") - r("mu");
             return phi((d + r("r_c")) / r("sigma2")) - phi((d - r("r_c")) / r("sigma2"));
         }},
        {"eq13.membership", "ranges closed at both ends",
         [](const Row& r, std::size_t i, double) {
             return r("depth") >= r("depth_min", i) && r("depth") <= r("depth_max", i) && r("n_dot_l") >= r("n_dot_l_min", i) &&
                            r("n_dot_l") <= r("n_dot_l_max", i)
                        ? 1.0
                        : 0.0;
         }},
        {"eq13.depth_min", "half the overlap",
         [](const Row& r, std::size_t i, double right) { return right + 0.25 * r("overlap") * (r("farthest") - r("nearest")) * (i ? 0.25 : 0.0); }},
        {"eq13.depth_max", "no overlap",
         [](const Row& r, std::size_t i, double) { return r("nearest") + (r("farthest") - r("nearest")) * double(i + 1) / 4.0; }},
        {"eq14.radiance", "the decay left out",
         [](const Row& r, std::size_t c, double) {
             double sum = 0.0;
             for (std::size_t l = 0; l < 4; ++l) sum += r("a", l) * r("l", 3 * l + c);
             return sum;
         }},
        {"eq14.coverage", "1 where there is any", [](const Row&, std::size_t, double right) { return right > 0.0 ? 1.0 : 0.0; }},
        {"eq15.decay", "linear for smoothstep",
         [](const Row& r, std::size_t, double right) {
             return right > 0.0 ? std::min({1.0, (r("z_c") - r("z_min")) / r("delta"), (r("z_max") - r("z_c")) / r("delta")}) : 0.0;
         }},
        {"eq15.decay", "decays at the far end alone",
         [](const Row& r, std::size_t, double right) { return r("z_c") < r("z_min") + r("delta") && right > 0.0 ? 1.0 : right; }},
        {"sec3.opacity", "a level too high", [](const Row& r, std::size_t, double right) { return 0.5 * (right + r("level2")); }},
        {"sec3.opacity_sampler", "border clamped", [](const Row& r, std::size_t, double right) { return right == 0.0 ? r("level0", 0) : right; }},
        {"sec3.mean", "the largest for the mean", [](const Row&, std::size_t, double right) { return right > 0.0 ? 1.0 : 0.0; }},
        {"sec5.level", "the natural logarithm",
         [](const Row& r, std::size_t, double) { return std::max(std::log(r("diameter") / (2.0 * r("texel"))) + r("bias"), r("least")); }},
        {"sec5.place", "v upwards", [](const Row&, std::size_t i, double right) { return i == 1 ? 1.0 - right : right; }},
        {"sec5.texel_size", "half a map for a whole", [](const Row&, std::size_t, double right) { return 0.5 * right; }},
        {"fig7.axis", "the wrong way round", [](const Row&, std::size_t i, double right) { return i == 1 ? -right : right; }},
        {"fig7.weight", "all the same", [](const Row&, std::size_t, double) { return 1.0 / 6.0; }},
        {"fig7.specular_tan", "roughness not squared",
         [](const Row& r, std::size_t, double) { return std::min(std::tan(3.14159265 / 3), std::tan(2.0 * std::atan(std::min(r("roughness"), 0.9)))); }},
        {"table1.half_toward_zero", "to the nearest", [](const Row&, std::size_t, double right) { return right * (1.0 + 0x1p-11); }},
        {"table1.half_nearest_even", "toward zero", [](const Row&, std::size_t, double right) { return right * (1.0 - 0x1p-11); }},
        {"table1.float_from_half", "denormals to zero", [](const Row&, std::size_t, double right) { return std::abs(right) < 0x1p-14 ? 0.0 : right; }},
        {"table1.unorm16", "cut off in place of rounded", [](const Row& r, std::size_t, double) { return std::floor(std::clamp(r("x"), 0.0, 1.0) * 65535.0); }},
        {"table1.unorm8", "times 256", [](const Row& r, std::size_t, double) { return std::floor(std::clamp(r("x"), 0.0, 1.0) * 256.0); }},
    };
}

std::vector<double> slipped(const Found& found, const Slip& slip)
{
    std::vector<double> values = found.output->exact.values;
    const std::size_t count = found.output->exact.perCase();
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = slip(Row(*found.set, i / count), i % count, values[i]);
    return values;
}

/// The program's own results of all outputs as files, but those given.
void writeResults(const std::string& folder, const std::map<std::string, std::vector<double>>& instead = {})
{
    OutputFolder files(folder);
    for (const VectorSet& set : sets())
        for (const VectorOutput& output : set.outputs) {
            const auto other = instead.find(output.exact.name);
            const std::vector<double>& values = other == instead.end() ? output.ours : other->second;
            files.write(givenFile(output), encodeNpy(Dtype::f8, wholeShape(output.exact, set.cases()), std::as_bytes(std::span(values))));
        }
    files.commit();
}

std::set<std::string> wrongNames(const Judgement& judgement)
{
    std::set<std::string> names;
    for (const JudgedOutput& o : judgement.outputs)
        if (o.verdict != OutputVerdict::ok) names.insert(o.output->exact.name);
    return names;
}

}  // namespace

TEST_CASE("the program's own functions keep what the vectors allow, with every equation and kind of case there", "[vectors]")
{
    std::set<std::string> equations;
    for (const VectorSet& set : sets()) {
        REQUIRE(set.cases() > 0);
        for (const VectorOutput& output : set.outputs) {
            CAPTURE(output.exact.name);
            equations.insert(output.equation);
            CHECK(judgeValues(set, output, output.ours).verdict == OutputVerdict::ok);
            CHECK(std::all_of(output.exact.values.begin(), output.exact.values.end(), [](double v) { return std::isfinite(v); }));
        }
        for (const VectorArray& input : set.inputs) CHECK(input.cases() == set.cases());
    }
    for (const std::string& equation : equationNames()) CHECK(equations.count(equation) == 1);
}

TEST_CASE("a planted slip in each equation is named, and no other equation", "[vectors]")
{
    std::set<std::string> planted;
    for (const Planted& p : plantedSlips()) {
        CAPTURE(p.output, p.what);
        const Found found = find(p.output);
        planted.insert(p.output);
        CHECK(judgeValues(*found.set, *found.output, slipped(found, p.slip)).verdict == OutputVerdict::wrong);
    }
    // Through files: one of an equation each.
    const ScratchFolder scratch;
    std::set<std::string> done;
    for (const Planted& p : plantedSlips()) {
        const Found found = find(p.output);
        if (!done.insert(found.output->equation).second) continue;
        CAPTURE(p.output, p.what);
        const std::string folder = scratch.path(std::to_string(done.size()));
        writeResults(folder, {{p.output, slipped(found, p.slip)}});
        const Judgement judgement = judgeFolder(sets(), folder);
        CHECK(wrongNames(judgement) == std::set<std::string>{p.output});
        CHECK(judgement.exitCode() == 1);
    }
    for (const VectorSet& set : sets())
        for (const VectorOutput& output : set.outputs)
            if (output.equation != "base") CHECK(planted.count(output.exact.name) == 1);
}

TEST_CASE("in every output a lost factor, a lost sign, NaN and 1e-3 too much are wrong", "[vectors]")
{
    for (const VectorSet& set : sets())
        for (const VectorOutput& output : set.outputs) {
            CAPTURE(output.exact.name);
            const bool loose = output.allowed.front() > 1e-3;  // codes, and what a sampler's fractions allow
            for (const Slip& slip : std::vector<Slip>{[](const Row&, std::size_t, double right) { return 0.5 * right; },
                                                      [](const Row&, std::size_t, double right) { return -right; },
                                                      [](const Row&, std::size_t, double right) { return right > 0.0 ? std::nan("") : right; },
                                                      [&](const Row&, std::size_t, double right) { return right * (loose ? 1.05 : 1.001); }})
                CHECK(judgeValues(set, output, slipped({&set, &output}, slip)).verdict == OutputVerdict::wrong);
        }
}

TEST_CASE("vectors come back from their files as they were", "[vectors]")
{
    const ScratchFolder scratch;
    OutputFolder folder(scratch.path("v"));
    writeVectors(folder, sets(), "test");
    folder.commit();
    const std::vector<VectorSet> read = readVectors(scratch.path("v"));
    REQUIRE(read.size() == sets().size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        CHECK(read[i].name == sets()[i].name);
        CHECK(read[i].kinds == sets()[i].kinds);
        for (std::size_t k = 0; k < read[i].inputs.size(); ++k) CHECK(read[i].inputs[k].values == sets()[i].inputs[k].values);
        for (std::size_t k = 0; k < read[i].outputs.size(); ++k) {
            CHECK(read[i].outputs[k].exact.values == sets()[i].outputs[k].exact.values);
            CHECK(read[i].outputs[k].allowed == sets()[i].outputs[k].allowed);
            CHECK(read[i].outputs[k].equation == sets()[i].outputs[k].equation);
        }
    }
    std::filesystem::remove(scratch.path("v/eq5.radiance.exact.npy"));
    CHECK_THROWS_AS(readVectors(scratch.path("v")), InputError);
}

TEST_CASE("what is missing, misnamed, of another shape or damaged is said, and the rest is judged", "[vectors]")
{
    const ScratchFolder scratch;
    const std::string folder = scratch.path("mine");
    writeResults(folder);
    const auto at = [&](const char* name) { return std::filesystem::path(folder) / name; };
    std::filesystem::remove(at("eq15.decay.npy"));
    std::filesystem::rename(at("eq5.radiance.npy"), at("Eq5_Radiance.npy"));
    std::filesystem::resize_file(at("eq8.normal_term.npy"), 200);
    {
        OutputFolder more(folder);
        const std::vector<double> few(7);
        more.write("eq10.mean.npy", encodeNpy(Dtype::f8, {7}, std::as_bytes(std::span(few))));
        more.write("scribbles.npy", encodeNpy(Dtype::f8, {7}, std::as_bytes(std::span(few))));
        more.commit();
    }
    const Judgement judgement = judgeFolder(sets(), folder);
    std::map<std::string, std::string> notes;
    for (const JudgedOutput& o : judgement.outputs)
        if (o.verdict != OutputVerdict::ok) notes[o.output->exact.name] = std::string(nameOf(o.verdict)) + ": " + o.note;
    CHECK(notes.size() == 4);
    CHECK(notes["eq15.decay"] == "not given: eq15.decay.npy is not there");
    CHECK(notes["eq5.radiance"] == "UNREADABLE: Eq5_Radiance.npy is of no output; did you mean eq5.radiance.npy?");
    CHECK(notes["eq10.mean"].find("has shape (7,) in place of (") != std::string::npos);
    CHECK(notes["eq8.normal_term"].find("UNREADABLE: " + at("eq8.normal_term.npy").string()) == 0);
    CHECK(judgement.notes == std::vector<std::string>{"scribbles.npy is of no output"});
    CHECK(judgement.exitCode() == 2);
    CHECK_THROWS_AS(judgeFolder(sets(), scratch.path("nowhere")), InputError);
}
