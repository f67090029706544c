// projection_model.h -- projection models: maps from directions to image points by calibration or
// formula, for fisheyes, panoramas, and the models of OpenCV, Kalibr and similar tools.
//
// Frame of this file, as in OpenCV: x right, y down, z ahead. Image points are relative to the
// principal point in units of focal length, like OpenCV's points before the camera matrix.
//
// Sources: OpenCV 5, "Camera Calibration and 3D Reconstruction" (rational, thin prism, tilt) and
// "Fisheye"; Kannala and Brandt 2006; OpenLensIO 1.0.1 (the inverse: its Brown-Conrady D-U);
// Usenko, Demmel and Cremers 2018, The Double Sphere Camera Model (double sphere, EUCM, UCM and
// their domains); Mei and Rives 2007 (omni); Devernay and Faugeras 2001 (FOV); NVIDIA, "Lens
// Distortion Schemas" of OmniLensDistortionFthetaAPI (f-theta).
#pragma once
#include <array>
#include <optional>
#include <string_view>

#include "math/vec.h"

namespace dg {

struct ProjectionModel {
    enum class Kind {
        rectilinear, equidistant, equisolid, stereographic, orthographic,   // functions of the angle from the axis
        equirectangular,   // longitude and latitude; x, y in radians
        cube,              // six faces in a row, of side 1: right, left, down, up, ahead, behind
        opencv,            // k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tilt_x tilt_y (radians)
        kannala_brandt,    // k1 k2 k3 k4; OpenCV's fisheye, ROS's and Kalibr's equidistant
        double_sphere,     // xi alpha
        eucm,              // alpha beta
        omni,              // xi k1 k2 p1 p2; Kalibr's omni with radtan
        fov,               // w (radians)
        opencv_inverse,    // k1 k2 p1 p2 k3 k4 k5 k6: maps image points to ideal points by opencv's terms
        ftheta,            // k2 k3 k4 k5: angle = r + k2 r^2 + k3 r^3 + k4 r^4 + k5 r^5, NVIDIA's f-theta
    };
    static constexpr int kMost = 14;

    /// Throws an Error with the parameter's name for invalid parameters.
    explicit ProjectionModel(Kind kind = Kind::rectilinear, std::array<double, kMost> parameters = {});

    Kind kind() const { return kind_; }
    /// Image point of a direction (of any length); empty outside the model's field of view.
    std::optional<Vec2d> project(Vec3d direction) const;
    /// Direction (unit) of an image point; empty if the model has none.
    std::optional<Vec3d> unproject(Vec2d point) const;
    /// Wraps a point beyond the edges of a panorama to the other side, for the filters of edge
    /// pixels. The identity for other models.
    Vec2d continued(Vec2d point) const;
    /// Solid angle per area of the image; 0 outside the field of view.
    double solid_angle(Vec2d point) const;

    /// Limits of the field of view of axially symmetric models (opencv: of the radial terms):
    /// largest angle from the axis and largest image radius; infinite without limit.
    double largest_angle() const { return largest_angle_; }
    double largest_radius() const { return largest_radius_; }
    /// Whether the field of view may include directions at 90 degrees and beyond.
    bool is_wide() const;

  private:
    double radius_of(double angle) const;
    double ftheta_angle(double radius) const;
    double ftheta_slope(double radius) const;
    std::optional<double> angle_of(double radius) const;
    std::optional<Vec2d> distorted(Vec2d ideal) const;     // of opencv and omni
    std::optional<Vec2d> undistorted(Vec2d point) const;
    struct Bent {
        Vec2d point, by_x, by_y;
        double area() const { return by_x.x * by_y.y - by_x.y * by_y.x; }   // not positive at a fold
    };
    Bent bent(Vec2d ideal) const;
    double radial_factor(double radius) const;
    double radial_slope(double radius) const;
    void find_fold();

    Kind kind_;
    std::array<double, kMost> k_;
    std::array<double, 8> radial_{};   // k1 k2 p1 p2 k3 k4 k5 k6, of opencv and omni
    std::array<double, 9> tilt_{}, untilt_{};   // row-major
    bool tilts_ = false;
    bool leans_ = false;   // has terms without axial symmetry
    double largest_angle_, largest_radius_;
    double ideal_end_;   // fold of opencv and omni: ideal radius at which the distorted radius peaks; swapped for
                         // opencv_inverse
};

}  // namespace dg
