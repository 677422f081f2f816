// Any text as a view file: a view that keeps its promises, or an InputError of one line.
#include "core/base/errors.h"
#include "core/scene/view_file.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const auto unit = [](const lrsm::Vec3& v) { return std::abs(glm::dot(v, v) - 1.0f) < 1e-5f; };
    try {
        const lrsm::View view = lrsm::parseView(std::string(data, data + size), "view.json");
        if (view.camera && !(unit(view.camera->forward) && unit(view.camera->up) && lrsm::isFinite(view.camera->position))) std::abort();
        if (view.camera && !(std::abs(glm::dot(view.camera->forward, view.camera->up)) < 1e-4f)) std::abort();
        if (view.lights) {
            if (view.lights->empty()) std::abort();
            for (const lrsm::Light& light : *view.lights)
                if (!unit(light.direction) || !unit(light.up) || !lrsm::isFinite(light.intensity)) std::abort();
        }
    } catch (const lrsm::InputError& error) {
        if (std::string(error.what()).find('\n') != std::string::npos) std::abort();
    }
    return 0;
}
