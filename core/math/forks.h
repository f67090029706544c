// forks.h -- a process that was forked while threads of its parent worked here.
#pragma once
#include <atomic>

namespace dg::forks {

/// Threads of this process that work in the core with Python's lock released.
inline std::atomic<int> working{0};

/// Whether this process was forked while `working` was not 0. Of its parent's threads it has only the one that
/// forked: locks of oneTBB and Embree that another one held stay locked, and who asks for one waits for ever.
inline std::atomic<bool> torn{false};

}  // namespace dg::forks
