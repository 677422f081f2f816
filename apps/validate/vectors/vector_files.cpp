#include "apps/validate/vectors/vector_files.h"

#include "apps/capture/buffer.h"
#include "core/base/file.h"
#include "core/base/json_reader.h"
#include "lrsm/gaussian_visibility.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

namespace lrsm {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "lrsm vectors";
constexpr int kFormatVersion = 1;

template <class T>
std::vector<std::byte> bytesAs(const std::vector<double>& values)
{
    std::vector<std::byte> bytes(values.size() * sizeof(T));
    for (std::size_t i = 0; i < values.size(); ++i) {
        const T value = static_cast<T>(values[i]);
        std::memcpy(bytes.data() + i * sizeof(T), &value, sizeof(T));
    }
    return bytes;
}

std::vector<std::byte> bytesOf(Dtype dtype, const std::vector<double>& values)
{
    switch (dtype) {
    case Dtype::u1: return bytesAs<std::uint8_t>(values);
    case Dtype::u2: return bytesAs<std::uint16_t>(values);
    case Dtype::f4: return bytesAs<float>(values);
    default: return bytesAs<double>(values);
    }
}

void writeArray(OutputFolder& folder, const std::string& file, Dtype dtype, const std::vector<std::size_t>& shape, const std::vector<double>& values)
{
    folder.write(file, encodeNpy(dtype, shape, bytesOf(dtype, values)));
}

Json arrayJson(const VectorArray& array, std::size_t cases)
{
    return {{"name", array.name}, {"dtype", nameOf(array.dtype)}, {"shape", wholeShape(array, cases)}, {"unit", array.unit}, {"meaning", array.meaning}};
}

/// Cases of a kind stand together: "typical": [0, 96], half-open.
Json kindsJson(const VectorSet& set)
{
    Json json = Json::object();
    for (std::size_t i = 0; i < set.cases(); ++i) {
        const std::string kind(nameOf(set.kinds[i]));
        if (!json.contains(kind)) json[kind] = {i, i};
        json[kind][1] = i + 1;
    }
    return json;
}

Json setJson(const VectorSet& set)
{
    Json json = {{"name", set.name},        {"meaning", set.meaning},  {"cases", set.cases()},
                 {"kinds", kindsJson(set)}, {"inputs", Json::array()}, {"outputs", Json::array()}};
    for (const VectorArray& input : set.inputs) {
        Json entry = arrayJson(input, set.cases());
        entry["file"] = inputFile(set, input);
        json["inputs"].push_back(std::move(entry));
    }
    for (const VectorOutput& output : set.outputs) {
        Json entry = arrayJson(output.exact, set.cases());
        entry["equation"] = output.equation;
        entry["write"] = givenFile(output);
        entry["exact"] = exactFile(output);
        entry["allowed"] = allowedFile(output);
        entry["bound"] = output.bound;
        json["outputs"].push_back(std::move(entry));
    }
    return json;
}

/// What an implementation may want to have from us: the floor of Eq. 11, Phi as a polynomial, the paper's table.
Json constantsJson()
{
    return {{"variance_floor", kVarianceFloor},
            {"gaussian",
             {{"table_half_width", kTableHalfWidth},
              {"table_entries", kVectorTableEntries},
              {"polynomial",
               {{"limit", kCdfLimit},
                {"numerator", std::vector<float>(std::begin(kCdfNumerator), std::end(kCdfNumerator))},
                {"denominator", std::vector<float>(std::begin(kCdfDenominator), std::end(kCdfDenominator))}}}}}};
}

/// The description alone; `cases` is what its shape must begin with.
VectorArray readArray(const JsonReader& json, std::size_t cases)
{
    VectorArray array{.name = json["name"].text(), .shape = {}, .unit = json["unit"].text(), .meaning = json["meaning"].text()};
    array.dtype = dtypeByName(json["dtype"].text(), json["dtype"].path());
    constexpr std::int64_t kMost = 1 << 24;  // extents of 0 are no cases
    for (const JsonReader& extent : json["shape"].items()) array.shape.push_back(static_cast<std::size_t>(extent.whole(1, kMost)));
    if (array.shape.empty() || array.shape.front() != cases) json["shape"].fail("must begin with the number of cases");
    array.shape.erase(array.shape.begin());
    return array;
}

std::vector<double> readValues(const std::string& folder, const JsonReader& file, const VectorArray& array, std::size_t cases)
{
    const std::string path = (std::filesystem::path(folder) / file.text()).string();
    const NpyArray read = readNpy(path);
    if (read.shape != wholeShape(array, cases))
        throw InputError(path, "has shape " + shapeText(read.shape) + ", " + kVectorsFile + " says " + shapeText(wholeShape(array, cases)) +
                                   "; write the vectors anew with `lrsm validate --vectors`");
    return numbersOf(read);
}

std::vector<CaseKind> readKinds(const JsonReader& json, std::size_t cases)
{
    json.allowOnly({nameOf(CaseKind::typical), nameOf(CaseKind::worst), nameOf(CaseKind::extreme)});
    std::vector<CaseKind> kinds(cases, CaseKind::typical);
    for (const CaseKind kind : {CaseKind::worst, CaseKind::extreme}) {
        const std::string name(nameOf(kind));
        if (!json.has(name)) continue;
        const std::vector<JsonReader> ends = json[name].items(2);
        for (std::uint64_t i = ends[0].count(); i < std::min<std::uint64_t>(ends[1].count(), cases); ++i) kinds[i] = kind;
    }
    return kinds;
}

VectorSet readSet(const std::string& folder, const JsonReader& json)
{
    VectorSet set{.name = json["name"].text(), .meaning = json["meaning"].text(), .inputs = {}, .outputs = {}, .kinds = {}};
    constexpr std::int64_t kMostCases = 1 << 24;
    set.kinds = readKinds(json["kinds"], static_cast<std::size_t>(json["cases"].whole(1, kMostCases)));
    for (const JsonReader& entry : json["inputs"].items()) {
        set.inputs.push_back(readArray(entry, set.cases()));
        set.inputs.back().values = readValues(folder, entry["file"], set.inputs.back(), set.cases());
    }
    for (const JsonReader& entry : json["outputs"].items()) {
        VectorOutput output{
            .equation = entry["equation"].text(), .exact = readArray(entry, set.cases()), .bound = entry["bound"].text(), .allowed = {}, .ours = {}};
        output.exact.values = readValues(folder, entry["exact"], output.exact, set.cases());
        output.allowed = readValues(folder, entry["allowed"], output.exact, set.cases());
        set.outputs.push_back(std::move(output));
    }
    return set;
}

}  // namespace

std::string inputFile(const VectorSet& set, const VectorArray& input)
{
    return set.name + ".in." + input.name + ".npy";
}
std::string exactFile(const VectorOutput& output)
{
    return output.exact.name + ".exact.npy";
}
std::string allowedFile(const VectorOutput& output)
{
    return output.exact.name + ".allowed.npy";
}
std::string givenFile(const VectorOutput& output)
{
    return output.exact.name + ".npy";
}

std::vector<std::size_t> wholeShape(const VectorArray& array, std::size_t cases)
{
    std::vector<std::size_t> shape = {cases};
    shape.insert(shape.end(), array.shape.begin(), array.shape.end());
    return shape;
}

std::vector<double> numbersOf(const NpyArray& array)
{
    Buffer buffer;
    buffer.dtype = array.dtype;
    buffer.shape = array.shape;
    buffer.bytes = array.bytes;
    std::vector<double> values(buffer.elements());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = decodedValue(buffer, i);
    return values;
}

void writeVectors(OutputFolder& folder, const std::vector<VectorSet>& sets, const std::string& version)
{
    Json json = {{"format", kFormat}, {"formatVersion", kFormatVersion}, {"version", version}, {"constants", constantsJson()}, {"sets", Json::array()}};
    for (const VectorSet& set : sets) {
        json["sets"].push_back(setJson(set));
        for (const VectorArray& input : set.inputs) writeArray(folder, inputFile(set, input), input.dtype, wholeShape(input, set.cases()), input.values);
        for (const VectorOutput& output : set.outputs) {
            const std::vector<std::size_t> shape = wholeShape(output.exact, set.cases());
            writeArray(folder, exactFile(output), Dtype::f8, shape, output.exact.values);
            writeArray(folder, allowedFile(output), Dtype::f8, shape, output.allowed);
        }
    }
    folder.write(kVectorsFile, json.dump(1) + "\n");
}

std::vector<VectorSet> readVectors(const std::string& folder)
{
    const std::string path = (std::filesystem::path(folder) / kVectorsFile).string();
    const Json json = parseJson(readFile(path), path, "write the vectors anew with `lrsm validate --vectors`");
    const JsonReader reader(json, path);
    if (reader["format"].text() != kFormat || reader["formatVersion"].whole(1, 1000) != kFormatVersion)
        reader.fail("format", std::string("must be \"") + kFormat + "\", version " + std::to_string(kFormatVersion));
    std::vector<VectorSet> sets;
    for (const JsonReader& set : reader["sets"].items()) sets.push_back(readSet(folder, set));
    return sets;
}

}  // namespace lrsm
