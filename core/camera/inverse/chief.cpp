#include "camera/inverse/chief.h"

#include <cmath>

#include "camera/mean_ray.h"
#include "math/error.h"

namespace dg {
namespace {

constexpr int kSteps = 64;  // film radii in the table
constexpr int kTurns = 16;  // film azimuths over which a chief ray is averaged
constexpr int kSide = 24;   // lens samples per side
constexpr double kBeyond =
    3;  // largest film radius of a search, relative to the end of the table

/// Passing rays from film points of one radius at all azimuths, rotated to +x.
std::vector<CameraRay> passing(const ExactLens& lens, double radius_mm) {
    std::vector<CameraSample> samples;
    for (int turn = 0; turn < kTurns; ++turn) {
        const double a = 2 * kPiD * turn / kTurns;
        const Vec2f film{float(radius_mm * std::cos(a)), float(radius_mm * std::sin(a))};
        const std::vector<CameraSample> cells = lens_cells(film, kSide);
        samples.insert(samples.end(), cells.begin(), cells.end());
    }
    std::vector<CameraRay> rays(samples.size());
    lens.generate(samples, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const double a = 2 * kPiD * double(i / (kSide * kSide)) / kTurns;
        const float c = float(std::cos(a)), s = float(std::sin(a));
        const auto turned = [&](Vec3f v) {
            return Vec3f{c * v.x + s * v.y, c * v.y - s * v.x, v.z};
        };
        rays[i].ray.origin = turned(rays[i].ray.origin);
        rays[i].ray.direction = turned(rays[i].ray.direction);
    }
    std::erase_if(rays, [](const CameraRay& r) { return !(r.weight > 0); });
    return rays;
}

/// Mean ray in the meridional plane, from rays rotated to +x.
std::optional<ChiefRays::Meridional> mean_ray(const std::vector<CameraRay>& rays) {
    Vec3d axis = summed_direction(rays);
    axis.y = 0;  // residue of the sampling grid
    if (!(length(axis) > 0)) return std::nullopt;
    const RayMeans mean = means_across(normalize(axis), rays);
    const Vec3d o = mean.crossing, d = normalize(Vec3d{mean.slope.x, 0, mean.slope.z});
    const double angle = atan2(d.x, -d.z);
    return ChiefRays::Meridional{angle, o.x * std::cos(angle) + o.z * std::sin(angle),
                                 mean.start};
}

using Meridional = ChiefRays::Meridional;

Meridional sum(const Meridional& a, double s, const Meridional& b) {
    return {a.angle + s * b.angle, a.offset + s * b.offset, a.start + s * b.start};
}

/// The chief ray at -r, by symmetry.
Meridional mirrored(const Meridional& m) {
    return {-m.angle, -m.offset, m.start};
}

/// Common point of all chief rays of a kind with film_point().
template <typename L>
Vec3d origin_of(const L& lens) {
    if constexpr (requires { lens.pupil_offset_m(); })
        return {0, 0, lens.pupil_offset_m()};
    else
        return {};
}

Vec3d direction_of(const auto& lens, Vec2d film_mm) {
    return std::optional<Vec3d>(lens.chief_direction(film_mm)).value_or(Vec3d{0, 0, 0});
}

/// Whether a film point has a chief ray; kinds without an optional always have one.
bool has_chief(const auto& lens, Vec2d film_mm) {
    if constexpr (requires { lens.chief_direction(film_mm).has_value(); })
        return lens.chief_direction(film_mm).has_value();
    else
        return true;
}

template <typename L>
std::optional<Vec2d> film_point_of(const L& lens, Vec3d p, double w) {
    if constexpr (HasFilmPoint<L>)
        return lens.film_point(p, w);
    else
        return std::nullopt;   // unreachable: an exact lens has a table or a grid
}

}  // namespace

ChiefRays::ChiefRays(const LensKind& kind)
    : ChiefRays(std::visit([](const auto& lens) { return of(lens); }, kind)) {}

ChiefRays ChiefRays::of(const ExactLens& lens) {
    return lens.chief_rays().get([&] {
        ChiefRays rays;
        if (lens.is_axial())
            rays.tabulate(lens);
        else
            rays.grid_.emplace(lens);
        return rays;
    });
}

void ChiefRays::tabulate(const ExactLens& lens) {
    step_mm_ = lens.half_diagonal_mm() / kSteps;
    for (int i = 0; i <= kSteps; ++i) {
        const auto ray = mean_ray(passing(lens, i * step_mm_));
        ends_ = !ray || (i > 0 && ray->angle <= table_.back().angle);
        if (ends_) break;  // beyond the image circle
        table_.push_back(*ray);
    }
    if (table_.size() < 4)
        throw Error("chief rays: no light passes the lens near its axis");
    table_[0].angle = table_[0].offset = 0;
}

bool ChiefRays::changes_evenly() const {
    return straight_ && std::visit([]<typename L>(const L&) { return ChangesEvenly<L>; }, *straight_);
}

ChiefRays ChiefRays::between(const ChiefRays& a, const ChiefRays& b, double share) {
    ChiefRays now = share < 0.5 ? a : b;
    std::visit(
        [&]<typename L>(L& lens) {
            if constexpr (ChangesEvenly<L>)
                lens.set(blend(std::get<L>(*a.straight_).numbers(), std::get<L>(*b.straight_).numbers(), share));
        },
        *now.straight_);
    return now;
}

ChiefRaysOverTime::ChiefRaysOverTime(const Camera& camera)
    : times_(camera.lens_motion.times) {
    if (times_.empty()) states_.emplace_back(camera.lens);
    for (const LensKind& lens : camera.lens_motion.lenses) states_.emplace_back(lens);
}

/// Catmull-Rom cubic in the radius, linear past the last node.
ChiefRays::Meridional ChiefRays::at_radius(double mm) const {
    const int last = int(table_.size()) - 1;
    const auto node = [&](int i) {
        return i < 0      ? mirrored(table_[-i])
               : i > last ? sum(sum(table_[last], i - last, table_[last]), last - i,
                                table_[last - 1])
                          : table_[i];
    };
    const double x = mm / step_mm_;
    const int i = x < last - 1 ? int(x) : last - 1;   // NaN maps to the end
    const double t = x - i;
    if (t >= 1)
        return sum(sum(table_[last], t - 1, table_[last]), 1 - t, table_[last - 1]);
    const double t2 = t * t, t3 = t2 * t;
    Meridional m = sum({}, 0.5 * (2 * t2 - t3 - t), node(i - 1));
    m = sum(m, 0.5 * (3 * t3 - 5 * t2 + 2), node(i));
    m = sum(m, 0.5 * (4 * t2 - 3 * t3 + t), node(i + 1));
    return sum(m, 0.5 * (t3 - t2), node(i + 2));
}

ChiefRay ChiefRays::at(Vec2d film_mm) const {
    if (straight_)
        return std::visit([&](const auto& lens) { return ChiefRay{origin_of(lens), direction_of(lens, film_mm)}; },
                          *straight_);
    if (grid_) {
        const ChiefGrid::Line line = grid_->at(film_mm);
        return {line.foot + line.direction * line.start, line.direction};
    }
    const double radius = length(film_mm);
    const Meridional m = at_radius(radius);
    const Vec2d out = radius > 0 ? film_mm * (1 / radius) : Vec2d{1, 0};
    const auto turned = [&](double outward, double z) {
        return Vec3d{out.x * outward, out.y * outward, z};
    };
    const double c = std::cos(m.angle), s = std::sin(m.angle);
    return {turned(m.offset * c + m.start * s, m.offset * s - m.start * c),
            turned(s, -c)};
}

ChiefRays::Lit ChiefRays::lit(Vec2d film_mm) const {
    if (straight_) {
        const bool seen = std::visit([&](const auto& lens) { return has_chief(lens, film_mm); }, *straight_);
        return seen ? Lit::yes : Lit::no;
    }
    if (grid_) return grid_->lit(film_mm);
    if (!ends_) return Lit::yes;
    const double last = step_mm_ * (table_.size() - 1), radius = length(film_mm);
    return radius <= last ? Lit::yes : radius < last + step_mm_ ? Lit::unknown : Lit::no;
}

/// Film radius with a chief ray through the point: a ray of radius 0 passes on the inner side of
/// every point ahead, a ray of large radius on the outer side, so the root is bracketed.
std::optional<double> ChiefRays::solve(double outward, double z, double w) const {
    const double size = hypot(outward, z);
    const auto past = [&](double mm) {  // < 0: the ray passes on the outer side of the point
        const Meridional m = at_radius(mm);
        return outward * std::cos(m.angle) + z * std::sin(m.angle) - w * m.offset;
    };
    double low = 0, high = step_mm_ * (table_.size() - 1);
    double at_low = past(low), at_high = past(high);
    const double farthest = kBeyond * high;
    while (at_high > 0 && high < farthest && at_radius(high).angle < kPiD / 2) {
        low = high, at_low = at_high;
        high = std::min(farthest, high + 8 * step_mm_);
        at_high = past(high);
    }
    if (!(at_high <= 0)) return std::nullopt;
    // Regula falsi, halving the value at the retained end (Illinois).
    for (int i = 0; i < 100 && high - low > 1e-10 * farthest; ++i) {
        const double middle = (low * at_high - high * at_low) / (at_high - at_low);
        const double here = past(middle);
        if (std::abs(here) <= 1e-15 * size) return middle;
        if (here > 0) {
            low = middle, at_low = here, at_high *= 0.5;
        } else {
            high = middle, at_high = here, at_low *= 0.5;
        }
    }
    return 0.5 * (low + high);
}

std::optional<Vec2d> ChiefRays::film_point(Vec3d p, double w) const {
    if (straight_) return std::visit([&](const auto& lens) { return film_point_of(lens, p, w); }, *straight_);
    if (grid_) return grid_->film_point(p, w);
    const double outward = hypot(p.x, p.y);
    if (outward == 0) return p.z < 0 ? std::optional(Vec2d{}) : std::nullopt;
    const auto radius = solve(outward, p.z, w);
    if (!radius) return std::nullopt;
    const Meridional m = at_radius(*radius);
    if (!(outward * std::sin(m.angle) - p.z * std::cos(m.angle) > w * m.start))
        return std::nullopt;
    return Vec2d{p.x, p.y} * (*radius / outward);
}

}  // namespace dg
