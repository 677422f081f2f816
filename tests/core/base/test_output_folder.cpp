#include "core/base/output_folder.h"

#include "core/base/errors.h"

#include "catch.h"

#include <unistd.h>
#include <fstream>
#include <sstream>
#include <thread>

using namespace lrsm;
namespace fs = std::filesystem;

namespace {

/// An empty folder that goes away with the test.
struct Sandbox {
    fs::path path = fs::temp_directory_path() / ("lrsm_output_" + std::to_string(::getpid()));
    Sandbox()
    {
        fs::remove_all(path);
        fs::create_directories(path);
    }
    ~Sandbox() { fs::remove_all(path); }
    std::size_t entries() const { return static_cast<std::size_t>(std::distance(fs::recursive_directory_iterator(path), {})); }
};

std::string contents(const fs::path& path)
{
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

}  // namespace

TEST_CASE("output: nothing is seen before commit, everything after", "[core][output]")
{
    const Sandbox sandbox;
    const fs::path target = sandbox.path / "deep" / "er" / "out";
    {
        OutputFolder folder((target / "").string());
        CHECK(sandbox.entries() == 0);
        folder.write("a.txt", "alpha");
        folder.write("b.txt", "beta");
        CHECK_FALSE(fs::exists(sandbox.path / "deep"));
        folder.commit();
    }
    CHECK(contents(target / "a.txt") == "alpha");
    CHECK(contents(target / "b.txt") == "beta");
    CHECK(sandbox.entries() == 5);
}

TEST_CASE("output: without a commit no trace is left, missing parents included", "[core][output]")
{
    const Sandbox sandbox;
    {
        OutputFolder folder((sandbox.path / "x" / "y").string());
        folder.write("a.txt", "alpha");
    }
    CHECK(sandbox.entries() == 0);
}

TEST_CASE("output: in an existing folder files of the same name are replaced and others left alone", "[core][output]")
{
    const Sandbox sandbox;
    std::ofstream(sandbox.path / "mine.txt") << "mine";
    std::ofstream(sandbox.path / "a.txt") << "old";
    {
        OutputFolder folder(sandbox.path.string());
        folder.write("a.txt", "new");
        CHECK(contents(sandbox.path / "a.txt") == "old");
        folder.commit();
    }
    CHECK(contents(sandbox.path / "a.txt") == "new");
    CHECK(contents(sandbox.path / "mine.txt") == "mine");
    CHECK(sandbox.entries() == 2);
}

TEST_CASE("output: two writers that both miss the same parent both succeed", "[core][output]")
{
    const Sandbox sandbox;
    OutputFolder first((sandbox.path / "shared" / "one").string()), second((sandbox.path / "shared" / "two").string());
    first.write("a.txt", "1");
    second.write("a.txt", "2");
    first.commit();
    second.commit();
    CHECK(contents(sandbox.path / "shared" / "one" / "a.txt") == "1");
    CHECK(contents(sandbox.path / "shared" / "two" / "a.txt") == "2");
    CHECK(sandbox.entries() == 5);
}

TEST_CASE("output: a device, a file, an empty path, a place without write access are refused at once", "[core][output]")
{
    const Sandbox sandbox;
    std::ofstream(sandbox.path / "file") << "x";
    CHECK_THROWS_AS(OutputFolder("/dev/full"), MachineError);
    CHECK_THROWS_AS(OutputFolder("/proc/lrsm/out"), MachineError);
    CHECK_THROWS_AS(OutputFolder((sandbox.path / "file" / "out").string()), MachineError);
    CHECK_THROWS_AS(OutputFolder((sandbox.path / "file").string()), InputError);
    CHECK_THROWS_AS(OutputFolder(""), InputError);
    for (const char* root : {"/", "//", "/..", "/tmp/../."}) CHECK_THROWS_AS(OutputFolder(root), InputError);
    CHECK(sandbox.entries() == 1);
}

TEST_CASE("output: a full disk is a machine error and leaves nothing behind", "[core][output]")
{
    const Sandbox sandbox;
    CHECK_THROWS_AS(writeFileWhole("/dev/full", std::as_bytes(std::span("x", 1))), MachineError);
    CHECK_THROWS_AS(writeFileWhole((sandbox.path / "none" / "a").string(), std::as_bytes(std::span("x", 1))), MachineError);
    CHECK(sandbox.entries() == 0);
    writeFileWhole((sandbox.path / "a").string(), std::as_bytes(std::span("x", 1)));
    CHECK(contents(sandbox.path / "a") == "x");
    CHECK(sandbox.entries() == 1);
}

TEST_CASE("output: what an earlier run alone wrote goes with the commit, what is nobody's stays", "[core][output]")
{
    const Sandbox sandbox;
    for (const char* name : {"a.txt", "b.txt", "mine.txt"}) std::ofstream(sandbox.path / name) << "old";
    OutputFolder folder(sandbox.path.string());
    folder.write("a.txt", "new");
    folder.commit([](const fs::path&) { return std::vector<std::string>{"a.txt", "b.txt", "none.txt", "../" + std::string("mine.txt")}; });
    CHECK(contents(sandbox.path / "a.txt") == "new");
    CHECK(contents(sandbox.path / "mine.txt") == "old");
    CHECK(sandbox.entries() == 2);
}

TEST_CASE("output: of two that commit to one folder at once, one is left whole", "[core][output][threads]")
{
    const Sandbox sandbox;
    constexpr int kFiles = 40;
    const auto all = [](const fs::path&) {
        std::vector<std::string> names;
        for (const char* side : {"first", "second"})
            for (int i = 0; i < kFiles; ++i) names.push_back(side + std::to_string(i)), names.push_back("both" + std::to_string(i));
        return names;
    };
    for (int round = 0; round < 4; ++round) {
        const std::string target = (sandbox.path / "out").string();
        const auto run = [&](const std::string& side) {
            OutputFolder folder(target);
            for (int i = 0; i < kFiles; ++i) {
                folder.write("both" + std::to_string(i), side);
                folder.write(side + std::to_string(i), side);
            }
            folder.commit(all);
        };
        std::thread first(run, "first"), second(run, "second");
        first.join();
        second.join();
        const std::string left = contents(fs::path(target) / "both0"), gone = left == "first" ? "second" : "first";
        for (int i = 0; i < kFiles; ++i) {
            CHECK(contents(fs::path(target) / ("both" + std::to_string(i))) == left);
            CHECK(fs::exists(fs::path(target) / (left + std::to_string(i))));
            CHECK_FALSE(fs::exists(fs::path(target) / (gone + std::to_string(i))));
        }
    }
}
