#include "apps/sweep_report.h"

#include "core/report/html.h"

namespace lrsm {

std::string sweepReportHtml(const std::vector<Measurement>& rows, const std::string&)
{
    return htmlPage({"lrsm sweep", std::to_string(rows.size()) + " rows.", "", "", ""});
}

}  // namespace lrsm
