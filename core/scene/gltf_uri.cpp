#include "core/scene/gltf_uri.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <string_view>
#include <vector>

namespace lrsm::gltf {
namespace {

bool isSpace(char letter)
{
    return letter == ' ' || letter == '\t' || letter == '\n' || letter == '\r' || letter == '\f' || letter == '\v';
}

std::string lowerCase(std::string_view text)
{
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return lower;
}

bool isBase64(char c)
{
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '+' || c == '/';
}

bool isFile(const std::filesystem::path& path)
{
    std::error_code error;
    return std::filesystem::is_regular_file(path, error);
}

/// "C:/...", "/..." or "file:...": of the machine that wrote it.
bool isAbsolute(const std::string& name)
{
    return name.starts_with('/') || lowerCase(name).starts_with("file:") ||
           (name.size() > 2 && std::isalpha(static_cast<unsigned char>(name[0])) && name[1] == ':');
}

}  // namespace

bool isDataUri(const std::string& uri)
{
    return lowerCase(std::string_view(uri).substr(0, 5)) == "data:";
}

std::optional<std::string> plainDataUri(const std::string& uri)
{
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos) return {};
    std::string header = lowerCase(std::string_view(uri).substr(0, comma));
    std::erase_if(header, isSpace);
    if (!header.ends_with(";base64") && header != "data:base64") return {};

    const std::string_view rest = std::string_view(uri).substr(comma + 1);
    std::string text = rest.find('%') == std::string_view::npos ? std::string(rest) : decodeUri(std::string(rest));
    std::erase_if(text, isSpace);
    while (text.ends_with('=')) text.pop_back();
    std::replace(text.begin(), text.end(), '-', '+');
    std::replace(text.begin(), text.end(), '_', '/');
    if (!std::all_of(text.begin(), text.end(), isBase64)) return {};
    // Equal to what was given where nothing but the padding differs: that is no fault.
    std::string_view unpadded = rest;
    while (unpadded.ends_with('=')) unpadded.remove_suffix(1);
    if (unpadded == text && std::string_view(uri).substr(0, 5) == "data:" && std::string_view(uri).substr(0, comma).ends_with(";base64")) return uri;
    return "data:application/octet-stream;base64," + text;
}

std::string decodeUri(const std::string& uri)
{
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned char byte = 0;
        const char* digits = uri.data() + i + 1;
        const bool escaped = uri[i] == '%' && i + 2 < uri.size() && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
        text += escaped ? char(byte) : uri[i];
        if (escaped) i += 2;
    }
    return text;
}

std::string encodeUri(const std::string& name)
{
    std::string uri;
    for (const char c : name) uri += c == '%' ? std::string("%25") : std::string(1, c);
    return uri;
}

std::optional<std::string> otherFileName(const std::string& uri, const std::string& file)
{
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    const std::string decoded = decodeUri(uri);
    if (decoded.empty() || decoded.find('\0') != std::string::npos || isFile(folder / decoded)) return {};
    std::string slashes = decoded, rawSlashes = uri;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    std::replace(rawSlashes.begin(), rawSlashes.end(), '\\', '/');
    std::vector<std::string> names = {uri, slashes, rawSlashes};
    if (isAbsolute(slashes)) names.push_back(slashes.substr(slashes.rfind('/') + 1));
    if (const std::size_t end = slashes.find_first_of("?#"); end != std::string::npos) names.push_back(slashes.substr(0, end));  // of an address
    for (const std::string& name : names)
        if (!name.empty() && isFile(folder / name)) return name;
    return {};
}

}  // namespace lrsm::gltf
