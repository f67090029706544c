// camera.h -- the kinds of camera and the one function that they share. A camera is a pure function of
// named random numbers: a film point, a lens sample, a time and a wavelength give a ray and a weight.
//
// Camera frame: metres, origin = centre of the entrance pupil, -z along the view, +x right, +y up.
// Film points: mm, as the picture is seen upright: +x right, +y up, (0,0) on the optical axis.
//
// Adding an ideal kind X takes four files (examples/camera_kind.diff); the compiler says what is missing:
//   camera/x.h                         what camera_kind.h asks for: generate() and reproject(), chief_direction() and
//                                      film_point(), opening(); numbers(), set() and blend() for what changes
//   camera/camera.h                    X as an alternative of LensKind
//   bind/bind_camera.cpp               a constructor
//   python/daguerre/camera/ideal.py    a row: its name, whether it has an iris, the call of the constructor
// Then X joins the cameras that all tests of the way back run through (camera/inverse/view_cases.h), and stands in
// docs/lens-models.md and CHANGELOG.md. A parameter of its own is a row more (CONTRIBUTING.md). A kind whose chief rays
// or pupil change from place to place has ChiefRays::of and PupilView::of instead, like the exact lens.
// Nothing in render asks for a kind, but for what only an exact lens has: wavelengths that part, ghosts, scatter.
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

/// The lens at some moments (fractions of the scene's interval that do not fall), all of one kind. Kinds that
/// have numbers change evenly from one to the next; of others, and of what is no number (the parameters of a
/// projection's model), each sample takes the nearest in time.
struct LensMotion {
    std::vector<float> times;       // empty: it stays as it is
    std::vector<LensKind> lenses;   // real ones relative to the camera's own (in_the_body_of)
};

/// Other changes behind and in the lens: the iris's radius, as a fraction of the lens's own, and how
/// far the film is shifted (mm, upright), in addition to the sensor's centre.
struct LensSetting {
    float iris_opening = 1;
    Vec2f film_shift_mm{0, 0};
};
inline LensSetting blend(const LensSetting& a, const LensSetting& b, float s) {
    return {a.iris_opening + s * (b.iris_opening - a.iris_opening),
            a.film_shift_mm + (b.film_shift_mm - a.film_shift_mm) * s};
}

struct Camera {
    Motion world_from_camera;   // rigid; metres; time: fraction of the scene's interval
    LensKind lens;              // as it is at mid-interval: what H0 is measured with
    LensMotion lens_motion = {};
    Keyed<LensSetting> setting = {};  // empty: it stays
    SensorStack sensor_stack = {};    // what of the body reflects: for ghosts and scatter alone
    LensScatter scatter = {};         // how an exact lens's parts scatter, where that is drawn
    NearClip near_clip = {};          // of its view
};

/// Fills rays[i] (camera frame) for samples[i], with the lens as it is at their times; weight 0: stopped by
/// glass or iris. A white world of luminance 1 has mean weight 1 on the optical axis at mid-interval:
/// weights are exposures divided by H0.
void generate_rays(const Camera& camera, std::span<const CameraSample> samples,
                   std::span<CameraRay> rays);

/// Where scene rays (camera frame, from where generate_rays lets them start) meet the film, each at its
/// wavelength in nm, with the lens as it is at their times. A ray that generate_rays drew comes back to its
/// own film point with its own weight, aim_weight x transmittance.
void reproject(const Camera& camera, std::span<const CameraRay> rays,
               std::span<const float> wavelength_nm, std::span<Reprojection> out);

/// Film points of the picture from those on the film, which lay elsewhere where it is shifted at the rays' times.
void undo_film_shift(const Camera& camera, std::span<const CameraRay> rays, std::span<Reprojection> landings);

/// The camera's setting at a time.
inline LensSetting setting_at(const Camera& camera, float time) {
    return camera.setting.values.empty() ? LensSetting{} : camera.setting.at(time);
}

/// The wall between the camera's frame and the world's, as they lie at the ray's time. What the camera clips lies
/// before the t_min of the ray.
Ray to_world(const Camera& camera, const Ray& ray);

}  // namespace dg
