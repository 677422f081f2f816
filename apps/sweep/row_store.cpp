#include "apps/sweep/row_store.h"

#include "apps/sweep/measure.h"
#include "core/base/file.h"
#include "core/base/json_reader.h"
#include "core/base/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>

namespace lrsm {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

std::string pathIn(const std::string& folder, const char* name)
{
    return (fs::path(folder) / name).string();
}

[[noreturn]] void refuseFile(const std::string& path)
{
    throw MachineError(path, std::string("cannot be written: ") + std::strerror(errno));
}

/// All of the text at the end of an open file and down to the disk, or none of it.
void appendWhole(int file, const std::string& text, const std::string& path)
{
    const off_t before = ::lseek(file, 0, SEEK_END);
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t count = ::write(file, text.data() + done, text.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            const int error = errno;
            if (before >= 0 && ::ftruncate(file, before) != 0) errno = error;
            errno = error;
            refuseFile(path);
        }
        done += static_cast<std::size_t>(count);
    }
    if (::fsync(file) != 0 && errno != EINVAL && errno != ENOTSUP) refuseFile(path);
}

std::string csvField(const Json& value)
{
    if (value.is_null()) return "";
    if (!value.is_string()) return value.dump();
    const auto& text = value.get_ref<const std::string&>();
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
    return quoted + "\"";
}

std::string lineOf(const Measurement& row)
{
    return measurementJson(row).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string keyByThisVersion(const Measurement& row)
{
    return row.kind == RowKind::pathTracer ? rowKeyOf(row.caseKey, row.samples) : rowKeyOf(row.caseKey, row.settings);
}

}  // namespace

std::vector<std::string> csvColumns(const std::vector<Measurement>& rows)
{
    std::vector<std::string> columns;
    std::set<std::string> known;
    const auto add = [&](const Measurement& row) {
        const Json flat = measurementColumns(row);
        for (const auto& [name, unused] : flat.items())
            if (known.insert(name).second) columns.push_back(name);
    };
    if (rows.empty()) add(Measurement());
    for (const Measurement& row : rows) add(row);
    return columns;
}

std::string csvHeader(const std::vector<std::string>& columns)
{
    std::string line;
    for (const std::string& name : columns) line += (line.empty() ? "" : ",") + csvField(name);
    return line + "\r\n";
}

std::string csvLine(const Measurement& row, const std::vector<std::string>& columns)
{
    std::string line;
    const Json flat = measurementColumns(row);
    for (const std::string& name : columns) {
        const auto found = flat.find(name);
        line += (&name == &columns.front() ? "" : ",") + (found == flat.end() ? "" : csvField(*found));
    }
    return line + "\r\n";
}

RowStore::RowStore(const std::string& folder) : folder_(folder)
{
    if (folder.empty()) throw InputError("sweep folder", "the path is empty");
    std::error_code error;
    fs::create_directories(folder, error);
    if (error && !fs::is_directory(folder)) throw MachineError(folder, "cannot be made a folder: " + error.message());
    const std::string path = pathIn(folder, "rows.jsonl");
    file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file_ < 0) refuseFile(path);
    try {
        if (::flock(file_, LOCK_EX | LOCK_NB) != 0) throw InputError(folder, "another sweep is writing here; wait for it or choose another folder");
        read();
        rebuildCsv();
    } catch (...) {
        ::close(file_);
        throw;
    }
}

RowStore::~RowStore()
{
    ::close(file_);
}

void RowStore::read()
{
    const std::string path = pathIn(folder_, "rows.jsonl");
    const std::vector<unsigned char> bytes = readFile(path);
    std::size_t begin = 0, number = 0;
    while (begin < bytes.size()) {
        const auto end = static_cast<std::size_t>(std::find(bytes.begin() + static_cast<std::ptrdiff_t>(begin), bytes.end(), '\n') - bytes.begin());
        if (end == bytes.size()) {
            // Rows are written with their line end at once: this one was cut, and its measurement is made again.
            if (::ftruncate(file_, static_cast<off_t>(begin)) != 0 || ::fsync(file_) != 0) refuseFile(path);
            droppedTornLine_ = true;
            break;
        }
        const std::string place = path + ":" + std::to_string(++number);
        const std::string_view line(reinterpret_cast<const char*>(bytes.data()) + begin, end - begin);
        Measurement row = measurementFromJson(parseJson(line, place, "remove this line to measure its row again"), place);
        if (byKey_.emplace(row.key, rows_.size()).second) {
            otherVersions_ += row.key != keyByThisVersion(row);
            rows_.push_back(std::move(row));
        }
        begin = end + 1;
    }
}

void RowStore::rebuildCsv()
{
    columns_ = csvColumns(rows_);
    std::string text = csvHeader(columns_);
    for (const Measurement& row : rows_) text += csvLine(row, columns_);
    const std::string path = pathIn(folder_, "sweep.csv");
    if (fs::is_regular_file(path)) {
        const std::vector<unsigned char> found = readFile(path);
        if (std::equal(text.begin(), text.end(), found.begin(), found.end(), [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; }))
            return;
    }
    writeFileWhole(path, std::as_bytes(std::span(text)));
}

const Measurement* RowStore::find(const std::string& key) const
{
    const auto found = byKey_.find(key);
    return found == byKey_.end() ? nullptr : &rows_[found->second];
}

bool RowStore::add(const Measurement& row)
{
    if (find(row.key)) return false;
    appendWhole(file_, lineOf(row), pathIn(folder_, "rows.jsonl"));
    byKey_.emplace(row.key, rows_.size());
    rows_.push_back(row);

    // A pass that no row before had makes new columns.
    const Json flat = measurementColumns(row);
    const auto missing = [&](const auto& item) { return std::find(columns_.begin(), columns_.end(), item.key()) == columns_.end(); };
    if (std::any_of(flat.items().begin(), flat.items().end(), missing)) {
        rebuildCsv();
        return true;
    }
    const std::string path = pathIn(folder_, "sweep.csv");
    const int csv = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
    if (csv < 0) refuseFile(path);
    try {
        appendWhole(csv, csvLine(row, columns_), path);
    } catch (...) {
        ::close(csv);
        throw;
    }
    ::close(csv);
    return true;
}

void RowStore::writeJson() const
{
    std::string text = "[\n";
    for (const Measurement& row : rows_) {
        std::string line = lineOf(row);
        line.pop_back();
        text += line + (&row == &rows_.back() ? "\n" : ",\n");
    }
    text += "]\n";
    writeFileWhole(pathIn(folder_, "sweep.json"), std::as_bytes(std::span(text)));
}

}  // namespace lrsm
