#include "apps/check/texel_inputs.h"

#include "apps/capture/passes.h"
#include "apps/check/compare.h"

#include <algorithm>

namespace lrsm {

namespace {

/// Indices of the texel's first component, without the component axis: "row 3, column 7".
std::string texelPlace(const Buffer& buffer, std::size_t element)
{
    std::string text = placeText(buffer, element);
    const std::size_t at = text.find(", component");
    return at == std::string::npos ? text : text.substr(0, at);
}

class Inputs {
  public:
    Inputs(const Capture& capture, const Buffer& buffer, std::size_t element) : capture_(capture), buffer_(buffer), at_(indicesOf(buffer, element)) {}

    std::vector<TexelInput> list;

    void collect()
    {
        const int level = levelOf(buffer_.name);
        const PassRow* row = findPassRow(buffer_.pass);
        if (row && !row->sameTexel.empty()) texelOf(row->sameTexel);
        if (buffer_.pass == "voxel mips")
            voxelChildren(level);
        else if (buffer_.pass == "vct mips")
            volumeChildren(level);
        else if (buffer_.pass == "cones" || buffer_.pass == "vct cones")
            cones();
        else if (isMip(buffer_.name) && buffer_.pass != "rc fill")
            level > 0 ? layerChildren(level) : rsmBlock();
    }

  private:
    /// The texel of `name` at these indices (without the component).
    void add(const std::string& name, std::vector<std::size_t> indices)
    {
        const Buffer* from = capture_.find(name);
        if (!from || from->bytes.empty() || from == &buffer_ || name == buffer_.name) return;
        const std::vector<std::size_t> extents = extentsOf(*from);
        if (!from->components.empty()) indices.push_back(0);
        if (indices.size() != extents.size()) return;
        for (std::size_t axis = 0; axis < indices.size(); ++axis)
            if (indices[axis] >= extents[axis]) return;
        const std::size_t element = elementAt(*from, indices);
        list.push_back({name + ", " + texelPlace(*from, element), texelText(*from, element)});
    }

    /// Buffers with the same rows and columns; '#' is the light.
    void texelOf(const std::vector<std::string>& names)
    {
        const std::size_t first = buffer_.axes[0] == "cone" ? 1 : 0;
        for (std::string name : names) {
            if (const std::size_t hash = name.find('#'); hash != std::string::npos) name.replace(hash, 1, std::to_string(lightOfPass(buffer_.pass)));
            add(name, {at_[first], at_[first + 1]});
        }
    }

    void cones()
    {
        const std::size_t first = buffer_.axes[0] == "cone" ? 1 : 0, row = at_[first], column = at_[first + 1];
        const Buffer* rotation = capture_.find("tables.rotation");
        if (rotation && !rotation->bytes.empty())
            list.push_back({"rotation of the pixel's cones (tables.rotation)", numberText(7, decodedValue(*rotation, (row & 3) * 4 + (column & 3)))});
        if (first == 1) {
            const Buffer* axes = capture_.find("tables.cone_directions");
            if (axes && rotation && axes->shape.size() == 3)
                add("tables.cone_directions", {static_cast<std::size_t>(decodedValue(*rotation, (row & 3) * 4 + (column & 3))), at_[0] % axes->shape[1]});
        }
        list.push_back({"every step of its cones", "lrsm render " + capture_.sceneName + " --size " + std::to_string(capture_.width) + "x" +
                                                       std::to_string(capture_.height) + " --pixel " + std::to_string(column) + "," + std::to_string(row) +
                                                       ", with the golden's settings"});
    }

    void eightOf(const std::string& below)
    {
        for (std::size_t child = 0; child < 8; ++child) add(below, {2 * at_[0] + (child >> 2), 2 * at_[1] + (child >> 1 & 1), 2 * at_[2] + (child & 1)});
    }

    void volumeChildren(int level)
    {
        if (level > 1) return eightOf(mipName(stemOf(buffer_.name), level - 1));
        eightOf("vct.base");
        eightOf("vct.normal");
    }

    void voxelChildren(int level)
    {
        const std::string below = level > 1 ? mipName("voxel", level - 1) : "voxel.bits";
        eightOf(below);
        if (level > 1 && level <= 3 && buffer_.components.size() == 3)
            list.push_back({"of voxel.bits", "its value counts columns of the " + std::to_string(1 << level) + "^3 voxels from z " +
                                                 std::to_string(at_[0] << level) + ", y " + std::to_string(at_[1] << level) + ", x " +
                                                 std::to_string(at_[2] << level) + " on"});
    }

    void layerChildren(int level)
    {
        const std::string below = mipName(stemOf(buffer_.name), level - 1);
        for (std::size_t child = 0; child < 4; ++child) add(below, {at_[0], 2 * at_[1] + (child >> 1), 2 * at_[2] + (child & 1)});
    }

    void rsmBlock()
    {
        const std::size_t light = lightOfPass(buffer_.pass);
        const std::string prefix = "rsm" + std::to_string(light) + ".";
        for (const char* name : {"depth", "normal", "radiance"})
            for (std::size_t child = 0; child < 4; ++child) add(prefix + name, {2 * at_[1] + (child >> 1), 2 * at_[2] + (child & 1)});
        if (light >= capture_.lights.size()) return;
        const std::vector<LayerRange> ranges = capture_.lights[light].storedRanges();
        if (at_[0] >= ranges.size()) return;
        const LayerRange& r = ranges[at_[0]];
        list.push_back({"range of layer " + std::to_string(at_[0]), "depth [" + numberText(7, r.depthMin) + ", " + numberText(7, r.depthMax) + "], <n.l> [" +
                                                                        numberText(7, r.nDotLMin) + ", " + numberText(7, r.nDotLMax) + "], overlap " +
                                                                        numberText(7, r.delta)});
    }

    const Capture& capture_;
    const Buffer& buffer_;
    std::vector<std::size_t> at_;
};

}  // namespace

std::string texelText(const Buffer& buffer, std::size_t element)
{
    const std::size_t n = std::max<std::size_t>(buffer.components.size(), 1), first = element - element % n;
    std::string text;
    for (std::size_t c = 0; c < n; ++c) {
        if (!buffer.components.empty() && buffer.components[c].empty()) continue;
        text += text.empty() ? "" : ", ";
        if (!buffer.components.empty()) text += buffer.components[c] + " ";
        text += numberText(7, decodedValue(buffer, first + c));
    }
    return text;
}

std::vector<TexelInput> inputsOf(const Capture& inputs, const Buffer& buffer, std::size_t element)
{
    Inputs found(inputs, buffer, element);
    found.collect();
    return std::move(found.list);
}

}  // namespace lrsm
