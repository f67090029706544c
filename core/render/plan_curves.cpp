#include "render/plan_curves.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace dg {
namespace {

constexpr float kDark = 0.01f;      // of relative errors: variance / (value^2 + kDark)
constexpr double kFirst = 256;      // light paths of the smallest plan
constexpr double kSeenIn = 64;      // samples per pixel of a typical picture
constexpr int kReachOfSamples = 2, kReachOfArrivals = 1;   // radius of the blocks that are averaged, in blocks
constexpr int kEnoughArrivals = 4;  // for the mean of a single block

/// Calls visit(index, into) for each block and its neighbours up to `reach` blocks away.
template <typename Visit>
void around(std::size_t blocks, int columns, int reach, Visit visit) {
    const int rows = int(blocks) / columns;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            for (int v = std::max(0, y - reach); v <= std::min(rows - 1, y + reach); ++v)
                for (int u = std::max(0, x - reach); u <= std::min(columns - 1, x + reach); ++u)
                    visit(std::size_t(v) * columns + u, std::size_t(y) * columns + x);
}

struct Sum {
    Vec3f value{0, 0, 0};
    int blocks = 0;
};

/// Sums over each block and its neighbours.
std::vector<Sum> wide_sums(std::span<const Sum> sums, int columns, int reach) {
    std::vector<Sum> wide(sums.size());
    around(sums.size(), columns, reach, [&](std::size_t from, std::size_t into) {
        wide[into].value = wide[into].value + sums[from].value;
        ++wide[into].blocks;
    });
    return wide;
}

/// Sums over groups of paths, without each group in turn, and over all groups.
std::array<double, kGroups + 1> left_out(const std::array<double, kGroups>& groups) {
    std::array<double, kGroups + 1> sums;
    sums[kAll] = std::accumulate(groups.begin(), groups.end(), 0.0);
    for (int g = 0; g < kGroups; ++g) sums[g] = sums[kAll] - groups[g];
    return sums;
}

class CurveMaker {
  public:
    CurveMaker(const PilotArrivals& arrivals, std::span<const Vec3f> weights, double pixels)
        : arrivals_(arrivals), weights_(weights), pixels_(pixels), sums_(weights.size()) {}

    NoiseCurves make() {
        NoiseCurves curves{};
        if (arrivals_.all.empty()) return curves;
        for (int k = 0; k < kCandidates; ++k) add(curves, k);
        return curves;
    }

  private:
    /// Group of a light path: a run of consecutive indices, since these are stratified jointly.
    int group_of(const PilotArrival& a) const {
        return int(std::uint64_t(a.path) * kGroups / arrivals_.paths);
    }

    /// Adds S(m) - C(m)^2. C(m)^2 is estimated by products of different groups, which are independent.
    void add(NoiseCurves& curves, int k) {
        const double m = paths_of(k);
        std::ranges::fill(sums_, std::array<Vec3f, kGroups>{});
        std::array<double, kGroups> moments{}, squares{}, products{};
        for (const PilotArrival& a : arrivals_.all) {
            const int g = group_of(a);
            const double both = double(a.ratio) + m, left = double(a.ratio) + double(a.spread) * m;
            moments[g] += double(dot(a.value * a.value, weights_[a.block])) * left / (both * both);
            Vec3f& sum = sums_[a.block][g];
            sum = sum + a.value * float(double(a.ratio) / both);
        }
        double square = 0;   // square of the sum of all groups
        for (std::size_t b = 0; b < sums_.size(); ++b) {
            Vec3f all{0, 0, 0};
            for (const Vec3f& sum : sums_[b]) all = all + sum;
            square += double(dot(all * all, weights_[b]));
            for (int g = 0; g < kGroups; ++g) {
                squares[g] += double(dot(sums_[b][g] * sums_[b][g], weights_[b]));
                products[g] += double(dot(sums_[b][g] * all, weights_[b]));
            }
        }
        const auto second = left_out(moments), same = left_out(squares);
        const double paths = double(arrivals_.paths) / kGroups;   // per group
        for (int g = 0; g <= kAll; ++g) {
            const double n = g == kAll ? kGroups : kGroups - 1;
            const double with = g == kAll ? square : square - 2 * products[g] + squares[g];
            const double mean = (with - same[g]) / (n * (n - 1) * paths * paths * pixels_);
            curves[g][k] = std::max(0.0, second[g] / (n * paths) - mean);
        }
    }

    const PilotArrivals& arrivals_;
    std::span<const Vec3f> weights_;
    double pixels_;   // per block
    std::vector<std::array<Vec3f, kGroups>> sums_;
};

}  // namespace

double paths_of(int candidate) {
    return candidate == 0 ? 0 : std::round(kFirst * std::exp2(0.5 * (candidate - 1)));
}

std::vector<Vec3f> weights_of(const PilotPicture& picture, const PilotArrivals& straight) {
    std::vector<Sum> camera, light(picture.blocks.size());
    std::vector<int> arrived(light.size());
    for (const PilotBlock& block : picture.blocks) camera.push_back({block.mean, 1});
    const float share =
        float(1 / (picture.pixels * double(std::max<std::uint64_t>(1, straight.paths))));
    for (const PilotArrival& a : straight.all) {
        light[a.block].value = light[a.block].value + a.value * share;
        ++arrived[a.block];
    }
    const std::vector<Sum> smooth = wide_sums(camera, picture.columns, kReachOfSamples);
    const std::vector<Sum> nearby = wide_sums(light, picture.columns, kReachOfArrivals);
    std::vector<Vec3f> weights;
    for (std::size_t b = 0; b < light.size(); ++b) {
        const bool enough = arrived[b] >= kEnoughArrivals;
        const Vec3f straight_mean =
            enough ? light[b].value : nearby[b].value * (1 / float(nearby[b].blocks));
        Vec3f w = smooth[b].value * (1 / float(smooth[b].blocks)) + straight_mean;
        for (int c = 0; c < 3; ++c) w[c] = 1 / (w[c] * w[c] + kDark);
        weights.push_back(w);
    }
    return weights;
}

double rest_of(const PilotPicture& picture, std::span<const Vec3f> weights) {
    double sum = 0;
    for (std::size_t b = 0; b < weights.size(); ++b)
        sum += dot(picture.blocks[b].variance, weights[b]);
    return sum * picture.pixels;
}

std::vector<PilotArrival> seen(const PilotArrivals& arrivals, std::span<const Vec3f> weights) {
    std::vector<PilotArrival> all(arrivals.all.begin(), arrivals.all.end());
    const auto brightness = [&](const PilotArrival& a) {   // relative brightness for the camera
        return double(dot(a.value * a.value, weights[a.block])) / (double(a.ratio) * a.ratio);
    };
    std::ranges::sort(all, std::greater{}, brightness);
    double found = 0;   // expected number in a picture
    std::size_t k = 0;
    while (k < all.size() && found < 1) found += kSeenIn * all[k++].ratio / double(arrivals.paths);
    if (k > 0 && found >= 1) --k;
    all.erase(all.begin(), all.begin() + std::ptrdiff_t(k));
    return all;
}

NoiseCurves curves_of(const PilotArrivals& arrivals, std::span<const Vec3f> weights, double pixels) {
    return CurveMaker(arrivals, weights, pixels).make();
}

}  // namespace dg
