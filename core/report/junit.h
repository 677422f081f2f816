#pragma once

#include <string>
#include <vector>

/// JUnit's XML, as Jenkins, GitLab and others read it.
namespace lrsm {

struct JUnitCase {
    enum class Verdict { passed, failed, error, skipped };
    std::string name;
    Verdict verdict = Verdict::passed;
    std::string message = {};  ///< one line: why not passed
    std::string text = {};     ///< of a failure: more lines; of what passed: what it says nevertheless
};

struct JUnitSuite {
    std::string name;
    std::vector<JUnitCase> cases = {};
};

/// Text may hold anything: what XML has no place for is replaced.
std::string junitXml(const std::string& name, const std::vector<JUnitSuite>& suites);

}  // namespace lrsm
