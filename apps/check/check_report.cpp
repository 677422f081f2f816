#include "apps/check/check_report.h"

#include "core/report/junit.h"
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

JUnitCase testCase(const CheckedBuffer& b)
{
    switch (b.verdict) {
    case Verdict::wrong: return {b.golden->name, JUnitCase::Verdict::failed, b.comparison().why, failureText(b)};
    case Verdict::unreadable: return {b.golden->name, JUnitCase::Verdict::error, b.note};
    case Verdict::missing: return {b.golden->name, JUnitCase::Verdict::skipped, "not in the candidate"};
    case Verdict::inherits: return {b.golden->name, JUnitCase::Verdict::passed, "", "differs from the golden as its inputs do"};
    default: return {b.golden->name};
    }
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
    std::vector<JUnitSuite> suites;
    for (const CheckedBuffer& b : report.buffers) {
        if (suites.empty() || suites.back().name != b.golden->pass) suites.push_back({b.golden->pass});
        suites.back().cases.push_back(testCase(b));
    }
    return junitXml(name, suites);
}

}  // namespace lrsm
