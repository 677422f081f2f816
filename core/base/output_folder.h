#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lrsm {

/// Files that appear together, whole, or not at all.
///
/// They are written into a hidden folder beside the target and renamed by `commit`; without a commit the destructor removes every trace,
/// missing parent folders included. A target that does not exist appears in one rename. Into one that exists, the files are renamed one by
/// one, replacing files of the same name and leaving others alone; two processes that commit to one folder do so one after the other.
///
/// Throws MachineError (disk full, no permission, target is a device) or InputError (empty path, target is a file or the root).
class OutputFolder {
  public:
    /// Finds out at once whether files can be made there, so that a long render does not end in a surprise. Leaves nothing behind.
    explicit OutputFolder(const std::string& path);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    void write(const std::string& name, std::span<const std::byte> bytes);
    void write(const std::string& name, std::string_view text) { write(name, std::as_bytes(std::span(text))); }
    /// Which files of the target an earlier run wrote: those that this one has not written go. Asked in commit, of a target that exists.
    using Earlier = std::function<std::vector<std::string>(const std::filesystem::path& target)>;
    void commit(const Earlier& earlier = {});

    const std::filesystem::path& path() const { return target_; }
    /// Where a file that was written lies until commit.
    std::filesystem::path staged(const std::string& name) const { return files_ / name; }

  private:
    void makeStaging();
    void removeStaging() noexcept;

    std::filesystem::path target_;   ///< what the user named
    std::filesystem::path top_;      ///< nearest to the root of the folders that do not exist yet; empty: the target exists
    std::filesystem::path staging_;  ///< stands for `top_`, or lies inside the target; empty before the first write
    std::filesystem::path files_;    ///< where in `staging_` the files are
    std::vector<std::string> names_;
};

/// One file in the same manner: written beside `path`, then renamed.
void writeFileWhole(const std::string& path, std::span<const std::byte> bytes);

}  // namespace lrsm
