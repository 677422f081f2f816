#include "apps/compare/sequence_files.h"

#include "apps/common/sequence.h"
#include "core/base/file.h"
#include "core/base/json_reader.h"

#include <charconv>
#include <filesystem>

namespace lrsm {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::optional<int> frameNumber(const std::string& name)
{
    int number = 0;
    const auto parsed = std::from_chars(name.data(), name.data() + name.size(), number);
    if (name.empty() || name[0] == '-' || parsed.ec != std::errc() || parsed.ptr != name.data() + name.size()) return {};
    return number;
}

std::optional<double> timeOf(const fs::path& folder)
{
    std::error_code ignored;
    const std::string file = (folder / kFrameFile).string();
    if (!fs::exists(file, ignored)) return {};
    const Json json = parseJson(readFile(file), file);
    return JsonReader(json, file)["time"].number();
}

Image<float> scalarOrEmpty(const LayeredImage& image, const std::string& name, const std::string& path)
{
    return image.find(name) ? scalarLayer(image, name, path) : Image<float>();
}

PixelMask countedPixels(const FramePair& pair, const Image<Vec3>& test, const Image<Vec3>& reference, bool allPixels)
{
    PixelMask counted(test.width, test.height, 1);
    if (!allPixels && pair.test.find("depth") && pair.reference.find("depth")) {
        const Image<float> a = scalarLayer(pair.test, "depth", pair.testPath), b = scalarLayer(pair.reference, "depth", pair.referencePath);
        for (std::size_t i = 0; i < counted.texels.size(); ++i) counted.texels[i] = a.texels[i] != 0.0f || b.texels[i] != 0.0f;
    }
    for (std::size_t i = 0; i < counted.texels.size(); ++i)
        if (!isFinite(test.texels[i]) || !isFinite(reference.texels[i])) counted.texels[i] = 0;
    return counted;
}

}  // namespace

SequenceFiles readSequence(const std::string& folder)
{
    std::error_code error;
    if (!fs::is_directory(folder, error)) throw InputError(folder, "is no folder of frames");
    SequenceFiles files{folder, {}, {}};
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::optional<int> number = frameNumber(entry.path().filename().string());
        if (!number || !fs::exists(entry.path() / "image.exr", error)) continue;
        files.pictures[*number] = (entry.path() / "image.exr").string();
        if (const std::optional<double> time = timeOf(entry.path())) files.times[*number] = *time;
    }
    if (files.pictures.empty()) throw InputError(folder, "has no frame, as 0000/image.exr; lrsm render --frames writes them");
    return files;
}

std::vector<int> commonFrames(const SequenceFiles& test, const SequenceFiles& reference)
{
    std::vector<int> frames;
    for (const auto& [frame, path] : test.pictures)
        if (reference.pictures.contains(frame)) frames.push_back(frame);
    if (frames.size() < 3)
        throw InputError(test.folder, "has " + std::to_string(frames.size()) + " frames in common with " + reference.folder + "; three are needed");
    for (std::size_t i = 1; i < frames.size(); ++i)
        if (frames[i] != frames[i - 1] + 1) {
            const bool here = test.pictures.contains(frames[i - 1] + 1);
            throw InputError(here ? reference.folder : test.folder,
                             "has no frame " + std::to_string(frames[i - 1] + 1) + "; the frames of both must be consecutive");
        }
    for (const int frame : frames) {
        const auto a = test.times.find(frame), b = reference.times.find(frame);
        if (a != test.times.end() && b != reference.times.end() && a->second != b->second)
            throw InputError(test.folder, "has frame " + std::to_string(frame) + " at " + Json(a->second).dump() + " s, " + reference.folder + " at " +
                                              Json(b->second).dump() + " s; make both with one --fps");
    }
    return frames;
}

FramePair readFrame(const SequenceFiles& test, const SequenceFiles& reference, int frame)
{
    FramePair pair{test.pictures.at(frame), reference.pictures.at(frame), {}, {}};
    pair.test = readImage(pair.testPath);
    pair.reference = readImage(pair.referencePath);
    if (pair.test.width != pair.reference.width || pair.test.height != pair.reference.height)
        throw InputError(pair.testPath, "has another size than " + pair.referencePath);
    return pair;
}

std::optional<Camera> cameraOf(const LayeredImage& image)
{
    for (const auto& [key, value] : image.metadata) {
        if (key != "lrsm:camera") continue;
        const Json json = parseJson(value, "lrsm:camera");
        const JsonReader in(json, "lrsm:camera");
        Camera camera;
        camera.position = in["position"].vector();
        camera.forward = in["forward"].vector();
        camera.up = in["up"].vector();
        camera.perspective = in["perspective"].flag();
        if (!camera.perspective)
            camera.verticalExtent = in["vertical_extent"].real();
        else if (in.has("vertical_fov"))
            camera.verticalFov = in["vertical_fov"].real();
        else
            camera.verticalFov = float(in["vertical_fov_degrees"].number() * 0.017453292519943295);
        return camera;
    }
    return {};
}

std::uint64_t notFinite(const FramePair& pair, const std::string& layer)
{
    const Image<Vec3> test = rgbLayer(pair.test, layer, pair.testPath), reference = rgbLayer(pair.reference, layer, pair.referencePath);
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < test.texels.size(); ++i) count += !isFinite(test.texels[i]) || !isFinite(reference.texels[i]);
    return count;
}

MomentPair momentOf(const FramePair& pair, const std::string& layer, bool allPixels)
{
    const Image<Vec3> test = rgbLayer(pair.test, layer, pair.testPath), reference = rgbLayer(pair.reference, layer, pair.referencePath);
    MomentPair moment{luminances(test), luminances(reference), countedPixels(pair, test, reference, allPixels)};
    for (const bool ofTest : {true, false}) {
        const LayeredImage& image = ofTest ? pair.test : pair.reference;
        const std::string& path = ofTest ? pair.testPath : pair.referencePath;
        if (!image.find("position") || !image.find("depth")) continue;
        moment.camera = cameraOf(image);
        if (!moment.camera) continue;
        moment.position = rgbLayer(image, "position", path);
        moment.depth = scalarLayer(image, "depth", path);
        moment.object = scalarOrEmpty(image, "object", path);
        break;
    }
    return moment;
}

}  // namespace lrsm
