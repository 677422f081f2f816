#include "core/base/threads.h"

#include "catch.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <functional>

using namespace lrsm;

namespace {

/// What `body` returns in a process of its own, whose user may have no more processes and threads than it has; root, who knows no limit, becomes nobody.
int inCrampedProcess(const std::function<int()>& body)
{
    const pid_t child = ::fork();
    if (child == 0) {
        constexpr uid_t kNobody = 65534;
        const rlimit one{1, 1};
        if ((::getuid() == 0 && ::setuid(kNobody) != 0) || ::setrlimit(RLIMIT_NPROC, &one) != 0) ::_exit(100);
        ::_exit(body());
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("threads: as many as asked for where the system grants them, one where it grants none", "[core][threads]")
{
    CHECK(grantedThreads(1) == 1);
    CHECK(grantedThreads(3) == 3);
    CHECK(grantedThreads(0) >= 1);
    CHECK(inCrampedProcess([] { return grantedThreads(4); }) == 1);
}
