#include "core/report/table.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <string_view>

namespace lrsm {
namespace {

/// Bytes that are no continuation of a UTF-8 character: what a terminal shows.
std::size_t width(const std::string& text)
{
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

bool isNumber(const std::string& cell)
{
    return cell.empty() || std::string_view("0123456789+-.<>").find(cell.front()) != std::string_view::npos || cell == "nan" || cell == "inf";
}

std::string csvCell(const std::string& cell)
{
    if (cell.find_first_of(",\"\n\r") == std::string::npos) return cell;
    std::string quoted = "\"";
    for (const char letter : cell) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
    return quoted + "\"";
}

}  // namespace

std::vector<bool> numberColumns(const ReportTable& table)
{
    std::vector<bool> numbers(table.head.size(), true);
    for (const auto& row : table.rows)
        for (std::size_t i = 0; i < row.size() && i < numbers.size(); ++i) numbers[i] = numbers[i] && isNumber(row[i]);
    return numbers;
}

std::string textTable(const ReportTable& table)
{
    if (table.rows.empty()) return {};
    std::vector<std::size_t> widths;
    const auto widen = [&](const std::vector<std::string>& row) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
    };
    widen(table.head);
    for (const auto& row : table.rows) widen(row);

    std::string text = table.title.empty() ? "" : table.title + "\n";
    std::vector<bool> numbers = numberColumns(table);
    numbers.resize(widths.size(), false);
    const auto line = [&](const std::vector<std::string>& row) {
        std::string out;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string padding(widths[i] - width(row[i]), ' ');
            out += "  " + (numbers[i] ? padding + row[i] : row[i] + padding);
        }
        text += out.substr(0, out.find_last_not_of(' ') + 1) + "\n";
    };
    line(table.head);
    for (const auto& row : table.rows) line(row);
    return text;
}

std::string csvTable(const ReportTable& table, const std::string& lineEnd)
{
    std::string text;
    const auto line = [&](const std::vector<std::string>& row) {
        for (std::size_t i = 0; i < row.size(); ++i) text += (i ? "," : "") + csvCell(row[i]);
        text += lineEnd;
    };
    line(table.head);
    for (const auto& row : table.rows) line(row);
    return text;
}

std::string markdownTable(const ReportTable& table)
{
    std::string text;
    const auto line = [&](std::vector<std::string> row) {
        row.resize(table.head.size());
        text += "|";
        for (const std::string& cell : row) {
            text += " ";
            for (const char letter : cell) text += letter == '|' ? std::string("\\|") : std::string(1, letter);
            text += " |";
        }
        text += "\n";
    };
    line(table.head);
    line(std::vector<std::string>(table.head.size(), "---"));
    for (const auto& row : table.rows) line(row);
    return text;
}

std::string exactNumber(double value)
{
    char digits[32];
    return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

std::string numberText(int digits, double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

std::string shortNumber(double value)
{
    return numberText(3, value);
}

std::string fixedNumber(int digits, double value)
{
    char text[340];  // of the largest double
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

}  // namespace lrsm
