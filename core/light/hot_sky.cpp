#include "light/hot_sky.h"

#include <algorithm>

#include "light/environment_picture.h"

namespace dg {
namespace {

// What has less than this multiple of the mean is no bright spot.
constexpr double kHot = 4;

}  // namespace

HotSky::HotSky(const Environment& environment, std::span<const ViewCone> views)
    : environment_(environment) {
    if (environment.is_constant()) return;
    const Environment::Picture& p = *environment.picture_;
    if (!(p.total > 0)) return;
    strength_ = environment.mean_luminance() / (p.total / (4 * kPiD));
    const float spread = kPi / float(std::min(p.width / 2, p.height)) * 1.5f;   // of a cell, at least
    const auto seen = [&](Vec3f direction) {
        return std::ranges::any_of(views, [&](const ViewCone& view) {
            return view.sees_direction(environment.to_world(direction, view.time), spread);
        });
    };
    std::vector<std::uint32_t> visible;
    std::vector<double> weights;
    double sum = 0, solid_angle = 0;
    for (int r = 0; r <= p.height; ++r) {
        const double cell = 2 * kPiD / p.width * (double(p.cos_edge[r]) - p.cos_edge[r + 1]);
        for (int c = 0; c < p.width; ++c) {
            if (!seen(p.direction(c, r, 0.5f, 0.5f))) continue;
            visible.push_back(std::uint32_t(r) * p.width + c);
            weights.push_back(p.weight(c, r));
            sum += weights.back(), solid_angle += cell;
        }
    }
    std::vector<double> kept;
    for (std::size_t i = 0; i < visible.size(); ++i) {
        const int r = visible[i] / p.width;
        const double cell = 2 * kPiD / p.width * (double(p.cos_edge[r]) - p.cos_edge[r + 1]);
        if (!(weights[i] > kHot * cell * sum / solid_angle)) continue;
        index_.push_back(visible[i]);
        kept.push_back(weights[i]);
    }
    if (kept.empty()) return;
    cells_ = DiscreteDistribution(std::span<const double>(kept));
    hot_.resize(std::size_t(p.width) * (p.height + 1));
    for (const std::uint32_t i : index_) hot_[i] = true;
}

Environment::Sample HotSky::sample(Vec2f u, float time) const {
    const Environment::Picture& p = *environment_.picture_;
    const DiscreteSample cell = cells_.sample(u.x);
    const std::uint32_t at = index_[cell.index];
    const Vec3f d = p.sample_in(at % p.width, at / p.width, {cell.u_remapped, u.y});
    const Vec3f world = normalize(environment_.to_world(d, time));
    return {world, pdf(world, time)};   // of the direction as rounded
}

float HotSky::pdf(Vec3f direction, float time) const {
    if (cells_.empty()) return 0;
    const Environment::Picture& p = *environment_.picture_;
    const auto [c, r, luminance] = p.place(environment_.to_picture(direction, time));
    return hot_[std::size_t(r) * p.width + c] ? luminance / float(cells_.sum()) : 0;
}

}  // namespace dg
