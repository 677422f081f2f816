#include "apps/common/earlier_result.h"

#include "core/base/errors.h"
#include "core/base/file.h"
#include "core/base/json_reader.h"

namespace lrsm {

namespace {

namespace fs = std::filesystem;

/// A text of a JSON file's top level; "" where there is no such file or text.
std::string textIn(const fs::path& file, const std::string& key)
{
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) return "";
    try {
        const nlohmann::ordered_json json = parseJson(readFile(file.string()), file.string());
        return json.is_object() && json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : "";
    } catch (const InputError&) {
        return "";
    }
}

/// The command that wrote the folder; "" where none did.
std::string commandOf(const fs::path& folder)
{
    std::error_code ignored;
    if (fs::exists(folder / "samples.bin", ignored)) return "reference";
    for (const char* file : {"frame.json", "sequence.json"})
        if (const std::string command = textIn(folder / file, "command"); !command.empty()) return command;
    return textIn(folder / "manifest.json", "format").starts_with("lrsm") ? "capture" : "";
}

}  // namespace

void refuseOtherResult(const std::string& folder, const std::string& command)
{
    const std::string earlier = commandOf(folder);
    if (!earlier.empty() && earlier != command)
        throw InputError(folder, "holds what `lrsm " + earlier + "` wrote; give " + command + " a folder of its own with -o, or remove this one first");
}

OutputFolder::Earlier leftBy(const std::string& command, std::vector<std::string> files)
{
    return [command, files = std::move(files)](const fs::path& target) { return commandOf(target) == command ? files : std::vector<std::string>{}; };
}

}  // namespace lrsm
