// thick.h -- thick lens of a prescription: two principal planes and an exit pupil. Source: Kolb,
// Mitchell, Hanrahan 1995, A Realistic Camera Model for Computer Graphics, sections 3.2 (thick
// lens) and 3.4 (exposure over the exit pupil).
//
// A ray from the film toward a point of the exit pupil, a disc with the shape of the iris,
// intersects the rear principal plane, leaves the front principal plane at the same height, and is
// refracted by the focal length. So every film point is imaged to a point. There is no mechanical
// vignetting and no absorption; the remaining fall-off comes from the exit pupil as seen from the
// film, cos^4 if both are parallel.
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
    double f_stop = 0;  // 0: wide open
    Iris iris = {};
    double focus_distance_m = std::numeric_limits<double>::infinity();
    FocusFrom focus_from = FocusFrom::pupil;
    std::optional<double> film_z = {};  // lens frame, mm, on the lens's axis; if set, focus is already solved
    Vec2d tilt_deg{0, 0};               // see tilt.h
};

class ThickLens {
  public:
    /// Throws Error if the lens cannot open or focus as requested, or is telecentric.
    ThickLens(const Prescription& lens, const ThickLensSettings& settings);

    /// This lens as a state of another body, like ExactLens::in_the_body_of.
    ThickLens in_the_body_of(const ThickLens& middle) const;

    /// Generates rays that start on the plane of the first vertex.
    void generate(std::span<const CameraSample> samples, std::span<CameraRay> rays) const;

    /// Traces scene rays to the film. (This lens preserves dx dy times the measure of slopes, not
    /// dA cos dw, so the response varies between rays.)
    void reproject(std::span<const CameraRay> rays, std::span<Reprojection> out) const;

    /// Ray from the camera's origin through the centres of the pupils (unit; camera frame). Film
    /// points see points of every conjugate plane along these rays.
    Vec3d chief_direction(Vec2d film_mm) const;
    /// Film point (mm, upright) that sees a point (p, 1) in m, or a direction (p, 0); empty if none
    /// does.
    std::optional<Vec2d> film_point(Vec3d p, double w) const;
    /// z of the camera's origin relative to the pupil's centre, m: nonzero only for states of a
    /// body.
    double pupil_offset_m() const { return offset_m_; }
    /// Camera from lens, with the centre of the entrance pupil as origin.
    const Affine3d& turn() const { return turn_; }
    const Iris& iris() const { return iris_; }
    /// Entrance pupil.
    Opening opening() const;

    /// H0 like ExactLens::h0; all rays have the transmittance of the glass on the axis.
    double h0() const { return transmittance_ * axial_; }
    double transmittance() const { return transmittance_; }
    double f_stop() const { return f_stop_; }
    double iris_radius_mm() const { return iris_radius_; }
    double film_z_mm() const { return film_z_; }  // lens frame, on its axis
    const FirstOrder& first_order() const { return order_; }

  private:
    /// Ray in the lens frame, mm.
    struct Line {
        Vec2d height;  // on the principal planes, equal on both
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
    Affine3d back_;          // inverse of turn_
    Vec3d film_normal_;      // in the lens frame, toward the lens
    Vec2d film_origin_{};    // camera frame, mm: landing point of the chief ray along -z
    double axial_ = 0, transmittance_ = 1;   // E / L on the axis without glass, and transmittance of the glass
    double unit_ = 0;        // E / L of weight 1, without glass
    double offset_m_ = 0;
};

}  // namespace dg
