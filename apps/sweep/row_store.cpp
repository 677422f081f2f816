#include "apps/sweep/row_store.h"

#include "apps/sweep/measure.h"
#include "core/base/file.h"
#include "core/base/json_reader.h"
#include "core/base/output_folder.h"
#include "core/report/table.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <span>

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

std::string lineOf(const Measurement& row)
{
    return measurementJson(row).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string keyByThisVersion(const Measurement& row)
{
    return row.kind == RowKind::pathTracer ? rowKeyOf(row.caseKey, row.samples) : rowKeyOf(row.caseKey, row.settings);
}

}  // namespace

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
    return true;
}

void RowStore::writeTables() const
{
    const auto write = [&](const char* name, const std::string& text) { writeFileWhole(pathIn(folder_, name), std::as_bytes(std::span(text))); };
    // The columns of any row; what a row does not have is empty.
    ReportTable table;
    std::vector<Json> flat;
    const auto widen = [&](const Json& row) {
        for (const auto& [key, unused] : row.items())
            if (std::find(table.head.begin(), table.head.end(), key) == table.head.end()) table.head.push_back(key);
    };
    if (rows_.empty()) widen(measurementColumns(Measurement()));
    for (const Measurement& row : rows_) widen(flat.emplace_back(measurementColumns(row)));
    std::string array = "[";
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        std::vector<std::string>& cells = table.rows.emplace_back();
        for (const std::string& key : table.head) {
            const Json value = flat[i].contains(key) ? flat[i][key] : Json();
            cells.push_back(value.is_null() ? "" : value.is_string() ? value.get<std::string>() : value.dump());
        }
        std::string line = lineOf(rows_[i]);
        line.pop_back();
        array += (i == 0 ? "\n" : ",\n") + line;
    }
    write("sweep.csv", csvTable(table, "\r\n"));
    write("sweep.json", array + "\n]\n");
}

}  // namespace lrsm
