#include "apps/common/memory.h"

#include "core/base/errors.h"
#include "core/report/table.h"

#include <iomanip>
#include <nlohmann/json.hpp>

namespace lrsm {

std::string megabytes(std::size_t bytes)
{
    return fixedNumber(1, static_cast<double>(bytes) * 1e-6) + " MB";
}

void enforceMemoryLimit(const MemoryQuestion& question, double maxMegabytes)
{
    if (maxMegabytes <= 0.0) return;
    const auto bytesWith = [&](Unknowns unknowns) {
        MemoryQuestion bounded = question;
        bounded.unknowns = unknowns;
        return frameBytes(predictMemory(bounded), question.width, question.height);
    };
    const double limit = maxMegabytes * 1e6;
    if (static_cast<double>(bytesWith(Unknowns::most)) <= limit) return;
    std::size_t needed = bytesWith(Unknowns::least);
    if (static_cast<double>(needed) <= limit) needed = bytesWith(Unknowns::found);
    if (static_cast<double>(needed) > limit)
        throw InputError("--max-memory " + numberText(6, maxMegabytes),
                         "this frame needs " + megabytes(needed) +
                             "; lower --set voxel_resolution=N, rsm_resolution=N, depth_layers=N, normal_layers=N or --size (lrsm info shows each part)");
}

nlohmann::ordered_json memoryJson(const std::vector<MemoryRow>& rows)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const MemoryRow& row : rows) {
        nlohmann::ordered_json entry = {{"structure", row.structure}, {"detail", row.detail}, {"predicted_bytes", row.predicted}};
        if (row.measured) entry["measured_bytes"] = *row.measured;
        if (row.predictedGpu) entry["gpu_format_bytes"] = row.predictedGpu;
        if (!row.table2.empty()) entry["table2"] = row.table2;
        list.push_back(entry);
    }
    return list;
}

void printMemory(std::ostream& out, const std::vector<MemoryRow>& rows)
{
    const auto line = [&](const std::string& a, const std::string& b, const std::string& c, const std::string& d, const std::string& e) {
        out << "  " << std::left << std::setw(9) << a << std::setw(24) << b << std::right << std::setw(12) << c << std::setw(13) << d << "   " << e << "\n";
    };
    line("", "", "here", "GPU formats", "Table 2");
    std::size_t bytes = 0, gpuBytes = 0;
    for (const MemoryRow& row : rows) {
        line(row.structure, row.detail, megabytes(row.predicted), row.predictedGpu ? megabytes(row.predictedGpu) : "-", row.table2.empty() ? "-" : row.table2);
        bytes += row.predicted;
        gpuBytes += row.predictedGpu;
    }
    line("sum", "", megabytes(bytes), megabytes(gpuBytes), "");
}

}  // namespace lrsm
