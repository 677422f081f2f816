#include "apps/check/bless.h"

#include "core/base/errors.h"
#include "core/base/text.h"
#include "core/settings/settings_table.h"

#include <algorithm>

namespace lrsm {

namespace {

[[noreturn]] void refuse(const std::string& why)
{
    throw InputError("--bless", why + "; nothing was changed");
}

void refuseOtherFrames(const Capture& golden, const Capture& candidate)
{
    if (golden.sceneHash != candidate.sceneHash)
        refuse("the candidate is of another scene: " + candidate.sceneName + " (" + candidate.sceneHash.substr(0, 12) + "), the golden of " + golden.sceneName +
               " (" + golden.sceneHash.substr(0, 12) + ")");
    if (golden.width != candidate.width || golden.height != candidate.height)
        refuse("the candidate is " + std::to_string(candidate.width) + "x" + std::to_string(candidate.height) + ", the golden " + std::to_string(golden.width) +
               "x" + std::to_string(golden.height));
    if (const std::vector<SettingDifference> others = differences(golden.settings, candidate.settings); !others.empty())
        refuse("the candidate has other settings: " + joined(others, [](const SettingDifference& d) { return d.key + "=" + d.b + " (golden " + d.a + ")"; }));
}

void refuseOtherBuffers(const Capture& golden, const Capture& candidate)
{
    for (const Buffer& buffer : golden.buffers) {
        const Buffer* other = candidate.find(buffer.name);
        if (!other) refuse("the candidate has no " + buffer.name);
        if (other->shape != buffer.shape || other->dtype != buffer.dtype) refuse("the candidate's " + buffer.name + " has another shape or type");
    }
    for (const Buffer& buffer : candidate.buffers)
        if (!golden.find(buffer.name)) refuse("the golden has no " + buffer.name + ", which the candidate has");
}

}  // namespace

Capture blessed(const Capture& golden, const Capture& candidate, const std::string& reason, const std::string& version)
{
    if (reason.find_first_not_of(" \t\r\n") == std::string::npos) throw InputError("--reason", "must say why the golden changes");
    refuseOtherFrames(golden, candidate);
    refuseOtherBuffers(golden, candidate);

    Capture next = candidate;
    next.history = golden.history;
    Blessing blessing{reason, version, {}};
    for (Buffer& buffer : next.buffers) {
        const Buffer& before = golden.at(buffer.name);
        if (before.bytes != buffer.bytes) blessing.buffers.push_back(buffer.name);
        buffer.file = before.file;
        buffer.dds = before.dds;
    }
    if (!blessing.buffers.empty()) next.history.push_back(std::move(blessing));
    return next;
}

}  // namespace lrsm
