#include "core/base/file.h"

#include "core/base/errors.h"

#include <filesystem>
#include <fstream>

namespace lrsm {

std::vector<unsigned char> readFile(const std::string& path)
{
    if (path.empty()) throw InputError("file name", "is empty");
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) throw InputError(path, "there is no such file");
    if (status.type() == std::filesystem::file_type::directory) throw InputError(path, "is a folder, not a file");
    if (status.type() != std::filesystem::file_type::regular) throw InputError(path, "is no regular file or cannot be reached");

    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw InputError(path, "cannot be opened for reading");
    std::vector<unsigned char> bytes(std::filesystem::file_size(path, error));
    if (error) throw MachineError(path, "its size cannot be read");
    stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    if (std::size_t(stream.gcount()) != bytes.size()) throw MachineError(path, "reading broke off");
    return bytes;
}

}  // namespace lrsm
