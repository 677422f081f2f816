#include "apps/capture/capture_files.h"

#include "apps/capture/manifest_read.h"
#include "apps/capture/manifest_write.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/json_reader.h"

#include <filesystem>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

std::string jsonText(const Json& json)
{
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string pathIn(const std::string& folder, const std::string& file)
{
    return (std::filesystem::path(folder) / file).string();
}

void readBytes(const std::string& folder, Buffer& buffer)
{
    const std::string path = pathIn(folder, buffer.file);
    NpyArray array = readNpy(path);
    if (array.dtype != buffer.dtype)
        throw InputError(path, "holds " + std::string(nameOf(array.dtype)) + " where the manifest says " + std::string(nameOf(buffer.dtype)));
    if (array.shape != buffer.shape) throw InputError(path, "has another shape than the manifest says");
    const std::string hash = Sha256().add(array.bytes).hex();
    if (hash != buffer.sha256) throw InputError(path, "has another SHA-256 than the manifest says: it was changed after it was written");
    buffer.bytes = std::move(array.bytes);
}

}  // namespace

void writeCapture(OutputFolder& folder, const Capture& capture)
{
    for (const Buffer& buffer : capture.buffers) folder.write(buffer.file, encodeNpy(buffer.dtype, buffer.shape, buffer.bytes));
    for (NamedTexture& texture : texturesOf(capture.buffers)) {
        fillTexture(texture, capture.buffers);
        folder.write(texture.file, encodeDds(texture.texture));
        texture.texture.texels = {};
    }
    folder.write(kManifestFile, jsonText(manifestJson(capture)));
}

std::size_t predictCaptureBytes(const std::vector<Buffer>& buffers)
{
    std::size_t bytes = 0;
    for (const Buffer& buffer : buffers) bytes += npyHeader(buffer.dtype, buffer.shape).size() + buffer.elements() * sizeOf(buffer.dtype);
    for (const NamedTexture& texture : texturesOf(buffers)) bytes += kDdsHeaderBytes + texture.texture.byteSize();
    return bytes;
}

Capture readManifest(const std::string& folder)
{
    const std::string path = pathIn(folder, kManifestFile);
    if (!std::filesystem::is_directory(folder)) throw InputError(folder, "is no capture: there is no such folder");
    if (!std::filesystem::exists(path)) throw InputError(folder, "is no capture: it has no " + std::string(kManifestFile));
    return captureFromManifest(parseJson(readFile(path), path), path);
}

std::vector<std::string> filesOfCapture(const std::string& folder)
{
    std::vector<std::string> files;
    try {
        // Of any version: names are all that counts.
        const Json manifest = parseJson(readFile(pathIn(folder, kManifestFile)), folder);
        const auto add = [&](const Json& owner) {
            if (owner.is_object() && owner.contains("file") && owner["file"].is_string()) files.push_back(owner["file"].get<std::string>());
        };
        if (!manifest.is_object() || !manifest.contains("buffers") || !manifest["buffers"].is_array()) return {};
        for (const Json& buffer : manifest["buffers"]) {
            add(buffer);
            if (buffer.is_object() && buffer.contains("dds")) add(buffer["dds"]);
        }
    } catch (const InputError&) {
        return {};
    }
    return files;
}

Capture readCapture(const std::string& folder)
{
    Capture capture = readManifest(folder);
    for (Buffer& buffer : capture.buffers) readBytes(folder, buffer);
    return capture;
}

}  // namespace lrsm
