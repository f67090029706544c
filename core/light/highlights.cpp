#include "light/highlights.h"

#include <algorithm>
#include <cmath>

namespace dg {

std::optional<Vec2f> HighlightSpot::meet(const Ray& ray) const {
    const Vec3f way = frame.to_local(ray.direction), from = frame.to_local(ray.origin - anchor);
    if (!(way.z > 0)) return std::nullopt;
    const Vec2f s{way.x / way.z, way.y / way.z};
    const Vec2f at{s.x + nearness * (from.x - s.x * from.z), s.y + nearness * (from.y - s.y * from.z)};
    return at - velocity * (ray.time - 0.5f);
}

bool HighlightSpot::holds(const Ray& ray) const {
    const auto at = meet(ray);
    if (!at) return false;
    const Vec2f in = *at - low;
    return in.x >= 0 && in.y >= 0 && in.x < size.x && in.y < size.y;
}

/// A point on the spot's plane, or a direction for a spot at infinity.
EmitterPoint HighlightSpot::sample(Vec2f u, float time) const {
    const Sample2D s = weights.sample(u);
    const Vec2f t = Vec2f{low.x + size.x * s.x, low.y + size.y * s.y} + velocity * (time - 0.5f);
    const Vec3f way = frame.to_world({t.x, t.y, 1});
    const float pdf = s.pdf / (size.x * size.y), far = length(way);
    EmitterPoint from;
    from.at_infinity = nearness == 0;
    from.point = {.position = from.at_infinity ? way * (1 / far) : anchor + way * (1 / nearness),
                  .normal = frame.z * -1.f,
                  .pdf = pdf * (from.at_infinity ? far * far * far : nearness * nearness)};
    from.reflected = float(luminance * s.pdf);
    return from;
}

EmitterPoint HighlightTile::sample(Vec2f u) const {
    const Sample2D s = weights.sample(u);
    EmitterPoint from;
    from.at_infinity = true;
    from.point = {.position = tile.at({s.x, s.y}), .pdf = s.pdf / tile.solid_angle()};
    from.reflected = float(luminance * s.pdf);
    return from;
}

double Highlights::illuminance(int part) const {
    if (part < spots()) return spots_[part].luminance * spots_[part].solid_angle();
    const HighlightTile& tile = tiles_[part - spots()];
    return tile.luminance * tile.tile.solid_angle();
}

EmitterPoint Highlights::sample(int part, Vec2f u, float time) const {
    return part < spots() ? spots_[part].sample(u, time) : tiles_[part - spots()].sample(u);
}

bool Highlights::owns(int part, const Ray& ray) const {
    return !held(std::span(spots_).first(std::size_t(std::min(part, spots()))), ray);
}

bool held(std::span<const HighlightSpot> spots, const Ray& ray) {
    return std::ranges::any_of(spots, [&](const HighlightSpot& spot) { return spot.holds(ray); });
}

}  // namespace dg
