#pragma once

#include <optional>
#include <string>

/// URIs as glTF files have them, and as writers get them wrong.
namespace lrsm::gltf {

bool isDataUri(const std::string& uri);

/// A base64 data URI as RFC 2397 and 4648 have it: white space dropped, percent escapes resolved, the alphabet of URLs changed to the plain one, no padding.
/// What is no base64 data URI, or has other letters in it: nothing.
std::optional<std::string> plainDataUri(const std::string& uri);

/// Percent escapes resolved; what is no escape stays.
std::string decodeUri(const std::string& uri);

/// The other way: `%` alone needs it where only decodeUri reads the result.
std::string encodeUri(const std::string& name);

/// Where no file of the URI's name lies beside `file`: the name of one that does if back-slashes are slashes, escapes are letters, or the folders of another
/// machine, or an address's query, are left out. Nothing where there is none, or where the URI is right.
std::optional<std::string> otherFileName(const std::string& uri, const std::string& file);

}  // namespace lrsm::gltf
