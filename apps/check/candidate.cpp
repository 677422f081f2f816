#include "apps/check/candidate.h"

#include "apps/capture/capture_files.h"
#include "apps/capture/fill.h"
#include "apps/capture/npz.h"
#include "apps/capture/passes.h"
#include "apps/check/candidate_map.h"
#include "apps/check/given_arrays.h"
#include "apps/check/near_misses.h"
#include "core/base/errors.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/imageio/image_io.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

namespace lrsm {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 9> kPictureEndings = {".png", ".tif", ".tiff", ".jpg", ".jpeg", ".bmp", ".tga", ".hdr", ".pfm"};

class CandidateReader {
  public:
    CandidateReader(const std::string& folder, const Capture& golden, std::vector<MapEntry> map) : folder_(folder), golden_(golden), map_(std::move(map))
    {
        std::error_code error;
        if (!fs::is_directory(folder, error)) throw InputError(folder, "is no candidate: there is no such folder");
        for (const auto& entry : fs::directory_iterator(folder, fs::directory_options::skip_permission_denied, error))
            if (entry.is_regular_file(error)) files_.insert(entry.path().filename().string());
        if (error) throw InputError(folder, "cannot be listed");
        if (has(kManifestFile)) leaveOutStrangers();
    }

    std::optional<CandidateBuffer> read(const Buffer& golden)
    {
        if (const std::optional<MapEntry> entry = entryFor(map_, golden.name)) return mapped(golden, *entry);
        if (has(golden.name + ".npy")) return finish(golden, fromNpy(readNpy(path(golden.name + ".npy"))), {}, golden.name + ".npy");
        if (std::optional<CandidateBuffer> found = fromNpz(golden)) return found;
        for (const auto& [file, mip] : ddsPlaces(golden)) {
            if (!has(file)) continue;
            const DdsTexture& texture = dds(file);
            if (mip < texture.mips) return finish(golden, fromTexture(golden, texture, mip), {}, file + ", mip " + std::to_string(mip));
        }
        for (const char* ending : {".bin", ".raw"})
            if (has(golden.name + ending)) return raw(golden, golden.name + ending, golden.dtype, {});
        return fromPicture(golden);
    }

    /// Files that could hold buffers and are of none; a capture's DDS files repeat its .npy.
    std::vector<std::string> unused() const
    {
        std::vector<std::string> names;
        for (const std::string& file : files_) {
            const std::string extension = fs::path(file).extension().string();
            const bool repeats = std::any_of(golden_.buffers.begin(), golden_.buffers.end(), [&](const Buffer& b) { return b.dds && b.dds->file == file; });
            if (repeats) continue;
            if (isData(extension) && !used_.contains(file)) names.push_back(file);
        }
        return names;
    }

    /// Names that are in the folder beside those that were looked for: files of no use, arrays of .npz, layers of EXR.
    std::vector<NamedThing> namesHeld() const
    {
        std::vector<NamedThing> names;
        for (const std::string& file : unused()) names.push_back({fs::path(file).stem().string(), file});
        for (const auto& [file, arrays] : arrays_)
            for (const std::string& name : arrays) names.push_back({name, file + ", array " + name});
        for (const auto& [key, image] : pictures_)
            for (const ImageLayer& layer : image.layers)
                if (!layer.name.empty()) names.push_back({layer.name, key.first + ", layer " + layer.name});
        return names;
    }

    /// What was said of the pictures that were read.
    std::vector<std::string> pictureNotes() const
    {
        std::vector<std::string> notes;
        for (const auto& [key, image] : pictures_)
            for (const std::string& note : image.notes) notes.push_back(key.first + ": " + note);
        return notes;
    }

    /// Of a capture's folder: what is called as a buffer of the golden is, and is not in its manifest.
    std::string strangersNote() const
    {
        if (strangers_.empty()) return "";
        const bool one = strangers_.size() == 1;
        return std::to_string(strangers_.size()) + (one ? " buffer is" : " buffers are") +
               " not in the candidate's manifest, and left out as of another run: " + strangers_.front() + (one ? "" : " ...");
    }

  private:
    void leaveOutStrangers()
    {
        const std::vector<std::string> own = filesOfCapture(folder_);
        if (own.empty()) return;
        const auto leaveOut = [&](const std::string& file) {
            if (has(file) && std::find(own.begin(), own.end(), file) == own.end()) {
                files_.erase(file);
                strangers_.push_back(file);
            }
        };
        for (const Buffer& buffer : golden_.buffers) {
            leaveOut(buffer.file);
            if (buffer.dds) leaveOut(buffer.dds->file);
        }
    }

    bool has(const std::string& file) const { return files_.contains(file); }
    static bool isData(const std::string& extension) { return extension == ".npy" || extension == ".dds" || extension == ".bin" || extension == ".raw"; }
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
        found.note = array.note.empty() ? std::move(arranged.note) : array.note;
        return found;
    }

    CandidateBuffer mapped(const Buffer& golden, const MapEntry& entry)
    {
        const std::string extension = fs::path(entry.file).extension().string();
        if (extension == ".npy") return finish(golden, fromNpy(readNpy(path(entry.file))), entry.how, entry.file);
        if (extension == ".npz") return mappedNpz(golden, entry);
        if (extension == ".dds") {
            const DdsTexture& texture = dds(entry.file);
            const int own = golden.dds ? static_cast<int>(golden.dds->mip) : levelOf(golden.name);
            const int mip = entry.mip >= 0 ? entry.mip : own;
            if (mip >= static_cast<int>(texture.mips))
                throw InputError(path(entry.file), "has " + std::to_string(texture.mips) + " mips; " + golden.name + " is to be mip " + std::to_string(mip));
            return finish(golden, fromTexture(golden, texture, static_cast<std::uint32_t>(mip)), entry.how, entry.file + ", mip " + std::to_string(mip));
        }
        if (extension == ".bin" || extension == ".raw")
            return raw(golden, entry.file, entry.dtype.empty() ? golden.dtype : dtypeByName(entry.dtype, entry.file), entry.how);
        const LayeredImage& image = picture(entry.file, entry.transfer.value_or(transferFor(golden)));
        const ImageLayer* layer = image.find(entry.layer);
        if (!layer && entry.layer.empty() && image.layers.size() == 1) layer = &image.layers.front();
        if (!layer)
            throw InputError(path(entry.file), "has no layer \"" + entry.layer + "\"; it has " +
                                                   joined(image.layers, [](const ImageLayer& l) { return l.name.empty() ? "(unnamed)" : l.name; }));
        return finish(golden, fromLayer(image, *layer), entry.how, entry.file);
    }

    CandidateBuffer mappedNpz(const Buffer& golden, const MapEntry& entry)
    {
        const std::vector<std::string>& names = arrays(entry.file);
        std::string name = entry.layer.empty() && names.size() == 1 ? names.front() : entry.layer.empty() ? golden.name : entry.layer;
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw InputError(path(entry.file), "has no array \"" + name + "\"; it has " + joined(names));
        return finish(golden, fromNpy(readNpz(path(entry.file), name)), entry.how, entry.file + ", " + name);
    }

    /// An array of the buffer's name in any .npz, or the only one of NAME.npz.
    std::optional<CandidateBuffer> fromNpz(const Buffer& golden)
    {
        for (const std::string& file : files_) {
            if (fs::path(file).extension() != ".npz" || broken_.contains(file)) continue;
            const std::vector<std::string>& names = arrays(file);
            const bool own = file == golden.name + ".npz" && names.size() == 1;
            if (own || std::find(names.begin(), names.end(), golden.name) != names.end()) {
                const std::string& name = own ? names.front() : golden.name;
                return finish(golden, fromNpy(readNpz(path(file), name)), {}, file + ", " + name);
            }
        }
        return {};
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

    /// Pictures alone: a file of the buffer's name, or a layer or channel of that name in any EXR.
    std::optional<CandidateBuffer> fromPicture(const Buffer& golden)
    {
        if (golden.axes.size() < 2 || golden.axes[0] != "row" || isGiven(golden.pass)) return {};
        if (const std::string own = golden.name + ".exr"; has(own)) {
            const LayeredImage& image = picture(own, Transfer::srgb);
            const ImageLayer* layer = image.find(golden.name) ? image.find(golden.name) : image.find("");
            if (!layer && image.layers.size() == 1) layer = &image.layers.front();
            if (!layer) throw InputError(path(own), "has neither an unnamed layer nor one called " + golden.name);
            return finish(golden, fromLayer(image, *layer), {}, own);
        }
        for (const char* ending : kPictureEndings)
            if (const std::string own = golden.name + ending; has(own)) {
                const LayeredImage& image = picture(own, transferFor(golden));
                return finish(golden, fromLayer(image, image.layers.front()), {}, own);
            }
        for (const std::string& file : files_) {
            if (fs::path(file).extension() != ".exr" || broken_.contains(file)) continue;
            const LayeredImage& image = picture(file, Transfer::srgb);
            if (const ImageLayer* layer = image.find(golden.name)) return finish(golden, fromLayer(image, *layer), {}, file + ", layer " + golden.name);
            if (!golden.components.empty()) continue;
            for (const ImageLayer& layer : image.layers)
                for (std::size_t c = 0; c < layer.channelNames.size(); ++c)
                    if (layer.name + "." + layer.channelNames[c] == golden.name)
                        return finish(golden, fromLayer(image, channelOf(layer, c)), {}, file + ", channel " + golden.name);
        }
        return {};
    }

    /// Integer pictures hold sRGB codes where they are of colours, else numbers.
    static Transfer transferFor(const Buffer& golden) { return !golden.components.empty() && golden.components[0] == "r" ? Transfer::srgb : Transfer::linear; }

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
    const LayeredImage& picture(const std::string& file, Transfer transfer)
    {
        const std::pair key(file, transfer);
        const auto known = pictures_.find(key);
        if (known != pictures_.end()) return known->second;
        broken_.insert(file);
        LayeredImage image = readImage(path(file), transfer);
        broken_.erase(file);
        return pictures_.emplace(key, std::move(image)).first->second;
    }
    const std::vector<std::string>& arrays(const std::string& file)
    {
        const auto known = arrays_.find(file);
        if (known != arrays_.end()) return known->second;
        broken_.insert(file);
        std::vector<std::string> names = namesInNpz(path(file));
        broken_.erase(file);
        return arrays_.emplace(file, std::move(names)).first->second;
    }

    std::string folder_;
    const Capture& golden_;
    std::vector<MapEntry> map_;
    std::set<std::string> files_, used_;
    std::vector<std::string> strangers_;
    std::map<std::string, DdsTexture> textures_;
    std::map<std::pair<std::string, Transfer>, LayeredImage> pictures_;
    std::map<std::string, std::vector<std::string>> arrays_;
    std::set<std::string> broken_;  ///< said once: files that may hold any buffer, and cannot be read
};

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
    CandidateReader reader(folder, golden, map);
    Candidate candidate;
    candidate.folder = folder;
    compareManifests(folder, golden, candidate.notes);
    for (const Buffer& buffer : golden.buffers) {
        if (!isAskedFor(options.passes, buffer.pass)) continue;
        try {
            if (std::optional<CandidateBuffer> found = reader.read(buffer)) candidate.buffers.push_back(std::move(*found));
        } catch (const InputError& error) {
            candidate.unreadable.push_back({buffer.name, error.what()});
        }
    }
    if (const std::string note = reader.strangersNote(); !note.empty()) candidate.notes.push_back(note);
    candidate.nearMisses = nearMisses(golden, reader.namesHeld(), map);
    candidate.notes.insert(candidate.notes.end(), candidate.nearMisses.begin(), candidate.nearMisses.end());
    for (const std::string& note : reader.pictureNotes()) candidate.notes.push_back(note);
    if (options.passes.empty())
        for (const std::string& file : reader.unused())
            if (std::none_of(candidate.nearMisses.begin(), candidate.nearMisses.end(), [&](const std::string& miss) { return miss.starts_with(file + " "); }))
                candidate.notes.push_back(unusedNote(file, golden));
    return candidate;
}

const UnreadableBuffer* Candidate::findUnreadable(const std::string& name) const
{
    const auto found = std::find_if(unreadable.begin(), unreadable.end(), [&](const UnreadableBuffer& b) { return b.name == name; });
    return found == unreadable.end() ? nullptr : &*found;
}

}  // namespace lrsm
