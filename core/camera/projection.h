// projection.h -- a camera that is known by its calibration, or by the formula of its picture, and not by its
// glass: every ray is drawn through the model, none is bent afterwards.
//
// With an iris it has depth of field. The iris faces each chief ray, as the entrance pupils of fisheyes turn
// toward the side; so a field beyond 90 degrees has one, too. What is in focus lies on the plane across the
// axis at focus_distance_m, or, of models that see to the side and behind, on the sphere of that radius.
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
    Vec2d focal_mm{50, 50};            // across and up
    Vec2d principal_mm{0, 0};          // where the axis meets the film, upright
    double aperture_radius_mm = 0;     // of the round iris; 0: all is sharp
    double focus_distance_m = 1;       // infinity is allowed
    Iris iris = {};                    // shape of unit radius

    /// Numbers that change evenly while it is on its way; the model's parameters change in steps.
    struct Numbers {
        Vec2d focal_mm, principal_mm;
        double aperture_radius_mm, inverse_focus;   // 1/m: 0 at infinity
        double exposure = 1;                        // factor on weights

        /// Square of iris over image distance, like ThinLens::Numbers::light_cone.
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
    /// With other numbers than its own.
    void generate(const Numbers& numbers, std::span<const CameraSample> samples, std::span<CameraRay> rays) const;

    void reproject(std::span<const CameraRay> rays, std::span<Reprojection> out) const {
        reproject(numbers(), rays, out);
    }
    void reproject(const Numbers& numbers, std::span<const CameraRay> rays, std::span<Reprojection> out) const;

    /// Unit, camera frame; nothing where the model sees nothing.
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
