#include "render/pass.h"

#include <atomic>

#include "render/parallel.h"

namespace dg {

RenderCounters Passes::draw(int threads, const std::function<bool(double)>& progress) {
    std::vector<std::int64_t> ends;   // cumulative number of blocks
    for (const auto& pass : passes_) ends.push_back((ends.empty() ? 0 : ends.back()) + pass->count());
    const std::int64_t blocks = ends.back();
    std::atomic<std::int64_t> done{0};
    std::atomic<bool> stop{false};
    parallel_tasks(threads, blocks, [&](std::int64_t block) {
        if (stop) return;
        const auto i = std::size_t(std::ranges::upper_bound(ends, block) - ends.begin());
        passes_[i]->draw(i ? block - ends[i - 1] : block);
        if (progress && !progress(double(++done) / double(blocks))) stop = true;
    });
    RenderCounters counters;
    for (const auto& pass : passes_)
        if (!stop) pass->finish(threads);
    for (const auto& pass : passes_) counters += pass->counters();
    return counters;
}

}  // namespace dg
