#include "render/flare/maps/map_rays.h"

#include <algorithm>
#include <cmath>

#include "geometry/ray.h"
#include "math/across.h"
#include "math/thread_scratch.h"
#include "render/flare/flare_aim.h"

namespace dg {

Vec3d MapSource::point(Vec2f shift) const {
    const double far = at_infinity ? 1 : length(middle);
    const Vec3d e = middle / far;
    const Across across(e);
    const Vec3d p = far * e + radius * (double(shift.x) * across.x + double(shift.y) * across.y);
    return at_infinity ? normalize(p) : p;
}

Vec2f MapSource::shift_of(Vec3d point) const {
    if (!(radius > 0)) return {0, 0};
    const double far = at_infinity ? 1 : length(middle);
    const Vec3d e = middle / far;
    const Across across(e);
    const Vec3d p = point * (far / dot(point, e));   // on the plane through the source's center
    return {float(dot(p, across.x) / radius), float(dot(p, across.y) / radius)};
}

MapRays::MapRays(const Camera& camera, const Sensor& sensor, const GhostLens& ghosts,
                 const std::vector<GhostStep>& steps, const MapSource& source)
    : lens_(std::get<ExactLens>(camera.lens)), camera_(camera), sensor_(sensor), ghosts_(ghosts), steps_(steps),
      source_(source), crossings_(dg::crossings(ghosts, steps)),
      per_iris2_(float(1 / std::pow(ghosts.iris_radius() * ghosts.iris().outer_radius(), 2))), front_(lens_.front_ball()),
      turn_x_(front_.radius * std::cos(source.turn)), turn_y_(front_.radius * std::sin(source.turn)) {}

/// The square perpendicular to the direction from the center of the front to a source point.
MapRays::Front MapRays::front(Vec2f shift) const {
    const Vec3d p = source_.point(shift), e = source_.at_infinity ? p : normalize(p - front_.center);
    const Across across(e);
    if (source_.turn == 0) return {p, e, front_.radius * across.x, front_.radius * across.y};
    return {p, e, turn_x_ * across.x + turn_y_ * across.y, turn_x_ * across.y - turn_y_ * across.x};
}

MapRays::Line MapRays::line(const Front& front, Vec2f at) const {
    const Vec3d q = front_.center + double(at.x) * front.x + double(at.y) * front.y;
    return {q, source_.at_infinity ? front.toward : normalize(front.point - q)};
}

std::optional<Ray> MapRays::shadow(const MapRay& ray, const EmitterPoint& from, float time) const {
    const Line l = line(front(ray.shift), ray.at);
    const auto start = lens_.start(l.place, l.direction);
    if (!start) return std::nullopt;
    const Ray own{.origin = to_float(*start), .direction = to_float(l.direction), .time = time};
    const Ray shadow = flare_shadow(from, to_world(camera_, own));
    return is_traceable(shadow) ? std::optional(shadow) : std::nullopt;
}

float MapRays::stopped(const MapLanding& l) const {
    float most = l.beyond;
    if (l.sound)
        for (int k = 0; k < crossings(); ++k) most = std::max(most, length_squared(l.iris[k]) * per_iris2_ - 1);
    return most;
}

float MapRays::passed(const MapLanding& l, float iris_opening) const {
    if (!l.sound || !(l.beyond < 0)) return 0;
    const double per_radius = 1 / (ghosts_.iris_radius() * double(iris_opening));
    double pass = l.pass;
    for (int k = 0; k < crossings(); ++k)
        pass *= ghosts_.iris().transmission(Vec2d{l.iris[k].x, l.iris[k].y} * per_radius);
    return float(pass);
}

std::vector<MapLanding> MapRays::trace(std::span<const MapRay> rays) const {
    OpenLandings& open = thread_scratch<OpenLandings>([] {});
    std::vector<MapLanding> landings(rays.size());
    std::vector<CameraRay> some;
    std::vector<float> nm;
    const Vec2f shift = setting_at(camera_, 0.5f).film_shift_mm;
    for (std::size_t begin = 0; begin < rays.size(); begin += kLensBatch) {
        const std::size_t count = std::min<std::size_t>(kLensBatch, rays.size() - begin);
        some.clear(), nm.clear();
        std::optional<Front> front;
        for (std::size_t i = 0; i < count; ++i) {
            const MapRay& ray = rays[begin + i];
            if (i == 0 || ray.shift.x != rays[begin + i - 1].shift.x || ray.shift.y != rays[begin + i - 1].shift.y)
                front = this->front(ray.shift);
            const Line l = line(*front, ray.at);
            some.push_back({.ray = {.origin = to_float(l.place), .direction = to_float(l.direction)}});
            nm.push_back(rays[begin + i].nm);
        }
        const Vec2f own = lens_.trace_open(some, nm, ghosts_, steps_, open);
        for (std::size_t i = 0; i < count; ++i) {
            MapLanding& l = landings[begin + i];
            const Vec2f mm = own - Vec2f{open.x[i], open.y[i]} - shift;
            l = {sensor_.px_from_mm(mm), open.beyond[i], open.pass[i], open.sound[i] > 0,
                 std::int16_t(open.lost_after[i]), {}};
            for (int k = 0; k < kMostCrossings; ++k) l.iris[k] = {open.iris_x[k][i], open.iris_y[k][i]};
        }
    }
    return landings;
}

}  // namespace dg
