// light_sharing.h -- MIS between camera paths and light paths.
//
// The balance heuristic (Veach 1997, Robust Monte Carlo Methods, section 9.2) weighs each technique by its density. The
// densities are densities of rays, per m2 sr (etendue), a measure that film and emitter share because both are in air.
// FirstRay provides the camera's density (first_ray.h). The density of M light paths per sample index is
//   M p(point) p(lens point | point) / cos
// for paths directly to the lens, and M p(emitted ray) for paths with bounces.
#pragma once
#include "light/emission.h"
#include "light/emission_ray.h"
#include "transport/sharing/light_plan.h"

namespace dg {

class LightSharing {
  public:
    /// `plan`: light paths per unit of the camera's density. `scale`: divisor of the camera's density. `emission`,
    /// `rays`: samplers of emitters; they must outlive this object, and are null if the plan is off.
    LightSharing(LightPlan plan, Technique technique, double scale, const EmissionSampler* emission,
                 const EmissionRays* rays)
        : plan_(plan), technique_(technique), scale_(scale), emission_(emission), rays_(rays) {}

    bool off() const { return plan_.off(); }
    bool bounces() const { return plan_.m2 > 0 && !rays_->empty(); }
    const EmissionSampler& emission() const { return *emission_; }
    const EmissionRays& emission_rays() const { return *rays_; }

    /// Density of light paths directly to the lens, from the densities of the emitter point and of the direction to the
    /// lens, and the cosine at the emitter (1 for emitters at infinity).
    double direct_density(float emission_pdf, float lens_pdf, float cosine) const {
        return plan_.m1 * scale_ * double(emission_pdf) * lens_pdf / cosine;
    }

    /// Density of light paths with bounces; `pdf`: density of the emitted ray, as EmissionRay::pdf.
    double bounced_density(double pdf) const { return plan_.m2 * scale_ * pdf; }

    /// Divisor of a light path's contribution, for densities of light and camera paths.
    double divisor(double light, double camera) const {
        return technique_ == Technique::both ? light + camera : light;
    }
    /// MIS weight of a camera path's contribution.
    float camera_weight(double light, double camera) const {
        if (technique_ == Technique::both) return float(camera / (light + camera));
        return technique_ == Technique::camera ? 1.f : 0.f;
    }
    bool draws_light() const {
        return !off() && (technique_ == Technique::both || technique_ == Technique::light);
    }

  private:
    LightPlan plan_;
    Technique technique_;
    double scale_;
    const EmissionSampler* emission_;
    const EmissionRays* rays_;
};

}  // namespace dg
