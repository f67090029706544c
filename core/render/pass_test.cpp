#include "render/pass.h"

#include <doctest/doctest.h>

#include <atomic>
#include <mutex>
#include <set>

namespace dg {
namespace {

/// A pass that records the indices that it draws.
class Marker {
  public:
    static constexpr std::uint64_t kBlock = 7;
    struct Workspace {
        RenderCounters counters;
    };
    explicit Marker(std::vector<std::atomic<int>>& marks) : marks_(marks) {}
    void draw(Workspace& work, std::uint64_t first, std::uint64_t last) const {
        CHECK(last - first <= kBlock);
        for (std::uint64_t i = first; i < last; ++i) ++marks_[i];
        work.counters.rays += last - first;
    }

  private:
    std::vector<std::atomic<int>>& marks_;
};
static_assert(Draws<Marker>);

struct NoCounters {
    static constexpr std::uint64_t kBlock = 1;
    struct Workspace {};
    void draw(Workspace&, std::uint64_t, std::uint64_t) const {}
};
static_assert(!Draws<NoCounters>);

int marked(const std::vector<std::atomic<int>>& marks, std::size_t first, std::size_t last) {
    int wrong = 0;
    for (std::size_t i = 0; i < marks.size(); ++i) wrong += marks[i] != (i >= first && i < last ? 1 : 0);
    return wrong;
}

}  // namespace

TEST_CASE("each index of each pass is drawn once, by any number of threads") {
    for (const int threads : {1, 3}) {
        std::vector<std::atomic<int>> a(100), b(100), none(100), c(100);
        Passes passes;
        passes.add<Marker>({0, 100}, a);
        passes.add<Marker>({13, 41}, b);   // four full blocks
        passes.add<Marker>({5, 5}, none);
        passes.add<Marker>({99, 100}, c);
        std::mutex mutex;
        std::multiset<double> told;
        const RenderCounters counters = passes.draw(threads, [&](double done) {
            const std::scoped_lock lock(mutex);
            told.insert(done);
            return true;
        });
        CHECK(marked(a, 0, 100) == 0);
        CHECK(marked(b, 13, 41) == 0);
        CHECK(marked(none, 0, 0) == 0);
        CHECK(marked(c, 99, 100) == 0);
        CHECK(counters.rays == 129);
        CHECK(told.size() == 15 + 4 + 1);
        CHECK(*told.rbegin() == 1);
    }
}

TEST_CASE("a picture that is stopped draws nothing more") {
    std::vector<std::atomic<int>> marks(100);
    Passes passes;
    passes.add<Marker>({0, 100}, marks);
    int blocks = 0;
    const RenderCounters counters = passes.draw(1, [&](double) { return ++blocks < 3; });
    CHECK(blocks == 3);
    CHECK(counters.rays == 21);
}

TEST_CASE("counters of threads and passes add, each its own") {
    RenderCounters a{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    a += RenderCounters{10, 20, 30, 40, 50, 60, 70, 80, 90, 100};
    const RenderCounters sum{11, 22, 33, 44, 55, 66, 77, 88, 99, 110};
    CHECK(a.camera_rays == sum.camera_rays);
    CHECK(a.stopped_rays == sum.stopped_rays);
    CHECK(a.rays == sum.rays);
    CHECK(a.light_paths == sum.light_paths);
    CHECK(a.splats_off_film == sum.splats_off_film);
    CHECK(a.flare_paths == sum.flare_paths);
    CHECK(a.flare_rays == sum.flare_rays);
    CHECK(a.flare_hits == sum.flare_hits);
    CHECK(a.scatter_paths == sum.scatter_paths);
    CHECK(a.scatter_hits == sum.scatter_hits);
}

}  // namespace dg
