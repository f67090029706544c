// camera.h -- the kinds of camera and the one function that they share. A camera is a pure function of
// named random numbers: a film point, a lens sample, a time and a wavelength give a ray and a weight.
//
// Camera frame: metres, origin = centre of the entrance pupil, -z along the view, +x right, +y up.
// Film points: mm, as the picture is seen upright: +x right, +y up, (0,0) on the optical axis.
// Adding a kind: x.h/x.cpp with generate(), and an alternative of LensKind.
#pragma once
#include <span>
#include <variant>

#include "camera/exact.h"
#include "camera/pinhole.h"
#include "camera/projection.h"
#include "camera/thick.h"
#include "camera/thin.h"
#include "geometry/ray.h"
#include "motion/keyed.h"
#include "motion/motion.h"

namespace dg {

using LensKind = std::variant<Pinhole, ThinLens, ThickLens, ExactLens, Projection>;

/// The lens at some moments (fractions of the scene's interval that do not fall), all of one kind. Ideal
/// lenses and the numbers of projections change evenly from one to the next; of thick and exact ones, and of
/// the parameters of a projection's model, each sample takes the nearest in time.
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

/// The camera's setting at a time.
inline LensSetting setting_at(const Camera& camera, float time) {
    return camera.setting.values.empty() ? LensSetting{} : camera.setting.at(time);
}

/// The wall between the camera's frame and the world's, as they lie at the ray's time.
Ray to_world(const Camera& camera, const Ray& ray);

}  // namespace dg
