#include "render/plan_choice.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dg {
namespace {

constexpr float kDark = 0.01f;      // of relative errors: (value^2 + kDark)
constexpr int kCandidates = 18;     // 0, then powers of two
constexpr double kFirst = 256;      // the least plan that is no trifle
constexpr int kHalves = 2;
constexpr double kWorthBounced = 3;   // times the gain without them: what they promise is seldom all theirs
// A sample with light paths may cost twice what it costs without: who asks for so many samples has a time in
// mind, and rare light (caustics) would ask for light paths without end.
constexpr double kMostCost = 2;

double paths_of(int candidate) {
    return candidate == 0 ? 0 : kFirst * std::exp2(candidate - 1);
}

/// Sum over pixels and channels of V(m) / (mean^2 + kDark), for every candidate.
using Curve = std::array<double, kCandidates>;

/// The mean of each block with what arrives straight from emitters, as 1 / (mean^2 + kDark).
std::vector<Vec3f> weights_of(std::span<const PilotBlock> blocks, double pixels,
                              const PilotArrivals& straight) {
    std::vector<Vec3f> weights;
    weights.reserve(blocks.size());
    for (const PilotBlock& block : blocks) weights.push_back(block.mean);
    const float share = float(1 / (pixels * double(std::max<std::uint64_t>(1, straight.paths))));
    for (const PilotArrival& a : straight.all) weights[a.block] = weights[a.block] + a.value * share;
    for (Vec3f& w : weights)
        for (int c = 0; c < 3; ++c) w[c] = 1 / (w[c] * w[c] + kDark);
    return weights;
}

double rest_of(std::span<const PilotBlock> blocks, std::span<const Vec3f> weights, double pixels) {
    double sum = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b) sum += dot(blocks[b].variance, weights[b]);
    return sum * pixels;
}

/// S(m), of every other arrival.
double second_moment(const PilotArrivals& arrivals, std::span<const Vec3f> weights, double m, int half) {
    double sum = 0;
    for (std::size_t i = half; i < arrivals.all.size(); i += kHalves) {
        const PilotArrival& a = arrivals.all[i];
        const double both = double(a.ratio) + m, squares = double(a.ratio) + double(a.spread) * m;
        sum += double(dot(a.value * a.value, weights[a.block])) * squares / (both * both);
    }
    return sum * kHalves / double(arrivals.paths);
}

/// C(m)^2, the product of two independent estimates.
double squared_means(const PilotArrivals& arrivals, std::span<const Vec3f> weights, double pixels, double m) {
    std::vector<std::array<Vec3f, kHalves>> sums(weights.size());
    for (std::size_t i = 0; i < arrivals.all.size(); ++i) {
        const PilotArrival& a = arrivals.all[i];
        Vec3f& sum = sums[a.block][i % kHalves];
        sum = sum + a.value * float(double(a.ratio) / (double(a.ratio) + m));
    }
    double total = 0;
    for (std::size_t b = 0; b < sums.size(); ++b)
        total += double(dot(sums[b][0] * sums[b][1], weights[b]));
    const double share = kHalves / double(arrivals.paths);
    return total * share * share / pixels;   // pixels x (sum / pixels)^2
}

Curve curve_of(const PilotArrivals& arrivals, std::span<const Vec3f> weights, double pixels, int half) {
    Curve curve{};
    if (arrivals.all.empty()) return curve;
    for (int k = 0; k < kCandidates; ++k) {
        const double m = paths_of(k);
        const double v = second_moment(arrivals, weights, m, half) -
                         squared_means(arrivals, weights, pixels, m);
        curve[k] = std::max(0.0, v);
    }
    return curve;
}

/// Without the hundredth that the camera would suffer most: light after bounces has rare bright arrivals of all
/// kinds, each of which alone would ask for more paths than all others.
std::vector<PilotArrival> without_rare(const PilotArrivals& arrivals, std::span<const Vec3f> weights) {
    const auto suffered = [&](const PilotArrival& a) {
        return double(dot(a.value * a.value, weights[a.block])) / double(a.ratio);
    };
    std::vector<double> order;
    for (const PilotArrival& a : arrivals.all) order.push_back(suffered(a));
    if (order.empty()) return {};
    const auto limit = order.begin() + std::ptrdiff_t(order.size() - 1 - order.size() / 100);
    std::ranges::nth_element(order, limit);
    std::vector<PilotArrival> kept;
    for (const PilotArrival& a : arrivals.all)
        if (suffered(a) <= *limit) kept.push_back(a);
    return kept;
}

/// Error and cost of each pair of candidates, as one half of the arrivals has it.
struct Judge {
    Curve straight, bounced;
    double rest;   // variance of what the camera finds beside the straight

    double error(int k1, int k2) const {
        // The camera's few samples may have missed what it finds rarely.
        const double others = std::max(rest, bounced[0]);
        return straight[k1] + others - (bounced[0] - bounced[k2]);
    }
    /// Of two costs; see cost_of.
    double gain(int k1, int k2, double without, double with) const {
        return error(0, 0) * without / std::max(1e-300, error(k1, k2) * with);
    }
};

/// A sample of every pixel, with its light paths.
double cost_of(int k1, int k2, const PlanCosts& c) {
    const double light = c.straight * paths_of(k1) + c.bounced * paths_of(k2);
    const double sharing = (k1 + k2 > 0 ? c.sharing : 0) + (k2 > 0 ? c.sharing_bounced : 0);
    return c.camera + light + sharing;
}

}  // namespace

LightPlan choose_plan(std::span<const PilotBlock> blocks, double pixels, const PilotArrivals& straight,
                      const PilotArrivals& bounced, const PlanCosts& costs) {
    const std::vector<Vec3f> weights = weights_of(blocks, pixels, straight);
    const std::vector<PilotArrival> usual = without_rare(bounced, weights);
    std::array<Judge, kHalves> judges;
    for (int half = 0; half < kHalves; ++half)
        judges[half] = {curve_of(straight, weights, pixels, half),
                        curve_of({usual, bounced.paths}, weights, pixels, half),
                        rest_of(blocks, weights, pixels)};
    LightPlan best;
    double best_gain = kWorth;
    for (int k2 = 0; k2 < (bounced.all.empty() ? 1 : kCandidates); ++k2) {
        if (k2 == 1) best_gain *= kWorthBounced;
        for (int k1 = 0; k1 < (straight.all.empty() ? 1 : kCandidates); ++k1) {
            const double cost = cost_of(k1, k2, costs);
            if (cost > kMostCost * costs.camera) continue;
            double gain = judges[0].gain(k1, k2, costs.camera, cost);
            for (const Judge& judge : judges)
                gain = std::min(gain, judge.gain(k1, k2, costs.camera, cost));
            if (gain <= best_gain) continue;
            best_gain = gain;
            best = {paths_of(k1), paths_of(k2)};
        }
    }
    return best;
}

}  // namespace dg
