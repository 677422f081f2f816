#include "apps/check/check_report.h"

#include "core/report/html.h"
#include "core/report/table.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

std::string shortShare(std::size_t count, std::size_t of)
{
    const double percent = of ? 100.0 * static_cast<double>(count) / static_cast<double>(of) : 0.0;
    return count ? std::to_string(count) + " (" + numberText(3, percent) + " %)" : "0";
}

bool quiet(const CheckedBuffer& b)
{
    return !b.candidate || (b.verdict == Verdict::ok && b.comparison().differing == 0);
}

/// Mips of one texture that say the same.
bool joins(const CheckedBuffer& a, const CheckedBuffer& b)
{
    return quiet(a) && quiet(b) && a.verdict == b.verdict && a.note == b.note && isMip(a.golden->name) && stemOf(a.golden->name) == stemOf(b.golden->name);
}

std::vector<std::string> rowOf(const CheckedBuffer& b, const std::string& name)
{
    const BufferComparison& c = b.comparison();
    const std::string mark = b.verdict == Verdict::wrong ? "!" : "";
    if (!b.candidate) return {(b.verdict == Verdict::unreadable ? "!" : "") + b.golden->pass, name, "", "", "", "", "", std::string(nameOf(b.verdict).text)};
    const std::string where = c.worst ? placeText(*b.golden, c.worst->element) : "";
    return {mark + b.golden->pass,
            name,
            std::to_string(c.elements),
            shortShare(c.differing, c.live),
            shortShare(c.outside, c.live),
            c.worst ? sizeText(*b.golden, c.worst->size) : "0",
            where,
            std::string(nameOf(b.verdict).text)};
}

ReportTable tableOf(const CheckReport& report)
{
    ReportTable table{"", {"pass", "buffer", "elements", "differ", "outside", "worst", "where", "verdict"}, {}};
    std::vector<bool> done(report.buffers.size(), false);
    for (std::size_t i = 0; i < report.buffers.size(); ++i) {
        if (done[i]) continue;
        const CheckedBuffer& first = report.buffers[i];
        std::string name = first.golden->name, last;
        std::size_t elements = !first.candidate ? 0 : first.comparison().elements;
        for (std::size_t j = i + 1; j < report.buffers.size(); ++j)
            if (!done[j] && joins(first, report.buffers[j])) {
                done[j] = true;
                last = std::to_string(levelOf(report.buffers[j].golden->name));
                elements += !first.candidate ? 0 : report.buffers[j].comparison().elements;
            }
        std::vector<std::string> row = rowOf(first, last.empty() ? name : name + "-" + last);
        if (!last.empty() && first.candidate) row[2] = std::to_string(elements);
        table.rows.push_back(std::move(row));
    }
    return table;
}

Json differenceJson(const Buffer& buffer, const ElementDifference& d)
{
    Json at = Json::object();
    const std::vector<std::size_t> indices = indicesOf(buffer, d.element);
    const std::vector<std::string> names = axisNamesOf(buffer);
    for (std::size_t axis = 0; axis < indices.size(); ++axis) {
        const bool component = axis + 1 == indices.size() && !buffer.components.empty();
        if (component)
            at[names[axis]] = buffer.components[indices[axis]];
        else
            at[names[axis]] = indices[axis];
    }
    const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(exactNumber(value)); };
    return {{"at", at}, {"expected", number(d.golden)}, {"candidate", number(d.candidate)}, {"size", number(d.size)}, {"size_text", sizeText(buffer, d.size)}};
}

Json comparisonJson(const Buffer& buffer, const BufferComparison& c)
{
    Json json = {{"elements", c.elements}, {"not_zero", c.live}, {"differing", c.differing}, {"outside", c.outside}, {"nan", c.notANumber}, {"holds", c.holds}};
    if (!c.why.empty()) json["why"] = c.why;
    if (c.first) json["first"] = differenceJson(buffer, *c.first);
    if (c.worst) json["worst"] = differenceJson(buffer, *c.worst);
    return json;
}

/// XML 1.0 has no place for control characters, escaped or not.
std::string xmlText(std::string text)
{
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n'; }, '?');
    // Bytes that are no UTF-8 (file names may hold any) become U+FFFD, as in JSON.
    const std::string valid = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
    return htmlEscaped(Json::parse(valid).get<std::string>());
}

std::string failureText(const CheckedBuffer& b)
{
    const BufferComparison& c = b.comparison();
    std::string text = c.why + "; tolerance " + toleranceText(b.golden->tolerance);
    if (c.first)
        text += "\nfirst: " + placeText(*b.golden, c.first->element) + ": expected " + exactNumber(c.first->golden) + ", candidate " +
                exactNumber(c.first->candidate) + " (" + sizeText(*b.golden, c.first->size) + ")";
    if (!b.where.empty()) text += "\nwhere: " + b.where;
    for (const std::string& hint : b.hints) text += "\nhint: " + hint;
    if (!b.note.empty()) text += "\nnote: " + b.note;
    return text;
}

std::string testCase(const CheckedBuffer& b)
{
    std::string xml = "    <testcase classname=\"" + xmlText(b.golden->pass) + "\" name=\"" + xmlText(b.golden->name) + "\"";
    if (b.verdict == Verdict::wrong)
        return xml + ">\n      <failure message=\"" + xmlText(b.comparison().why) + "\">" + xmlText(failureText(b)) + "</failure>\n    </testcase>\n";
    if (b.verdict == Verdict::unreadable) return xml + ">\n      <error message=\"" + xmlText(b.note) + "\"/>\n    </testcase>\n";
    if (b.verdict == Verdict::missing) return xml + ">\n      <skipped message=\"not in the candidate\"/>\n    </testcase>\n";
    if (b.verdict == Verdict::inherits) return xml + ">\n      <system-out>differs from the golden as its inputs do</system-out>\n    </testcase>\n";
    return xml + "/>\n";
}

}  // namespace

std::string checkTable(const CheckReport& report)
{
    std::string text = textTable(tableOf(report));
    std::string said;
    for (const CheckedBuffer& b : report.buffers) {
        // A file that holds many buffers is unreadable once.
        if (b.verdict == Verdict::unreadable && b.note != said) text += "\n" + b.golden->name + " cannot be read: " + (said = b.note) + "\n";
        if (b.verdict != Verdict::wrong) continue;
        text += "\n" + b.golden->name + ": " + b.comparison().why + "\n";
        if (!b.where.empty()) text += "  where: " + b.where + "\n";
        for (const std::string& hint : b.hints) text += "  hint:  " + hint + "\n";
        if (!b.note.empty()) text += "  note:  " + b.note + "\n";
    }
    return text;
}

Json checkJson(const CheckReport& report)
{
    Json json = {{"summary", report.summary()}, {"holds", report.holds()}, {"notes", report.notes}, {"buffers", Json::array()}};
    for (const CheckedBuffer& b : report.buffers) {
        Json entry = {
            {"pass", b.golden->pass}, {"name", b.golden->name}, {"verdict", nameOf(b.verdict).key}, {"tolerance", toleranceText(b.golden->tolerance)}};
        if (b.candidate) {
            entry["file"] = b.candidate->file;
            if (!b.candidate->note.empty()) entry["read_as"] = b.candidate->note;
            entry["against_golden"] = comparisonJson(*b.golden, b.againstGolden);
            if (b.againstRerun) entry["against_rerun"] = comparisonJson(*b.golden, *b.againstRerun);
        }
        if (!b.where.empty()) entry["where"] = b.where;
        if (!b.hints.empty()) entry["hints"] = b.hints;
        if (!b.note.empty()) entry["note"] = b.note;
        json["buffers"].push_back(std::move(entry));
    }
    return json;
}

std::string checkJUnit(const CheckReport& report, const std::string& name)
{
    struct Suite {
        std::string pass, cases;
        std::size_t tests = 0, failures = 0, errors = 0, skipped = 0;
    };
    std::vector<Suite> suites;
    for (const CheckedBuffer& b : report.buffers) {
        if (suites.empty() || suites.back().pass != b.golden->pass) suites.push_back({b.golden->pass, "", 0, 0, 0, 0});
        Suite& suite = suites.back();
        ++suite.tests;
        suite.failures += b.verdict == Verdict::wrong ? 1 : 0;
        suite.errors += b.verdict == Verdict::unreadable ? 1 : 0;
        suite.skipped += b.verdict == Verdict::missing ? 1 : 0;
        suite.cases += testCase(b);
    }
    std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"" + xmlText(name) + "\" tests=\"" +
                      std::to_string(report.buffers.size()) + "\" failures=\"" + std::to_string(report.count(Verdict::wrong)) + "\" errors=\"" +
                      std::to_string(report.count(Verdict::unreadable)) + "\" skipped=\"" + std::to_string(report.count(Verdict::missing)) + "\">\n";
    for (const Suite& suite : suites)
        xml += "  <testsuite name=\"" + xmlText(suite.pass) + "\" tests=\"" + std::to_string(suite.tests) + "\" failures=\"" + std::to_string(suite.failures) +
               "\" errors=\"" + std::to_string(suite.errors) + "\" skipped=\"" + std::to_string(suite.skipped) + "\">\n" + suite.cases + "  </testsuite>\n";
    return xml + "</testsuites>\n";
}

}  // namespace lrsm
