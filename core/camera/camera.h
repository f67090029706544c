// camera.h -- the kinds of camera and their common interface. A camera is a pure function of named
// random numbers: film point, lens sample, time and wavelength give a ray and a weight.
//
// Camera frame: metres, origin at the centre of the entrance pupil, -z along the view, +x right, +y
// up. Film points: mm in the upright image, +x right, +y up, (0,0) on the optical axis.
//
// A new ideal kind X takes four files (examples/camera_kind.diff); the compiler reports missing
// functions:
//   camera/x.h                         the interface of camera_kind.h: generate() and reproject(),
//                                      chief_direction() and film_point(), opening(); numbers(),
//                                      set() and blend() for parameters that change over time
//   camera/camera.h                    X as an alternative of LensKind
//   bind/bind_camera.cpp               a constructor
//   python/daguerre/camera/ideal.py    a row: name, whether it has an iris, call of the constructor
// Also add X to the cameras of the tests (camera/inverse/view_cases.h), to docs/lens-models.md and
// to CHANGELOG.md. A new parameter takes another row (CONTRIBUTING.md). Kinds with chief rays or
// pupils that vary over the film define ChiefRays::of and PupilView::of instead, like the exact
// lens. render does not distinguish kinds, except for features of exact lenses: dispersion, ghosts,
// scatter.
#pragma once
#include <span>
#include <variant>

#include "camera/camera_kind.h"
#include "camera/exact.h"
#include "camera/near_clip.h"
#include "camera/pinhole.h"
#include "camera/projection.h"
#include "camera/thick.h"
#include "camera/thin.h"
#include "geometry/ray.h"
#include "motion/keyed.h"
#include "motion/motion.h"

namespace dg {

using LensKind = std::variant<Pinhole, ThinLens, ThickLens, ExactLens, Projection>;

template <typename Kinds>
inline constexpr bool kCameraKinds = false;
template <typename... L>
inline constexpr bool kCameraKinds<std::variant<L...>> = (CameraKind<L> && ...);
static_assert(kCameraKinds<LensKind>);

/// Keyframes of the lens, all of one kind, at ascending times (fractions of the scene's interval).
/// Kinds with numbers interpolate them linearly between keys; other kinds, and parameters that are
/// not numbers (a projection's model), use the nearest key.
struct LensMotion {
    std::vector<float> times;       // empty: constant
    std::vector<LensKind> lenses;   // exact and thick lenses relative to the camera's lens (in_the_body_of)
};

/// Other settings that change over time: iris radius as a fraction of the lens's iris radius, and
/// film shift (mm, upright) in addition to the sensor's centre.
struct LensSetting {
    float iris_opening = 1;
    Vec2f film_shift_mm{0, 0};
};
inline LensSetting blend(const LensSetting& a, const LensSetting& b, float s) {
    return {a.iris_opening + s * (b.iris_opening - a.iris_opening),
            a.film_shift_mm + (b.film_shift_mm - a.film_shift_mm) * s};
}

struct Camera {
    Motion world_from_camera;   // rigid, metres; time as fraction of the scene's interval
    LensKind lens;              // at mid-interval; reference of H0
    LensMotion lens_motion = {};
    Keyed<LensSetting> setting = {};  // empty: constant
    SensorStack sensor_stack = {};    // reflecting parts of the body, for ghosts and scatter only
    LensScatter scatter = {};         // scatter of an exact lens's parts, if rendered
    NearClip near_clip = {};          // near clipping of the view
};

/// Generates rays[i] (camera frame) for samples[i], with the lens at their times; weight 0:
/// clipped. Weights are exposures divided by H0: under uniform luminance 1, their mean is 1 on the
/// optical axis at mid-interval.
void generate_rays(const Camera& camera, std::span<const CameraSample> samples,
                   std::span<CameraRay> rays);

/// Traces scene rays (camera frame, from the origins that generate_rays uses) to the film, each at
/// its wavelength in nm, with the lens at their times. A ray from generate_rays returns to its film
/// point with its weight, aim_weight x transmittance.
void reproject(const Camera& camera, std::span<const CameraRay> rays,
               std::span<const float> wavelength_nm, std::span<Reprojection> out);

/// Converts physical film points to points of the upright image, by subtracting the film shift at
/// the rays' times.
void undo_film_shift(const Camera& camera, std::span<const CameraRay> rays, std::span<Reprojection> landings);

/// The camera's setting at a time.
inline LensSetting setting_at(const Camera& camera, float time) {
    return camera.setting.values.empty() ? LensSetting{} : camera.setting.at(time);
}

/// Transforms a ray from camera frame to world frame at the ray's time. Near clipping sets the
/// ray's t_min.
Ray to_world(const Camera& camera, const Ray& ray);

}  // namespace dg
