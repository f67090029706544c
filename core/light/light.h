// light.h -- emitters: sample, pdf, emission. They take geometry, never the scene.
// Photometric law: colours are Rgb of D65-shaped spectra; intensity cd, illuminance lux, luminance cd/m2.
#pragma once
#include <optional>
#include <variant>
#include <vector>

#include "geometry/mesh.h"
#include "light/environment.h"
#include "math/distribution.h"
#include "math/transform.h"
#include "spectrum/wavelengths.h"

namespace dg {

struct PointLight {
    Vec3f position;         // m
    Rgb intensity;          // cd
    float range = std::numeric_limits<float>::infinity();  // m; glTF window (KHR_lights_punctual)
};
struct SpotLight {
    Vec3f position;         // m
    Vec3f direction;        // unit, where it shines
    Rgb intensity;          // cd, on the axis
    float inner_angle, outer_angle;   // rad, half angles
    float range = std::numeric_limits<float>::infinity();
};
struct DirectionalLight {
    Vec3f direction;        // unit, where it shines
    Rgb illuminance;        // lux
};
/// A ball that shines evenly; rays can hit it (Intersector sphere `sphere`).
struct SphereLight {
    Sphere shape;
    Rgb luminance;          // cd/m2
};
/// One emissive triangle, world space.
struct TriangleLight {
    Vec3f a, b, c;
    Rgb mean_luminance;     // cd/m2, mean over the triangle: steers the choice of lights only
    std::uint32_t instance, primitive;
    bool two_sided;
};
using Light = std::variant<PointLight, SpotLight, DirectionalLight, SphereLight, TriangleLight>;

struct LightSample {
    Vec3f wi;               // unit, toward the light
    float distance;         // m; infinity for directional and environment
    Spectrum radiance;      // incident radiance; for a delta light the incident irradiance on a facing surface
    float pdf;              // solid angle, selection included; for a delta light the selection probability
    bool delta;
    /// For triangle lights: where it was sampled; the scene evaluates textured emission there.
    std::int64_t triangle_light = -1;
    Vec2f barycentric;
};

/// All lights of a scene with the law by which one is chosen (power, and the environment).
class LightSet {
  public:
    LightSet() = default;
    /// scene_radius: m, of the bounding sphere: makes powers of directional lights and environment comparable.
    LightSet(std::vector<Light> lights, std::optional<Environment> environment, float scene_radius);

    bool empty() const;
    /// Radiance of triangle lights is mean_luminance here; LightSample::triangle_light tells the caller
    /// to replace it by the textured value.
    std::optional<LightSample> sample(float u_select, Vec2f u, Vec3f position,
                                      const Wavelengths& wavelengths) const;
    /// Solid-angle density (selection included) with which sample() would have chosen the direction
    /// from `position` that met this triangle at `t` metres under |cos| at the light.
    float pdf_triangle(std::uint32_t instance, std::uint32_t primitive, float t, float cos_light) const;
    float pdf_sphere(std::uint32_t sphere, Vec3f position) const;
    float pdf_environment(Vec3f direction) const;
    /// Emission seen by a ray that hit sphere light `sphere` / left the scene.
    Spectrum sphere_radiance(std::uint32_t sphere, const Wavelengths& wavelengths) const;
    Spectrum environment_radiance(Vec3f direction, const Wavelengths& wavelengths) const;
    bool has_environment() const;
    const std::vector<Light>& lights() const;
};

}  // namespace dg
