#include "apps/check/check.h"

#include "apps/capture/passes.h"
#include "apps/check/hints.h"
#include "core/base/errors.h"
#include "core/base/text.h"

#include <algorithm>
#include <cmath>

namespace lrsm {

namespace {

std::size_t passIndex(const Capture& golden, const std::string& pass)
{
    const auto found = std::find_if(golden.passes.begin(), golden.passes.end(), [&](const CapturedPass& p) { return p.name == pass; });
    return static_cast<std::size_t>(found - golden.passes.begin()) + 1;
}

void refuseUnknownPasses(const Capture& golden, const std::vector<std::string>& passes)
{
    for (const std::string& asked : passes) {
        std::vector<std::string> known;
        for (const Buffer& buffer : golden.buffers)
            if (known.empty() || known.back() != buffer.pass) known.push_back(buffer.pass);
        if (std::none_of(known.begin(), known.end(), [&](const std::string& pass) { return isAskedFor({asked}, pass); }))
            throw InputError("--only " + asked, "the golden has no buffers of such a pass; it has " + joined(known));
    }
}

/// The golden's buffers in the order in which data flow through them; what is given and not in the candidate is left out.
std::vector<CheckedBuffer> inOrder(const Capture& golden, const Candidate& candidate, const CheckOptions& options)
{
    std::vector<CheckedBuffer> buffers;
    for (const Buffer& buffer : golden.buffers) {
        if (!isAskedFor(options.passes, buffer.pass)) continue;
        CheckedBuffer checked;
        checked.golden = &buffer;
        checked.candidate = candidate.find(buffer.name);
        if (const UnreadableBuffer* unreadable = candidate.findUnreadable(buffer.name)) {
            checked.verdict = Verdict::unreadable;
            checked.note = unreadable->why;
        } else if (!checked.candidate && isGiven(buffer.pass)) {
            continue;
        }
        buffers.push_back(std::move(checked));
    }
    const auto place = [&](const CheckedBuffer& b) {
        return std::pair(isGiven(b.golden->pass) ? std::size_t(0) : passIndex(golden, b.golden->pass), levelOf(b.golden->name));
    };
    std::stable_sort(buffers.begin(), buffers.end(), [&](const CheckedBuffer& a, const CheckedBuffer& b) { return place(a) < place(b); });
    return buffers;
}

/// Passes upstream of which the candidate has no buffer, as text; for what a verdict rests on.
std::string inputsTakenFromGolden(const Capture& golden, const Candidate& candidate, const CapturedPass& pass)
{
    std::string text;
    for (const std::string& input : pass.inputs) {
        if (isGiven(input)) continue;
        std::size_t has = 0, of = 0;
        for (const Buffer& buffer : golden.buffers) {
            if (buffer.pass != input) continue;
            ++of;
            has += candidate.find(buffer.name) ? 1 : 0;
        }
        if (has < of) text += (text.empty() ? "" : ", ") + input + (has ? " (in part)" : "");
    }
    return text;
}

/// Does the candidate have a buffer of which this pass is made, its own lower mips included?
bool hasInputs(const Capture& golden, const Candidate& candidate, const CapturedPass& pass)
{
    return std::any_of(golden.buffers.begin(), golden.buffers.end(), [&](const Buffer& buffer) {
        const bool read = buffer.pass == pass.name || std::find(pass.inputs.begin(), pass.inputs.end(), buffer.pass) != pass.inputs.end();
        return read && !isGiven(buffer.pass) && candidate.find(buffer.name);
    });
}

void judgeByInputs(CheckedBuffer& checked, const Rerun& rerun, const std::string& fromGolden)
{
    const auto made = std::find_if(rerun.outputs.begin(), rerun.outputs.end(), [&](const Buffer& b) { return b.name == checked.golden->name; });
    if (made == rerun.outputs.end()) {
        checked.note = "not run anew: " + rerun.why;
        return;
    }
    checked.rerun = *made;
    checked.againstRerun = compareBuffers(checked.rerun, checked.candidate->buffer, checked.candidate->given);
    if (!fromGolden.empty()) checked.note = "inputs from the golden: " + fromGolden;
    if (checked.againstRerun->holds)
        checked.verdict = checked.againstGolden.holds ? Verdict::ok : Verdict::inherits;
    else if (!checked.againstGolden.holds)
        checked.verdict = Verdict::wrong;
    else
        // The golden's own output beside inputs that are not: both are in the candidate, but the one was not made from the other.
        checked.note = "matches the golden, but not what this pass makes of the candidate's own inputs";
}

void rerunPasses(const Capture& golden, const Candidate& candidate, const Capture& mixed, const CheckOptions& options, std::vector<CheckedBuffer>& buffers)
{
    std::size_t done = 0;
    for (const CapturedPass& pass : golden.passes) {
        if (options.progress) options.progress(pass.name, static_cast<double>(done++) / static_cast<double>(golden.passes.size()));
        const auto ours = [&](const CheckedBuffer& b) { return b.golden->pass == pass.name && b.candidate; };
        // A pass that reads the scene alone has the same inputs here and there: the golden is what it makes of them.
        if (std::all_of(pass.inputs.begin(), pass.inputs.end(), isGiven) || std::none_of(buffers.begin(), buffers.end(), ours) ||
            !hasInputs(golden, candidate, pass))
            continue;
        const Rerun rerun = rerunPass(mixed, pass.name);
        const std::string fromGolden = inputsTakenFromGolden(golden, candidate, pass);
        for (CheckedBuffer& checked : buffers)
            if (ours(checked)) judgeByInputs(checked, rerun, fromGolden);
    }
}

void addHints(const Capture& inputs, std::vector<CheckedBuffer>& buffers)
{
    std::string lastPass;
    for (CheckedBuffer& checked : buffers) {
        if (checked.verdict != Verdict::wrong) continue;
        // Other settings and other inputs are tried on the first wrong buffer of a pass alone: each costs a run of the pass.
        const bool first = checked.golden->pass != lastPass;
        lastPass = checked.golden->pass;
        const HintQuestion question{inputs, checked.expected(), *checked.candidate, checked.comparison(), first};
        checked.where = whatTheyShare(question);
        checked.hints = findHints(question);
    }
}

[[noreturn]] void refuseNothingInCommon(const Capture& golden, const Candidate& candidate)
{
    if (!candidate.unreadable.empty()) {
        const std::size_t more = candidate.unreadable.size() - 1;
        throw InputError(candidate.unreadable.front().why + (more ? " (" + std::to_string(more) + " more buffers cannot be read, and none can)" : ""));
    }
    std::string near;
    for (const std::string& miss : candidate.nearMisses)
        if (&miss - candidate.nearMisses.data() < 3) near += "; " + miss;
    throw InputError(candidate.folder,
                     "has no buffer in common with the golden" +
                         (near.empty() ? "; buffers are found by name, as " +
                                             (golden.buffers.empty() ? std::string("lrsm0.depth.mip0") : golden.buffers.back().name) + ".npy, or by --map"
                                       : near));
}

}  // namespace

VerdictName nameOf(Verdict verdict)
{
    switch (verdict) {
    case Verdict::ok: return {"ok", "ok"};
    case Verdict::wrong: return {"WRONG", "wrong"};
    case Verdict::inherits: return {"inherits", "inherits"};
    case Verdict::unreadable: return {"UNREADABLE", "unreadable"};
    case Verdict::missing: break;
    }
    return {"not in candidate", "not_in_candidate"};
}

const CheckedBuffer* CheckReport::firstWrong() const
{
    const auto found = std::find_if(buffers.begin(), buffers.end(), [](const CheckedBuffer& b) { return b.verdict == Verdict::wrong; });
    return found == buffers.end() ? nullptr : &*found;
}

std::size_t CheckReport::count(Verdict verdict) const
{
    return static_cast<std::size_t>(std::count_if(buffers.begin(), buffers.end(), [&](const CheckedBuffer& b) { return b.verdict == verdict; }));
}

std::string CheckReport::summary() const
{
    const CheckedBuffer* wrong = firstWrong();
    const auto buffersAre = [](std::size_t n) { return std::to_string(n) + (n == 1 ? " buffer is" : " buffers are"); };
    std::string unread;
    if (const std::size_t n = count(Verdict::unreadable)) {
        const auto first = std::find_if(buffers.begin(), buffers.end(), [](const CheckedBuffer& b) { return b.verdict == Verdict::unreadable; });
        unread = "; " + std::to_string(n) + " cannot be read: " + first->note + (n > 1 ? " (and so on)" : "");
    }
    if (!wrong) {
        std::string text = buffersAre(count(Verdict::ok)) + " within " + (count(Verdict::ok) == 1 ? "its tolerance" : "their tolerances");
        if (const std::size_t inherits = count(Verdict::inherits)) text += "; " + std::to_string(inherits) + " differ from the golden as their inputs do";
        if (const std::size_t missing = count(Verdict::missing)) text += "; " + std::to_string(missing) + " are not in the candidate";
        return text + unread;
    }
    const Buffer& golden = wrong->expected();
    const BufferComparison& c = wrong->comparison();
    std::string text = "first difference: pass \"" + golden.pass + "\", " + golden.name;
    if (c.first) {
        text += ", " + placeText(golden, c.first->element) + ": " + (wrong->againstRerun ? "expected " : "golden ") + numberText(6, c.first->golden) +
                ", candidate " + numberText(6, c.first->candidate);
        if (golden.tolerance.kind != Tolerance::Kind::exact && !std::isnan(c.first->size)) text += ", off by " + sizeText(golden, c.first->size);
    }
    text += " (tolerance " + toleranceText(golden.tolerance) + "); " + std::to_string(c.differing) + " of " + std::to_string(c.elements) + " differ, " +
            std::to_string(c.outside) + " outside";
    if (!wrong->hints.empty()) text += "; hint: " + wrong->hints.front();
    return text + unread;
}

void demandBits(Capture& golden)
{
    for (Buffer& buffer : golden.buffers) buffer.tolerance = {Tolerance::Kind::exact, 0.0, 0.0, 0.0, 1.0, "--exact"};
}

CheckReport checkCandidate(const Capture& golden, const Candidate& candidate, const CheckOptions& options)
{
    refuseUnknownPasses(golden, options.passes);
    CheckReport report;
    report.notes = candidate.notes;
    report.buffers = inOrder(golden, candidate, options);
    if (std::none_of(report.buffers.begin(), report.buffers.end(), [](const CheckedBuffer& b) { return b.candidate; }))
        refuseNothingInCommon(golden, candidate);
    for (CheckedBuffer& checked : report.buffers) {
        if (!checked.candidate) continue;
        checked.againstGolden = compareBuffers(*checked.golden, checked.candidate->buffer, checked.candidate->given);
        checked.verdict = checked.againstGolden.holds ? Verdict::ok : Verdict::wrong;
    }
    if (options.fromGolden) {
        const Capture mixed = layOver(golden, candidate);
        rerunPasses(golden, candidate, mixed, options, report.buffers);
        if (options.hints) addHints(mixed, report.buffers);
    } else if (options.hints) {
        addHints(golden, report.buffers);
    }
    return report;
}

}  // namespace lrsm
