#include "render/dispersion.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace dg {
namespace {

// Smaller shares of a wavelength's light move to another pixel by Russian roulette, since adding to one more pixel
// costs time.
constexpr float kLeastShare = 0.25f;

}  // namespace

void Landings::add(Pixel pixel, int wavelength, float weight) {
    for (int i = 0; i < count_; ++i) {
        if (all_[i].pixel != pixel) continue;
        all_[i].weight.set(wavelength, all_[i].weight[wavelength] + weight);
        return;
    }
    all_[count_].pixel = pixel;
    all_[count_++].weight.set(wavelength, weight);
}

float Footprint::Axis::sum() const {
    float total = 0;
    for (int i = 0; i < count; ++i) total += std::abs(f[i]);
    return total;
}

void Footprint::fill(Axis& axis, const Filter& filter, float at, int first, int count) {
    const float r = filter.radius();
    const int whole = int(std::floor(at - r));
    axis.first = std::max(whole, first);
    const int end = std::min(int(std::floor(at + r)) + 1, first + count);
    axis.count = std::max(0, end - axis.first);
    if (axis.first == whole || axis.count == 0) return filter.axis(at - axis.first - 0.5f, axis.count, axis.f);
    // Sums start at the filter's extent instead of the region's, so that crops are bit-identical.
    float all[kReach];
    filter.axis(at - whole - 0.5f, end - whole, all);
    std::copy_n(all + (axis.first - whole), axis.count, axis.f);
}

void Footprint::expose(Axis& axis, const Shutter& shutter, float time) {
    for (int i = 0; i < axis.count; ++i) axis.f[i] *= shutter.opening(axis.first + i, time);
}

Footprint::Footprint(const FilmDensity& density, Vec2f px, float time) : density_(density) {
    const FilmLayout& region = density.region();
    fill(x_, density.filter(), px.x, region.offset_x, region.width);
    fill(y_, density.filter(), px.y, region.offset_y, region.height);
    if (const Shutter* shutter = density.rolling())
        expose(shutter->scans_columns() ? x_ : y_, *shutter, time);
    if (density.even()) {
        x_sum_ = x_.sum();
        total_ = x_sum_ * y_.sum();
    } else {
        for (int y = 0; y < y_.count; ++y)
            for (int x = 0; x < x_.count; ++x)
                total_ += density.count({x_.first + x, y_.first + y}) * std::abs(x_.f[x] * y_.f[y]);
    }
    per_total_ = total_ > 0 ? 1 / total_ : 0;
}

float Footprint::share(Pixel p) const {
    const float f = std::abs(x_.of(p.x) * y_.of(p.y));
    return f > 0 ? density_.count(p) * f * per_total_ : 0;
}

float Footprint::sign(Pixel p) const { return x_.of(p.x) * y_.of(p.y) < 0 ? -1.f : 1.f; }

Pixel Footprint::choose(Vec2f u) const {
    const auto row = [&](int y) {   // sum of n |f| over the row
        if (density_.even()) return std::abs(y_.f[y]) * x_sum_;
        float sum = 0;
        for (int x = 0; x < x_.count; ++x)
            sum += density_.count({x_.first + x, y_.first + y}) * std::abs(x_.f[x]);
        return std::abs(y_.f[y]) * sum;
    };
    const auto pick = [](int count, float left, const auto& weight) {
        int last = 0;
        for (int i = 0; i < count && left >= 0; ++i) {
            const float w = weight(i);
            if (w > 0) last = i, left -= w;
        }
        return last;
    };
    const int y = pick(y_.count, u.y * total_, row);
    const auto column = [&](int x) {
        return density_.count({x_.first + x, y_.first + y}) * std::abs(x_.f[x]);
    };
    float sum = x_sum_;
    if (!density_.even()) {
        sum = 0;
        for (int x = 0; x < x_.count; ++x) sum += column(x);
    }
    return {x_.first + pick(x_.count, u.x * sum, column), y_.first + y};
}

Pixel Footprint::choose_excess(const Footprint& other, Pixel own, float u) const {
    float excess[kReach * kReach];
    float rest = 0;
    int n = 0;
    for (int y = 0; y < y_.count; ++y) {
        const float here = y_.f[y] * per_total_,
                    there = other.y_.of(y_.first + y) * other.per_total_;
        for (int x = 0; x < x_.count; ++x) {
            const float more = std::abs(here * x_.f[x]) - std::abs(there * other.x_.of(x_.first + x));
            const float n_p = density_.count({x_.first + x, y_.first + y});
            rest += excess[n++] = std::max(0.f, n_p * more);
        }
    }
    float left = u * rest;
    Pixel chosen = own;
    for (int i = 0; i < n && left >= 0; ++i) {
        if (excess[i] <= 0) continue;
        chosen = {x_.first + i % x_.count, y_.first + i / x_.count};
        left -= excess[i];
    }
    return chosen;
}

Landings land(const FilmDensity& density, const Sensor& sensor, const Hero& hero,
              std::span<const Reprojection> others, float u) {
    const Footprint home(density, hero.px, hero.time);
    std::optional<Footprint> there[kWavelengths];
    float sum = home.total() / hero.aim_weight;
    for (int i = 1; i < kWavelengths; ++i) {
        const Reprojection& other = others[i - 1];
        if (other.aim_weight <= 0) continue;
        there[i].emplace(density, sensor.px_from_mm(other.film_mm), hero.time);
        sum += there[i]->total() / other.aim_weight;
    }
    Landings landings(hero.pixel);
    if (!(home.total() > 0)) return landings;   // at the instant at which its line opens
    const float scale = kWavelengths * density.integral() / sum;
    landings.add(hero.pixel, 0, home.sign(hero.pixel) * home.total() * scale *
                                    (hero.weight / hero.aim_weight));
    const float drawn = home.share(hero.pixel);
    for (int i = 1; i < kWavelengths; ++i) {
        if (!there[i] || there[i]->total() <= 0) continue;
        const float weight = there[i]->total() * scale * others[i - 1].transmittance;
        const auto add = [&](Pixel p, float share) {
            landings.add(p, i, there[i]->sign(p) * weight * share);
        };
        // The hero's pixel was drawn by its share at the hero's film point. The overlap with its share at this
        // wavelength's film point stays.
        const float overlap = drawn > 0 ? std::min(1.f, there[i]->share(hero.pixel) / drawn) : 0.f;
        if (overlap > 0) add(hero.pixel, overlap);
        const float moved = 1 - overlap, chance = std::min(1.f, moved / kLeastShare);
        if (u < chance)
            add(there[i]->choose_excess(home, hero.pixel, u / chance),
                std::max(moved, kLeastShare));
    }
    return landings;
}

}  // namespace dg
