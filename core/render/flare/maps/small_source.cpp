#include "render/flare/maps/small_source.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/sampler.h"

namespace dg {
namespace {

constexpr int kPoints = 1024, kSequence = -6;
constexpr double kWidest = 0.035;    // largest tangent of half the angular diameter: two degrees
constexpr double kNearest = 50;      // least distance, in radii of the front
constexpr double kDeepest = 0.01;    // largest depth, as a fraction of its distance
constexpr double kStill = 1e-6;      // largest motion of a static source, as a fraction of its distance

constexpr int kCells = 12;           // along the diameter of the circle
constexpr double kEven = 0.65;       // approximate share of these cells that a uniform disc lights

using Point = FlareAim::SourcePoint;

struct Drawn {
    Point point;
    Moment moment;
};

/// Samples points of the source over the exposure, or at a given time.
std::optional<std::vector<Drawn>> points_of(const FlareAim& aim, int source, std::optional<float> time) {
    std::vector<Drawn> points;
    for (int i = 0; i < kPoints; ++i) {
        PathSampler sampler(source, kSequence, std::uint32_t(i), 0);
        const CameraRandom u = sampler.camera();
        Moment moment = aim.shutter().draw_any(u.time);
        if (time) moment.time = *time;
        const auto point = aim.point(source, u.film.x, u.lens, moment.time);
        if (!point) return std::nullopt;
        points.push_back({*point, moment});
    }
    return points;
}

/// Bounding circle of the points.
std::optional<MapSource> around(const std::vector<Drawn>& points) {
    MapSource s;
    s.at_infinity = points[0].point.at_infinity, s.middle = {0, 0, 0}, s.radius = 1;
    for (const auto& [p, moment] : points) {
        if (p.at_infinity != s.at_infinity) return std::nullopt;
        s.middle += p.place * (1 / double(points.size()));
    }
    if (s.at_infinity) s.middle = normalize(s.middle);
    double reach = 0;
    for (const auto& [p, moment] : points) reach = std::max(reach, double(length(s.shift_of(p.place))));
    s.radius = reach;
    return s;
}

bool is_small(const MapSource& s, const std::vector<Drawn>& points, double front_radius) {
    const double far = s.at_infinity ? 1 : length(s.middle);
    if (s.radius > kWidest * far || (!s.at_infinity && far < kNearest * front_radius)) return false;
    return std::ranges::all_of(points, [&](const Drawn& d) {
        return s.at_infinity || std::abs(length(d.point.place) - far) <= kDeepest * far;
    });
}

/// Effective lit share of the circle's cells: (sum of light)^2 over sum of squares.
float filled(const std::vector<SmallSource::Point>& points) {
    std::array<double, kCells * kCells> light{};
    const auto cell = [](float x) { return std::clamp(int((0.5f + 0.5f * x) * kCells), 0, kCells - 1); };
    for (const SmallSource::Point& p : points) light[cell(p.shift.y) * kCells + cell(p.shift.x)] += luminance(p.light);
    double sum = 0, squares = 0;
    for (const double l : light) sum += l, squares += l * l;
    return squares > 0 ? float(std::min(1.0, sum * sum / squares / (kEven * light.size()))) : 0;
}

/// Whether the source moves, by comparing its points at two times.
bool moves(const FlareAim& aim, int source, double far) {
    const auto begin = points_of(aim, source, 0.f), middle = points_of(aim, source, 0.5f),
               end = points_of(aim, source, 1.f);
    if (!begin || !middle || !end) return true;
    for (int i = 0; i < kPoints; ++i)
        for (const auto* other : {&*begin, &*end})
            if (length((*other)[i].point.place - (*middle)[i].point.place) > kStill * far) return true;
    return false;
}

}  // namespace

double SmallSource::luminance() const {
    double sum = 0;
    for (const Point& p : points) sum += dg::luminance(p.light);
    return sum / double(points.size());
}

std::optional<SmallSource> small_source(const FlareAim& aim, int source) {
    if (aim.sources().reflected(source)) return std::nullopt;
    const auto drawn = points_of(aim, source, std::nullopt);
    if (!drawn) return std::nullopt;
    const auto shape = around(*drawn);
    if (!shape || !is_small(*shape, *drawn, aim.front_radius())) return std::nullopt;
    SmallSource small{source, *shape, {}, moves(aim, source, shape->at_infinity ? 1 : length(shape->middle)), 0};
    for (const auto& [p, moment] : *drawn) small.points.push_back({shape->shift_of(p.place), p.light, moment, p.from});
    small.filled = filled(small.points);
    return small;
}

}  // namespace dg
