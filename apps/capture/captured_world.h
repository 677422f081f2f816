#pragma once

#include "apps/capture/capture.h"
#include "conetrace/frame/gather.h"

namespace lrsm {

/// What a GatherInput refers to, as far as it is asked for.
struct CapturedWorld {
    Scene scene;
    GBuffer gbuffer;
    std::vector<Rsm> rsms;
    OpacityPyramid opacity;

    GatherInput input(const Capture& capture, const Settings& settings) const
    {
        return {.scene = scene, .camera = capture.camera, .needs = capture.needs, .settings = settings, .gbuffer = gbuffer, .rsms = rsms, .opacity = opacity};
    }
};

}  // namespace lrsm
