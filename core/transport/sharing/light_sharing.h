// light_sharing.h -- how the camera's paths and light paths share what both find.
//
// The balance heuristic (Veach 1997, Robust Monte Carlo Methods, section 9.2) gives each technique the share
// of its own density. Both densities are those of one ray, per m2 sr of the phase space in which it is a
// point: film and emitter see the same measure, as both lie in air. How densely the camera draws a ray is asked
// of it (first_ray.h); for light that goes straight to the lens light paths have
//   M p(point) p(lens point | point) / cos, M paths per sample index,
// and for light with bounces M p of the ray that leaves the emitter.
#pragma once
#include "light/emission.h"
#include "light/emission_ray.h"
#include "transport/sharing/light_plan.h"

namespace dg {

class LightSharing {
  public:
    /// `plan`: paths per unit of the camera's density, which is divided by `scale`. `emission`, `rays`: how light
    /// paths leave emitters; they outlive this, and are null if the plan is off.
    LightSharing(LightPlan plan, Technique technique, double scale, const EmissionSampler* emission,
                 const EmissionRays* rays)
        : plan_(plan), technique_(technique), scale_(scale), emission_(emission), rays_(rays) {}

    bool off() const { return plan_.off(); }
    bool bounces() const { return plan_.m2 > 0 && !rays_->empty(); }
    const EmissionSampler& emission() const { return *emission_; }
    const EmissionRays& emission_rays() const { return *rays_; }

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
    LightPlan plan_;
    Technique technique_;
    double scale_;
    const EmissionSampler* emission_;
    const EmissionRays* rays_;
};

}  // namespace dg
