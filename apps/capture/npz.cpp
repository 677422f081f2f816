#include "apps/capture/npz.h"

#include "core/base/errors.h"

#include <zip.h>
#include <memory>

namespace lrsm {

namespace {

constexpr std::string_view kEnding = ".npy";
constexpr zip_uint64_t kLargestArray = zip_uint64_t(1) << 36;  // a corrupt directory must not ask for more memory than any capture has

struct CloseZip {
    void operator()(zip_t* archive) const { zip_discard(archive); }
    void operator()(zip_file_t* file) const { zip_fclose(file); }
};
using Archive = std::unique_ptr<zip_t, CloseZip>;

Archive openNpz(const std::string& path)
{
    int code = 0;
    Archive archive(zip_open(path.c_str(), ZIP_RDONLY, &code));
    if (archive) return archive;
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw InputError(path, "is no readable .npz: " + why);
}

}  // namespace

std::vector<std::string> namesInNpz(const std::string& path)
{
    const Archive archive = openNpz(path);
    std::vector<std::string> names;
    for (zip_int64_t i = 0; i < zip_get_num_entries(archive.get(), 0); ++i) {
        const char* entry = zip_get_name(archive.get(), static_cast<zip_uint64_t>(i), 0);
        std::string name = entry ? entry : "";
        if (name.ends_with(kEnding)) names.push_back(name.substr(0, name.size() - kEnding.size()));
    }
    return names;
}

NpyArray readNpz(const std::string& path, const std::string& name)
{
    const Archive archive = openNpz(path);
    const std::string entry = name + std::string(kEnding), place = path + ", " + name;
    zip_stat_t about;
    zip_stat_init(&about);
    if (zip_stat(archive.get(), entry.c_str(), 0, &about) != 0 || !(about.valid & ZIP_STAT_SIZE)) throw InputError(place, "is not in it");
    if (about.size > kLargestArray) throw InputError(place, "says that it holds " + std::to_string(about.size) + " bytes");
    const std::unique_ptr<zip_file_t, CloseZip> file(zip_fopen(archive.get(), entry.c_str(), 0));
    if (!file) throw InputError(place, std::string("cannot be read: ") + zip_strerror(archive.get()));
    // As it comes, not as the directory promises: a lie there costs no memory.
    std::vector<std::byte> bytes;
    constexpr std::size_t kBlock = 1 << 20;
    for (zip_int64_t got = 1; got > 0;) {
        const std::size_t held = bytes.size();
        bytes.resize(held + kBlock);
        got = zip_fread(file.get(), bytes.data() + held, kBlock);
        if (got < 0) throw InputError(place, "cannot be read: it is damaged or cut off");
        bytes.resize(held + static_cast<std::size_t>(got));
        if (bytes.size() > about.size) throw InputError(place, "cannot be read: it holds more than its directory says");
    }
    return decodeNpy(bytes, place);
}

}  // namespace lrsm
