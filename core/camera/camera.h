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
#include "camera/thin.h"
#include "geometry/ray.h"
#include "motion/motion.h"

namespace dg {

using LensKind = std::variant<Pinhole, ThinLens, ExactLens>;

struct Camera {
    Motion world_from_camera;   // rigid; metres; time: fraction of the scene's interval
    LensKind lens;
};

/// Fills rays[i] (camera frame) for samples[i]; weight 0: stopped by glass or iris. A white world of
/// luminance 1 has mean weight 1 on the optical axis: weights are exposures divided by H0.
void generate_rays(const Camera& camera, std::span<const CameraSample> samples,
                   std::span<CameraRay> rays);

/// The wall between the camera's frame and the world's, as they lie at the ray's time.
Ray to_world(const Camera& camera, const Ray& ray);

}  // namespace dg
