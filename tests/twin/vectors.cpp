#include "tests/twin/vectors.h"

#include "apps/capture/npy.h"
#include "tests/twin/frame.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace lrsm::twin {

namespace {

/// A set that shaders have, and the defines that each run of it gets.
struct ShaderSet {
    const char* name;
    std::vector<std::vector<std::string>> runs = {{"GAUSSIAN 1"}};
};
const std::vector<ShaderSet>& shaderSets()
{
    static const std::vector<ShaderSet> all = {
        {"front_to_back"},
        {"step_opacity"},
        {"transmittance"},
        {"reflected_radiance"},
        {"direct_sum"},
        {"product"},
        {"layer_texel"},
        {"normal_term"},
        {"depth_moments"},
        {"normal_cdf", {{"GAUSSIAN 1"}, {"GAUSSIAN 0"}}},
        {"visibility", {{"GAUSSIAN 1"}, {"GAUSSIAN 0"}}},
        {"sampler_weights"},
        {"membership"},
        {"layer_sum"},
        {"decay"},
        {"lrsm_level"},
        {"projection"},
        {"half", {{"GAUSSIAN 1"}, {"GAUSSIAN 1", "HALF_NEAREST_EVEN"}}},
        {"half_bits"},
        {"unorm16"},
        {"log2"},
        {"exp2"},
    };
    return all;
}

/// Elements as float32, which holds those of all sets here exactly.
std::vector<float> floatsOf(const NpyArray& array)
{
    std::vector<float> values(array.bytes.size() / sizeOf(array.dtype));
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::byte* at = array.bytes.data() + i * sizeOf(array.dtype);
        std::uint16_t code = 0;
        switch (array.dtype) {
        case Dtype::f4: std::memcpy(&values[i], at, 4); break;
        case Dtype::u1: values[i] = float(std::to_integer<int>(*at)); break;
        case Dtype::u2: std::memcpy(&code, at, 2), values[i] = float(code); break;
        default: throw std::runtime_error("inputs of " + std::string(nameOf(array.dtype)) + " are not float32's");
        }
    }
    return values;
}

/// Numbers of one case.
std::size_t perCase(const Json& array)
{
    std::size_t count = 1;
    for (std::size_t i = 1; i < array["shape"].size(); ++i) count *= array["shape"][i].get<std::size_t>();
    return count;
}
std::size_t perCaseOfAll(const Json& arrays)
{
    std::size_t count = 0;
    for (const Json& array : arrays) count += perCase(array);
    return count;
}

/// All inputs of a case in a row.
std::vector<float> rowsOf(const std::string& folder, const Json& set)
{
    const std::size_t cases = set["cases"], stride = perCaseOfAll(set["inputs"]);
    std::vector<float> rows(cases * stride);
    std::size_t first = 0;
    for (const Json& input : set["inputs"]) {
        const std::vector<float> values = floatsOf(readNpy(folder + "/" + input["file"].get<std::string>()));
        const std::size_t count = perCase(input);
        for (std::size_t i = 0; i < cases; ++i)
            std::copy_n(values.begin() + std::ptrdiff_t(i * count), count, rows.begin() + std::ptrdiff_t(i * stride + first));
        first += count;
    }
    return rows;
}

void setConstants(const Json& constants, const Program& program)
{
    const Json &gaussian = constants["gaussian"], &polynomial = gaussian["polynomial"];
    program.set("varianceFloor", constants["variance_floor"].get<float>());
    program.set("phiHalfWidth", gaussian["table_half_width"].get<float>());
    program.set("phiEntries", gaussian["table_entries"].get<int>());
    program.set("phiLimit", polynomial["limit"].get<float>());
    program.setArray("phiNumerator", numbers(polynomial["numerator"]));
    program.setArray("phiDenominator", numbers(polynomial["denominator"]));
}

/// Phi between the table's ends.
StorageBuffer phiTable(const Json& gaussian)
{
    const int entries = gaussian["table_entries"];
    const double half = gaussian["table_half_width"];
    std::vector<float> table;
    for (int i = 0; i < entries; ++i) table.push_back(float(0.5 * std::erfc((half - 2.0 * half * i / (entries - 1)) * std::sqrt(0.5))));
    return makeBuffer(std::as_bytes(std::span(table)));
}

/// A layer for each texel of 8x8 with all mips, 1 in that texel and 0 in all others.
Texture texelTexture()
{
    constexpr int kEdge = 8, kLevels = 4, kTexels = 64 + 16 + 4 + 1;
    Texture texture = makeTexture(GL_TEXTURE_2D_ARRAY, kFloat, kEdge, kEdge, kTexels, kLevels);
    int first = 0;
    for (int level = 0; level < kLevels; ++level) {
        const int count = (kEdge >> level) * (kEdge >> level);
        std::vector<float> texels(std::size_t(count * kTexels), 0.0f);
        for (int i = 0; i < count; ++i) texels[std::size_t((first + i) * count + i)] = 1.0f;
        upload(texture, GL_TEXTURE_2D_ARRAY, kFloat, level, kEdge >> level, kEdge >> level, kTexels, texels.data());
        first += count;
    }
    return texture;
}

/// Is the result asked for once more, as a GPU's own functions or its sampler make it?
bool hasGpuForm(const Json& set, const Json& output)
{
    const std::string name = output["name"];
    return std::any_of(set["outputs"].begin(), set["outputs"].end(),
                       [&](const Json& o) { return o["name"] == name + "_gpu" || o["name"] == name + "_sampler"; });
}

void writeResults(const std::string& folder, const Json& set, const std::vector<float>& rows)
{
    const std::size_t cases = set["cases"], stride = perCaseOfAll(set["outputs"]);
    std::size_t first = 0;
    for (const Json& output : set["outputs"]) {
        const std::size_t count = perCase(output);
        std::vector<float> values;
        for (std::size_t i = 0; i < cases; ++i)
            for (std::size_t k = 0; k < count; ++k) values.push_back(rows[i * stride + first + k]);
        first += count;
        if (hasGpuForm(set, output)) continue;
        const std::vector<std::byte> file = encodeNpy(Dtype::f4, output["shape"].get<std::vector<std::size_t>>(), std::as_bytes(std::span(values)));
        std::ofstream out(folder + "/" + output["write"].get<std::string>(), std::ios::binary);
        out.write(reinterpret_cast<const char*>(file.data()), std::streamsize(file.size()));
        if (!out) throw std::runtime_error(folder + ": cannot be written");
    }
}

}  // namespace

std::vector<std::string> runVectors(Programs& programs, const std::string& vectors, const std::string& results)
{
    std::ifstream in(vectors + "/vectors.json");
    if (!in) throw std::runtime_error(vectors + ": has no vectors.json");
    const Json json = Json::parse(in);
    std::filesystem::create_directories(results);
    const StorageBuffer table = phiTable(json["constants"]["gaussian"]);
    const Texture texels = texelTexture();
    const Sampler sampler = borderSampler();
    std::vector<std::string> leftOut;
    for (const Json& set : json["sets"]) {
        const auto known = std::find_if(shaderSets().begin(), shaderSets().end(), [&](const ShaderSet& s) { return set["name"] == s.name; });
        if (known == shaderSets().end()) {
            leftOut.push_back(set["name"]);
            continue;
        }
        const std::vector<float> rows = rowsOf(vectors, set);
        const int cases = set["cases"], outputs = int(perCaseOfAll(set["outputs"]));
        const StorageBuffer inputs = makeBuffer(std::as_bytes(std::span(rows))), out = makeBuffer(std::size_t(cases * outputs) * sizeof(float));
        for (std::vector<std::string> defines : known->runs) {
            defines.push_back("SET_" + std::string(known->name));
            const Program& program =
                programs.get({{GL_COMPUTE_SHADER, {"formats.glsl", "light.glsl", "lrsm.glsl", "terms.glsl", "vectors.comp.glsl"}}}, defines);
            setConstants(json["constants"], program);
            program.set("cases", cases);
            program.set("inputCount", int(perCaseOfAll(set["inputs"])));
            program.set("outputCount", outputs);
            bindBuffer(0, inputs);
            bindBuffer(1, out);
            bindBuffer(10, table);
            bindTexture(0, texels, &sampler);
            program.dispatch(cases, 1, 1, 64, 1, 1);
        }
        checkErrors(known->name);
        const std::vector<std::byte> bytes = download(out, std::size_t(cases * outputs) * sizeof(float));
        std::vector<float> values(std::size_t(cases * outputs));
        std::memcpy(values.data(), bytes.data(), bytes.size());
        writeResults(results, set, values);
    }
    return leftOut;
}

}  // namespace lrsm::twin
