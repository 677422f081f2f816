#include "conetrace/frame/pass_log.h"

#include <algorithm>
#include <ctime>

namespace lrsm {

std::string passFamily(const std::string& pass)
{
    const std::size_t last = pass.find_last_not_of("0123456789");
    return last != std::string::npos && last + 1 < pass.size() && pass[last] == ' ' ? pass.substr(0, last) : pass;
}

double counterSum(const std::vector<PassReport>& passes, std::string_view name)
{
    double sum = 0.0;
    for (const PassReport& pass : passes) sum += counterSum(pass.counters, name);
    return sum;
}

double processorMilliseconds()
{
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

void PassLog::repeat(const std::vector<PassReport>& earlier)
{
    for (PassReport report : earlier) {
        report.milliseconds = report.cpuMilliseconds = 0.0;
        report.kept = true;
        reports.push_back(std::move(report));
    }
}

void PassLog::begin(const std::string& name) const
{
    if (!watch_.progress) return;
    const double done = static_cast<double>(reports.size());
    watch_.progress(name, done / std::max(done + 1.0, static_cast<double>(expected_)));
}

}  // namespace lrsm
