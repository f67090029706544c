#include "render/plan_choice.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "math/hash.h"
#include "math/statistics.h"

using namespace dg;

namespace {

constexpr double kPixels = 36;   // per block
constexpr int kBlocks = 400, kColumns = 20;

float uniform(std::uint64_t a, std::uint64_t b) { return float(hash_uniform(a, b)); }

/// A lamp with a disc that covers `lit` blocks evenly; a camera sample in these blocks hits the lamp with probability
/// p.
struct Disc {
    int lit;
    double p;        // probability that a camera sample of a lit pixel hits the lamp
    double mean;     // value of a lit pixel
    double share;    // fraction of light paths that reach the film

    double pixels() const { return lit * kPixels; }
    /// A light path adds to one lit pixel, to each with probability share / pixels.
    PilotArrival arrival(std::uint32_t block, std::uint32_t path = 0) const {
        const double light = share / pixels();           // probability per path of hitting a given pixel
        const float y = float(mean / light);
        return {block, {y, y, y}, float(p / light), 1, path};
    }
    double variance(double m) const {   // variance of a sample, summed over the lit pixels
        const double light = share / pixels(), y = mean / light, r = p / light;
        return pixels() * light * y * y / (r + m) - pixels() * std::pow(mean * r / (r + m), 2);
    }
    std::vector<PilotArrival> arrivals(int paths) const {
        std::vector<PilotArrival> all;
        for (int i = 0; i < paths; ++i)
            if (uniform(1, i) < share) all.push_back(arrival(std::uint32_t(uniform(2, i) * float(lit)), std::uint32_t(i)));
        return all;
    }
};

std::vector<PilotBlock> even_blocks(float mean, float variance) {
    return std::vector<PilotBlock>(
        kBlocks, {{mean, mean, mean}, {variance, variance, variance}});
}

PilotPicture picture(const std::vector<PilotBlock>& blocks) { return {blocks, kColumns, kPixels}; }

LightPlan plan_of(const std::vector<PilotBlock>& blocks, const PilotArrivals& straight, const PilotArrivals& bounced,
                  const PlanCosts& costs) {
    return choose_plan(picture(blocks), straight, bounced, costs).plan;
}

}  // namespace

TEST_CASE("plan choice: second moments of both techniques are what drawing them gives") {
    const Disc disc{4, 0.02, 2.0, 0.5};
    for (const double m : {0.0, 64.0, 512.0}) {
        const PilotArrival a = disc.arrival(0);
        const double weight_light = m / (a.ratio + m), weight_camera = a.ratio / (a.ratio + m);
        std::vector<double> values;   // one pixel, with camera sample and light paths
        for (int i = 0; i < 200'000; ++i) {
            double v = uniform(3, i) < disc.p ? disc.mean / disc.p * weight_camera : 0;
            // The number of arrivals at a pixel is binomial; it is so small that one Bernoulli trial approximates it.
            const double chance = m * disc.share / disc.pixels();
            double left = chance;
            for (int k = 0; left > 0; ++k, left -= 0.25)
                if (uniform(100 + k, i) < std::min(left, 0.25)) v += a.value.x / m * weight_light;
            values.push_back(v);
        }
        const auto found = moments(values);
        CHECK(found.mean == doctest::Approx(disc.mean).epsilon(0.04));
        // With a probability of 1/4 at most, the variance is about an eighth below that of independent arrivals.
        const double expected = disc.variance(m) / disc.pixels();
        CHECK(found.variance == doctest::Approx(expected).epsilon(0.2));
    }
}

TEST_CASE("plan choice: rare lamps get as many paths as the closed form wants") {
    const Disc disc{20, 1.0 / 400, 2.0, 0.4};
    const float rest = 1e-3f;
    const std::vector<PilotBlock> blocks = even_blocks(0.1f, rest);
    const std::vector<PilotArrival> all = disc.arrivals(40'000);
    for (const double cost : {2e-6, 2e-5, 2e-4}) {   // at most four times the cost of a sample
        const LightPlan plan = plan_of(blocks, {all, 40'000}, {}, {.straight = cost, .bounced = cost});
        const double dark = kBlocks * kPixels * rest / (0.01 + 0.01);   // counts the few lit blocks, too
        const double lit = std::pow(2.1, 2) + 0.01;
        double best = 1e300, wanted = 0;
        for (double m = 256; cost * m < 3; m *= 2) {
            const double total = (dark + disc.variance(m) / lit) * (1 + cost * m);
            if (total < best) best = total, wanted = m;
        }
        CHECK(plan.m1 >= wanted / 2);
        CHECK(plan.m1 <= wanted * 2);
        CHECK(plan.m2 == 0);
    }
}

constexpr PlanCosts kCheap{.straight = 1e-5, .bounced = 1e-5};

TEST_CASE("plan choice: no paths where they gain nothing") {
    CHECK(plan_of(even_blocks(1, 0.3f), {}, {}, kCheap).off());

    // A large emitter that every camera sample hits.
    const Disc broad{kBlocks, 1.0, 1.0, 0.5};
    const std::vector<PilotArrival> many = broad.arrivals(20'000);
    CHECK(plan_of(even_blocks(0, 0.1f), {many, 20'000}, {}, kCheap).off());
    CHECK(plan_of(even_blocks(1, 0.3f), {}, {many, 20'000}, kCheap).off());
}

TEST_CASE("plan choice: what the camera finds rarely is noise, however few samples have met it") {
    // Samples of 2, one in 22, where the mean is 0.09: relative variance 10 per channel, not 2.
    std::vector<PilotBlock> sparks(kBlocks);
    for (int b = 0; b < kBlocks; b += 11) sparks[b] = {{1, 1, 1}, {2, 2, 2}};
    const Disc disc{6, 1.0 / 40, 2.0, 0.4};
    const std::vector<PilotArrival> all = disc.arrivals(40'000);
    CHECK(plan_of(sparks, {all, 40'000}, {}, kCheap).off());   // fireflies would remain
    CHECK(plan_of(even_blocks(0.1f, 1e-3f), {all, 40'000}, {}, kCheap).m1 > 0);
}

TEST_CASE("plan choice: no paths for one that was lucky") {
    const std::vector<PilotBlock> blocks = even_blocks(1, 0.01f);
    // A bright path that the camera finds rarely: plans would gain if more than one light path found it.
    std::vector<PilotArrival> lucky;
    for (int k = 0; k < 10; ++k) lucky.push_back({0, {1e5f, 1e5f, 1e5f}, 200, 1, 77});
    CHECK(plan_of(blocks, {}, {lucky, 20'000}, kCheap).off());
    CHECK(plan_of(blocks, {lucky, 20'000}, {}, kCheap).off());
    for (int k = 0; k < 10; ++k) lucky[k].path = k * 2000;
    CHECK(plan_of(blocks, {}, {lucky, 20'000}, kCheap).m2 > 0);
    // Brighter paths that occur only in few pictures.
    for (PilotArrival& a : lucky) a.ratio = 1;
    CHECK(plan_of(blocks, {}, {lucky, 20'000}, kCheap).off());

    const Disc caustic{3, 1e-3, 1, 0.2};
    const std::vector<PilotArrival> bright = caustic.arrivals(20'000);
    const LightPlan plan = plan_of(blocks, {}, {bright, 20'000}, kCheap);
    CHECK(plan.m1 == 0);
    CHECK(plan.m2 > 0);
}

TEST_CASE("plan choice: few arrivals leave a gain open, many decide it") {
    const Disc caustic{3, 2e-3, 1, 0.2};
    const std::vector<PilotBlock> blocks = even_blocks(1, 0.01f);
    const auto choice = [&](int paths) {
        const std::vector<PilotArrival> all = caustic.arrivals(paths);
        return choose_plan(picture(blocks), {}, {all, std::uint64_t(paths)}, kCheap);
    };
    CHECK_FALSE(choice(8).sure);
    CHECK(choice(8).plan.off());
    CHECK(choice(20'000).sure);
    CHECK(choice(20'000).plan.m2 > 0);
    CHECK(choose_plan(picture(blocks), {}, {}, kCheap).sure);
}
