#include "optics/first_order/best_focus.h"

#include <cmath>

#include "optics/lens/lens_error.h"
#include "optics/trace/trace.h"

namespace dg {
namespace {

constexpr int kRings = 64, kAzimuths = 16, kBisections = 30;

/// Intersection of a ray with the reference plane, and its slope.
struct Landing {
    Vec2d at, slope;
    double weight;
};

/// Point on the axis that emits rays into the entrance pupil.
struct AxisPoint {
    const Tracer& tracer;
    LensIndices index;
    Clip clip;
    double z, pupil_z;  // z of the point, -infinity if distant

    std::optional<TracedRay> ray(double radius, double azimuth) const {
        const Vec3d pupil{radius * std::cos(azimuth), radius * std::sin(azimuth), pupil_z};
        const Vec3d direction =
            std::isinf(z) ? Vec3d{0, 0, 1} : normalize(pupil - Vec3d{0, 0, z});
        // Start in front of the lens, even if the pupil is behind the first surface.
        const double back = (pupil.z + 1e3) / direction.z;
        return tracer.to_film({pupil - back * direction, direction}, index, clip);
    }

    /// Radius in the pupil at which rays start to be clipped; 0 if none passes.
    double edge(double guess, double azimuth) const {
        const double step = 1.6 * guess / kRings;
        int k = kRings;
        while (k > 0 && !ray(k * step, azimuth)) --k;
        double low = k * step, high = low + step;
        for (int i = 0; k > 0 && i < kBisections; ++i) {
            const double middle = 0.5 * (low + high);
            (ray(middle, azimuth) ? low : high) = middle;
        }
        return low;
    }
};

void land(const AxisPoint& source, double guess, double azimuth, double weight, double film_z,
          std::vector<Landing>& out) {
    const double edge = source.edge(guess, azimuth);
    for (int k = 0; k < kRings; ++k) {
        const auto traced = source.ray(edge * std::sqrt((k + 0.5) / kRings), azimuth);
        if (!traced) continue;
        const Vec3d at = at_plane(traced->ray, film_z), d = traced->ray.direction;
        out.push_back({{at.x, at.y}, {d.x / d.z, d.y / d.z}, weight * edge * edge});
    }
}

/// Smallest spot: sum w |at + t slope - centre|^2 is quadratic in t.
BestFocus smallest(const std::vector<Landing>& rays, double film_z, bool centred) {
    double weight = 0, aa = 0, as = 0, ss = 0;
    Vec2d at{}, slope{};
    for (const Landing& r : rays) {
        weight += r.weight;
        if (centred) continue;
        at = at + r.weight * r.at, slope = slope + r.weight * r.slope;
    }
    at = at * (1 / weight), slope = slope * (1 / weight);
    for (const Landing& r : rays) {
        const Vec2d a = r.at - at, s = r.slope - slope;
        aa += r.weight * dot(a, a), as += r.weight * dot(a, s), ss += r.weight * dot(s, s);
    }
    const double t = -as / ss;
    return {film_z + t, std::sqrt(std::max(0.0, (aa + t * as) / weight))};
}

}  // namespace

BestFocus best_focus(const Prescription& lens, double f_stop, double distance_m,
                     FocusFrom from, const std::vector<WeightedWavelength>& wavelengths) {
    const FirstOrder f = first_order(lens);
    const Tracer tracer(lens);
    const Iris round;
    const double radius = iris_radius(lens, f, f_stop);
    const bool symmetric = is_axially_symmetric(lens);
    BestFocus best{film_position(lens, f, distance_m, from), 0};
    // A distance measured from the film moves the object with the film; a few iterations converge.
    for (int round_trip = 0; round_trip < (from == FocusFrom::sensor ? 4 : 1); ++round_trip) {
        const double origin = from == FocusFrom::sensor ? best.film_z : f.entrance_pupil_z;
        const double guess = radius * std::abs(f.entrance_magnification);
        std::vector<Landing> rays;
        for (const auto& [nm, weight] : wavelengths) {
            const AxisPoint source{tracer, tracer.at(nm), {true, &round, radius},
                                origin - 1e3 * distance_m, f.entrance_pupil_z};
            for (int k = 0; k < (symmetric ? 1 : kAzimuths); ++k)
                land(source, guess, 2 * kPiD * k / kAzimuths, weight, best.film_z, rays);
        }
        if (rays.empty())
            throw lens_error("lens-no-light", -1, lens.name, "best focus", "light on the axis",
                             "no ray that passes");
        best = smallest(rays, best.film_z, symmetric);
    }
    return best;
}

}  // namespace dg
