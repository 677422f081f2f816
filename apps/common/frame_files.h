#pragma once

#include "apps/common/memory.h"
#include "apps/common/proxies_picture.h"
#include "conetrace/caches/gather.h"
#include "conetrace/render.h"
#include "core/base/output_folder.h"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

/// The files of a rendered frame: image.exr, image.png and a PNG a part, frame.json. docs/file-formats.md says what is in them.
namespace lrsm {

inline constexpr const char *kCachesPicture = "caches.png", *kProxiesPicture = "proxies.png";  ///< the files that not every frame has

/// What made the frame.
struct FrameRecord {
    const Scene& scene;
    const Camera& camera;
    const Settings& settings;
    std::string preset;
    std::string sceneHash;
    std::vector<MemoryRow> memory;
    std::optional<float> exposureStops;    ///< of the PNGs; nothing: automatic
    std::string radiance;                  ///< of what the diffuse gather meets: "lrsm" or "exact"
    const Caches* caches = nullptr;        ///< of method=caches: drawn as caches.png
    const SeenProxies* proxies = nullptr;  ///< of method=proxies: drawn as proxies.png
};

nlohmann::ordered_json frameJson(const Frame& frame, const FrameRecord& record);

/// `json` goes into frame.json as it is; its settings and scene also into the EXR's metadata.
void writeFrame(OutputFolder& folder, const Frame& frame, const FrameRecord& record, const nlohmann::ordered_json& json);

}  // namespace lrsm
