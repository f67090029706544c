// camera_first_ray.h -- the first ray of a camera path as the lens and the film know it: how densely light paths and the
// camera's samples draw it. The camera's density is the mean over the path's wavelengths of N / e, N the density
// of film points (Footprint::total) and e the etendue (Reprojection) per unit square of lens samples. It is up to
// factors that light paths have too: the density of times, where all lines are open at once, and the integral by
// which N is divided.
#pragma once
#include <span>

#include "render/light_weight.h"
#include "render/ray_on_film.h"
#include "transport/sharing/first_ray.h"

namespace dg {

class CameraFirstRay final : public FirstRay {
  public:
    /// `ray`: camera frame; `landings`: of its wavelengths, as of RayOnFilm. They outlive this.
    CameraFirstRay(const LightWeight& weight, const Ray& ray, const FilmDensity& density, const Sensor& sensor,
            std::span<const Reprojection> landings)
        : FirstRay(weight, ray.time), weight_(weight), ray_(ray), film_(density), sensor_(sensor), landings_(landings) {}

  private:
    float lens_pdf(Vec3d p, double w) const override {
        const Affine3d to_camera = inverse(weight_.pose(ray_.time));
        return weight_.pupil().pdf(w > 0 ? to_camera.point(p) : to_camera.vector(p), w, ray_);
    }
    /// Most paths are never asked.
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
