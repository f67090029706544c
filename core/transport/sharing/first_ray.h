// first_ray.h -- the first ray of a camera path, while it has met nothing but windows: the share of an emitter's
// light that is left to it, where light paths find the same. What only the lens and the film know is asked for;
// whoever has them answers (render/camera_first_ray.h).
#pragma once
#include <optional>

#include "geometry/hit.h"
#include "light/light.h"
#include "transport/sharing/light_sharing.h"

namespace dg {

class FirstRay {
  public:
    const LightSharing& sharing() const { return sharing_; }

    /// Nothing where no light path could have found it.
    std::optional<float> share_of_triangle(const SurfaceHit& hit) const;
    std::optional<float> share_of_sphere(const LightSet& lights, std::uint32_t sphere, const SurfaceHit& hit) const;
    std::optional<float> share_of_sky(Vec3f direction) const;

    /// Density of rays to the lens from a point (m, world) on the ray, per sr there, over that of the camera.
    double lens_over_camera(Vec3f point) const { return lens_pdf(to_double(point), 1) / camera_density(); }

  protected:
    /// `time` of the ray. `sharing` outlives this.
    FirstRay(const LightSharing& sharing, float time) : sharing_(sharing), time_(time) {}
    ~FirstRay() = default;

  private:
    /// Density with which a light path draws this ray from a point of the world (p, 1) in m, per sr there, or
    /// from the direction (p, 0), per m2 across the ray.
    virtual float lens_pdf(Vec3d p, double w) const = 0;
    /// Density with which camera samples draw it, per m2 sr and sample index.
    virtual double camera_density() const = 0;
    /// Where the lens is at a time.
    virtual Viewpoint viewpoint(float time) const = 0;

    std::optional<float> share(Vec3d p, double w, float emission_pdf, float cosine) const;

    const LightSharing& sharing_;
    float time_;
};

}  // namespace dg
