#pragma once

#include "conetrace/proxies/evaluate.h"
#include "conetrace/proxies/filter.h"
#include "conetrace/proxies/march.h"

#include <optional>

/// method = proxies, of [P], "voxelized point proxies" (2014): points stand for the surfaces, are lit by the lights' maps and hashed into cells. Sparse shadow
/// rays find the cells that every few pixels see, the Visibility Filter joins their lists, and these cells light the pixels.
namespace lrsm {

/// The passes "pp place", "pp light" and "pp cells".
ProxyCells buildProxyCells(const GatherInput& input, PassLog& log);

/// Who sees what.
struct ProxyVisibility {
    VisibilityLists marched;                  ///< V_p
    std::optional<VisibilityLists> filtered;  ///< V'_p; none with pp_filter_radius=0
    std::optional<WeighedProxies> seen;       ///< with pp_cell_weight=seen
    const VisibilityLists& lists() const { return filtered ? *filtered : marched; }
    const WeighedProxies* weights() const { return seen ? &*seen : nullptr; }
};
/// The passes "pp march" and, where they are asked for, "pp filter" and "pp weigh".
ProxyVisibility seeCells(const GatherInput& input, const ProxyCells& cells, PassLog& log);

/// The passes above, "pp gather" and, with pp_gather_divisor above 1, "pp reduce" before it and "pp upsample" after it.
Gathered gatherProxies(const GatherInput& input, PassLog& log);

/// The line of the frame's switch.
GatherMethod proxiesMethod();

}  // namespace lrsm
