// parallel.h -- runs tasks on a limited number of threads.
#pragma once
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <cstdint>
#include <optional>

#include "math/cancel.h"

namespace dg {

/// Calls run(0), ..., run(tasks - 1) on `threads` threads; 0: all. Throws if the calling thread's task group was
/// cancelled, which skips tasks.
template <typename Run>
void parallel_tasks(int threads, std::int64_t tasks, const Run& run) {
    // TBB limits itself to the number of cores unless a higher limit is set.
    std::optional<oneapi::tbb::global_control> allowed;
    if (threads > oneapi::tbb::this_task_arena::max_concurrency())
        allowed.emplace(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    oneapi::tbb::task_arena arena(threads > 0 ? threads : oneapi::tbb::task_arena::automatic);
    const CancelToken* token = CancelScope::current();
    const auto task = [&](std::int64_t i) {
        const CancelScope scope(token);
        if (!is_cancelled()) run(i);
    };
    arena.execute([&] { oneapi::tbb::parallel_for(std::int64_t(0), tasks, task); });
    throw_if_cancelled();
}

}  // namespace dg
