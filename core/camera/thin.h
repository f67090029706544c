// thin.h -- thin lens: an iris of some diameter and one plane in perfect focus.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "camera/camera_sample.h"
#include "camera/opening.h"
#include "camera/straight.h"
#include "camera/tilt.h"
#include "optics/lens/stop.h"

namespace dg {

/// film_distance_mm is the film distance of the equivalent pinhole: the focal length, or the image
/// distance f s / (s - f) with focus breathing. A point at distance s has the circle of confusion 2
/// aperture_radius |s - focus| / s * film_distance / focus on the film.
///
/// With tilt, the film is film_distance_mm behind the centre along the camera's axis, and
/// focus_distance_m is measured along the lens's axis. Rays through the centre are undeviated, so
/// the framing equals the pinhole's. The planes of focus, film and lens intersect in a line
/// (Scheimpflug).
/// focus meets film and lens in one line (Scheimpflug).
struct ThinLens {
    double film_distance_mm = 50;
    double aperture_radius_mm = 4.5;   // round iris; other shapes have the same area
    double focus_distance_m = 1;       // along the axis; may be infinite
    Iris iris = {};                    // shape of unit radius
    bool natural_vignetting = false;   // darken by cos^4 of the field angle
    Vec2d tilt_deg{0, 0};              // see tilt.h

    /// Parameters that can be interpolated over time.
    struct Numbers {
        double film_distance_mm, aperture_radius_mm, inverse_focus;   // 1/m, 0 at infinity
        double exposure = 1;                                          // factor on weights
        Vec2d tilt_deg{0, 0};

        /// Proportional to exposure: square of iris radius / image distance.
        double light_cone() const {
            const double slope = aperture_radius_mm / film_distance_mm;
            return slope * slope;
        }
        std::vector<std::vector<double>> groups() const {
            return {{film_distance_mm, aperture_radius_mm, inverse_focus, tilt_deg.x, tilt_deg.y}};
        }
    };
    Numbers numbers() const {
        return {film_distance_mm, aperture_radius_mm, 1 / focus_distance_m, 1, tilt_deg};
    }
    void set(const Numbers& numbers);

    void generate(std::span<const CameraSample> samples, std::span<CameraRay> rays) const {
        generate(numbers(), samples, rays);
    }
    /// Uses `numbers` instead of the lens's parameters.
    void generate(const Numbers& numbers, std::span<const CameraSample> samples,
                  std::span<CameraRay> rays) const;

    /// Traces scene rays to the film.
    void reproject(std::span<const CameraRay> rays, std::span<Reprojection> out) const {
        reproject(numbers(), rays, out);
    }
    void reproject(const Numbers& numbers, std::span<const CameraRay> rays,
                   std::span<Reprojection> out) const;

    /// Undeviated ray through the centre, tilted or not; unit, camera frame.
    Vec3d chief_direction(Vec2d film_mm) const { return straight_direction(film_mm, film_distance_mm); }
    std::optional<Vec2d> film_point(Vec3d p, double) const { return straight_film_point(p, film_distance_mm); }
    Opening opening() const { return opening(numbers()); }
    Opening opening(const Numbers& numbers) const {
        return FlatIris{lens_turn(numbers.tilt_deg), 1e-3 * numbers.aperture_radius_mm, 0};
    }

  private:
    Vec2f iris_point(Vec2f u, double covered, float& weight) const;
    void generate_tilted(const Numbers& numbers, std::span<const CameraSample> samples,
                         std::span<CameraRay> rays) const;
};

inline ThinLens::Numbers blend(const ThinLens::Numbers& a, const ThinLens::Numbers& b, double s) {
    const auto mix = [&](double x, double y) { return x + s * (y - x); };
    return {mix(a.film_distance_mm, b.film_distance_mm),
            mix(a.aperture_radius_mm, b.aperture_radius_mm),
            mix(a.inverse_focus, b.inverse_focus),
            1,
            {mix(a.tilt_deg.x, b.tilt_deg.x), mix(a.tilt_deg.y, b.tilt_deg.y)}};
}

}  // namespace dg
