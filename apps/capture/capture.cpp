#include "apps/capture/capture.h"

#include "core/base/errors.h"

namespace lrsm {

std::vector<LayerRange> CapturedLight::storedRanges() const
{
    std::vector<LayerRange> ranges;
    for (std::size_t i = 0; i < partition.size(); ++i)
        if (stored[i] >= 0) ranges.push_back(partition[i]);
    return ranges;
}

const Buffer* Capture::find(const std::string& name) const
{
    for (const Buffer& buffer : buffers)
        if (buffer.name == name) return &buffer;
    return nullptr;
}

const Buffer& Capture::at(const std::string& name) const
{
    if (const Buffer* buffer = find(name)) return *buffer;
    throw InputError("capture", "has no buffer " + name);
}

}  // namespace lrsm
