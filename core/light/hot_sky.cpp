#include "light/hot_sky.h"

#include <algorithm>

#include "light/environment_picture.h"

namespace dg {
namespace {

// Ratio to the mean above which a cell is a bright spot.
constexpr double kHot = 4;

}  // namespace

HotSky::HotSky(const Environment& environment, std::span<const ViewCone> views)
    : environment_(environment) {
    if (environment.is_constant()) return;
    const Environment::Picture& picture = *environment.picture_;
    const double total = picture.blocks.total();
    if (!(total > 0)) return;
    const SkyGrid& p = picture.grid;
    strength_ = environment.mean_luminance() / (total / (4 * kPiD));
    const float spread = kPi / float(std::min(p.width / 2, p.height)) * 1.5f;   // bound of a cell's size
    const auto in_view = [&](Vec3f direction) {
        return std::ranges::any_of(views, [&](const ViewCone& view) {
            return view.sees_direction(environment.to_world(direction, view.time), spread);
        });
    };
    std::vector<std::uint32_t> visible;
    std::vector<double> weights;
    double sum = 0, solid_angle = 0;
    for (int r = 0; r <= p.height; ++r) {
        const double cell = p.solid_angle(r);
        for (int c = 0; c < p.width; ++c) {
            if (!in_view(p.center(c, r))) continue;
            visible.push_back(std::uint32_t(r) * p.width + c);
            weights.push_back(p.weight(c, r));
            sum += weights.back(), solid_angle += cell;
        }
    }
    std::vector<double> kept;
    for (std::size_t i = 0; i < visible.size(); ++i) {
        const int r = visible[i] / p.width;
        const double cell = p.solid_angle(r);
        if (!(weights[i] > kHot * cell * sum / solid_angle)) continue;
        index_.push_back(visible[i]);
        kept.push_back(weights[i]);
    }
    if (kept.empty()) return;
    cells_ = DiscreteDistribution(std::span<const double>(kept));
    mark_hot();
}

void HotSky::mark_hot() {
    const SkyGrid& p = environment_.picture_->grid;
    std::vector<bool> hot(std::size_t(p.width) * (p.height + 1));
    for (const std::uint32_t i : index_) hot[i] = true;
    hot_ = std::make_shared<const std::vector<bool>>(std::move(hot));
}

std::vector<HotSky> HotSky::parts(int most) const {
    if (cells_.empty()) return {};
    const SkyGrid& p = environment_.picture_->grid;
    constexpr int kAcross = 16, kDown = 8;
    std::vector<std::vector<std::uint32_t>> members(kAcross * kDown);
    std::vector<double> weights(members.size());
    for (const std::uint32_t i : index_) {
        const int c = int(i % p.width), r = int(i / p.width);
        const std::size_t part = std::size_t(std::min(r * kDown / (p.height + 1), kDown - 1)) * kAcross +
                                 std::min(c * kAcross / p.width, kAcross - 1);
        members[part].push_back(i), weights[part] += p.weight(c, r);
    }
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < members.size(); ++i)
        if (!members[i].empty()) order.push_back(i);
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) { return weights[i]; });
    std::vector<HotSky> parts;
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool own = k + 1 < std::size_t(most) || k + 1 == order.size();
        if (own || k + 1 == std::size_t(most)) {
            parts.emplace_back(*this);
            parts.back().index_.clear();
        }
        auto& index = parts.back().index_;
        index.insert(index.end(), members[order[k]].begin(), members[order[k]].end());
    }
    for (HotSky& part : parts) {
        std::ranges::sort(part.index_);
        std::vector<double> kept;
        for (const std::uint32_t i : part.index_) kept.push_back(p.weight(i % p.width, i / p.width));
        part.cells_ = DiscreteDistribution(std::span<const double>(kept));
        part.mark_hot();
    }
    return parts;
}

Environment::Sample HotSky::sample(Vec2f u, float time) const {
    const SkyGrid& p = environment_.picture_->grid;
    const DiscreteSample cell = cells_.sample(u.x);
    const std::uint32_t at = index_[cell.index];
    const Vec3f d = p.sample_in(at % p.width, at / p.width, {cell.u_remapped, u.y}).direction;
    const Vec3f world = normalize(environment_.to_world(d, time));
    return {world, pdf(world, time)};   // for the rounded direction
}

float HotSky::pdf(Vec3f direction, float time) const {
    if (cells_.empty()) return 0;
    const SkyGrid& p = environment_.picture_->grid;
    const Vec3f d = environment_.to_picture(direction, time);
    const SkyGrid::Place at = p.place(p.texels(d));
    return (*hot_)[std::size_t(at.r) * p.width + at.c] ? p.weight(at, d) / float(cells_.sum()) : 0;
}

}  // namespace dg
