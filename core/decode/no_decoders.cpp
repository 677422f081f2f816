// Where the passes alone are built (LRSM_PASSES_ONLY), without the three libraries.
#include "core/decode/decode.h"

namespace lrsm {

bool hasDecoders()
{
    return false;
}

std::optional<Bytes> decodeMeshopt(std::span<const unsigned char>, const MeshoptStream&)
{
    return {};
}

std::optional<DracoMesh> decodeDraco(std::span<const unsigned char>, std::span<const DracoAttribute>)
{
    return {};
}

std::optional<WebpSize> webpSize(std::span<const unsigned char>)
{
    return {};
}

std::optional<Bytes> decodeWebp(std::span<const unsigned char>)
{
    return {};
}

}  // namespace lrsm
