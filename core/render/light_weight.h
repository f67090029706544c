// light_weight.h -- how the camera's paths and light paths share what both find.
//
// The balance heuristic (Veach 1997, Robust Monte Carlo Methods, section 9.2) gives each technique the share
// of its own density. Both densities are those of one ray, per m2 sr of the phase space in which it is a
// point: film and emitter see the same measure, as both lie in air. For light that goes straight to the lens
//   camera:  mean over the path's wavelengths of  N / e,  N the density of film points (Footprint::total)
//            and e the etendue (Reprojection) per unit square of lens samples;
//   light:   M p(point) p(lens point | point) / cos, M paths per sample index.
// Both are up to common factors: the density of times, where all lines are open at once, and the integral by
// which N is divided.
#pragma once
#include <span>

#include "camera/camera.h"
#include "camera/sensor.h"
#include "geometry/hit.h"
#include "render/dispersion.h"
#include "render/light_guide.h"
#include "render/light_plan.h"
#include "render/ray_on_film.h"
#include "scene/scene.h"

namespace dg {

class LightWeight {
  public:
    /// `plan`: paths per unit of the density's counts. `guide`: of an earlier pass of this picture, or null.
    /// All else outlives this.
    LightWeight(const Scene& scene, const Camera& camera, const Sensor& sensor,
                const FilmDensity& density, LightPlan plan, Technique technique,
                std::shared_ptr<const LightGuide> guide);

    bool off() const { return plan_.off(); }
    bool bounces() const { return plan_.m2 > 0 && !guide_->rays.empty(); }
    const EmissionSampler& emission() const { return guide_->emission; }
    const EmissionRays& emission_rays() const { return guide_->rays; }
    const PupilViewOverTime& pupil() const { return guide_->pupil; }
    Viewpoint viewpoint(float time) const;
    Affine3d pose(float time) const { return camera_.world_from_camera.at(time); }
    const Scene& scene() const { return scene_; }

    /// Density of light paths straight to the lens: `pdf` of the emitter's point and of the lens's, for a ray
    /// that leaves it under this cosine (1 from infinity).
    double of_light(float emission_pdf, float lens_pdf, float cosine) const {
        return plan_.m1 * scale_ * double(emission_pdf) * lens_pdf / cosine;
    }

    /// The same for rays that leave emitters on their way to surfaces; `pdf` as EmissionRay::pdf.
    double of_bounced(double pdf) const { return plan_.m2 * scale_ * pdf; }

    /// Divisor of a light path's find, and the share of a camera path's find that counts.
    double divisor(double light, double camera) const {
        return technique_ == Technique::both ? light + camera : light;
    }
    float camera_share(double light, double camera) const {
        if (technique_ == Technique::both) return float(camera / (light + camera));
        return technique_ == Technique::camera ? 1.f : 0.f;
    }
    bool draws_light() const {
        return !off() && (technique_ == Technique::both || technique_ == Technique::light);
    }

  private:
    const Scene& scene_;
    const Camera& camera_;
    LightPlan plan_;
    Technique technique_;
    double scale_ = 1;
    std::shared_ptr<const LightGuide> guide_;   // null where nothing is drawn
};

/// The first ray of a camera path, while it has met nothing but windows: the share of an emitter's light that
/// is left to it. Nothing where no light path could have found it.
class FirstRay {
  public:
    /// `ray`: camera frame; `landings`: of its wavelengths, as of RayOnFilm. They outlive this.
    FirstRay(const LightWeight& weight, const Ray& ray, const FilmDensity& density,
             const Sensor& sensor, std::span<const Reprojection> landings)
        : weight_(weight), ray_(ray), film_(density), sensor_(sensor), landings_(landings) {}

    std::optional<float> share_of_triangle(const SurfaceHit& hit) const;
    std::optional<float> share_of_sphere(std::uint32_t sphere, const SurfaceHit& hit) const;
    std::optional<float> share_of_sky(Vec3f direction) const;

    const LightWeight& weight() const { return weight_; }
    /// Density of rays to the lens from a point (m, world) on the ray, per sr there, over that of the camera.
    double lens_over_camera(Vec3f point) const;

  private:
    std::optional<float> share(Vec3d at, double w, float emission_pdf, float cosine) const;
    /// Density of the camera's samples; most paths are never asked.
    double density() const {
        return RayOnFilm(film_, sensor_, landings_, ray_.time).camera_density();
    }

    const LightWeight& weight_;
    Ray ray_;
    const FilmDensity& film_;
    const Sensor& sensor_;
    std::span<const Reprojection> landings_;
};

}  // namespace dg
