#pragma once

#include "apps/capture/passes.h"
#include "apps/check/check.h"
#include "tests/apps/check/check_fixture.h"

#include "catch.h"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace lrsm::test {

/// Plants a defect in one buffer after the other of the passes whose names begin with `prefix`: each is found in that very buffer, and else in what is made
/// from it alone. Every family in `families` has been met.
inline void findsEachDefect(const Capture& golden, const std::string& prefix, const std::function<void(Buffer&)>& plant,
                            const std::vector<std::string>& families)
{
    std::vector<std::string> met;
    for (const Buffer& buffer : golden.buffers) {
        if (!buffer.pass.starts_with(prefix)) continue;
        CAPTURE(buffer.name);
        met.push_back(passFamily(buffer.pass));
        Capture copy = golden;
        for (Buffer& planted : copy.buffers)
            if (planted.name == buffer.name) plant(planted);
        const Candidate candidate = candidateOf(copy);
        CheckOptions options;
        options.fromGolden = true;
        options.hints = false;
        const CheckReport report = checkCandidate(golden, candidate, options);
        REQUIRE(report.firstWrong());
        CHECK(report.firstWrong()->golden->name == buffer.name);
        CHECK(textHas(report.summary(), "pass \"" + buffer.pass + "\", " + buffer.name));
        for (const CheckedBuffer& other : report.buffers)
            if (other.verdict == Verdict::wrong && other.golden->name != buffer.name) {
                CAPTURE(other.golden->name);
                const std::vector<std::string> reads = inputsOf(other.golden->pass, golden.settings, golden.needs, golden.lights.size());
                CHECK((other.golden->pass == buffer.pass || std::find(reads.begin(), reads.end(), buffer.pass) != reads.end()));
            }
    }
    for (const std::string& family : families) {
        CAPTURE(family);
        CHECK(std::find(met.begin(), met.end(), family) != met.end());
    }
}

}  // namespace lrsm::test
