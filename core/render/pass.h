// pass.h -- a technique that adds light to the film: camera paths, light paths directly to the lens or over surfaces,
// ghosts, scattering in the lens. A pass is drawn in blocks, in any order and by any thread; film sums are exact, so
// the result is bit-identical.
//
// To add a pass, write a class that satisfies Draws, and list it in render.cpp or emitter_passes.cpp.
#pragma once
#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "render/dispersion.h"
#include "render/render.h"

namespace dg {

/// Scene, camera, film and settings that passes share. They must outlive the passes.
struct Picture {
    const Scene& scene;
    const Camera& camera;
    Film& film;
    const RenderSettings& settings;
    const FilmDensity& density;
};

/// Half-open range of indices of tiles or paths.
using IndexRange = std::array<std::uint64_t, 2>;

/// Concept of a pass: draw(work, first, last) draws the indices [first, last) with the buffers of a thread; kBlock
/// indices form a task. finish(threads) is optional and is called after the last task.
template <typename D>
concept Draws = requires(const D& drawer, typename D::Workspace& work, std::uint64_t index) {
    { D::kBlock } -> std::convertible_to<std::uint64_t>;
    drawer.draw(work, index, index);
    { work.counters } -> std::convertible_to<const RenderCounters&>;
};

class Pass {
  public:
    virtual ~Pass() = default;
    /// Number of blocks.
    virtual std::int64_t count() const = 0;
    /// Draws a block; each block is drawn once, by any thread.
    virtual void draw(std::int64_t block) = 0;
    /// Adds buffered light to the film. Called once, after the last block.
    virtual void finish(int threads) = 0;
    /// Sums over all threads. Called after the last block.
    virtual RenderCounters counters() const = 0;
};

template <Draws D>
class PassOf final : public Pass {
  public:
    template <typename... Args>
    explicit PassOf(IndexRange range, Args&&... args) : range_(range), drawer_(std::forward<Args>(args)...) {}

    std::int64_t count() const override {
        return std::int64_t((range_[1] - range_[0] + D::kBlock - 1) / D::kBlock);
    }
    void draw(std::int64_t block) override {
        const std::uint64_t first = range_[0] + std::uint64_t(block) * D::kBlock;
        drawer_.draw(workspaces_.local(), first, std::min(first + D::kBlock, range_[1]));
    }
    void finish(int threads) override {
        if constexpr (requires { drawer_.finish(threads); }) drawer_.finish(threads);
    }
    RenderCounters counters() const override {
        RenderCounters sum;
        for (const typename D::Workspace& work : workspaces_) sum += work.counters;
        return sum;
    }

  private:
    IndexRange range_;
    D drawer_;
    oneapi::tbb::enumerable_thread_specific<typename D::Workspace> workspaces_;
};

/// All passes of a picture.
class Passes {
  public:
    /// Adds a pass over a range of indices; `args` are forwarded to its constructor.
    template <Draws D, typename... Args>
    void add(IndexRange range, Args&&... args) {
        passes_.push_back(std::make_unique<PassOf<D>>(range, std::forward<Args>(args)...));
    }
    void add(std::unique_ptr<Pass> pass) { passes_.push_back(std::move(pass)); }
    /// See render().
    RenderCounters draw(int threads, const std::function<bool(double)>& progress);

  private:
    std::vector<std::unique_ptr<Pass>> passes_;
};

}  // namespace dg
