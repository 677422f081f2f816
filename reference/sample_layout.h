#pragma once

namespace lrsm {

/// Where each value of a pixel lies in the sums. A scene without specular part stops after the opacity; the cone is there when asked for.
enum SampleChannel { kIrradiance = 0, kOpacity = 3, kLobe = 4, kCone = 7 };
enum SampleChannelCount { kDiffuseChannels = 4, kLobeChannels = 7, kConeChannels = 10 };

}  // namespace lrsm
