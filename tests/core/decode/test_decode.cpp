// Each decoder against the data that the format's own encoder was given.
#include "core/decode/decode.h"

#include "catch.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>
#include <webp/encode.h>

#include <array>
#include <cstring>

using namespace lrsm;

namespace {

template <class T>
Bytes bytesOf(const std::vector<T>& values)
{
    Bytes bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

/// 16-bit quadruples that wander.
std::vector<std::uint16_t> wandering(std::size_t count)
{
    std::vector<std::uint16_t> values;
    for (std::size_t i = 0; i < 4 * count; ++i) values.push_back(std::uint16_t(i * i % 911 + 3 * i));
    return values;
}

Bytes encodedVertices(const Bytes& plain, std::size_t count, std::size_t stride)
{
    Bytes encoded(meshopt_encodeVertexBufferBound(count, stride));
    encoded.resize(meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), plain.data(), count, stride));
    return encoded;
}

const std::vector<unsigned> kTriangles = {0, 1, 2, 2, 1, 3, 4, 2, 3, 5, 4, 3};

}  // namespace

TEST_CASE("meshopt: attributes and both kinds of indices come back to the byte", "[decode]")
{
    const Bytes plain = bytesOf(wandering(100));
    CHECK(decodeMeshopt(encodedVertices(plain, 100, 8), {.count = 100, .stride = 8}) == plain);

    Bytes triangles(meshopt_encodeIndexBufferBound(kTriangles.size(), 6)), sequence(meshopt_encodeIndexSequenceBound(kTriangles.size(), 6));
    triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), kTriangles.data(), kTriangles.size()));
    sequence.resize(meshopt_encodeIndexSequence(sequence.data(), sequence.size(), kTriangles.data(), kTriangles.size()));
    CHECK(decodeMeshopt(sequence, {.mode = MeshoptStream::Mode::indices, .count = 12, .stride = 4}) == bytesOf(kTriangles));
    CHECK(decodeMeshopt(sequence, {.mode = MeshoptStream::Mode::indices, .count = 12, .stride = 2}) ==
          bytesOf(std::vector<std::uint16_t>(kTriangles.begin(), kTriangles.end())));

    // The triangle codec may turn a triangle round its corners, which changes neither it nor its winding.
    const std::optional<Bytes> decoded = decodeMeshopt(triangles, {.mode = MeshoptStream::Mode::triangles, .count = 12, .stride = 4});
    REQUIRE(decoded);
    for (std::size_t t = 0; t < kTriangles.size(); t += 3) {
        std::array<unsigned, 3> triangle;
        std::memcpy(triangle.data(), decoded->data() + 4 * t, sizeof triangle);
        std::rotate(triangle.begin(), std::find(triangle.begin(), triangle.end(), kTriangles[t]), triangle.end());
        CHECK(triangle == std::array{kTriangles[t], kTriangles[t + 1], kTriangles[t + 2]});
    }
}

TEST_CASE("meshopt: filters are undone to what their bits hold", "[decode]")
{
    const std::vector<float> normals = {0, 0, 1, 0, 0.6f, 0, 0.8f, 0, 0, -0.6f, -0.8f, 0};
    std::vector<std::int16_t> octahedral(12);
    meshopt_encodeFilterOct(octahedral.data(), 3, 8, 16, normals.data());
    const std::optional<Bytes> decoded =
        decodeMeshopt(encodedVertices(bytesOf(octahedral), 3, 8), {.filter = MeshoptStream::Filter::octahedral, .count = 3, .stride = 8});
    REQUIRE(decoded);
    std::vector<std::int16_t> read(12);
    std::memcpy(read.data(), decoded->data(), decoded->size());
    for (std::size_t i = 0; i < 12; ++i)
        if (i % 4 != 3) CHECK(read[i] / 32767.0 == Approx(double(normals[i])).margin(1e-4));

    const std::vector<float> positions = {1.5f, -0.25f, 1000.0f, 0.0f, 7.0f, -3.125f};
    std::vector<std::uint32_t> exponential(6);
    meshopt_encodeFilterExp(exponential.data(), 2, 12, 24, positions.data()
#if MESHOPTIMIZER_VERSION >= 200
                                                               ,
                            meshopt_EncodeExpSeparate
#endif
    );
    CHECK(decodeMeshopt(encodedVertices(bytesOf(exponential), 2, 12), {.filter = MeshoptStream::Filter::exponential, .count = 2, .stride = 12}) ==
          bytesOf(positions));
}

TEST_CASE("meshopt: damaged streams and impossible strides give nothing", "[decode]")
{
    const Bytes encoded = encodedVertices(bytesOf(wandering(100)), 100, 8);
    CHECK_FALSE(decodeMeshopt(std::span(encoded).first(encoded.size() / 2), {.count = 100, .stride = 8}));
    CHECK_FALSE(decodeMeshopt({}, {.count = 100, .stride = 8}));
    CHECK_FALSE(decodeMeshopt(encoded, {.count = 100, .stride = 7}));
    CHECK_FALSE(decodeMeshopt(encoded, {.count = 0, .stride = 8}));
    CHECK_FALSE(decodeMeshopt(encoded, {.mode = MeshoptStream::Mode::triangles, .count = 100, .stride = 4}));
    CHECK_FALSE(decodeMeshopt(encoded, {.filter = MeshoptStream::Filter::quaternion, .count = 100, .stride = 16}));
}

TEST_CASE("Draco: a mesh comes back with its corners, wherever its points went", "[decode]")
{
    const std::vector<std::array<float, 3>> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0.5f}, {0, 1, 0}};
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (std::uint32_t f = 0; f < 2; ++f)
        builder.SetAttributeValuesForFace(position, draco::FaceIndex(f), corners[3 * f].data(), corners[3 * f + 1].data(), corners[3 * f + 2].data());
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    REQUIRE(mesh);
    const std::uint32_t id = mesh->attribute(position)->unique_id();
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    const Bytes encoded(buffer.data(), buffer.data() + buffer.size());

    const std::array<DracoAttribute, 1> wanted = {DracoAttribute{.id = id}};
    const std::optional<DracoMesh> decoded = decodeDraco(encoded, wanted);
    REQUIRE(decoded);
    CHECK(decoded->points == 4);
    REQUIRE(decoded->indices.size() == 6);
    std::vector<std::array<float, 3>> points(decoded->points);
    std::memcpy(points.data(), decoded->attributes[0].data(), decoded->attributes[0].size());
    // Faces may come in another order and turned.
    for (std::size_t t = 0; t < 6; t += 3) {
        bool found = false;
        for (std::size_t f = 0; f < 6; f += 3)
            for (std::size_t turn = 0; turn < 3; ++turn) {
                bool same = true;
                for (std::size_t c = 0; c < 3; ++c) same &= points[decoded->indices[f + (c + turn) % 3]] == corners[t + c];
                found |= same;
            }
        CHECK(found);
    }

    const std::array<DracoAttribute, 1> other = {DracoAttribute{.id = id + 7}}, wide = {DracoAttribute{.id = id, .components = 4}};
    CHECK_FALSE(decodeDraco(encoded, other));
    CHECK_FALSE(decodeDraco(encoded, wide));
    for (std::size_t length = 0; length < encoded.size(); length += 5) CHECK_FALSE(decodeDraco(std::span(encoded).first(length), wanted));
}

TEST_CASE("WebP: a lossless picture comes back with its alpha", "[decode]")
{
    const Bytes rgba = {255, 0, 0, 255, 0, 255, 0, 128, 1, 2, 3, 255, 90, 80, 70, 1, 0, 0, 255, 255, 7, 7, 7, 200};
    unsigned char* output = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(rgba.data(), 3, 2, 12, &output);
    const Bytes encoded(output, output + size);
    WebPFree(output);
    const std::optional<WebpSize> header = webpSize(encoded);
    REQUIRE(header);
    CHECK(header->width == 3);
    CHECK(header->height == 2);
    CHECK(decodeWebp(encoded) == rgba);
    CHECK_FALSE(decodeWebp(std::span(encoded).first(encoded.size() - 4)));
    CHECK_FALSE(webpSize(rgba));
}
