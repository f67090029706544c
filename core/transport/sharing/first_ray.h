// first_ray.h -- MIS weights for emitters on the first ray of a camera path (windows do not end it), against light
// paths from the emitter to the lens. The densities of lens and film are virtual functions; render/camera_first_ray.h
// implements them.
#pragma once
#include <optional>

#include "geometry/hit.h"
#include "light/light.h"
#include "transport/sharing/light_sharing.h"

namespace dg {

class FirstRay {
  public:
    const LightSharing& sharing() const { return sharing_; }

    /// MIS weight of the camera path, in [0, 1]. Empty: light paths cannot find the emitter.
    std::optional<float> weight_of_triangle(const SurfaceHit& hit) const;
    std::optional<float> weight_of_sphere(const LightSet& lights, std::uint32_t sphere, const SurfaceHit& hit) const;
    std::optional<float> weight_of_sky(Vec3f direction) const;

    /// Density of light paths toward the lens from a point (m, world) on the ray, per sr at the point, divided by the
    /// camera's density of the ray.
    double lens_over_camera(Vec3f point) const { return lens_pdf(to_double(point), 1) / camera_density(); }

  protected:
    /// `time`: of the ray. `sharing` must outlive this object.
    FirstRay(const LightSharing& sharing, float time) : sharing_(sharing), time_(time) {}
    ~FirstRay() = default;

  private:
    /// Density with which light paths draw this ray: from a world point (p, 1), m, per sr at the point; from a
    /// direction (p, 0), per m2 perpendicular to the ray.
    virtual float lens_pdf(Vec3d p, double w) const = 0;
    /// Density with which camera samples draw this ray, per m2 sr and sample index.
    virtual double camera_density() const = 0;
    /// Position of the lens at a time.
    virtual Viewpoint viewpoint(float time) const = 0;

    std::optional<float> weight(Vec3d p, double w, float emission_pdf, float cosine) const;

    const LightSharing& sharing_;
    float time_;
};

}  // namespace dg
