#include "camera/inverse/pixel_cone.h"

#include <algorithm>
#include <cmath>

namespace dg {
namespace {

/// Direction, or 0 outside the field of view.
Vec3d direction(const std::optional<Vec3d>& chief) { return chief.value_or(Vec3d{0, 0, 0}); }

/// Whether the field angle depends only on the film radius.
template <HasChief Lens>
bool is_round(const Lens& lens) {
    if constexpr (requires { lens.is_axial(); })
        return lens.is_axial();
    else
        return true;
}

/// Root of the solid angle per mm^2 of film, averaged over azimuths at a radius, for lenses without
/// axial symmetry.
double mean_angle_per_mm(const Projection& lens, double radius_mm, double) {
    constexpr int kTurns = 16;
    double sum = 0;
    int lit = 0;
    for (int i = 0; i < kTurns; ++i) {
        const double a = 2 * kPiD * (i + 0.5) / kTurns;
        const Vec2d out{radius_mm * std::cos(a), radius_mm * std::sin(a)};
        const double area = lens.solid_angle(lens.principal_mm + out);
        if (area > 0) sum += std::sqrt(area), ++lit;
    }
    return lit ? sum / lit : 0;
}

template <HasChief Lens>
double mean_angle_per_mm(const Lens& lens, double radius_mm, double step_mm) {
    constexpr int kTurns = 8;
    double sum = 0;
    int lit = 0;
    for (int i = 0; i < kTurns; ++i) {
        const double a = 2 * kPiD * i / kTurns;
        const Vec2d at{radius_mm * std::cos(a), radius_mm * std::sin(a)};
        const Vec3d here = direction(lens.chief_direction(at));
        const Vec3d x = direction(lens.chief_direction({at.x + step_mm, at.y})) - here;
        const Vec3d y = direction(lens.chief_direction({at.x, at.y + step_mm})) - here;
        const double area = length(cross(x, y)) / (step_mm * step_mm);
        if (area > 0) sum += std::sqrt(area), ++lit;
    }
    return lit ? sum / lit : 0;
}

template <HasChief Lens>
double field_angle(const Lens& lens, double x_mm) {
    const Vec3d d = direction(lens.chief_direction({x_mm, 0}));
    return atan2(d.x, -d.z);
}

double largest_radius(const Sensor& s) {
    return hypot(0.5 * s.width_mm + std::abs(s.center_mm.x),
                      0.5 * s.height_mm + std::abs(s.center_mm.y));
}

double pitch(const Sensor& s) { return std::sqrt(s.mm2_per_px()); }

}  // namespace

PixelCone::PixelCone(const Camera& camera, const Sensor& sensor)
    : PixelCone(std::visit([&](const auto& lens) { return of(lens, sensor); }, camera.lens)) {}

template <HasChief Lens>
PixelCone PixelCone::of(const Lens& lens, const Sensor& sensor) {
    PixelCone cone;
    cone.steps_per_mm_ = float(1 / (largest_radius(sensor) / kSteps));
    if (is_round(lens))
        cone.measure_along(lens, sensor);
    else
        cone.measure_around(lens, sensor);
    return cone;
}

template <HasChief Lens>
void PixelCone::measure_around(const Lens& lens, const Sensor& sensor) {
    const double step = largest_radius(sensor) / kSteps;
    for (int i = 0; i <= kSteps; ++i) {
        const double angle = mean_angle_per_mm(lens, i * step, 0.5 * step);
        angles_[i] = angle > 0 || i == 0 ? float(pitch(sensor) * angle) : angles_[i - 1];
    }
}

// A film circle of radius r has the field angle a(r): one mm along r covers a'(r), one mm across
// covers sin(a) / r.
template <HasChief Lens>
void PixelCone::measure_along(const Lens& lens, const Sensor& sensor) {
    const double step = largest_radius(sensor) / kSteps;
    std::array<double, kSteps + 1> a;
    for (int i = 0; i <= kSteps; ++i) a[i] = field_angle(lens, i * step);
    for (int i = 0; i <= kSteps; ++i) {
        const int low = std::max(i - 1, 0), high = std::min(i + 1, kSteps);
        const double radial = (a[high] - a[low]) / ((high - low) * step);
        if (!(radial > 0)) {  // beyond the image circle of the lens
            angles_[i] = i ? angles_[i - 1] : 0;
            continue;
        }
        const double across = i ? std::sin(a[i]) / (i * step) : radial;
        angles_[i] = float(pitch(sensor) * std::sqrt(radial * across));
    }
}

float PixelCone::angle(Vec2f film_mm) const {
    const float most = float(kSteps) - 1e-3f, at = length(film_mm) * steps_per_mm_;
    const float x = at < most ? at : most;   // NaN maps to the end
    const int i = int(x);
    return angles_[i] + (angles_[i + 1] - angles_[i]) * (x - float(i));
}

RayCone PixelCone::cone(Vec2f film_mm, const Ray& ray) const {
    const float spread = kConeShare * angle(film_mm);
    // Rays of an exact lens start on the front surface, at some distance from the pupil.
    const float from_pupil = ray.direction.z < 0 ? ray.origin.z / ray.direction.z : 0.f;
    return {spread * std::max(0.f, from_pupil), spread};
}

}  // namespace dg
