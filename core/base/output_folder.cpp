#include "core/base/output_folder.h"

#include "core/base/errors.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace lrsm {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void failed(const fs::path& path, int error)
{
    throw MachineError(path.string(), std::string("cannot be written: ") + std::strerror(error));
}

/// All of the bytes, down to the disk: a full disk may show only at fsync or close.
void writeBytes(const fs::path& path, std::span<const std::byte> bytes)
{
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file < 0) failed(path, errno);
    int error = 0;
    for (std::size_t done = 0; done < bytes.size() && !error;) {
        const ssize_t count = ::write(file, bytes.data() + done, bytes.size() - done);
        if (count >= 0)
            done += static_cast<std::size_t>(count);
        else if (errno != EINTR)
            error = errno;
    }
    // Pipes and devices cannot be synchronised, which is no fault.
    if (!error && ::fsync(file) != 0 && errno != EINVAL && errno != ENOTSUP) error = errno;
    if (::close(file) != 0 && !error) error = errno;
    if (error) failed(path, error);
}

/// Held, it keeps other processes' commits to the folder waiting. Where a file system knows no locks there is none.
class FolderLock {
  public:
    explicit FolderLock(const fs::path& folder) : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC))
    {
        while (folder_ >= 0 && ::flock(folder_, LOCK_EX) != 0 && errno == EINTR) {
        }
    }
    ~FolderLock()
    {
        if (folder_ >= 0) ::close(folder_);
    }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int folder_;
};

/// A new folder whose name begins with `prefix`, readable by all (mkdtemp's is for the owner alone).
fs::path makeUniqueFolder(const fs::path& prefix, const fs::path& blame)
{
    std::string name = prefix.string() + "XXXXXX";
    if (!::mkdtemp(name.data())) failed(blame, errno);
    std::error_code ignored;
    fs::permissions(name, fs::perms(0755), ignored);
    return name;
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path)
{
    if (path.empty()) throw InputError("output folder", "the path is empty");
    std::error_code error;
    target_ = fs::absolute(path, error).lexically_normal();
    if (error) failed(path, error.value());
    if (!target_.has_filename()) target_ = target_.parent_path();  // "out/" is "out"
    if (target_ == target_.root_path()) throw InputError(path, "is the root of the file system; -o needs a folder of its own");

    const fs::file_status status = fs::status(target_, error);
    if (fs::is_regular_file(status)) throw InputError(path, "is a file; -o needs a folder");
    if (fs::exists(status) && !fs::is_directory(status)) throw MachineError(path, "cannot be written: it is a device, not a folder");
    if (!fs::exists(status))
        for (top_ = target_; top_ != top_.root_path() && !fs::exists(top_.parent_path(), error);) top_ = top_.parent_path();

    makeStaging();
    removeStaging();
}

OutputFolder::~OutputFolder()
{
    removeStaging();
}

void OutputFolder::makeStaging()
{
    if (top_.empty()) {
        staging_ = files_ = makeUniqueFolder(target_ / ".lrsm-partial-", target_);
        return;
    }
    staging_ = makeUniqueFolder(top_.parent_path() / ("." + top_.filename().string() + "-partial-"), target_);
    files_ = (staging_ / target_.lexically_relative(top_)).lexically_normal();
    std::error_code error;
    fs::create_directories(files_, error);
    if (error) failed(target_, error.value());
}

void OutputFolder::removeStaging() noexcept
{
    std::error_code ignored;
    if (!staging_.empty()) fs::remove_all(staging_, ignored);
    staging_.clear();
    names_.clear();
}

void OutputFolder::write(const std::string& name, std::span<const std::byte> bytes)
{
    if (staging_.empty()) makeStaging();
    writeBytes(files_ / name, bytes);
    names_.push_back(name);
}

void OutputFolder::commit(const Earlier& earlier)
{
    if (staging_.empty()) return;
    if (!top_.empty() && ::rename(staging_.c_str(), top_.c_str()) == 0) {
        staging_.clear();
        return;
    }
    // The target exists, or another process has made it in the meantime.
    std::error_code error;
    fs::create_directories(target_, error);
    if (error) failed(target_, error.value());
    const FolderLock lock(target_);
    if (earlier)
        for (const std::string& name : earlier(target_))
            if (std::find(names_.begin(), names_.end(), name) == names_.end() && fs::path(name).filename() == name) fs::remove(target_ / name, error);
    for (const std::string& name : names_)
        if (::rename((files_ / name).c_str(), (target_ / name).c_str()) != 0) failed(target_ / name, errno);
    removeStaging();
}

void writeFileWhole(const std::string& path, std::span<const std::byte> bytes)
{
    if (path.empty()) throw InputError("output file", "the path is empty");
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) throw InputError(path, "is a folder; a file name is needed");
    if (fs::exists(status) && !fs::is_regular_file(status)) return writeBytes(path, bytes);  // /dev/stdout and the like

    const fs::path partial = path + ".partial-" + std::to_string(::getpid());
    try {
        writeBytes(partial, bytes);
        if (::rename(partial.c_str(), path.c_str()) != 0) failed(path, errno);
    } catch (...) {
        ::unlink(partial.c_str());
        throw;
    }
}

}  // namespace lrsm
