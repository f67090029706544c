// unlocked.h -- releases Python's lock during work in the core, and handles forks and the exit of Python.
#pragma once
#include <nanobind/nanobind.h>

#include <thread>

namespace dg::bind {

/// A scope without Python's lock; use it instead of nanobind::gil_scoped_release. Throws dg::Error if a fork during
/// work has made the core unusable (math/forks.h).
class Unlocked {
  public:
    Unlocked();
    ~Unlocked();
    Unlocked(const Unlocked&) = delete;
    Unlocked& operator=(const Unlocked&) = delete;

  private:
    PyThreadState* thread_;
};

/// Whether Python is exiting.
bool is_ending();
/// Whether Python is exiting in another thread, so that rendering in this thread stops. The exiting thread may render
/// in its exit handlers.
bool is_ending_beside(std::thread::id thread);

/// Registers handlers, once: ends oneTBB's threads before a fork, so that the child may start new threads, and waits
/// for daemon threads before Python exits, which would kill them inside C++ code.
void watch_process();

}  // namespace dg::bind
