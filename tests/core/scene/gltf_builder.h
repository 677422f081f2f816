#pragma once

#include "core/base/errors.h"
#include "core/scene/gltf.h"
#include "scratch.h"

#include <cstring>
#include <nlohmann/json.hpp>

/// Small glTF files made in the test: a triangle in the plane z = 0 to begin with, and everything about it open to change.
class GltfBuilder {
  public:
    nlohmann::json json = nlohmann::json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {}}]}], "accessors": [], "bufferViews": [], "buffers": []})");

    nlohmann::json moreBuffers = nlohmann::json::array();  ///< after that of the values

    GltfBuilder() { primitive()["attributes"]["POSITION"] = add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 5126); }

    nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }
    nlohmann::json& attributes() { return primitive()["attributes"]; }
    nlohmann::json& node(std::size_t i = 0) { return json["nodes"][i]; }

    /// Appends an accessor with a buffer view of its own; its index.
    template <class T>
    int add(const std::vector<T>& values, const std::string& type, int componentType, bool normalized = false)
    {
        const std::size_t components = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : std::size_t(type.back() - '0');
        json["accessors"].push_back({{"bufferView", addView(values)}, {"componentType", componentType}, {"type", type}, {"count", values.size() / components}});
        if (normalized) json["accessors"].back()["normalized"] = true;
        return int(json["accessors"].size()) - 1;
    }

    template <class T>
    int addView(const std::vector<T>& values)
    {
        while (binary_.size() % 4) binary_.push_back(0);
        const std::size_t at = binary_.size(), bytes = values.size() * sizeof(T);
        binary_.resize(at + bytes);
        std::memcpy(binary_.data() + at, values.data(), bytes);
        json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", at}, {"byteLength", bytes}});
        return int(json["bufferViews"].size()) - 1;
    }

    void addPng(const std::vector<unsigned char>& bytes) { json["images"].push_back({{"bufferView", addView(bytes)}, {"mimeType", "image/png"}}); }

    /// As a .glb in memory.
    std::string glb() const
    {
        nlohmann::json whole = json;
        std::string binary(binary_.begin(), binary_.end());
        binary.resize((binary.size() + 3) / 4 * 4);
        whole["buffers"] = {{{"byteLength", binary.size()}}};
        for (const nlohmann::json& buffer : moreBuffers) whole["buffers"].push_back(buffer);
        std::string text = whole.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const auto word = [](std::size_t value) {
            std::string bytes;
            for (int i = 0; i < 4; ++i) bytes += char(value >> (8 * i) & 255);
            return bytes;
        };
        return "glTF" + word(2) + word(12 + 8 + text.size() + 8 + binary.size()) + word(text.size()) + "JSON" + text + word(binary.size()) +
               std::string("BIN\0", 4) + binary;
    }

    lrsm::Scene load(const lrsm::LoadOptions& options = {}) const
    {
        const ScratchFolder folder;
        return lrsm::loadGltf(folder.write("test.glb", glb()), options);
    }

    /// The message of the InputError that loading must end with; "" if it loads.
    std::string error(const lrsm::LoadOptions& options = {}) const
    {
        try {
            load(options);
        } catch (const lrsm::InputError& e) {
            return e.what();
        }
        return "";
    }

  private:
    std::vector<unsigned char> binary_;
};
