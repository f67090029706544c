#include "render/flare/live/ghost_place.h"

#include <algorithm>

namespace dg {
namespace {

void add(GhostPlace::Spectrum& sum, const GhostPlace::Spectrum& other, float weight) {
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * other[k];
}

FlareRectangle between(const FlareRectangle& a, const FlareRectangle& b, float w) {
    return {(1 - w) * a.low + w * b.low, (1 - w) * a.size + w * b.size};
}

bool meet(const FlareRectangle& a, const FlareRectangle& b) {
    return a.low.x < b.low.x + b.size.x && b.low.x < a.low.x + a.size.x && a.low.y < b.low.y + b.size.y &&
           b.low.y < a.low.y + a.size.y;
}

}  // namespace

GhostPlace::Spectrum GhostPlace::spectrum(Vec2f u) const {
    const float end = float(side - 1), x = std::clamp(u.x, 0.f, 1.f) * end, y = std::clamp(u.y, 0.f, 1.f) * end;
    const int column = std::min(int(x), side - 2), row = std::min(int(y), side - 2);
    const float fx = x - float(column), fy = y - float(row);
    Spectrum sum{};
    for (int k = 0; k < 4; ++k)
        add(sum, spectra[std::size_t(row + (k >> 1)) * side + column + (k & 1)], (k & 1 ? fx : 1 - fx) * (k & 2 ? fy : 1 - fy));
    return sum;
}

KnownGhost::KnownGhost(std::shared_ptr<const GhostPlace> a, std::shared_ptr<const GhostPlace> b, float weight_of_b)
    : places{std::move(a), std::move(b)}, weight(!places[0] ? 1 : !places[1] ? 0 : weight_of_b),
      region(between((places[0] ? places[0] : places[1])->region, (places[1] ? places[1] : places[0])->region, weight)),
      share(std::max(places[0] ? places[0]->share : 0, places[1] ? places[1]->share : 0)) {}

bool KnownGhost::jumps() const {
    return places[0] && places[1] && !meet(places[0]->region, places[1]->region);
}

GhostPlace::Spectrum KnownGhost::spectrum(Vec2f at) const {
    GhostPlace::Spectrum sum{};
    const Vec2f u = region.in(at);
    if (weight < 1) add(sum, places[0]->spectrum(u), 1 - weight);
    if (weight > 0) add(sum, places[1]->spectrum(u), weight);
    return sum;
}

}  // namespace dg
