// thread_seconds.h -- clock for benchmarks.
#pragma once
#include <ctime>

namespace dg::bind {

/// CPU seconds of this thread, which do not depend on the load of the machine.
inline double thread_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

}  // namespace dg::bind
