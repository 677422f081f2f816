#include "core/decode/decode.h"

#include <meshoptimizer.h>

namespace lrsm {
namespace {

bool isValid(const MeshoptStream& s)
{
    using Mode = MeshoptStream::Mode;
    using Filter = MeshoptStream::Filter;
    if (s.count == 0) return false;
    if (s.mode == Mode::attributes) {
        if (s.stride < 4 || s.stride > 256 || s.stride % 4 != 0) return false;
        if (s.filter == Filter::octahedral) return s.stride == 4 || s.stride == 8;
        if (s.filter == Filter::quaternion) return s.stride == 8;
        return true;
    }
    return (s.stride == 2 || s.stride == 4) && (s.mode != Mode::triangles || s.count % 3 == 0) && s.filter == Filter::none;
}

int decodeInto(Bytes& out, std::span<const unsigned char> bytes, const MeshoptStream& s)
{
    switch (s.mode) {
    case MeshoptStream::Mode::attributes: return meshopt_decodeVertexBuffer(out.data(), s.count, s.stride, bytes.data(), bytes.size());
    case MeshoptStream::Mode::triangles: return meshopt_decodeIndexBuffer(out.data(), s.count, s.stride, bytes.data(), bytes.size());
    default: return meshopt_decodeIndexSequence(out.data(), s.count, s.stride, bytes.data(), bytes.size());
    }
}

}  // namespace

std::optional<Bytes> decodeMeshopt(std::span<const unsigned char> bytes, const MeshoptStream& stream)
{
    if (!isValid(stream)) return {};
    Bytes out(stream.count * stream.stride);
    if (decodeInto(out, bytes, stream) != 0) return {};
    switch (stream.filter) {
    case MeshoptStream::Filter::none: break;
    case MeshoptStream::Filter::octahedral: meshopt_decodeFilterOct(out.data(), stream.count, stream.stride); break;
    case MeshoptStream::Filter::quaternion: meshopt_decodeFilterQuat(out.data(), stream.count, stream.stride); break;
    case MeshoptStream::Filter::exponential: meshopt_decodeFilterExp(out.data(), stream.count, stream.stride); break;
    }
    return out;
}

}  // namespace lrsm
