#include "tests/twin/frame.h"

#include "tests/twin/gl.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace lrsm::twin {

Frame::Frame(const std::string& goldenFolder, bool chained) : folder_(goldenFolder), chained_(chained)
{
    std::ifstream in(folder_ + "/manifest.json");
    if (!in) throw std::runtime_error(folder_ + ": has no manifest.json");
    manifest_ = Json::parse(in);
    const Json& buffers = manifest_["buffers"];
    for (std::size_t i = 0; i < buffers.size(); ++i) described_[buffers[i]["name"]] = i;
}

std::string Frame::setting(const char* key) const
{
    const Json& value = settings().at(key);
    return value.is_string() ? value.get<std::string>() : value.dump();
}

const Json& Frame::description(const std::string& name) const
{
    const auto found = described_.find(name);
    if (found == described_.end()) throw std::runtime_error("the golden capture has no buffer " + name);
    return manifest_["buffers"][found->second];
}

NpyArray Frame::golden(const std::string& name) const
{
    return readNpy(folder_ + "/" + description(name)["file"].get<std::string>());
}

const NpyArray& Frame::input(const std::string& name)
{
    if (const auto own = outputs_.find(name); chained_ && own != outputs_.end()) return own->second;
    const auto found = golden_.find(name);
    return found != golden_.end() ? found->second : golden_.emplace(name, golden(name)).first->second;
}

void Frame::output(const std::string& name, std::vector<std::byte> bytes)
{
    if (!has(name)) return;
    const Json& like = description(name);
    NpyArray array;
    array.dtype = dtypeByName(like["dtype"].get<std::string>(), name);
    array.shape = like["shape"].get<std::vector<std::size_t>>();
    if (bytes.size() != elementCount(array.shape, name) * sizeOf(array.dtype))
        throw std::runtime_error(name + ": the twin's buffer has another size than the golden's");
    array.bytes = std::move(bytes);
    outputs_[name] = std::move(array);
}

void Frame::time(const std::string& pass, const std::function<void()>& work)
{
    double shortest = 0.0;
    for (int i = 0; i < repeats; ++i) {
        glFinish();
        const auto begin = std::chrono::steady_clock::now();
        work();
        glFinish();
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        shortest = i == 0 ? seconds : std::min(shortest, seconds);
    }
    checkErrors(pass.c_str());
    seconds_.emplace_back(pass, shortest);
}

void Frame::write(const std::string& folder) const
{
    std::filesystem::create_directories(folder);
    for (const auto& [name, array] : outputs_) {
        const std::vector<std::byte> file = encodeNpy(array.dtype, array.shape, array.bytes);
        std::ofstream out(folder + "/" + description(name)["file"].get<std::string>(), std::ios::binary);
        out.write(reinterpret_cast<const char*>(file.data()), std::streamsize(file.size()));
        if (!out) throw std::runtime_error(folder + ": cannot be written");
    }
}

std::vector<float> numbers(const Json& list)
{
    std::vector<float> all;
    for (const Json& item : list) {
        if (item.is_array()) {
            const std::vector<float> inner = numbers(item);
            all.insert(all.end(), inner.begin(), inner.end());
        } else {
            all.push_back(item.is_boolean() ? float(item.get<bool>()) : item.get<float>());
        }
    }
    return all;
}

}  // namespace lrsm::twin
