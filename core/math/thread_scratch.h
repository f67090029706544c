// thread_scratch.h -- large buffers that a thread reuses between calls.
#pragma once
#include <memory>

namespace dg {

/// Returns a T of this thread, created on first use. `here` is `[] {}`, a distinct type per call
/// site, so that each has a separate buffer.
///
/// The buffer is on the heap: the C library ends the process when it cannot allocate thread-local
/// memory.
template <typename T, typename Here>
T& thread_scratch(Here /*here*/) {
    thread_local const auto own = std::make_unique<T>();
    return *own;
}

}  // namespace dg
