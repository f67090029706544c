// projection.h -- camera defined by a calibration or a projection formula instead of a lens: the
// model gives the direction of every ray.
//
// With an iris it has depth of field. The iris faces each chief ray, as entrance pupils of fisheyes
// turn toward the side, so fields beyond 90 degrees work. The surface in focus is the plane across
// the axis at focus_distance_m, or, for models with fields of 180 degrees and more, the sphere of
// that radius.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "camera/camera_sample.h"
#include "camera/opening.h"
#include "camera/projection_model.h"
#include "optics/lens/stop.h"

namespace dg {

struct Projection {
    ProjectionModel model{};
    Vec2d focal_mm{50, 50};            // horizontal and vertical
    Vec2d principal_mm{0, 0};          // principal point on the film, upright
    double aperture_radius_mm = 0;     // round iris; 0: everything in focus
    double focus_distance_m = 1;       // may be infinite
    Iris iris = {};                    // shape of unit radius

    /// Parameters that can be interpolated over time; the model's parameters use the nearest key.
    struct Numbers {
        Vec2d focal_mm, principal_mm;
        double aperture_radius_mm, inverse_focus;   // 1/m, 0 at infinity
        double exposure = 1;                        // factor on weights

        /// Square of iris radius / image distance, like ThinLens::Numbers::light_cone.
        double light_cone() const { return aperture_radius_mm * aperture_radius_mm / (focal_mm.x * focal_mm.y); }
        std::vector<std::vector<double>> groups() const {
            return {{focal_mm.x, focal_mm.y}, {principal_mm.x, principal_mm.y}, {aperture_radius_mm}, {inverse_focus}};
        }
    };
    Numbers numbers() const { return {focal_mm, principal_mm, aperture_radius_mm, 1 / focus_distance_m}; }
    void set(const Numbers& numbers);

    void generate(std::span<const CameraSample> samples, std::span<CameraRay> rays) const {
        generate(numbers(), samples, rays);
    }
    /// Uses `numbers` instead of the camera's parameters.
    void generate(const Numbers& numbers, std::span<const CameraSample> samples, std::span<CameraRay> rays) const;

    void reproject(std::span<const CameraRay> rays, std::span<Reprojection> out) const {
        reproject(numbers(), rays, out);
    }
    void reproject(const Numbers& numbers, std::span<const CameraRay> rays, std::span<Reprojection> out) const;

    /// Unit, camera frame; empty outside the field of view.
    std::optional<Vec3d> chief_direction(Vec2d film_mm) const { return chief_direction(numbers(), film_mm); }
    std::optional<Vec2d> film_point(Vec3d p, double) const { return film_point(numbers(), p); }
    Opening opening() const { return opening(numbers()); }
    Opening opening(const Numbers& numbers) const;
    static constexpr bool is_axial() { return false; }
    /// Solid angle of the scene per mm2 of film.
    double solid_angle(Vec2d film_mm) const { return solid_angle(numbers(), film_mm); }

  private:
    std::optional<Vec3d> chief_direction(const Numbers& now, Vec2d film_mm) const;
    std::optional<Vec2d> film_point(const Numbers& now, Vec3d direction) const;
    double solid_angle(const Numbers& now, Vec2d film_mm) const;
    Reprojection reproject_hole(const Numbers& now, const CameraRay& ray) const;
    Reprojection reproject_iris(const Numbers& now, const CameraRay& ray) const;
    std::optional<Vec3d> in_focus(const Numbers& now, Vec3d from, Vec3d direction) const;
};

Projection::Numbers blend(const Projection::Numbers& a, const Projection::Numbers& b, double share);

}  // namespace dg
