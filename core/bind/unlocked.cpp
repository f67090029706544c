// unlocked.cpp -- handlers before a fork, in the child, and at the exit of Python.
#include "bind/unlocked.h"

#include <pthread.h>
#include <unistd.h>

#define TBB_PREVIEW_WAITING_FOR_WORKERS 1   // its name before oneTBB 2021.9
#include <oneapi/tbb/global_control.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <thread>

#include "math/error.h"
#include "math/forks.h"

namespace nb = nanobind;

namespace dg::bind {

namespace {

std::atomic<bool> ending{false};
std::atomic<std::thread::id> last_thread{};   // the thread in which Python exits
const std::thread::id first_thread = std::this_thread::get_id();   // the thread that imports the core

using Workers = oneapi::tbb::task_scheduler_handle;

/// Keeps oneTBB's workers alive while no Python thread refers to them. Never destroyed, as destruction takes locks.
Workers* const kept_workers = new Workers;
bool ended = false;           // whether the workers ended before this fork
thread_local int depth = 0;   // nested `Unlocked` scopes of this thread, through callbacks

void keep_workers() {
    *kept_workers = Workers{oneapi::tbb::attach{}};
}

/// Drops this thread's reference to the workers, so that they can end while the thread lives. Otherwise a fork while
/// the thread sleeps would leave them running, and a worker that goes to sleep holds a lock that the child waits for.
/// The first thread keeps its reference, as oneTBB would query its stack again, for which glibc parses the memory map
/// (0.4 ms).
void detach_thread() {
    if (std::this_thread::get_id() == first_thread) return;
    Workers here{oneapi::tbb::attach{}};
    oneapi::tbb::finalize(here, std::nothrow);   // false: other references remain
}

/// Ends the workers, since a worker that goes to sleep briefly holds locks of oneTBB.
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
    nb::set_leak_warnings(false);   // references of the parent's other threads remain
}

/// Ends a torn child without the destructors of the libraries loaded before this one. Embree's mutexes may be locked by
/// threads that the child lacks, and their destructors would abort. Runs before those, as it is registered after them.
void leave(int status, void*) {
    if (!forks::torn) return;
    std::fflush(nullptr);
    ::_exit(status);
}

/// When Python exits, a thread that requests its lock would be killed, inside C++ code.
void park() {
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

void at_exit() {
    last_thread = std::this_thread::get_id();
    ending = true;
    // References of daemon threads remain, which is no leak.
    if (nb::len(nb::module_::import_("sys").attr("_current_frames")()) > 1) nb::set_leak_warnings(false);
    const nb::gil_scoped_release release;
    while (forks::working != 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace

// Counts while Python's lock is held: as a fork holds the lock, it finds each thread either before or inside its work.
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
    on_exit(leave, nullptr);
    nb::module_::import_("atexit").attr("register")(nb::cpp_function(at_exit));
}

}  // namespace dg::bind
