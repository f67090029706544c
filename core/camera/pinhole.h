// pinhole.h -- pinhole camera: everything is in focus. A leaf shutter only scales the exposure by
// its area.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "camera/camera_sample.h"
#include "camera/opening.h"
#include "camera/straight.h"

namespace dg {

/// film_distance_mm sets the field of view: tan(half angle) = half film / film_distance.
struct Pinhole {
    double film_distance_mm = 50;
    bool natural_vignetting = false;   // darken by cos^4 of the field angle

    /// Parameters that can be interpolated over time.
    struct Numbers {
        double film_distance_mm;

        std::vector<std::vector<double>> groups() const { return {{film_distance_mm}}; }
    };
    Numbers numbers() const { return {film_distance_mm}; }
    void set(const Numbers& numbers) { film_distance_mm = numbers.film_distance_mm; }

    void generate(std::span<const CameraSample> samples, std::span<CameraRay> rays) const {
        generate(numbers(), samples, rays);
    }
    /// Uses `numbers` instead of the lens's parameters.
    void generate(const Numbers& numbers, std::span<const CameraSample> samples, std::span<CameraRay> rays) const;

    /// Reprojects rays through the hole, which has measure 1 across the ray: etendue is in sr.
    void reproject(std::span<const CameraRay> rays, std::span<Reprojection> out) const {
        reproject(numbers(), rays, out);
    }
    void reproject(const Numbers& numbers, std::span<const CameraRay> rays, std::span<Reprojection> out) const;

    /// Unit, camera frame.
    Vec3d chief_direction(Vec2d film_mm) const { return straight_direction(film_mm, film_distance_mm); }
    std::optional<Vec2d> film_point(Vec3d p, double) const { return straight_film_point(p, film_distance_mm); }
    Opening opening() const { return Hole{}; }
    Opening opening(const Numbers&) const { return opening(); }
};

inline Pinhole::Numbers blend(const Pinhole::Numbers& a, const Pinhole::Numbers& b, double share) {
    return {a.film_distance_mm + share * (b.film_distance_mm - a.film_distance_mm)};
}

}  // namespace dg
