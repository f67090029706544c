// unlocked.cpp -- before a fork, in the child, and at the end of Python.
#include "bind/unlocked.h"

#include <pthread.h>

#define TBB_PREVIEW_WAITING_FOR_WORKERS 1   // its name before oneTBB 2021.9
#include <oneapi/tbb/global_control.h>

#include <atomic>
#include <chrono>
#include <new>
#include <thread>

#include "math/error.h"
#include "math/forks.h"

namespace nb = nanobind;

namespace dg::bind {

namespace {

std::atomic<bool> ending{false};
std::atomic<std::thread::id> last_thread{};   // the one in which Python ends
const std::thread::id first_thread = std::this_thread::get_id();   // the one that imports the core

using Workers = oneapi::tbb::task_scheduler_handle;

/// Keeps oneTBB's workers while no thread of Python refers to them. Never destroyed: that takes locks.
Workers* const kept_workers = new Workers;
bool ended = false;           // whether the workers ended before this fork
thread_local int depth = 0;   // scopes `Unlocked` of this thread, in callbacks of one another

void keep_workers() {
    *kept_workers = Workers{oneapi::tbb::attach{}};
}

/// Drops what this thread refers to, so that the workers can end though it lives on. Else a fork while it
/// sleeps would leave them running, and one that goes to sleep itself holds a lock that the child waits for.
/// The first thread keeps it: glibc reads the map of the whole memory, 0.4 ms, when oneTBB asks for its stack again.
void detach_thread() {
    if (std::this_thread::get_id() == first_thread) return;
    Workers here{oneapi::tbb::attach{}};
    oneapi::tbb::finalize(here, std::nothrow);   // false: the workers are still kept
}

/// Ends the workers: one that goes to sleep holds locks of oneTBB for a moment; one that has ended holds none.
void before_fork() {
    ended = false;
    if (forks::working != 0 || forks::torn) return;
    ended = oneapi::tbb::finalize(*kept_workers, std::nothrow);
}

void after_fork() {
    if (!*kept_workers) keep_workers();
}

void in_child() {
    forks::working = 0;
    if (ended) after_fork();
    else forks::torn = true;
    nb::set_leak_warnings(false);   // the parent's other threads keep what they referred to
}

/// At the end of Python a thread that asked for its lock would be ended there and then, and C++ with it.
void park() {
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

void at_exit() {
    last_thread = std::this_thread::get_id();
    ending = true;
    // Daemon threads keep what they refer to, which is no fault.
    if (nb::len(nb::module_::import_("sys").attr("_current_frames")()) > 1) nb::set_leak_warnings(false);
    const nb::gil_scoped_release release;
    while (forks::working != 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace

// Counts while Python's lock is held: a fork, which holds it, finds each thread before its work or within.
Unlocked::Unlocked() {
    if (forks::torn)
        throw Error("this process was forked beside a thread that draws or has drawn, and would wait for threads "
                    "that it does not have: start processes by spawn or forkserver, or fork before anything is drawn");
    ++forks::working;
    thread_ = PyEval_SaveThread();
    ++depth;
    if (!is_ending_beside(std::this_thread::get_id())) return;
    --forks::working;
    park();
}

Unlocked::~Unlocked() {
    if (--depth == 0) detach_thread();
    --forks::working;
    if (is_ending_beside(std::this_thread::get_id())) park();
    PyEval_RestoreThread(thread_);
}

bool is_ending() {
    return ending;
}

bool is_ending_beside(std::thread::id thread) {
    return ending && last_thread.load() != thread;
}

void watch_process() {
    keep_workers();
    pthread_atfork(before_fork, after_fork, in_child);
    nb::module_::import_("atexit").attr("register")(nb::cpp_function(at_exit));
}

}  // namespace dg::bind
