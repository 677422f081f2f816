// The pass run anew, with another setting or with something about its inputs changed: what the candidate may be computing instead.
#include "apps/capture/fill.h"
#include "apps/capture/passes.h"
#include "apps/check/hint_trial.h"
#include "core/base/errors.h"
#include "core/base/text.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <set>

namespace lrsm {

namespace {

constexpr std::size_t kPixels = 4096;         ///< traced for each suspicion about the cones
constexpr std::size_t kMostTexels = 1 << 22;  ///< passes with larger outputs are not tried once a setting

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
        {"vct_facing", {"0", "0.1", "2"}},
        {"rc_radius", {"1", "2"}},
        {"rc_min_cosine", {"-1", "0", "0.5"}},
        {"pp_radius", {"1", "2"}},
        {"pp_range", {"2", "8"}},
        {"pp_filter_radius", {"0", "1", "3"}},
        {"ism_bias", {"0", "0.01", "0.02"}},
        {"depth_bias_texels", {"0", "0.5", "0.75", "1", "2"}},
        {"shadow_cone_aperture_degrees", {"1", "2", "4"}},
        {"specular_aperture_degrees", {"5", "10", "20"}},
    };
    return tries;
}

/// Every other choice for every setting of the pass, one at a time: "key=value" and the settings.
std::vector<std::pair<std::string, Settings>> otherSettings(const Settings& settings, const std::vector<std::string>& stages)
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
        if (std::find(stages.begin(), stages.end(), info.stage) == stages.end() || info.shorthand || info.key.find("storage") != std::string::npos) continue;
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
    PassSuspicions(HintTrial& trial, const std::vector<std::string>& stages)
        : trial_(trial), expected_(trial.expected()), stages_(stages), changed_(trial.inputs())
    {
        if (perPixel()) thinOut();
        for (std::size_t i = 0; i < trial.count(); ++i) before_ += chosen(i) && trial_.wrong(i) ? 1 : 0;
    }

    void run()
    {
        if (before_ == 0 || (!perPixel() && trial_.count() > kMostTexels)) return;
        const Settings own = changed_.settings;
        for (const auto& [text, settings] : otherSettings(own, stages_)) {
            changed_.settings = settings;
            tryPass("as with " + text + " (the golden has " + valueOf(own, text) + ")");
        }
        changed_.settings = own;
        if (expected_.pass == "cones") {
            tryLayers();
            tryWithoutLights();
        }
        if (perPixel() && expected_.pass != "vct cones") trySides();
        if (expected_.pass == "cones") tryVoxels();
        if (expected_.pass == "vct cones") tryVolumes();
        if (traces()) tryRotations();
    }

  private:
    bool traces() const { return expected_.pass == "cones" || expected_.pass == "vct cones"; }
    bool perPixel() const { return traces() || expected_.pass == "direct"; }
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

    /// Runs with these buffers changed, then puts them back.
    template <class Which, class Change>
    void tryChanged(const std::string& text, const Which& which, const Change& change)
    {
        const std::vector<Buffer> kept = changeSome(which, change);
        if (!kept.empty()) tryPass(text);
        restore(kept);
    }
    /// The buffers as they were.
    template <class Which, class Change>
    std::vector<Buffer> changeSome(const Which& which, const Change& change)
    {
        std::vector<Buffer> kept;
        for (Buffer& buffer : changed_.buffers)
            if (which(buffer)) {
                kept.push_back(buffer);
                change(buffer);
            }
        return kept;
    }
    void restore(const std::vector<Buffer>& kept)
    {
        for (const Buffer& original : kept) findBuffer(changed_.buffers, original.name)->bytes = original.bytes;
    }
    static auto startsWith(const std::string& prefix)
    {
        return [prefix](const Buffer& buffer) { return buffer.name.starts_with(prefix); };
    }
    static void clear(Buffer& buffer) { std::fill(buffer.bytes.begin(), buffer.bytes.end(), std::byte{0}); }

    /// Alpha as 1 wherever there is something: then nothing is divided by it.
    void tryLayers()
    {
        const auto alphaOne = [](Buffer& buffer) {
            const bool depth = buffer.name.find(".depth.") != std::string::npos;
            const std::size_t at = depth ? 2 : 3;
            auto* codes = reinterpret_cast<std::uint16_t*>(buffer.bytes.data());
            constexpr std::uint16_t kHalfOne = 0x3c00, kUnormOne = 0xffff;
            for (std::size_t texel = 0; texel < buffer.bytes.size() / 8; ++texel)
                if (codes[texel * 4 + at] != 0) codes[texel * 4 + at] = depth ? kUnormOne : kHalfOne;
        };
        const auto layers = [](bool normal, bool depth) {
            return [normal, depth](const Buffer& b) {
                const bool named = (normal && b.name.find(".normal.") != std::string::npos) || (depth && b.name.find(".depth.") != std::string::npos);
                return named && b.name.starts_with("lrsm") && b.dtype != Dtype::f4;
            };
        };
        tryChanged("the mean normal is not divided by alpha", layers(true, false), alphaOne);
        tryChanged("the mean depths are not divided by alpha", layers(false, true), alphaOne);
        tryChanged("what a layer holds is not divided by alpha", layers(true, true), alphaOne);
    }

    void tryWithoutLights()
    {
        for (std::size_t light = 0; light < changed_.lights.size(); ++light) {
            const std::string name = "light " + std::to_string(light);
            const auto own = startsWith("lrsm" + std::to_string(light) + ".");
            if (changed_.lights.size() > 1) tryChanged(name + " is left out", own, clear);
            const std::size_t layers = changed_.lights[light].storedRanges().size();
            for (std::size_t layer = 0; layer < layers && layers > 1; ++layer)
                tryChanged("layer " + std::to_string(layer) + " of " + name + " is left out", own, [&](Buffer& buffer) {
                    const std::size_t bytes = buffer.bytes.size() / buffer.shape[0];
                    std::fill_n(buffer.bytes.begin() + static_cast<std::ptrdiff_t>(layer * bytes), bytes, std::byte{0});
                });
        }
    }

    /// The light's map read the other way.
    void trySides()
    {
        const std::vector<CapturedLight> lights = changed_.lights;
        for (const auto& [name, axis] : {std::pair("v", &LightProjection::up), std::pair("u", &LightProjection::right)}) {
            for (CapturedLight& light : changed_.lights) light.projection.*axis = -(light.projection.*axis);
            tryPass(std::string("the light's map is looked up with ") + name + " flipped");
            changed_.lights = lights;
        }
    }

    void tryVoxels()
    {
        tryChanged("nothing is occluded: the voxels are read as empty", startsWith("voxel."), clear);
        tryChanged("the voxels' mips are read as empty", startsWith("voxel.mip"), clear);
    }

    void tryVolumes()
    {
        tryChanged("the base's normals are not read: what faces away is lit", startsWith("vct.normal"), clear);
        const auto exchanged = [this](Buffer& buffer) {
            std::string name = buffer.name;
            name[4] = name[4] == 'p' ? 'n' : 'p';  // "vct.px.mip1"
            buffer.bytes = trial_.inputs().at(name).bytes;
        };
        tryChanged(
            "the volumes of opposite directions are exchanged", [](const Buffer& b) { return b.pass == "vct mips"; }, exchanged);
    }

    /// The picture upside down or mirrored: the pass is the same but for the rotations, which go by row and column.
    void tryRotations()
    {
        tryMirrored("the rotation of a pixel's cones goes by rows counted from the bottom", true);
        tryMirrored("the rotation of a pixel's cones goes by columns counted from the right", false);
    }
    void tryMirrored(const std::string& text, bool rows)
    {
        const std::vector<Buffer> kept = changeSome([](const Buffer& b) { return b.pass == "gbuffer"; }, [&](Buffer& b) { mirror(b, rows); });
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

    HintTrial& trial_;
    const Buffer& expected_;
    const std::vector<std::string>& stages_;
    Capture changed_;  ///< what the pass is run on
    std::vector<bool> chosen_;
    std::size_t before_ = 0;
};

}  // namespace

void suspectPass(HintTrial& trial)
{
    const PassRow* row = findPassRow(trial.expected().pass);
    if (row && !row->stages.empty()) PassSuspicions(trial, row->stages).run();
}

}  // namespace lrsm
