#pragma once

#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

/// Drives the real binary: arguments in; exit code, both streams and files out.
namespace lrsm::test {

namespace fs = std::filesystem;

inline std::string readText(const fs::path& path)
{
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

struct Outcome {
    int code = -1;  ///< exit code; -1: ended by a signal
    std::string out, err;
};

/// A folder of its own to run in, with a subfolder `here` that the program sees as the current one.
class Sandbox {
  public:
    Sandbox()
    {
        std::string name = (fs::temp_directory_path() / "lrsm_program_XXXXXX").string();
        root_ = ::mkdtemp(name.data());
        fs::create_directory(here());
    }
    ~Sandbox() { fs::remove_all(root_); }

    fs::path here() const { return root_ / "here"; }

    /// `before` is shell code that runs first, `after` stands behind the arguments (redirections).
    Outcome run(const std::string& arguments, const std::string& before = "", const std::string& after = "") const
    {
        const std::string streams = " >'" + (root_ / "out").string() + "' 2>'" + (root_ / "err").string() + "' ";
        const std::string command = "cd '" + here().string() + "' && " + before + " '" LRSM_PROGRAM "' " + arguments + streams + after;
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(root_ / "out"), readText(root_ / "err")};
    }

    bool empty() const { return fs::is_empty(here()); }

  private:
    fs::path root_;
};

inline bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

inline bool isOneLine(const std::string& text)
{
    return std::count(text.begin(), text.end(), '\n') == 1 && text.back() == '\n';
}

}  // namespace lrsm::test
