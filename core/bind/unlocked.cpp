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

/// A worker that goes to sleep holds locks of oneTBB for a moment; one that has ended holds none.
void before_fork() {
    if (forks::working != 0 || forks::torn) return;
    oneapi::tbb::task_scheduler_handle workers{oneapi::tbb::attach{}};
    oneapi::tbb::finalize(workers, std::nothrow);   // false: another thread still refers to them, asleep
}

void in_child() {
    if (forks::working.exchange(0) != 0) forks::torn = true;
    nb::set_leak_warnings(false);   // the parent's other threads keep what they referred to
}

/// At the end of Python a thread that asked for its lock would be ended there and then, and C++ with it.
void park_if_ending() {
    if (!is_ending_beside(std::this_thread::get_id())) return;
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

Work::Work() {
    park_if_ending();
    if (forks::torn)
        throw Error("this process was forked while its parent drew, and would wait for threads that it does not "
                    "have: start processes by spawn or forkserver, or fork before anything is drawn");
    ++forks::working;
}

Work::~Work() {
    --forks::working;
    park_if_ending();
}

bool is_ending() {
    return ending;
}

bool is_ending_beside(std::thread::id thread) {
    return ending && last_thread.load() != thread;
}

void watch_process() {
    pthread_atfork(before_fork, nullptr, in_child);
    nb::module_::import_("atexit").attr("register")(nb::cpp_function(at_exit));
}

}  // namespace dg::bind
