#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

/// Where the real scenes lie that some tests load: $LRSM_SCENES, else ../shared/scenes beside the source tree. The product never
/// needs them; tests that do begin with LRSM_NEED_SCENES and are visibly skipped without.
inline std::filesystem::path scenesFolder()
{
    if (const char* folder = std::getenv("LRSM_SCENES")) return folder;
    return std::filesystem::path(LRSM_SOURCE_DIR) / ".." / "shared" / "scenes";
}

#define LRSM_NEED_SCENES()                                                        \
    if (!std::filesystem::exists(scenesFolder() / "SCENES.tsv")) {                \
        WARN("SKIPPED: no scenes in " << scenesFolder() << " (set LRSM_SCENES)"); \
        return;                                                                   \
    }
