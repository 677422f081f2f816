#include "apps/sweep/row_store.h"

#include "apps/sweep/measure.h"
#include "core/base/errors.h"
#include "core/settings/settings_table.h"

#include "catch.h"

#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

using namespace lrsm;
namespace fs = std::filesystem;

namespace {

struct Folder {
    Folder()
    {
        std::string name = (fs::temp_directory_path() / "lrsm_rows_XXXXXX").string();
        path = ::mkdtemp(name.data());
    }
    ~Folder() { fs::remove_all(path); }
    fs::path path;
    fs::path file(const char* name) const { return path / name; }
};

std::string textOf(const fs::path& path)
{
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

Measurement rowNumber(int i)
{
    Measurement row;
    row.scene = i % 3 ? "plain" : "with \"quotes\", a comma\nand a line end";
    row.caseKey = "0123456789abcdef";
    row.label = "cone_count=" + std::to_string(i + 1);
    row.settings.cones.set.count = i + 1;
    row.error.rmse = 1.0 / (i + 3);
    row.key = rowKeyOf(row.caseKey, row.settings);
    return row;
}

/// RFC 4180, by a state machine of its own.
std::vector<std::vector<std::string>> parseCsv(const std::string& text)
{
    std::vector<std::vector<std::string>> records(1, std::vector<std::string>(1));
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        std::string& field = records.back().back();
        if (quoted && text[i] == '"' && i + 1 < text.size() && text[i + 1] == '"') {
            field += '"';
            ++i;
        } else if (text[i] == '"')
            quoted = !quoted;
        else if (quoted || (text[i] != ',' && text[i] != '\r'))
            field += text[i];
        else if (text[i] == ',')
            records.back().emplace_back();
        else {
            REQUIRE(text.at(++i) == '\n');
            records.emplace_back(1);
        }
    }
    CHECK_FALSE(quoted);
    REQUIRE(records.back() == std::vector<std::string>(1));
    records.pop_back();
    return records;
}

/// sweep.csv says what rows.jsonl says.
void requireCsvAgrees(const Folder& folder)
{
    std::istringstream lines(textOf(folder.file("rows.jsonl")));
    const auto records = parseCsv(textOf(folder.file("sweep.csv")));
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        const auto json = measurementColumns(measurementFromJson(nlohmann::ordered_json::parse(line), "line"));
        REQUIRE(++number < records.size());
        REQUIRE(records[number].size() == json.size());
        std::size_t column = 0;
        for (const auto& [key, value] : json.items()) {
            CHECK(records[0][column] == key);
            const std::string& field = records[number][column++];
            if (value.is_null())
                CHECK(field.empty());
            else if (value.is_string())
                CHECK(field == value.get<std::string>());
            else if (value.is_number())
                CHECK(std::stod(field) == value.get<double>());
            else
                CHECK(field == value.dump());
        }
    }
    CHECK(records.size() == number + 1);
}

std::string refusal(const Folder& folder)
{
    try {
        const RowStore store(folder.path.string());
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

}  // namespace

TEST_CASE("a row with passes and counters that no row had before widens the CSV, what others lack is empty", "[sweep][rows]")
{
    const Folder folder;
    Measurement plain = rowNumber(0), invented = rowNumber(1);
    plain.passes = {{"cones", true, {2.0, 1.0, 0.5}}};
    invented.passes = {{"invented pass", true, {4.0, 3.0, 0.25}}};
    invented.counters = {{"invented_taps", 7.0}};
    {
        RowStore store(folder.path.string());
        REQUIRE(store.add(plain));
        REQUIRE(store.add(invented));
        store.writeTables();
    }
    const auto records = parseCsv(textOf(folder.file("sweep.csv")));
    const auto column = [&](const std::string& name) {
        const auto found = std::find(records[0].begin(), records[0].end(), name);
        REQUIRE(found != records[0].end());
        return static_cast<std::size_t>(found - records[0].begin());
    };
    REQUIRE(records.size() == 3);
    CHECK(records[1][column("cones_ms")] == "2.0");
    CHECK(records[1][column("invented_pass_ms")].empty());
    CHECK(records[2][column("invented_pass_ms_min")] == "3.0");
    CHECK(records[2][column("invented_taps")] == "7");
    CHECK(records[2][column("cones_ms")].empty());
    CHECK(RowStore(folder.path.string()).rows().size() == 2);
}

TEST_CASE("rows are kept in order, once each, and the CSV and the JSON say the same", "[sweep][rows]")
{
    const Folder folder;
    {
        RowStore store((folder.path / "new" / "folder").string());
        CHECK(store.rows().empty());
    }
    {
        RowStore store(folder.path.string());
        for (int i = 0; i < 4; ++i) CHECK(store.add(rowNumber(i)));
        CHECK_FALSE(store.add(rowNumber(2)));
    }
    RowStore store(folder.path.string());
    REQUIRE(store.rows().size() == 4);
    for (int i = 0; i < 4; ++i) CHECK(measurementJson(store.rows()[std::size_t(i)]) == measurementJson(rowNumber(i)));
    CHECK_FALSE(store.add(rowNumber(0)));
    CHECK(store.add(rowNumber(4)));
    CHECK(store.find(rowNumber(4).key)->settings.cones.set.count == 5);
    CHECK_FALSE(store.find("no such key"));
    CHECK(store.rowsOfOtherVersions() == 0);
    store.writeTables();
    requireCsvAgrees(folder);
    const auto array = nlohmann::ordered_json::parse(textOf(folder.file("sweep.json")));
    REQUIRE(array.size() == 5);
    CHECK(array[3] == measurementJson(rowNumber(3)));
}

TEST_CASE("a line that was cut anywhere is dropped on opening, and its row can be added again", "[sweep][rows]")
{
    const Folder folder;
    {
        RowStore store(folder.path.string());
        for (int i = 0; i < 3; ++i) store.add(rowNumber(i));
    }
    const std::string whole = textOf(folder.file("rows.jsonl"));
    const std::size_t last = whole.rfind('\n', whole.size() - 2) + 1;
    for (const std::size_t size : {last + 1, last + 5, (last + whole.size()) / 2, whole.size() - 2, whole.size() - 1}) {
        std::ofstream(folder.file("rows.jsonl"), std::ios::binary) << whole.substr(0, size);
        RowStore store(folder.path.string());
        CHECK(store.droppedTornLine());
        CHECK(store.rows().size() == 2);
        CHECK(store.add(rowNumber(2)));
        CHECK(textOf(folder.file("rows.jsonl")) == whole);
    }
}

TEST_CASE("a process that is killed while it adds loses no row that was added and doubles none", "[sweep][rows]")
{
    const Folder folder;
    std::set<int> acknowledged;
    for (int attempt = 0; attempt < 6; ++attempt) {
        int pipe[2];
        REQUIRE(::pipe(pipe) == 0);
        const pid_t child = ::fork();
        if (child == 0) {
            RowStore store(folder.path.string());
            for (int i = 0; i < 100000; ++i) {
                Measurement row = rowNumber(i % 256);
                row.caseKey = std::to_string(i / 256);
                row.key = rowKeyOf(row.caseKey, row.settings);
                if (store.add(row) && ::write(pipe[1], &i, sizeof i) != sizeof i) ::_exit(1);
            }
            ::_exit(0);
        }
        ::close(pipe[1]);
        int added = 0;
        for (int seen = 0; seen < 3 + 2 * attempt && ::read(pipe[0], &added, sizeof added) == sizeof added; ++seen) CHECK(acknowledged.insert(added).second);
        ::kill(child, SIGKILL);
        while (::read(pipe[0], &added, sizeof added) == sizeof added) CHECK(acknowledged.insert(added).second);
        ::waitpid(child, nullptr, 0);
        ::close(pipe[0]);
    }
    const RowStore store(folder.path.string());
    CHECK(acknowledged.size() >= 48);
    CHECK(store.rows().size() >= acknowledged.size());
    CHECK(store.rows().size() <= acknowledged.size() + 6);  // written, and killed before it could say so
    std::set<std::string> keys;
    for (const Measurement& row : store.rows()) CHECK(keys.insert(row.key).second);
}

TEST_CASE("a folder has one sweep at a time, damaged lines are named, rows of another version stay", "[sweep][rows]")
{
    const Folder folder;
    {
        RowStore store(folder.path.string());
        for (int i = 0; i < 3; ++i) store.add(rowNumber(i));
        CHECK(refusal(folder).find("another sweep") != std::string::npos);
    }
    CHECK(refusal(folder).empty());
    const std::string whole = textOf(folder.file("rows.jsonl"));

    std::string damaged = whole;
    damaged[whole.find('\n') + 3] = '\0';
    std::ofstream(folder.file("rows.jsonl"), std::ios::binary) << damaged;
    CHECK(refusal(folder).find("rows.jsonl:2: is no JSON: ") != std::string::npos);
    CHECK(refusal(folder).ends_with("; remove this line to measure its row again"));
    CHECK(textOf(folder.file("rows.jsonl")) == damaged);

    Measurement other = rowNumber(7);
    other.key = "made by another";
    std::ofstream(folder.file("rows.jsonl"), std::ios::binary) << whole << measurementJson(other).dump() << "\n"
                                                               << measurementJson(rowNumber(1)).dump() << "\n";
    RowStore store(folder.path.string());
    CHECK(store.rowsOfOtherVersions() == 1);
    CHECK(store.rows().size() == 4);  // the repeated row counts once
    CHECK(store.add(rowNumber(7)));
}
