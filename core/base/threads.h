#pragma once

namespace lrsm {

/// How many threads the system lets this process have at once, itself included, of `wanted` (0: one a processor): it starts them and ends them again.
/// Limits of users, containers and address space show here, and not in the middle of oneTBB, which would end the program.
int grantedThreads(int wanted);

}  // namespace lrsm
