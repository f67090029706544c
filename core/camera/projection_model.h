// projection_model.h -- how a camera that is known by a calibration, or by a formula, maps directions to its
// picture: fisheyes, panoramas, and the models of OpenCV, Kalibr and their kin.
//
// Frame of this file, which is OpenCV's: x to the right, y down, z ahead. Points of the picture are in units
// of the focal length from the principal point, as OpenCV has them before the camera matrix.
//
// Sources: OpenCV 5, "Camera Calibration and 3D Reconstruction" (rational, thin prism, tilt) and "Fisheye";
// Kannala and Brandt 2006; OpenLensIO 1.0.1 (the inverse: its Brown-Conrady D-U); Usenko, Demmel and Cremers 2018, The Double Sphere Camera Model (double sphere,
// EUCM, UCM and their domains); Mei and Rives 2007 (omni); Devernay and Faugeras 2001 (FOV); NVIDIA, "Lens Distortion
// Schemas" of OmniLensDistortionFthetaAPI (f-theta).
#pragma once
#include <array>
#include <optional>
#include <string_view>

#include "math/vec.h"

namespace dg {

struct ProjectionModel {
    enum class Kind {
        rectilinear, equidistant, equisolid, stereographic, orthographic,   // by the angle from the axis alone
        equirectangular,   // longitude and latitude; x, y in radians
        cube,              // six faces side by side, of side 1: right, left, below, above, ahead, behind
        opencv,            // k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tilt_x tilt_y (radians)
        kannala_brandt,    // k1 k2 k3 k4; OpenCV's fisheye, ROS's and Kalibr's equidistant
        double_sphere,     // xi alpha
        eucm,              // alpha beta
        omni,              // xi k1 k2 p1 p2; Kalibr's omni with radtan
        fov,               // w (radians)
        opencv_inverse,    // k1 k2 p1 p2 k3 k4 k5 k6: points of the picture to ideal ones, by opencv's terms
        ftheta,            // k2 k3 k4 k5: angle = r + k2 r^2 + k3 r^3 + k4 r^4 + k5 r^5, NVIDIA's f-theta
    };
    static constexpr int kMost = 14;

    /// Error that names the parameter where they make no model.
    explicit ProjectionModel(Kind kind = Kind::rectilinear, std::array<double, kMost> parameters = {});

    Kind kind() const { return kind_; }
    /// Where a direction (of any length) is seen; nothing outside of the model's valid field, where no point of the
    /// picture sees it.
    std::optional<Vec2d> project(Vec3d direction) const;
    /// The direction (unit) that a point sees; nothing where the model has none.
    std::optional<Vec3d> unproject(Vec2d point) const;
    /// The point in place of one beyond the edges: a panorama goes on at its other side, where the filters of its last
    /// pixels reach. Of other models the point itself.
    Vec2d continued(Vec2d point) const;
    /// Solid angle per area of the picture; 0 where nothing is seen.
    double solid_angle(Vec2d point) const;

    /// Ends of the valid field: the largest angle from the axis, and the largest radius of the picture, of models that
    /// are the same on all sides (opencv: of its radial part); infinite where nothing ends.
    double largest_angle() const { return largest_angle_; }
    double largest_radius() const { return largest_radius_; }
    /// Directions straight to the side, or behind, may be seen.
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
        double area() const { return by_x.x * by_y.y - by_x.y * by_y.x; }   // at most 0 where it folds
    };
    Bent bent(Vec2d ideal) const;
    double radial_factor(double radius) const;
    double radial_slope(double radius) const;
    void find_fold();

    Kind kind_;
    std::array<double, kMost> k_;
    std::array<double, 8> radial_{};   // k1 k2 p1 p2 k3 k4 k5 k6, of opencv and omni
    std::array<double, 9> tilt_{}, untilt_{};   // rows
    bool tilts_ = false;
    bool leans_ = false;   // has terms that are not the same on all sides
    double largest_angle_, largest_radius_;
    double ideal_end_;   // of opencv and omni: the ideal radius where the distorted one folds; of the inverse the other
};

}  // namespace dg
