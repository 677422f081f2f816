#pragma once

#include "apps/capture/npy.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// The files of a capture as somebody sees them who has docs/capture.md alone: JSON, and arrays by name.
namespace lrsm::twin {

using Json = nlohmann::json;

/// A golden folder, and the candidate made from it.
class Frame {
  public:
    /// `chained`: a pass reads what the pass before it made here; else always the golden's, so that differences do not add up.
    Frame(const std::string& goldenFolder, bool chained);

    const Json& manifest() const { return manifest_; }
    const Json& settings() const { return manifest_["settings"]; }
    std::string setting(const char* key) const;  ///< a choice: its name; anything else: as JSON prints it
    bool is(const char* key, const char* choice) const { return setting(key) == choice; }
    float number(const char* key) const { return settings().at(key).get<float>(); }
    float constant(const char* key) const { return manifest_["constants"].at(key).get<float>(); }
    int whole(const char* key) const { return settings().at(key).get<int>(); }
    bool specular() const { return manifest_["requires"]["specular"].get<bool>(); }
    int width() const { return manifest_["size"][0]; }
    int height() const { return manifest_["size"][1]; }

    bool has(const std::string& name) const { return described_.count(name) != 0; }
    /// The description in the manifest.
    const Json& description(const std::string& name) const;
    /// An input of a pass.
    const NpyArray& input(const std::string& name);
    /// An output of a pass, of the type and shape that the manifest gives; passed over if it has no such buffer.
    void output(const std::string& name, std::vector<std::byte> bytes);

    /// Runs `work` `repeats` times and keeps the shortest time; the driver compiles shaders in the first.
    void time(const std::string& pass, const std::function<void()>& work);
    const std::vector<std::pair<std::string, double>>& seconds() const { return seconds_; }
    int repeats = 1;

    const std::map<std::string, NpyArray>& outputs() const { return outputs_; }
    NpyArray golden(const std::string& name) const;
    /// One .npy a buffer.
    void write(const std::string& folder) const;

  private:
    std::string folder_;
    bool chained_;
    Json manifest_;
    std::map<std::string, std::size_t> described_;
    std::map<std::string, NpyArray> golden_, outputs_;
    std::vector<std::pair<std::string, double>> seconds_;
};

/// A JSON list of numbers, of lists of numbers one after the other.
std::vector<float> numbers(const Json& list);

}  // namespace lrsm::twin
