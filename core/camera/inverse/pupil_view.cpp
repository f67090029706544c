#include "camera/inverse/pupil_view.h"

#include <cmath>

#include "camera/inverse/inverse_kind.h"
#include "camera/inverse/pupil_shape.h"
#include "camera/tilt.h"
#include "math/across.h"
#include "math/warp.h"

namespace dg {
namespace {

// Keeps rays at the rim inside after rounding to float.
constexpr double kRim = 1 + 1e-5;

using Sample = PupilView::Sample;

/// Line through a scene point and a lens point; density of the lens point per m2 of a plane with
/// the given normal.
struct Line {
    Vec3d direction;  // unit, from the lens to the point, or the reverse if the point is behind
    double pdf;
};

std::optional<Line> line_through(Vec3d p, double w, Vec3d q, Vec3d axis, double per_m2) {
    const Vec3d way = p - w * q;
    const double d2 = length_squared(way), along = dot(way, axis);
    if (!(d2 > 0) || along == 0) return std::nullopt;
    const double cosine = std::abs(along) / std::sqrt(d2);
    const Vec3d direction = way * ((along > 0 ? 1 : -1) / std::sqrt(d2));
    return Line{direction, per_m2 / cosine * (w == 0 ? 1 : d2)};
}

/// Closest distance in iris radii; nearer points are inside the ball of the iris.
constexpr double kNear = 4;

/// Bound of the disc across the direction to a point that contains all its rays through an iris of
/// the given radius: the iris is tilted against the disc by angles of about radius / distance.
double bound_of(double radius, Vec3d p, double w) {
    const double angle = w == 0 ? 0 : radius / length(p);
    return kRim * radius * (1 + 4 * angle * angle);
}

std::optional<Sample> sample_hole(Vec3d p, double w, bool all_around) {
    const double d2 = length_squared(p);
    if (!(all_around ? d2 > 0 : p.z < 0)) return std::nullopt;
    return Sample{{}, to_float(p * (1 / std::sqrt(d2))), w == 0 ? 1.f : float(d2)};
}

}  // namespace

PupilView PupilView::of(const ExactLens& lens) { return PupilView(std::make_shared<const PupilShape>(lens)); }

PupilView::PupilView(const LensKind& kind)
    : PupilView(std::visit([](const auto& lens) { return of(lens); }, kind)) {}

std::optional<Sample> PupilView::sample(Vec3d p, double w, Vec2f u) const {
    if (pupil_) return pupil_->sample(p, w, u);
    if (const auto* hole = std::get_if<Hole>(&opening_)) return sample_hole(p, w, hole->all_around);
    if (const auto* iris = std::get_if<TurningIris>(&opening_)) {
        const double far = length(p);
        if (!(far > w * kNear * iris->radius) || !(iris->all_around || p.z < 0)) return std::nullopt;
        const Vec3d axis = p / far;
        const Across across(axis);
        const double radius = bound_of(iris->radius, p, w);
        const Vec2f disk = warp_disk(u);
        const Vec3d q = radius * (disk.x * across.x + disk.y * across.y);
        const auto line = line_through(p, w, q, axis, 1 / (kPiD * radius * radius));
        if (!line) return std::nullopt;
        return Sample{to_float(q), to_float(line->direction), float(line->pdf)};
    }
    const FlatIris& disc = std::get<FlatIris>(opening_);
    const Vec3d axis = -disc.frame.z;
    // Rays start at depth -start along the axis; the point must be in front.
    if (!(dot(p - w * disc.frame.origin, axis) > w * -disc.start)) return std::nullopt;
    const Vec2d at = iris_->sample({u.x, u.y}, kRim) * disc.radius;
    const Vec3d q = disc.frame.point({at.x, at.y, 0});
    const double area = iris_->sampling_area(kRim) * disc.radius * disc.radius;
    const auto line = line_through(p, w, q, axis, 1 / area);
    if (!line) return std::nullopt;
    const Vec3d origin = q - line->direction * (disc.start / dot(line->direction, axis));
    return Sample{to_float(origin), to_float(line->direction), float(line->pdf)};
}

float PupilView::pdf(Vec3d p, double w, const Ray& ray) const {
    if (pupil_) return pupil_->pdf(p, w, ray);
    if (const auto* hole = std::get_if<Hole>(&opening_)) {
        const auto drawn = sample_hole(p, w, hole->all_around);
        return drawn ? drawn->pdf : 0;
    }
    if (const auto* iris = std::get_if<TurningIris>(&opening_)) {
        const double far = length(p);
        if (!(far > w * kNear * iris->radius) || !(iris->all_around || p.z < 0)) return 0;
        const Vec3d axis = p / far, d = to_double(ray.direction), from = to_double(ray.origin);
        if (!(dot(d, axis) > 0)) return 0;
        const Vec3d q = from - d * (dot(from, axis) / dot(d, axis));
        const double radius = bound_of(iris->radius, p, w);
        if (!(length(q) <= radius)) return 0;
        const auto line = line_through(p, w, q, axis, 1 / (kPiD * radius * radius));
        return line ? float(line->pdf) : 0;
    }
    const FlatIris& disc = std::get<FlatIris>(opening_);
    const Vec3d axis = -disc.frame.z, d = to_double(ray.direction);
    const Vec3d from = to_double(ray.origin) - disc.frame.origin;
    if (!(dot(d, axis) > 0) || !(dot(p - w * disc.frame.origin, axis) > w * -disc.start))
        return 0;
    const Vec3d at = from - d * (dot(from, axis) / dot(d, axis));
    const Vec2d in{dot(at, disc.frame.x), dot(at, disc.frame.y)};
    if (!iris_->in_sampling_region(in * (1 / disc.radius), kRim)) return 0;
    const double area = iris_->sampling_area(kRim) * disc.radius * disc.radius;
    const auto line = line_through(p, w, at + disc.frame.origin, axis, 1 / area);
    return line ? float(line->pdf) : 0;
}

PupilViewOverTime::PupilViewOverTime(const Camera& camera)
    : times_(camera.lens_motion.times) {
    const auto add = [&](const LensKind& lens) {
        states_.push_back(std::make_unique<State>());
        states_.back()->lens = lens;
    };
    if (times_.empty()) add(camera.lens);
    for (const LensKind& lens : camera.lens_motion.lenses) add(lens);
}

const PupilView& PupilViewOverTime::view(std::size_t state) const {
    State& s = *states_[state];
    std::call_once(s.once, [&] { s.view.emplace(s.lens); });
    return *s.view;
}

template <typename Use>
decltype(auto) PupilViewOverTime::with_lens(float time, const Use& use) const {
    if (times_.empty()) return use(view(0));
    const KeyPlace p = place_among(times_, time);
    const std::size_t nearest = p.share < 0.5 ? p.left : p.right;
    return std::visit(
        [&]<typename L>(const L& lens) {
            if constexpr (ChangesEvenly<L>) {
                const L &from = std::get<L>(states_[p.left]->lens), &to = std::get<L>(states_[p.right]->lens);
                const auto now = blend(from.numbers(), to.numbers(), p.share);
                return use(PupilView(lens.opening(now), view(nearest).iris_));
            } else {
                return use(view(nearest));
            }
        },
        states_[nearest]->lens);
}

std::optional<Sample> PupilViewOverTime::sample(Vec3d p, double w, Vec2f u,
                                                float time) const {
    return with_lens(time, [&](const PupilView& view) { return view.sample(p, w, u); });
}

float PupilViewOverTime::pdf(Vec3d p, double w, const Ray& ray) const {
    return with_lens(ray.time,
                     [&](const PupilView& view) { return view.pdf(p, w, ray); });
}

}  // namespace dg
