// unlocked.h -- work in the core while other threads of Python run; what a fork, and the end of Python, make of it.
#pragma once
#include <nanobind/nanobind.h>

#include <thread>

namespace dg::bind {

/// A scope of work without Python's lock; use it instead of nanobind::gil_scoped_release. Throws dg::Error where
/// a fork has torn the core (math/forks.h).
class Unlocked {
  public:
    Unlocked();
    ~Unlocked();
    Unlocked(const Unlocked&) = delete;
    Unlocked& operator=(const Unlocked&) = delete;

  private:
    PyThreadState* thread_;
};

/// Whether Python is about to end.
bool is_ending();
/// Whether Python is about to end in another thread than this one: what it draws stops. The thread in which
/// Python ends may draw, in functions that it calls at its exit.
bool is_ending_beside(std::thread::id thread);

/// Sends the threads of oneTBB home before a fork, so that the child may start its own; and waits for
/// daemon threads before Python ends, which would end them in the middle of C++. Called once.
void watch_process();

}  // namespace dg::bind
