// thick.h -- the thick lens of a prescription: two principal planes and an exit pupil instead of glass.
// Source: Kolb, Mitchell, Hanrahan 1995, A Realistic Camera Model for Computer Graphics, sections 3.2
// (thick lens) and 3.4 (exposure over the exit pupil).
//
// A ray from the film goes to a point of the exit pupil, a disc of the iris's shape; it meets the rear
// principal plane, leaves the front one at the same height, and is bent as the focal length says. So every
// film point is imaged to one point. No mount vignettes and no glass absorbs; what is left of the fall-off is
// that of the exit pupil as the film sees it, cos^4 where both are parallel.
#pragma once
#include <limits>
#include <optional>
#include <span>

#include "camera/camera_sample.h"
#include "camera/opening.h"
#include "math/transform.h"
#include "optics/first_order/paraxial.h"
#include "optics/lens/stop.h"

namespace dg {

struct ThickLensSettings {
    double f_stop = 0;  // 0: as wide as the lens opens
    Iris iris = {};
    double focus_distance_m = std::numeric_limits<double>::infinity();
    FocusFrom focus_from = FocusFrom::pupil;
    std::optional<double> film_z = {};  // lens frame, mm, on the lens's axis; set: focus was solved above
    Vec2d tilt_deg{0, 0};               // see tilt.h
};

class ThickLens {
  public:
    /// Error if the lens cannot open or focus like that, or has no pupils at a finite place.
    ThickLens(const Prescription& lens, const ThickLensSettings& settings);

    /// The lens moved to the body of another, like ExactLens::in_the_body_of.
    ThickLens in_the_body_of(const ThickLens& middle) const;

    /// Rays start on the plane of the first vertex.
    void generate(std::span<const CameraSample> samples, std::span<CameraRay> rays) const;

    /// Where scene rays meet the film. (This lens keeps dx dy times the slopes', not dA cos dw: a response
    /// is not the same for all rays.)
    void reproject(std::span<const CameraRay> rays, std::span<Reprojection> out) const;

    /// Through the centres of the pupils: from the camera's origin (unit; camera frame). Every plane that is
    /// imaged to the film sees its points on these rays.
    Vec3d chief_direction(Vec2d film_mm) const;
    /// Its inverse: the film point (mm, upright) that sees a point (p, 1), m, or a direction (p, 0); nothing if none
    /// does.
    std::optional<Vec2d> film_point(Vec3d p, double w) const;
    /// z of the camera's origin, m, as it lies from the middle of the pupil: 0 but for states of a body.
    double pupil_offset_m() const { return offset_m_; }
    /// Camera from lens, with the middle of the entrance pupil as origin.
    const Affine3d& turn() const { return turn_; }
    const Iris& iris() const { return iris_; }
    /// The entrance pupil.
    Opening opening() const;

    /// H0 like ExactLens::h0: with the transmittance of the glass on the axis, which all rays have here.
    double h0() const { return transmittance_ * axial_; }
    double transmittance() const { return transmittance_; }
    double f_stop() const { return f_stop_; }
    double iris_radius_mm() const { return iris_radius_; }
    double film_z_mm() const { return film_z_; }  // lens frame, on its axis
    const FirstOrder& first_order() const { return order_; }

  private:
    /// Lens frame, mm.
    struct Line {
        Vec2d height;  // on the rear or front principal plane, which see the same
        Vec2d slope;   // dx/dz, dy/dz
    };
    Vec3d film_in_lens(Vec2d film_mm) const;
    Line to_scene(Vec3d from, Vec2d pupil) const;
    Line to_film(const Line& scene) const;
    std::optional<Vec3d> meets_film(const Line& rear) const;
    std::optional<Vec2d> film_hit(Vec3d direction) const;
    double solid_angle(Vec3d film, Vec2d pupil) const;

    FirstOrder order_;
    Iris iris_;
    double f_stop_, iris_radius_, film_z_;
    Affine3d turn_;          // camera from lens, mm, origin at the entrance pupil
    Affine3d back_;          // its inverse
    Vec3d film_normal_;      // in the lens's frame, toward the lens
    Vec2d film_origin_{};    // camera frame, mm: where the chief ray from straight ahead lands
    double axial_ = 0, transmittance_ = 1;   // E / L on the axis, without and through glass
    double unit_ = 0;        // E / L of weight 1, without glass
    double offset_m_ = 0;
};

}  // namespace dg
