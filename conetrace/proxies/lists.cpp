#include "conetrace/proxies/lists.h"

namespace lrsm {

VisibilityLists joinRows(const std::vector<VisibilityLists>& rows, int divisor)
{
    VisibilityLists out;
    out.divisor = divisor;
    out.first = {0};
    std::size_t entries = 0;
    for (const VisibilityLists& row : rows) entries += row.cells.size();
    out.cells.reserve(entries);
    out.hits.reserve(entries);
    for (const VisibilityLists& row : rows) {
        const auto before = static_cast<std::uint32_t>(out.cells.size());
        for (std::size_t i = 1; i < row.first.size(); ++i) out.first.push_back(before + row.first[i]);
        out.cells.insert(out.cells.end(), row.cells.begin(), row.cells.end());
        out.hits.insert(out.hits.end(), row.hits.begin(), row.hits.end());
        out.opacity.insert(out.opacity.end(), row.opacity.begin(), row.opacity.end());
        out.lobeOpacity.insert(out.lobeOpacity.end(), row.lobeOpacity.begin(), row.lobeOpacity.end());
        out.rays.insert(out.rays.end(), row.rays.begin(), row.rays.end());
    }
    return out;
}

}  // namespace lrsm
