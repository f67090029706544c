#include "render/dispersion.h"

#include <cmath>

namespace dg {
namespace {

/// Calls visit(pixel, |f|) for the region's pixels whose filter covers px.
template <typename Visit>
void for_each_pixel(const Filter& filter, const FilmLayout& region, Vec2f px, Visit visit) {
    const float r = filter.radius();
    const int x0 = std::max(int(std::floor(px.x - r)), region.offset_x);
    const int y0 = std::max(int(std::floor(px.y - r)), region.offset_y);
    const int x1 = std::min(int(std::floor(px.x + r)), region.offset_x + region.width - 1);
    const int y1 = std::min(int(std::floor(px.y + r)), region.offset_y + region.height - 1);
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x)
            visit(Pixel{x, y}, std::abs(filter.evaluate({px.x - x - 0.5f, px.y - y - 0.5f})));
}

}  // namespace

float FilmDensity::absolute_integral() const { return filter_.absolute_integral(); }

float FilmDensity::total(Vec2f px) const {
    const auto along = [&](float at, int first, int count) {
        const float r = filter_.radius();
        const int end = std::min(int(std::floor(at + r)), first + count - 1);
        float sum = 0;
        for (int i = std::max(int(std::floor(at - r)), first); i <= end; ++i)
            sum += std::abs(filter_.axis(at - i - 0.5f));
        return sum;
    };
    return along(px.x, region_.offset_x, region_.width) *
           along(px.y, region_.offset_y, region_.height);
}

float FilmDensity::of(Vec2f px, Pixel p) const {
    const bool inside = p.x >= region_.offset_x && p.x < region_.offset_x + region_.width &&
                        p.y >= region_.offset_y && p.y < region_.offset_y + region_.height;
    return inside ? std::abs(filter_.evaluate({px.x - p.x - 0.5f, px.y - p.y - 0.5f})) : 0;
}

float FilmDensity::sign(Vec2f px, Pixel p) const {
    return filter_.evaluate({px.x - p.x - 0.5f, px.y - p.y - 0.5f}) < 0 ? -1.f : 1.f;
}

std::optional<Pixel> FilmDensity::choose(Vec2f px, Vec2f kept_px, Pixel kept, float u) const {
    const float here = total(px), there = total(kept_px);
    if (here <= 0 || there <= 0) return std::nullopt;
    // Maximal coupling: keep with probability min(1, q/p), else draw from the part of q above p.
    const float p = of(kept_px, kept) / there, q = of(px, kept) / here;
    if (p > 0 && u * p < q) return kept;
    float rest = 0;
    const auto excess = [&](Pixel pixel, float f) {
        return std::max(0.f, f / here - of(kept_px, pixel) / there);
    };
    for_each_pixel(filter_, region_, px, [&](Pixel x, float f) { rest += excess(x, f); });
    // Conditional on not keeping, u is uniform above q/p: stretched to [0, rest) it serves again.
    const float keep = p > 0 ? std::min(1.f, q / p) : 0.f;
    float left = (u - keep) / std::max(1.f - keep, 1e-20f) * rest;
    std::optional<Pixel> chosen;
    for_each_pixel(filter_, region_, px, [&](Pixel x, float f) {
        const float e = excess(x, f);
        if (e <= 0 || left < 0) return;
        chosen = x;
        left -= e;
    });
    return chosen;
}

std::array<Landing, kWavelengths> land(const FilmDensity& density, const Sensor& sensor,
                                       const Hero& hero,
                                       std::span<const Reprojection> others, float u) {
    std::array<Landing, kWavelengths> landings;
    std::array<Vec2f, kWavelengths> px;
    std::array<float, kWavelengths> total;
    px[0] = hero.px;
    total[0] = density.total(hero.px);
    float sum = total[0] / hero.aim_weight;
    for (int i = 1; i < kWavelengths; ++i) {
        const Reprojection& other = others[i - 1];
        if (other.aim_weight <= 0) continue;
        px[i] = sensor.px_from_mm(other.film_mm);
        total[i] = density.total(px[i]);
        sum += total[i] / other.aim_weight;
    }
    const float scale = kWavelengths * density.absolute_integral() / sum;
    landings[0] = {hero.pixel, density.sign(hero.px, hero.pixel) * total[0] * scale *
                                   (hero.weight / hero.aim_weight)};
    for (int i = 1; i < kWavelengths; ++i) {
        const Reprojection& other = others[i - 1];
        if (other.aim_weight <= 0 || total[i] <= 0) continue;
        const auto pixel = density.choose(px[i], hero.px, hero.pixel, u);
        if (!pixel) continue;
        landings[i] = {*pixel, density.sign(px[i], *pixel) * total[i] * scale * other.transmittance};
    }
    return landings;
}

}  // namespace dg
