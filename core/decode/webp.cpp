#include "core/decode/decode.h"

#include <webp/decode.h>

namespace lrsm {

bool hasDecoders()
{
    return true;
}

std::optional<WebpSize> webpSize(std::span<const unsigned char> bytes)
{
    WebpSize size;
    if (!WebPGetInfo(bytes.data(), bytes.size(), &size.width, &size.height)) return {};
    return size;
}

std::optional<Bytes> decodeWebp(std::span<const unsigned char> bytes)
{
    const std::optional<WebpSize> size = webpSize(bytes);
    if (!size) return {};
    Bytes rgba(4 * std::size_t(size->width) * std::size_t(size->height));
    if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), rgba.data(), rgba.size(), 4 * size->width)) return {};
    return rgba;
}

}  // namespace lrsm
