#include "core/report/junit.h"

#include "core/report/html.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace lrsm {
namespace {

/// XML 1.0 has no place for control characters, escaped or not.
std::string xmlText(std::string text)
{
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n'; }, '?');
    // Bytes that are no UTF-8 (file names may hold any) become U+FFFD, as in JSON.
    const std::string valid = nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return htmlEscaped(nlohmann::json::parse(valid).get<std::string>());
}

std::string caseXml(const JUnitSuite& suite, const JUnitCase& c)
{
    const std::string xml = "    <testcase classname=\"" + xmlText(suite.name) + "\" name=\"" + xmlText(c.name) + "\"", message = xmlText(c.message);
    switch (c.verdict) {
    case JUnitCase::Verdict::failed: return xml + ">\n      <failure message=\"" + message + "\">" + xmlText(c.text) + "</failure>\n    </testcase>\n";
    case JUnitCase::Verdict::error: return xml + ">\n      <error message=\"" + message + "\"/>\n    </testcase>\n";
    case JUnitCase::Verdict::skipped: return xml + ">\n      <skipped message=\"" + message + "\"/>\n    </testcase>\n";
    default: break;
    }
    if (!c.text.empty()) return xml + ">\n      <system-out>" + xmlText(c.text) + "</system-out>\n    </testcase>\n";
    return xml + "/>\n";
}

/// The four attributes that suites and the whole carry.
struct Counts {
    std::size_t tests = 0, failures = 0, errors = 0, skipped = 0;
    void add(const JUnitSuite& suite)
    {
        const auto count = [&](JUnitCase::Verdict verdict) {
            return static_cast<std::size_t>(std::count_if(suite.cases.begin(), suite.cases.end(), [&](const JUnitCase& c) { return c.verdict == verdict; }));
        };
        tests += suite.cases.size();
        failures += count(JUnitCase::Verdict::failed);
        errors += count(JUnitCase::Verdict::error);
        skipped += count(JUnitCase::Verdict::skipped);
    }
    std::string xml() const
    {
        return " tests=\"" + std::to_string(tests) + "\" failures=\"" + std::to_string(failures) + "\" errors=\"" + std::to_string(errors) + "\" skipped=\"" +
               std::to_string(skipped) + "\">\n";
    }
};

}  // namespace

std::string junitXml(const std::string& name, const std::vector<JUnitSuite>& suites)
{
    Counts all;
    std::string body;
    for (const JUnitSuite& suite : suites) {
        Counts own;
        own.add(suite);
        all.add(suite);
        body += "  <testsuite name=\"" + xmlText(suite.name) + "\"" + own.xml();
        for (const JUnitCase& c : suite.cases) body += caseXml(suite, c);
        body += "  </testsuite>\n";
    }
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"" + xmlText(name) + "\"" + all.xml() + body + "</testsuites>\n";
}

}  // namespace lrsm
