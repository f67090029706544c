// thread_scratch.h -- large buffers that a thread keeps from call to call.
#pragma once
#include <memory>

namespace dg {

/// Returns a T of this thread, made when it is first asked for here. `here` is `[] {}`: it gives each place its own.
///
/// On the heap: the C library ends the process if it has no memory for what threads hold themselves.
template <typename T, typename Here>
T& thread_scratch(Here /*here*/) {
    thread_local const auto own = std::make_unique<T>();
    return *own;
}

}  // namespace dg
