// forks.h -- detection of forks while threads were active.
#pragma once
#include <atomic>

namespace dg::forks {

/// Number of threads inside the core with Python's lock released.
inline std::atomic<int> working{0};

/// Whether this process was forked while `working` was not 0. The child has only the forking
/// thread: locks of oneTBB and Embree held by other threads stay locked, and acquiring them blocks
/// for ever.
inline std::atomic<bool> torn{false};

}  // namespace dg::forks
