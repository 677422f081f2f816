#pragma once

#include "apps/capture/buffer.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"
#include "core/settings/settings.h"

/// The list of a frame's buffers as it grows, pass by pass (passes.h).
namespace lrsm {

/// What the shapes of a frame's buffers follow from.
struct DescribedFrame {
    const Scene& scene;
    const Requirements& needs;
    const Settings& settings;
    int width = 0, height = 0;
    std::vector<int> layersStored;  ///< one entry a light
};

/// What a texture's storage makes of it.
struct TexelFormat {
    Dtype dtype = Dtype::f4;
    Encoding encoding = Encoding::number;
    DxgiFormat dds = DxgiFormat::R32_FLOAT;
};

/// Buffers without bytes. Those with components have an axis "component" besides those that are named, the last.
class Catalogue {
  public:
    struct Text {
        std::string meaning, space, unit;
    };
    using Names = std::vector<std::string>;

    std::string pass;  ///< of the buffers that are added
    std::vector<Buffer> buffers;

    Buffer& add(const std::string& name, Dtype dtype, const std::vector<std::size_t>& shape, const Names& axes, const Names& components, const Text& text,
                const Tolerance& tolerance);
    /// Rows and columns.
    Buffer& picture(const std::string& name, int width, int height, const Names& components, const Text& text, const Tolerance& tolerance,
                    Dtype dtype = Dtype::f4);
};

/// Spaces, units and components that several passes name.
inline constexpr const char *kWorldSpace = "world", *kPicture = "picture", *kRadianceUnit = "W/(m^2 sr)", *kIrradianceUnit = "W/m^2";
inline const Catalogue::Names kXyz = {"x", "y", "z"}, kRgb = {"r", "g", "b"}, kRgbOpacity = {"r", "g", "b", "opacity"};

}  // namespace lrsm
