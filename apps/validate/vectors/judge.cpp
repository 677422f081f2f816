#include "apps/validate/vectors/judge.h"

#include "apps/validate/equations/check_equations.h"
#include "apps/validate/vectors/vector_files.h"
#include "core/base/errors.h"
#include "core/base/text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>

namespace lrsm {
namespace {

namespace fs = std::filesystem;

/// The spacing of a format's numbers about `value`; 1 for codes.
double ulpOf(Dtype dtype, double value)
{
    if (!isFloat(dtype)) return 1.0;
    const int digits = dtype == Dtype::f8 ? 52 : 23, least = dtype == Dtype::f8 ? -1022 : -126;
    return std::ldexp(1.0, std::max(value == 0.0 ? least : std::ilogb(value), least) - digits);
}

/// Letters and digits alone: "Eq5_Radiance" and "eq5.radiance" are the same.
std::string bareName(const std::string& name)
{
    std::string bare;
    for (const char c : name)
        if (std::isalnum(static_cast<unsigned char>(c))) bare += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return bare;
}

/// Names of the .npy files of a folder that are not the vectors' own, in order.
std::vector<std::string> givenNames(const std::string& folder)
{
    std::error_code error;
    std::vector<std::string> names;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        if (at->path().extension() == ".npy") names.push_back(at->path().stem().string());
    if (error) throw InputError(folder, "cannot be listed: " + error.message());
    // Inputs, exact results and what is allowed, of these vectors or of others written here before.
    std::erase_if(names,
                  [](const std::string& name) { return name.ends_with(".exact") || name.ends_with(".allowed") || name.find(".in.") != std::string::npos; });
    std::sort(names.begin(), names.end());
    return names;
}

/// Extents of 1 aside.
std::vector<std::size_t> bareShape(std::vector<std::size_t> shape)
{
    std::erase(shape, std::size_t(1));
    return shape;
}

JudgedOutput judgeFile(const VectorSet& set, const VectorOutput& output, const std::string& path)
{
    JudgedOutput unreadable{.set = &set, .output = &output, .verdict = OutputVerdict::unreadable};
    try {
        const NpyArray given = readNpy(path);
        const std::vector<std::size_t> wanted = wholeShape(output.exact, set.cases());
        if (bareShape(given.shape) != bareShape(wanted)) {
            unreadable.note = path + ": has shape " + shapeText(given.shape) + " in place of " + shapeText(wanted);
            return unreadable;
        }
        JudgedOutput judged = judgeValues(set, output, numbersOf(given));
        if (sizeOf(given.dtype) < sizeOf(output.exact.dtype))
            judged.note = path + ": is of " + std::string(nameOf(given.dtype)) + ", " + std::string(nameOf(output.exact.dtype)) + " is asked for";
        return judged;
    } catch (const InputError& error) {
        unreadable.note = error.what();
        return unreadable;
    }
}

/// Files that are of no output: what lacks a file and is called nearly so is theirs.
void nameStrangers(const std::vector<std::string>& strangers, Judgement& judgement)
{
    for (const std::string& stranger : strangers) {
        JudgedOutput* nearest = nullptr;
        std::size_t least = 3;  // more letters than two are another word
        for (JudgedOutput& judged : judgement.outputs) {
            if (judged.verdict != OutputVerdict::missing) continue;
            const std::size_t distance = editDistance(bareName(stranger), bareName(judged.output->exact.name));
            if (distance < least) least = distance, nearest = &judged;
        }
        const std::string line = stranger + ".npy is of no output";
        if (nearest) {
            nearest->verdict = OutputVerdict::unreadable;
            nearest->note = line + "; did you mean " + givenFile(*nearest->output) + "?";
        } else {
            judgement.notes.push_back(line);
        }
    }
}

}  // namespace

std::string_view nameOf(OutputVerdict verdict)
{
    switch (verdict) {
    case OutputVerdict::ok: return "ok";
    case OutputVerdict::wrong: return "WRONG";
    case OutputVerdict::missing: return "not given";
    default: return "UNREADABLE";
    }
}

std::size_t Judgement::count(OutputVerdict verdict) const
{
    return static_cast<std::size_t>(std::count_if(outputs.begin(), outputs.end(), [&](const JudgedOutput& o) { return o.verdict == verdict; }));
}

bool Judgement::holds() const
{
    return exitCode() == 0;
}

int Judgement::exitCode() const
{
    if (count(OutputVerdict::wrong)) return 1;
    return count(OutputVerdict::ok) && !count(OutputVerdict::unreadable) ? 0 : 2;
}

JudgedOutput judgeValues(const VectorSet& set, const VectorOutput& output, const std::vector<double>& given)
{
    JudgedOutput judged{.set = &set, .output = &output, .verdict = OutputVerdict::ok};
    const std::vector<double>& exact = output.exact.values;
    double hardest = -1.0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        double error = given[i] == exact[i] ? 0.0 : std::abs(given[i] - exact[i]);
        if (std::isnan(error)) error = std::numeric_limits<double>::infinity(), ++judged.notANumber;
        const double ulp = error / ulpOf(output.exact.dtype, exact[i]);
        judged.worst = std::max(judged.worst, error), judged.worstUlp = std::max(judged.worstUlp, ulp);
        judged.mean += error / double(exact.size()), judged.meanUlp += ulp / double(exact.size());
        if (error > output.allowed[i]) ++judged.outside;
        const double hard = error == 0.0 ? 0.0 : output.allowed[i] > 0.0 ? error / output.allowed[i] : std::numeric_limits<double>::infinity();
        if (hard > hardest) hardest = hard, judged.worstValue = i, judged.given = given[i];
    }
    if (judged.outside) judged.verdict = OutputVerdict::wrong;
    return judged;
}

Judgement judgeFolder(const std::vector<VectorSet>& sets, const std::string& folder)
{
    std::vector<std::string> names = givenNames(folder);
    Judgement judgement;
    for (const VectorSet& set : sets)
        for (const VectorOutput& output : set.outputs) {
            const auto found = std::find(names.begin(), names.end(), output.exact.name);
            if (found == names.end()) {
                judgement.outputs.push_back({.set = &set, .output = &output, .verdict = OutputVerdict::missing, .note = givenFile(output) + " is not there"});
                continue;
            }
            names.erase(found);
            judgement.outputs.push_back(judgeFile(set, output, (fs::path(folder) / givenFile(output)).string()));
        }
    nameStrangers(names, judgement);
    const std::vector<std::string> order = equationNames();
    const auto place = [&](const JudgedOutput& o) { return std::find(order.begin(), order.end(), o.output->equation) - order.begin(); };
    std::stable_sort(judgement.outputs.begin(), judgement.outputs.end(), [&](const JudgedOutput& a, const JudgedOutput& b) { return place(a) < place(b); });
    return judgement;
}

}  // namespace lrsm
