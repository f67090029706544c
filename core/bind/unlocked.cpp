// unlocked.cpp -- before a fork, and in the child.
#include "bind/unlocked.h"

#include <pthread.h>

#define TBB_PREVIEW_WAITING_FOR_WORKERS 1   // its name before oneTBB 2021.9
#include <oneapi/tbb/global_control.h>

#include <new>

#include "math/error.h"
#include "math/forks.h"

namespace dg::bind {

namespace {

/// A worker that goes to sleep holds locks of oneTBB for a moment; one that has ended holds none.
void before_fork() {
    if (forks::working != 0 || forks::torn) return;
    oneapi::tbb::task_scheduler_handle workers{oneapi::tbb::attach{}};
    oneapi::tbb::finalize(workers, std::nothrow);   // false: another thread still refers to them, asleep
}

void in_child() {
    if (forks::working.exchange(0) != 0) forks::torn = true;
}

}  // namespace

Work::Work() {
    if (forks::torn)
        throw Error("this process was forked while its parent drew, and would wait for threads that it does not "
                    "have: start processes by spawn or forkserver, or fork before anything is drawn");
    ++forks::working;
}

Work::~Work() {
    --forks::working;
}

void watch_forks() {
    pthread_atfork(before_fork, nullptr, in_child);
}

}  // namespace dg::bind
