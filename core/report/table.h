#pragma once

#include <string>
#include <vector>

/// Tables, written for a terminal, for a spreadsheet, for Markdown, and (html.h) for a page.
namespace lrsm {

struct ReportTable {
    std::string title;
    std::vector<std::string> head;
    /// A row whose first cell begins with "!" tells of a failure: pages colour it, terminals show the mark.
    std::vector<std::vector<std::string>> rows;
};

/// Columns aligned with spaces, those of numbers alone to the right. Empty without rows.
std::string textTable(const ReportTable& table);

/// Which columns hold numbers ("< 3" and nothing count as such) alone: those stand to the right. One entry for each column of the head.
std::vector<bool> numberColumns(const ReportTable& table);

/// RFC 4180 but for its line ends; the head is the first line, the title is not written.
std::string csvTable(const ReportTable& table, const std::string& lineEnd = "\n");

/// Of GitHub, without the title.
std::string markdownTable(const ReportTable& table);

/// The shortest digits that restore the value's bits; "nan", "inf".
std::string exactNumber(double value);

/// So many significant digits at the most, for people: "0.0123", "1.2e-07", "0".
std::string numberText(int digits, double value);
/// Three of them.
std::string shortNumber(double value);
/// So many digits behind the point.
std::string fixedNumber(int digits, double value);

}  // namespace lrsm
