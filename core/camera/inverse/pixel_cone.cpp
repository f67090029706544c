#include "camera/inverse/pixel_cone.h"

#include <algorithm>
#include <cmath>

namespace dg {
namespace {

/// View direction of a film point on +x.
Vec3d chief(const ExactLens& lens, double x_mm) { return lens.chief_direction({x_mm, 0}); }
Vec3d chief(const ThickLens& lens, double x_mm) { return lens.chief_direction({x_mm, 0}); }
Vec3d chief(const Projection& lens, double x_mm) {
    return lens.chief_direction({x_mm, 0}).value_or(Vec3d{0, 0, 0});
}
template <typename Ideal>
Vec3d chief(const Ideal& lens, double x_mm) {
    return normalize(Vec3d{x_mm, 0, -lens.film_distance_mm});
}

/// Solid angle per mm^2 of film (its root), mean over the directions at a radius: of lenses that are not the
/// same on all sides.
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

double mean_angle_per_mm(const ExactLens& lens, double radius_mm, double step_mm) {
    constexpr int kTurns = 8;
    double sum = 0;
    int lit = 0;
    for (int i = 0; i < kTurns; ++i) {
        const double a = 2 * kPiD * i / kTurns;
        const Vec2d at{radius_mm * std::cos(a), radius_mm * std::sin(a)};
        const Vec3d here = lens.chief_direction(at);
        const Vec3d x = lens.chief_direction({at.x + step_mm, at.y}) - here;
        const Vec3d y = lens.chief_direction({at.x, at.y + step_mm}) - here;
        const double area = length(cross(x, y)) / (step_mm * step_mm);
        if (area > 0) sum += std::sqrt(area), ++lit;
    }
    return lit ? sum / lit : 0;
}

double field_angle(const LensKind& lens, double x_mm) {
    const Vec3d d = std::visit([&](const auto& kind) { return chief(kind, x_mm); }, lens);
    return std::atan2(d.x, -d.z);
}

double largest_radius(const Sensor& s) {
    return std::hypot(0.5 * s.width_mm + std::abs(s.center_mm.x),
                      0.5 * s.height_mm + std::abs(s.center_mm.y));
}

}  // namespace

// A circle of radius r on the film is seen under the angle a(r). One mm along r covers a'(r),
// one mm across covers sin(a) / r.
PixelCone::PixelCone(const Camera& camera, const Sensor& sensor) {
    const double radius = largest_radius(sensor), step = radius / kSteps;
    const double pitch = std::sqrt(sensor.width_mm / sensor.width * sensor.height_mm / sensor.height);
    steps_per_mm_ = float(1 / step);
    const auto by_turns = [&](const auto& lens) {
        for (int i = 0; i <= kSteps; ++i) {
            const double angle = mean_angle_per_mm(lens, i * step, 0.5 * step);
            angles_[i] = angle > 0 || i == 0 ? float(pitch * angle) : angles_[i - 1];
        }
    };
    if (const auto* lens = std::get_if<ExactLens>(&camera.lens); lens && !lens->is_axial()) {
        by_turns(*lens);
        return;
    }
    if (const auto* lens = std::get_if<Projection>(&camera.lens)) {
        by_turns(*lens);
        return;
    }
    std::array<double, kSteps + 1> a;
    for (int i = 0; i <= kSteps; ++i) a[i] = field_angle(camera.lens, i * step);
    for (int i = 0; i <= kSteps; ++i) {
        const int low = std::max(i - 1, 0), high = std::min(i + 1, kSteps);
        const double radial = (a[high] - a[low]) / ((high - low) * step);
        if (!(radial > 0)) {  // beyond the image circle of the lens
            angles_[i] = i ? angles_[i - 1] : 0;
            continue;
        }
        const double across = i ? std::sin(a[i]) / (i * step) : radial;
        angles_[i] = float(pitch * std::sqrt(radial * across));
    }
}

float PixelCone::angle(Vec2f film_mm) const {
    const float x = std::min(length(film_mm) * steps_per_mm_, float(kSteps) - 1e-3f);
    const int i = int(x);
    return angles_[i] + (angles_[i + 1] - angles_[i]) * (x - float(i));
}

RayCone PixelCone::cone(Vec2f film_mm, const Ray& ray) const {
    const float spread = kConeShare * angle(film_mm);
    // Rays of an exact lens start on its front, some way before the pupil.
    const float from_pupil = ray.direction.z < 0 ? ray.origin.z / ray.direction.z : 0.f;
    return {spread * std::max(0.f, from_pupil), spread};
}

}  // namespace dg
