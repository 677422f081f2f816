#pragma once

#include "core/scene/gltf_document.h"

namespace lrsm::gltf {

/// EXT_meshopt_compression and KHR_draco_mesh_compression: what they hold is decoded into buffers of its own, and buffer views and accessors are pointed
/// there. All that follows finds an ordinary file. After the buffers; before accessors are checked. Throws InputError.
void decompress(Document& document);

/// A buffer that only compressed views stand for, and that no file holds.
bool isFallbackBuffer(const Json& buffer);

}  // namespace lrsm::gltf
