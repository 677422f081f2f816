#pragma once

#include "apps/sweep/measurement.h"

#include <map>
#include <string>
#include <vector>

/// The rows of a sweep on disk: FOLDER/rows.jsonl, one JSON object a line, which only ever grows; FOLDER/sweep.csv, the same rows for a spreadsheet, and
/// FOLDER/sweep.json, the same as one array, both made from it at the end of a run.
namespace lrsm {

/// Holds the folder while it lives: a second one, in this process or another, is an InputError. A row is on the disk when `add` returns; a process that is
/// killed at any moment leaves at most one cut line at the end, which the next one removes.
class RowStore {
  public:
    /// Makes the folder where there is none. InputError with file and line number for a line that is no row; MachineError where the disk fails.
    explicit RowStore(const std::string& folder);
    ~RowStore();
    RowStore(const RowStore&) = delete;
    RowStore& operator=(const RowStore&) = delete;

    /// In the order of the file; of rows with the same key the first.
    const std::vector<Measurement>& rows() const { return rows_; }
    /// nullptr when there is none; valid until the next `add`.
    const Measurement* find(const std::string& key) const;
    /// Appends a row; false, and nothing is written, where its key is there already.
    bool add(const Measurement& row);
    /// sweep.csv (RFC 4180, lines end with CR LF; null is an empty field; columns as measurementJson has them) and sweep.json.
    void writeTables() const;

    bool droppedTornLine() const { return droppedTornLine_; }
    /// Rows whose key another version of the program made: they are kept, and never match.
    std::size_t rowsOfOtherVersions() const { return otherVersions_; }

  private:
    void read();

    std::string folder_;
    int file_ = -1;
    std::vector<Measurement> rows_;
    std::vector<std::string> columns_;  ///< of sweep.csv
    std::map<std::string, std::size_t> byKey_;
    bool droppedTornLine_ = false;
    std::size_t otherVersions_ = 0;
};

}  // namespace lrsm
