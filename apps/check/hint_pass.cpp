// The pass run anew, with another setting or with something about its inputs changed: what the candidate may be computing instead.
#include "apps/capture/convert.h"
#include "apps/check/hint_trial.h"
#include "apps/check/rerun.h"
#include "core/base/errors.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <set>

namespace lrsm {

namespace {

constexpr std::size_t kPixels = 4096;         ///< traced for each suspicion about the cones
constexpr std::size_t kMostTexels = 1 << 22;  ///< passes with larger outputs are not tried once a setting

std::string stageOf(const std::string& pass)
{
    if (pass == "voxelize" || pass == "voxel mips") return "voxel";
    if (pass.starts_with("rsm")) return "rsm";
    if (pass.starts_with("lrsm")) return "layers";
    return pass;  // "direct", "cones"
}

std::vector<std::string> split(const std::string& text, const std::string& by)
{
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(by, at), text.size());
        parts.push_back(text.substr(at, end - at));
        at = end + by.size();
    }
    return parts;
}

/// Numbers that programs choose differently. Relative to what is set: "*2", "+1".
struct NumericTry {
    const char* key;
    std::vector<const char*> values;
};
const std::vector<NumericTry>& numericTries()
{
    static const std::vector<NumericTry> tries = {
        {"voxel_level_bias", {"-3", "-2", "-1", "0", "1"}},
        {"rsm_level_bias", {"-2", "-1", "0", "1", "2"}},
        {"aperture_scale", {"0.5", "1", "2"}},
        {"step", {"0.25", "0.5", "1"}},
        {"start_voxels", {"0", "1", "2", "3"}},
        {"normal_offset_voxels", {"0", "0.5", "1", "2"}},
        {"min_diameter_voxels", {"0.5", "1", "2"}},
        {"emitter_delay_taps", {"0", "1", "2"}},
        {"emitter_delay_voxels", {"0", "0.75"}},
        {"emitter_slant_cap", {"0", "0.5", "1"}},
        {"transmittance_cutoff", {"0", "0.01", "0.05"}},
        {"density_k", {"1", "2"}},
        {"push", {"0", "1"}},
        {"depth_bias_texels", {"0", "0.5", "0.75", "1", "2"}},
        {"shadow_cone_aperture_degrees", {"1", "2", "4"}},
        {"specular_aperture_degrees", {"5", "10", "20"}},
    };
    return tries;
}

/// Every other choice for every setting of the pass, one at a time: "key=value" and the settings.
std::vector<std::pair<std::string, Settings>> otherSettings(const Settings& settings, const std::string& stage)
{
    std::vector<std::pair<std::string, Settings>> others;
    std::set<std::string> tried;
    const auto add = [&](const std::string& key, const std::string& value) {
        Settings other = settings;
        try {
            applySetting(other, key + "=" + value);
            validate(other);
        } catch (const InputError&) {
            return;
        }
        if (!(other == settings) && tried.insert(key + "=" + value).second) others.emplace_back(key + "=" + value, other);
    };
    for (const SettingInfo& info : describeSettings()) {
        if (info.stage != stage || info.shorthand || info.key.find("storage") != std::string::npos) continue;
        if (info.allowed.find(" | ") != std::string::npos)
            for (const std::string& value : split(info.allowed, " | ")) add(info.key, value);
        for (const NumericTry& numeric : numericTries())
            if (info.key == numeric.key)
                for (const char* value : numeric.values) add(info.key, value);
    }
    return others;
}

/// Covered pixels that are traced; the others are taken out of the G-buffer.
std::vector<bool> choosePixels(const HintTrial& trial, std::size_t pixels)
{
    std::vector<bool> chosen(pixels, false);
    const Buffer* ids = trial.inputs().find("gbuffer.object_id");
    std::vector<std::size_t> covered;
    for (std::size_t i = 0; i < pixels; ++i)
        if (ids && decodedValue(*ids, i) != 0.0) covered.push_back(i);
    const std::size_t stride = covered.size() / kPixels + 1;
    for (std::size_t i = stride / 2; i < covered.size(); i += stride) chosen[covered[i]] = true;
    return chosen;
}

class PassSuspicions {
  public:
    explicit PassSuspicions(HintTrial& trial) : trial_(trial), expected_(trial.expected()), changed_(trial.inputs())
    {
        if (perPixel()) thinOut();
        for (std::size_t i = 0; i < trial.count(); ++i) before_ += chosen(i) && trial_.wrong(i) ? 1 : 0;
    }

    void run()
    {
        if (before_ == 0 || (!perPixel() && trial_.count() > kMostTexels)) return;
        const Settings own = changed_.settings;
        for (const auto& [text, settings] : otherSettings(own, stageOf(expected_.pass))) {
            changed_.settings = settings;
            tryPass("as with " + text + " (the golden has " + valueOf(own, text) + ")");
        }
        changed_.settings = own;
        if (expected_.pass == "cones") tryLayers();
        if (expected_.pass == "cones") tryVoxels();
        if (expected_.pass == "cones") tryRotations();
        if (expected_.pass == "direct") trySides();
    }

  private:
    bool perPixel() const { return expected_.pass == "cones" || expected_.pass == "direct"; }
    std::size_t pixelOf(std::size_t i) const
    {
        const std::size_t pixels = static_cast<std::size_t>(changed_.width) * static_cast<std::size_t>(changed_.height);
        return i / trial_.components() % pixels;
    }
    bool chosen(std::size_t i) const { return chosen_.empty() || chosen_[pixelOf(i)]; }

    void thinOut()
    {
        chosen_ = choosePixels(trial_, static_cast<std::size_t>(changed_.width) * static_cast<std::size_t>(changed_.height));
        for (Buffer& buffer : changed_.buffers) {
            if (buffer.name != "gbuffer.object_id") continue;
            auto* ids = reinterpret_cast<std::uint32_t*>(buffer.bytes.data());
            for (std::size_t i = 0; i < chosen_.size(); ++i)
                if (!chosen_[i]) ids[i] = 0;
        }
    }

    static std::string valueOf(const Settings& settings, const std::string& assignment)
    {
        Settings other = settings;
        applySetting(other, assignment);
        const std::vector<SettingDifference> d = differences(settings, other);
        return d.empty() ? "the same" : d.front().a;
    }

    void tryPass(const std::string& text)
    {
        const Rerun rerun = rerunPass(changed_, expected_.pass);
        for (const Buffer& made : rerun.outputs)
            if (made.name == expected_.name && made.bytes.size() == expected_.bytes.size()) judge(text, made);
    }
    void judge(const std::string& text, const Buffer& made)
    {
        std::size_t left = 0;
        for (std::size_t i = 0; i < trial_.count(); ++i) left += chosen(i) && compared(expected_, i) && !trial_.fits(decodedValue(made, i), i) ? 1 : 0;
        trial_.note(text, left, before_);
    }

    /// Runs with every texel of these buffers changed, then puts them back.
    template <class Change>
    void tryChanged(const std::string& text, const std::string& part, const Change& change)
    {
        std::vector<Buffer> kept;
        bool any = false;
        for (Buffer& buffer : changed_.buffers)
            if (buffer.name.starts_with("lrsm") && buffer.name.find(part) != std::string::npos && buffer.dtype != Dtype::f4) {
                kept.push_back(buffer);
                change(buffer);
                any = true;
            }
        if (any) tryPass(text);
        for (const Buffer& original : kept)
            for (Buffer& buffer : changed_.buffers)
                if (buffer.name == original.name) buffer.bytes = original.bytes;
    }

    void tryLayers()
    {
        // Alpha as 1 wherever there is something: then nothing is divided by it.
        const auto alphaOne = [](Buffer& buffer) {
            const bool depth = buffer.name.find(".depth.") != std::string::npos;
            const std::size_t at = depth ? 2 : 3;
            auto* codes = reinterpret_cast<std::uint16_t*>(buffer.bytes.data());
            constexpr std::uint16_t kHalfOne = 0x3c00, kUnormOne = 0xffff;
            for (std::size_t texel = 0; texel < buffer.bytes.size() / 8; ++texel)
                if (codes[texel * 4 + at] != 0) codes[texel * 4 + at] = depth ? kUnormOne : kHalfOne;
        };
        tryChanged("the mean normal is not divided by alpha", ".normal.", alphaOne);
        tryChanged("the mean depths are not divided by alpha", ".depth.", alphaOne);
        {
            std::vector<Buffer> kept;
            for (Buffer& buffer : changed_.buffers)
                if (buffer.name.starts_with("lrsm") && buffer.name.find(".radiance.") == std::string::npos && buffer.dtype != Dtype::f4) {
                    kept.push_back(buffer);
                    alphaOne(buffer);
                }
            if (!kept.empty()) tryPass("what a layer holds is not divided by alpha");
            restore(kept);
        }
        const std::vector<CapturedLight> lights = changed_.lights;
        for (std::size_t light = 0; light < lights.size(); ++light) {
            tryWithoutLight(light);
            for (std::size_t layer = 0; layer < lights[light].storedRanges().size() && lights[light].storedRanges().size() > 1; ++layer)
                tryWithoutLayer(light, layer);
        }
        trySides();
    }

    /// v runs the other way when the LRSM is looked up.
    void trySides()
    {
        const std::vector<CapturedLight> lights = changed_.lights;
        for (CapturedLight& light : changed_.lights) light.projection.up = -light.projection.up;
        tryPass("the light's map is looked up with v flipped");
        changed_.lights = lights;
        for (CapturedLight& light : changed_.lights) light.projection.right = -light.projection.right;
        tryPass("the light's map is looked up with u flipped");
        changed_.lights = lights;
    }

    void restore(const std::vector<Buffer>& kept)
    {
        for (const Buffer& original : kept)
            for (Buffer& buffer : changed_.buffers)
                if (buffer.name == original.name) buffer.bytes = original.bytes;
    }

    void tryWithoutLayer(std::size_t light, std::size_t layer)
    {
        std::vector<Buffer> kept;
        const std::string prefix = "lrsm" + std::to_string(light) + ".";
        for (Buffer& buffer : changed_.buffers)
            if (buffer.name.starts_with(prefix)) {
                kept.push_back(buffer);
                const std::size_t bytes = buffer.bytes.size() / buffer.shape[0];
                std::fill_n(buffer.bytes.begin() + static_cast<std::ptrdiff_t>(layer * bytes), bytes, std::byte{0});
            }
        tryPass("layer " + std::to_string(layer) + " of light " + std::to_string(light) + " is left out");
        restore(kept);
    }

    void tryWithoutLight(std::size_t light)
    {
        if (changed_.lights.size() < 2) return;
        std::vector<Buffer> kept;
        for (Buffer& buffer : changed_.buffers)
            if (buffer.name.starts_with("lrsm" + std::to_string(light) + ".")) {
                kept.push_back(buffer);
                std::fill(buffer.bytes.begin(), buffer.bytes.end(), std::byte{0});
            }
        tryPass("light " + std::to_string(light) + " is left out");
        restore(kept);
    }

    /// The picture upside down or mirrored: the pass is the same but for the rotations, which go by row and column.
    void tryRotations()
    {
        tryMirrored("the rotation of a pixel's cones goes by rows counted from the bottom", true);
        tryMirrored("the rotation of a pixel's cones goes by columns counted from the right", false);
    }
    void tryMirrored(const std::string& text, bool rows)
    {
        std::vector<Buffer> kept;
        for (Buffer& buffer : changed_.buffers)
            if (buffer.pass == "gbuffer") {
                kept.push_back(buffer);
                mirror(buffer, rows);
            }
        Rerun rerun = rerunPass(changed_, expected_.pass);
        restore(kept);
        for (Buffer& made : rerun.outputs) {
            if (made.name != expected_.name) continue;
            mirror(made, rows);
            judge(text, made);
        }
    }
    void mirror(Buffer& buffer, bool rows) const
    {
        const auto width = static_cast<std::size_t>(changed_.width), height = static_cast<std::size_t>(changed_.height);
        const std::size_t pixel = sizeOf(buffer.dtype) * std::max<std::size_t>(buffer.components.size(), 1), slice = width * height * pixel;
        const std::vector<std::byte> before = buffer.bytes;
        for (std::size_t at = 0; at < before.size(); at += pixel) {
            const std::size_t in = at % slice / pixel, x = in % width, y = in / width;
            const std::size_t from = rows ? (height - 1 - y) * width + x : y * width + width - 1 - x;
            std::copy_n(before.begin() + static_cast<std::ptrdiff_t>(at / slice * slice + from * pixel), pixel,
                        buffer.bytes.begin() + static_cast<std::ptrdiff_t>(at));
        }
    }

    void tryVoxels()
    {
        std::vector<Buffer> kept;
        for (Buffer& buffer : changed_.buffers)
            if (buffer.name.starts_with("voxel.")) {
                kept.push_back(buffer);
                std::fill(buffer.bytes.begin(), buffer.bytes.end(), std::byte{0});
            }
        tryPass("nothing is occluded: the voxels are read as empty");
        restore(kept);
        if (const std::vector<Buffer> mips = clearVoxelMips(); !mips.empty()) {
            tryPass("the voxels' mips are read as empty");
            restore(mips);
        }
    }
    std::vector<Buffer> clearVoxelMips()
    {
        std::vector<Buffer> kept;
        for (Buffer& buffer : changed_.buffers)
            if (buffer.name.starts_with("voxel.mip")) {
                kept.push_back(buffer);
                std::fill(buffer.bytes.begin(), buffer.bytes.end(), std::byte{0});
            }
        return kept;
    }

    HintTrial& trial_;
    const Buffer& expected_;
    Capture changed_;  ///< what the pass is run on
    std::vector<bool> chosen_;
    std::size_t before_ = 0;
};

}  // namespace

void suspectPass(HintTrial& trial)
{
    const std::string& pass = trial.expected().pass;
    if (pass == "scene" || pass == "tables" || pass == "composite" || pass == "filter" || pass == "gbuffer") return;
    PassSuspicions(trial).run();
}

}  // namespace lrsm
