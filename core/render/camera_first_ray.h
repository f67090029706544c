// camera_first_ray.h -- densities with which light paths and camera samples draw the first ray of a camera path. The
// camera's density is the mean over the path's wavelengths of N / e, with N the density of film points
// (Footprint::total) and e the etendue (Reprojection) per unit square of lens samples. Factors common to camera and
// light paths are omitted: the density of times if all lines are open at once, and the integral that normalizes N.
#pragma once
#include <span>

#include "render/light_weight.h"
#include "render/ray_on_film.h"
#include "transport/sharing/first_ray.h"

namespace dg {

class CameraFirstRay final : public FirstRay {
  public:
    /// `ray`: in the camera frame. `landings`: film points of its wavelengths, as in RayOnFilm. Both must outlive this.
    CameraFirstRay(const LightWeight& weight, const Ray& ray, const FilmDensity& density, const Sensor& sensor,
            std::span<const Reprojection> landings)
        : FirstRay(weight, ray.time), weight_(weight), ray_(ray), film_(density), sensor_(sensor), landings_(landings) {}

  private:
    float lens_pdf(Vec3d p, double w) const override {
        const Affine3d to_camera = inverse(weight_.pose(ray_.time));
        return weight_.pupil().pdf(w > 0 ? to_camera.point(p) : to_camera.vector(p), w, ray_);
    }
    /// Computed on demand, as most paths do not need it.
    double camera_density() const override {
        return RayOnFilm(film_, sensor_, landings_, ray_.time).camera_density();
    }
    Viewpoint viewpoint(float time) const override { return weight_.viewpoint(time); }

    const LightWeight& weight_;
    Ray ray_;
    const FilmDensity& film_;
    const Sensor& sensor_;
    std::span<const Reprojection> landings_;
};

}  // namespace dg
