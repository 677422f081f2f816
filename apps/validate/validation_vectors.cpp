#include "apps/validate/validation_report.h"
#include "core/base/text.h"
#include "core/report/html.h"
#include "core/report/junit.h"
#include "core/report/table.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace lrsm {
namespace {

using Json = nlohmann::ordered_json;

bool wasRead(const JudgedOutput& o)
{
    return o.verdict == OutputVerdict::ok || o.verdict == OutputVerdict::wrong;
}

/// "exact 0.5, given 0.25, off by 0.25 where 8e-07 is allowed".
std::string worstText(const JudgedOutput& o)
{
    const double exact = o.output->exact.values[o.worstValue], error = std::abs(o.given - exact);
    std::string place;
    if (o.output->exact.perCase() > 1) place = ", value " + std::to_string(o.worstValue % o.output->exact.perCase());
    return caseText(*o.set, o.worstCase()) + place + ": exact " + exactNumber(exact) + ", given " + exactNumber(o.given) + ", off by " +
           shortNumber(std::isnan(error) ? std::numeric_limits<double>::infinity() : error) + " where " + shortNumber(o.output->allowed[o.worstValue]) +
           " is allowed";
}

/// "12 of 195 values are outside: case 17 ...".
std::string failureText(const JudgedOutput& o)
{
    return std::to_string(o.outside) + " of " + std::to_string(o.output->exact.values.size()) + " values are outside" +
           (o.notANumber ? ", " + std::to_string(o.notANumber) + " of them NaN or of the wrong infinity" : "");
}

ReportTable judgedForPeople(const Judgement& judgement)
{
    ReportTable table{"", {"Eq.", "output", "values", "outside", "worst ULP", "mean ULP", "worst error", "mean error", "verdict", "worst at"}, {}};
    for (const JudgedOutput& o : judgement.outputs) {
        if (o.verdict == OutputVerdict::missing) continue;
        const bool bad = o.verdict == OutputVerdict::wrong || o.verdict == OutputVerdict::unreadable;
        std::vector<std::string> row = {(bad ? "!" : "") + o.output->equation, o.output->exact.name};
        if (wasRead(o))
            row.insert(row.end(),
                       {std::to_string(o.output->exact.values.size()), std::to_string(o.outside), shortNumber(o.worstUlp), shortNumber(o.meanUlp),
                        shortNumber(o.worst), shortNumber(o.mean), std::string(nameOf(o.verdict)), o.worst > 0.0 ? caseText(*o.set, o.worstCase()) : ""});
        else
            row.insert(row.end(), {"", "", "", "", "", "", std::string(nameOf(o.verdict)), ""});
        table.rows.push_back(std::move(row));
    }
    return table;
}

ReportTable judgedForPrograms(const Judgement& judgement)
{
    ReportTable table{"", {"equation", "output", "verdict", "values", "outside", "worst_ulp", "mean_ulp", "worst", "mean", "bound", "worst_input", "note"}, {}};
    for (const JudgedOutput& o : judgement.outputs)
        table.rows.push_back({o.output->equation, o.output->exact.name, std::string(nameOf(o.verdict)), std::to_string(o.output->exact.values.size()),
                              std::to_string(o.outside), exactNumber(o.worstUlp), exactNumber(o.meanUlp), exactNumber(o.worst), exactNumber(o.mean),
                              o.output->bound, wasRead(o) ? caseText(*o.set, o.worstCase()) : "", o.note});
    return table;
}

Json judgementJson(const Judgement& judgement)
{
    const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(exactNumber(value)); };
    Json outputs = Json::array();
    for (const JudgedOutput& o : judgement.outputs) {
        Json entry = {{"equation", o.output->equation}, {"name", o.output->exact.name}, {"verdict", nameOf(o.verdict)}, {"bound", o.output->bound}};
        if (wasRead(o)) {
            entry["values"] = o.output->exact.values.size();
            entry["outside"] = o.outside;
            entry["nan"] = o.notANumber;
            entry["worstUlp"] = number(o.worstUlp), entry["meanUlp"] = number(o.meanUlp);
            entry["worst"] = number(o.worst), entry["mean"] = number(o.mean);
            entry["worstInput"] = caseText(*o.set, o.worstCase());
            entry["exact"] = number(o.output->exact.values[o.worstValue]), entry["given"] = number(o.given);
        }
        if (!o.note.empty()) entry["note"] = o.note;
        outputs.push_back(std::move(entry));
    }
    return {{"outputs", std::move(outputs)}, {"notes", judgement.notes}};
}

/// "Eq. 5, 12", "Sec. 5", "Table 1".
std::string equationTitle(const std::string& equation)
{
    if (equation == "sec3") return "Sec. 3.1";
    if (equation == "sec5") return "Sec. 5";
    if (equation == "fig7") return "Fig. 7";
    if (equation == "table1") return "Table 1";
    if (equation == "base") return "an elementary function";
    return "Eq. " + equation;
}

std::string verdictText(const Judgement& judgement)
{
    const auto are = [](std::size_t count) { return std::to_string(count) + (count == 1 ? " is " : " are "); };
    const std::size_t ok = judgement.count(OutputVerdict::ok), wrong = judgement.count(OutputVerdict::wrong),
                      unreadable = judgement.count(OutputVerdict::unreadable), missing = judgement.count(OutputVerdict::missing);
    std::vector<std::string> titles;
    for (const JudgedOutput& o : judgement.outputs)
        if (const std::string title = equationTitle(o.output->equation);
            o.verdict == OutputVerdict::wrong && std::find(titles.begin(), titles.end(), title) == titles.end())
            titles.push_back(title);
    std::string text = "Vectors: ";
    if (wrong) text += "WRONG: " + joined(titles) + "; of " + std::to_string(ok + wrong) + " outputs " + are(wrong) + "outside what is allowed";
    if (!wrong && ok) text += "of " + std::to_string(ok) + " outputs all are within what is allowed";
    if (!wrong && !ok) text += "no output could be judged";
    if (unreadable) text += "; " + std::to_string(unreadable) + " cannot be read";
    if (missing) text += "; " + are(missing) + "not given";
    return text + ".";
}

}  // namespace

ValidationPart describeJudgement(const Judgement& judgement, Json& json)
{
    json = judgementJson(judgement);
    ValidationPart part{"vectors", judgement.holds(), verdictText(judgement), {}, {}, {}};
    const ReportTable table = judgedForPeople(judgement);
    std::string lines;
    for (const JudgedOutput& o : judgement.outputs) {
        if (o.verdict == OutputVerdict::wrong)
            lines += o.output->exact.name + " (" + equationTitle(o.output->equation) + "): " + failureText(o) + "; the worst, " + worstText(o) + "\n";
        if (!o.note.empty() && o.verdict != OutputVerdict::missing) lines += o.note + "\n";
    }
    for (const std::string& note : judgement.notes) lines += "note: " + note + "\n";
    if (judgement.count(OutputVerdict::missing)) {
        std::vector<std::string> names;
        for (const JudgedOutput& o : judgement.outputs)
            if (o.verdict == OutputVerdict::missing) names.push_back(o.output->exact.name);
        lines += "not given: " + joined(names) + "\n";
    }
    part.text = textTable(table) + "\n" + lines;
    part.html = headingHtml("Results computed elsewhere against the exact ones") + paragraphHtml(part.verdict) + tableHtml(table) + preformattedHtml(lines);
    part.csv = {{"vectors.csv", csvTable(judgedForPrograms(judgement))}};
    return part;
}

std::string judgementJUnit(const Judgement& judgement, const std::string& name)
{
    std::vector<JUnitSuite> suites;
    for (const JudgedOutput& o : judgement.outputs) {
        const std::string title = equationTitle(o.output->equation);
        auto suite = std::find_if(suites.begin(), suites.end(), [&](const JUnitSuite& s) { return s.name == title; });
        if (suite == suites.end()) suite = suites.insert(suites.end(), {title});
        JUnitCase made{o.output->exact.name};
        if (o.verdict == OutputVerdict::wrong) made = {made.name, JUnitCase::Verdict::failed, failureText(o), worstText(o) + "; allowed: " + o.output->bound};
        if (o.verdict == OutputVerdict::unreadable) made = {made.name, JUnitCase::Verdict::error, o.note};
        if (o.verdict == OutputVerdict::missing) made = {made.name, JUnitCase::Verdict::skipped, o.note};
        suite->cases.push_back(std::move(made));
    }
    return junitXml(name, suites);
}

}  // namespace lrsm
