#include "apps/check/candidate.h"

#include "apps/capture/capture_files.h"
#include "apps/capture/fill.h"
#include "apps/capture/passes.h"
#include "apps/check/candidate_map.h"
#include "apps/check/compare.h"
#include "core/base/errors.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/imageio/image_io.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

namespace lrsm {

namespace {

namespace fs = std::filesystem;

GivenArray fromNpy(NpyArray array)
{
    return {.dtype = array.dtype, .encoding = Encoding::number, .encodingKnown = false, .shape = std::move(array.shape), .bytes = std::move(array.bytes)};
}

struct ChannelType {
    Dtype dtype;
    Encoding encoding;
};
ChannelType channelTypeOf(DxgiFormat format)
{
    switch (format) {
    case DxgiFormat::R32G32B32A32_FLOAT:
    case DxgiFormat::R32_FLOAT: return {Dtype::f4, Encoding::number};
    case DxgiFormat::R16G16B16A16_FLOAT:
    case DxgiFormat::R16_FLOAT: return {Dtype::f2, Encoding::number};
    case DxgiFormat::R16G16B16A16_UNORM:
    case DxgiFormat::R16_UNORM: return {Dtype::u2, Encoding::unorm};
    case DxgiFormat::R32_UINT: return {Dtype::u4, Encoding::number};
    default: return {Dtype::u1, Encoding::unorm};
    }
}

/// One mip of all layers.
GivenArray fromTexture(const DdsTexture& texture, std::uint32_t mip)
{
    const auto extent = [&](std::uint32_t n) { return std::size_t(std::max(1u, n >> mip)); };
    const ChannelType type = channelTypeOf(texture.format);
    GivenArray given;
    given.dtype = type.dtype;
    given.encoding = type.encoding;
    given.encodingKnown = true;
    given.shape = {texture.layers, extent(texture.depth), extent(texture.height), extent(texture.width), std::size_t(channelsOf(texture.format))};
    for (std::uint32_t layer = 0; layer < texture.layers; ++layer) {
        const auto level = texture.level(layer, mip);
        given.bytes.insert(given.bytes.end(), level.begin(), level.end());
    }
    return given;
}

GivenArray fromLayer(const LayeredImage& image, const ImageLayer& layer)
{
    GivenArray given;
    given.shape = {std::size_t(image.height), std::size_t(image.width), layer.channelNames.size()};
    given.bytes.resize(layer.values.size() * sizeof(float));
    if (!layer.values.empty()) std::memcpy(given.bytes.data(), layer.values.data(), given.bytes.size());
    return given;
}

class CandidateReader {
  public:
    CandidateReader(const std::string& folder, const Capture& golden, std::vector<MapEntry> map) : folder_(folder), golden_(golden), map_(std::move(map))
    {
        std::error_code error;
        if (!fs::is_directory(folder, error)) throw InputError(folder, "is no candidate: there is no such folder");
        for (const auto& entry : fs::directory_iterator(folder, fs::directory_options::skip_permission_denied, error))
            if (entry.is_regular_file(error)) files_.insert(entry.path().filename().string());
        if (error) throw InputError(folder, "cannot be listed");
    }

    std::optional<CandidateBuffer> read(const Buffer& golden)
    {
        if (const std::optional<MapEntry> entry = entryFor(map_, golden.name)) return mapped(golden, *entry);
        if (has(golden.name + ".npy")) return finish(golden, fromNpy(readNpy(path(golden.name + ".npy"))), {}, golden.name + ".npy");
        for (const auto& [file, mip] : ddsPlaces(golden)) {
            if (!has(file)) continue;
            const DdsTexture& texture = dds(file);
            if (mip < texture.mips) return finish(golden, fromTexture(texture, mip), {}, file + ", mip " + std::to_string(mip));
        }
        for (const char* ending : {".bin", ".raw"})
            if (has(golden.name + ending)) return raw(golden, golden.name + ending, golden.dtype, {});
        return fromExr(golden);
    }

    /// Files that could hold buffers and are of none; a capture's DDS files repeat its .npy.
    std::vector<std::string> unused() const
    {
        std::vector<std::string> names;
        for (const std::string& file : files_) {
            const std::string extension = fs::path(file).extension().string();
            const bool repeats = std::any_of(golden_.buffers.begin(), golden_.buffers.end(), [&](const Buffer& b) { return b.dds && b.dds->file == file; });
            if (repeats) continue;
            if ((extension == ".npy" || extension == ".dds" || extension == ".bin" || extension == ".raw") && !used_.contains(file)) names.push_back(file);
        }
        return names;
    }

  private:
    bool has(const std::string& file) const { return files_.contains(file); }
    std::string path(const std::string& file)
    {
        used_.insert(file);
        return (fs::path(folder_) / file).string();
    }

    CandidateBuffer finish(const Buffer& golden, const GivenArray& array, const Arrangement& how, const std::string& file) const
    {
        Arranged arranged = arrange(golden, array, how, halfRoundingOf(golden_.settings, golden.pass), (fs::path(folder_) / file).string());
        CandidateBuffer found;
        found.buffer = golden;
        found.buffer.bytes = std::move(arranged.bytes);
        found.given = std::move(arranged.given);
        found.file = file;
        found.note = std::move(arranged.note);
        return found;
    }

    CandidateBuffer mapped(const Buffer& golden, const MapEntry& entry)
    {
        const std::string extension = fs::path(entry.file).extension().string();
        if (extension == ".npy") return finish(golden, fromNpy(readNpy(path(entry.file))), entry.how, entry.file);
        if (extension == ".dds") {
            const DdsTexture& texture = dds(entry.file);
            const int own = golden.dds ? static_cast<int>(golden.dds->mip) : levelOf(golden.name);
            const int mip = entry.mip >= 0 ? entry.mip : own;
            if (mip >= static_cast<int>(texture.mips))
                throw InputError(path(entry.file), "has " + std::to_string(texture.mips) + " mips; " + golden.name + " is to be mip " + std::to_string(mip));
            return finish(golden, fromTexture(texture, static_cast<std::uint32_t>(mip)), entry.how, entry.file + ", mip " + std::to_string(mip));
        }
        if (extension == ".bin" || extension == ".raw")
            return raw(golden, entry.file, entry.dtype.empty() ? golden.dtype : dtypeByName(entry.dtype, entry.file), entry.how);
        const LayeredImage& image = picture(entry.file);
        const ImageLayer* layer = image.find(entry.layer);
        if (!layer && entry.layer.empty() && image.layers.size() == 1) layer = &image.layers.front();
        if (!layer) throw InputError(path(entry.file), "has no layer \"" + entry.layer + "\"");
        return finish(golden, fromLayer(image, *layer), entry.how, entry.file);
    }

    /// Nothing but the bytes, in the golden's shape.
    CandidateBuffer raw(const Buffer& golden, const std::string& file, Dtype dtype, const Arrangement& how)
    {
        const std::string place = path(file);
        const std::vector<unsigned char> bytes = readFile(place);
        GivenArray array;
        array.dtype = dtype;
        array.shape = golden.shape;
        if (bytes.size() != golden.elements() * sizeOf(dtype))
            throw InputError(place, "holds " + std::to_string(bytes.size()) + " bytes where " + golden.name + " has " +
                                        std::to_string(golden.elements() * sizeOf(dtype)) + " as " + std::string(nameOf(dtype)));
        const auto data = std::as_bytes(std::span(bytes));
        array.bytes.assign(data.begin(), data.end());
        return finish(golden, array, how, file);
    }

    /// Pictures alone: a file of the buffer's name, or a layer of that name in any file.
    std::optional<CandidateBuffer> fromExr(const Buffer& golden)
    {
        if (golden.axes.size() < 2 || golden.axes[0] != "row") return {};
        if (const std::string own = golden.name + ".exr"; has(own)) {
            const LayeredImage& image = picture(own);
            const ImageLayer* layer = image.find(golden.name) ? image.find(golden.name) : image.find("");
            if (!layer && image.layers.size() == 1) layer = &image.layers.front();
            if (!layer) throw InputError(path(own), "has neither an unnamed layer nor one called " + golden.name);
            return finish(golden, fromLayer(image, *layer), {}, own);
        }
        for (const std::string& file : files_)
            if (fs::path(file).extension() == ".exr")
                if (const ImageLayer* layer = picture(file).find(golden.name))
                    return finish(golden, fromLayer(picture(file), *layer), {}, file + ", layer " + golden.name);
        return {};
    }

    std::vector<std::pair<std::string, std::uint32_t>> ddsPlaces(const Buffer& golden) const
    {
        std::vector<std::pair<std::string, std::uint32_t>> places;
        if (golden.dds) places.emplace_back(golden.dds->file, golden.dds->mip);
        if (!golden.dds) places.emplace_back(stemOf(golden.name) + ".dds", static_cast<std::uint32_t>(levelOf(golden.name)));
        if (isMip(golden.name)) places.emplace_back(golden.name + ".dds", 0u);
        return places;
    }

    const DdsTexture& dds(const std::string& file)
    {
        const auto known = textures_.find(file);
        return known != textures_.end() ? known->second : textures_.emplace(file, readDds(path(file))).first->second;
    }
    const LayeredImage& picture(const std::string& file)
    {
        const auto known = pictures_.find(file);
        return known != pictures_.end() ? known->second : pictures_.emplace(file, readImage(path(file))).first->second;
    }

    std::string folder_;
    const Capture& golden_;
    std::vector<MapEntry> map_;
    std::set<std::string> files_, used_;
    std::map<std::string, DdsTexture> textures_;
    std::map<std::string, LayeredImage> pictures_;
};

std::string unusedNote(const std::string& file, const Capture& golden)
{
    const std::string stem = fs::path(file).stem().string();
    std::string nearest;
    std::size_t least = std::max<std::size_t>(stem.size() / 3, 2);
    for (const Buffer& buffer : golden.buffers)
        if (const std::size_t distance = editDistance(stem, buffer.name); distance <= least && distance > 0) {
            least = distance - 1;
            nearest = buffer.name;
        }
    return file + " is of no buffer of the golden" + (nearest.empty() ? "" : "; did you mean " + nearest + "?");
}

/// What the candidate's own manifest, when it has one, says otherwise.
void compareManifests(const std::string& folder, const Capture& golden, std::vector<std::string>& notes)
{
    std::error_code ignored;
    if (!fs::is_regular_file(fs::path(folder) / kManifestFile, ignored)) return;
    const Capture own = readManifest(folder);
    if (own.sceneHash != golden.sceneHash) notes.push_back("its manifest is of another scene: " + own.sceneName + ", golden " + golden.sceneName);
    if (own.width != golden.width || own.height != golden.height)
        notes.push_back("its manifest is of another size: " + std::to_string(own.width) + "x" + std::to_string(own.height) + ", golden " +
                        std::to_string(golden.width) + "x" + std::to_string(golden.height));
    for (const SettingDifference& d : differences(golden.settings, own.settings))
        notes.push_back("its manifest has another setting: " + d.key + "=" + d.b + ", golden " + d.a);
}

/// Bits of one packing into the other.
void repack(const Buffer& from, Buffer& to)
{
    to.bytes.assign(to.elements() * sizeOf(to.dtype), std::byte{0});
    const std::vector<std::size_t> extents = extentsOf(to);
    for (std::size_t bit = 0; bit < valueCount(from); ++bit) {
        if (decodedValue(from, bit) == 0.0) continue;
        const std::vector<std::size_t> at = indicesOf(from, bit);
        if (at[0] >= extents[0] || at[1] >= extents[1] || at[2] >= extents[2]) continue;
        const std::size_t target = elementAt(to, at);
        to.bytes[target / 8] |= std::byte(1u << (target & 7));
    }
}

}  // namespace

const CandidateBuffer* Candidate::find(const std::string& name) const
{
    const auto found = std::find_if(buffers.begin(), buffers.end(), [&](const CandidateBuffer& b) { return b.buffer.name == name; });
    return found == buffers.end() ? nullptr : &*found;
}

Candidate readCandidate(const std::string& folder, const Capture& golden, const CandidateOptions& options)
{
    std::vector<MapEntry> map;
    if (!options.map.empty()) map = readCandidateMap(options.map);
    CandidateReader reader(folder, golden, std::move(map));
    Candidate candidate;
    candidate.folder = folder;
    compareManifests(folder, golden, candidate.notes);
    for (const Buffer& buffer : golden.buffers) {
        if (!isAskedFor(options.passes, buffer.pass)) continue;
        if (std::optional<CandidateBuffer> found = reader.read(buffer)) candidate.buffers.push_back(std::move(*found));
    }
    if (options.passes.empty())
        for (const std::string& file : reader.unused()) candidate.notes.push_back(unusedNote(file, golden));
    return candidate;
}

Capture layOver(const Capture& golden, const Candidate& candidate)
{
    Capture mixed = golden;
    for (const CandidateBuffer& from : candidate.buffers) findBuffer(mixed.buffers, from.buffer.name)->bytes = from.buffer.bytes;
    Buffer* rows = findBuffer(mixed.buffers, "voxel.bits");
    Buffer* bricks = findBuffer(mixed.buffers, "voxel.bricks");
    if (rows && bricks) {
        if (candidate.find("voxel.bits"))
            repack(*rows, *bricks);
        else if (candidate.find("voxel.bricks"))
            repack(*bricks, *rows);
    }
    return mixed;
}

}  // namespace lrsm
