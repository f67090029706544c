// thread_seconds.h -- the clock of benches.
#pragma once
#include <ctime>

namespace dg::bind {

/// CPU seconds of this thread: unlike the wall clock, the same on a busy machine.
inline double thread_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

}  // namespace dg::bind
