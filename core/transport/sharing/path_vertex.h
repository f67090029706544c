// path_vertex.h -- a path vertex that can be sampled from the camera and from the light.
//
// The BSDF is defined for camera paths: f(wo, wi) with wo toward the camera and wi toward the light, shaded for the
// view direction wo, with the radiance factor f |ns . wi| for a shading normal ns. A light path carries flux. It is
// scattered by
//     f |ns . wi| |ng . wo| / |ng . wi|       with the geometric normal ng,
// Veach's correction for shading normals (1997, Robust Monte Carlo Methods, section 5.3), and without the factor
// 1 / eta^2 of radiance at refracting delta lobes (5.2).
#pragma once
#include <optional>

#include "material/material.h"

namespace dg {

/// The BSDF between two directions without delta lobes, and its sampling densities in both directions, 1/sr.
struct Scattering {
    Spectrum f_cos{0.f};     // f |ns . to_light|
    float camera_pdf = 0;    // density of to_light for camera paths
    float light_pdf = 0;     // density of to_camera for light paths
    bool hero_only = false;  // as in BsdfSample; light paths end here
};

/// A sampled direction of a light path.
struct LightStep {
    Vec3f to_camera;
    Spectrum weight{0.f};    // of flux
    float pdf = 0;           // as Scattering::light_pdf; 0 for a delta lobe
    float camera_pdf = 0;
    bool specular = false, transmitted = false;
};

class PathVertex {
  public:
    /// `hit`: intersection without a footprint, from either side, before shading. `shaded`, if given: its BSDF for the
    /// view direction hit.wo.
    PathVertex(const Material& material, const std::vector<Texture>& textures, const SurfaceHit& hit,
           const Wavelengths& wavelengths, const Bsdf* shaded = nullptr);

    /// The BSDF shaded for the view direction w. Valid until the next call.
    const Bsdf& seen_from(Vec3f w);
    Scattering scattering(Vec3f to_camera, Vec3f to_light);
    /// Empty: the path ends.
    std::optional<LightStep> step(Vec3f to_light, float u_lobe, Vec2f u);
    /// Whether a delta lobe between two directions is symmetric. It is not if a shading normal was adjusted to face the
    /// viewer.
    bool reversible(Vec3f a, Vec3f b);

  private:
    /// Whether a smooth surface reflects between two sides of its triangle, which light paths cannot find.
    bool is_behind(Vec3f a, Vec3f b) const { return hit_.smooth && dot(hit_.ng, a) * dot(hit_.ng, b) <= 0; }
    Bsdf shade_from(Vec3f w) const;
    const Material& material_;
    const std::vector<Texture>& textures_;
    const Wavelengths& wavelengths_;
    SurfaceHit hit_;
    bool view_independent_;   // shading does not depend on the view direction
    Vec3f view_;              // view direction of bsdf_
    Bsdf bsdf_;
    std::optional<Bsdf> other_bsdf_;
};

}  // namespace dg
