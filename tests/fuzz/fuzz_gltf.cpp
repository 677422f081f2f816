// Any bytes as a glTF file: a scene that keeps its promises, or an InputError; nothing else, no sanitizer finding.
// Seeds: the samples and malformed files of LRSM_SCENES, small ones first.
#include "core/base/errors.h"
#include "core/scene/load_scene.h"

#include <unistd.h>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const std::string path = (std::filesystem::temp_directory_path() / ("fuzz-gltf-" + std::to_string(getpid()))).string();
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(data), std::streamsize(size));
    try {
        const lrsm::Scene scene = lrsm::loadGltf(path, {0.7f, 0});
        if (scene.bounds.empty() || scene.triangleCount() == 0 || scene.lights.empty() || scene.cameras.empty()) std::abort();
        for (const lrsm::Mesh& mesh : scene.meshes) {
            if (mesh.normals.size() != mesh.positions.size()) std::abort();
            for (const lrsm::Vec3& n : mesh.normals)
                if (!(std::abs(glm::dot(n, n) - 1.0f) < 1e-5f)) std::abort();
            for (const auto& triangle : mesh.triangles)
                for (const std::uint32_t v : triangle)
                    if (v >= mesh.positions.size() || !lrsm::isFinite(mesh.positions[v])) std::abort();
        }
        lrsm::hashScene(scene);
    } catch (const lrsm::InputError& error) {
        if (std::string(error.what()).find('\n') != std::string::npos) std::abort();  // one line
    }
    return 0;
}
