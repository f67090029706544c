// path_vertex.h -- a vertex of a path that can be followed either way.
//
// The BSDF counts as a path from the camera has it: f(wo, wi) with wo toward the camera and wi toward
// the light, shaded as it looks from wo, and radiance is f |ns . wi| for a shading normal ns. A path from the
// light carries flux past the same vertex, and finds the same light if it is scattered by
//     f |ns . wi| |ng . wo| / |ng . wi|       with the geometric normal ng,
// Veach's correction for shading normals (1997, Robust Monte Carlo Methods, section 5.3); and flux has no
// 1 / eta^2 where a delta lobe refracts it (5.2).
#pragma once
#include <optional>

#include "material/material.h"

namespace dg {

/// The BSDF between two directions, delta lobes aside, and the densities of either way to sample it (sr).
struct Scattering {
    Spectrum f_cos{0.f};     // f |ns . to_light|
    float camera_pdf = 0;    // of to_light, by a path that comes from the camera
    float light_pdf = 0;     // of to_camera, by a path that comes from the light
    bool hero_only = false;  // as in BsdfSample: no path from the light goes on from there
};

/// How a path from the light goes on.
struct LightStep {
    Vec3f to_camera;
    Spectrum weight{0.f};    // of flux
    float pdf = 0;           // as Scattering::light_pdf; a delta lobe has none
    float camera_pdf = 0;
    bool specular = false, transmitted = false;
};

class PathVertex {
  public:
    /// `hit` as a ray without a cone finds it, from either side, not yet shaded. `shaded`, if given, is its
    /// BSDF as seen from hit.wo.
    PathVertex(const Material& material, const std::vector<Texture>& textures, const SurfaceHit& hit,
           const Wavelengths& wavelengths, const Bsdf* shaded = nullptr);

    /// The BSDF that a path finds which comes along w. Valid until the next call.
    const Bsdf& seen_from(Vec3f w);
    Scattering scattering(Vec3f to_camera, Vec3f to_light);
    /// Empty: the path ends.
    std::optional<LightStep> step(Vec3f to_light, float u_lobe, Vec2f u);
    /// Whether a delta lobe that takes one direction to the other takes it back too: not where a shading
    /// normal had to be bent to be visible.
    bool reversible(Vec3f a, Vec3f b);

  private:
    Bsdf shade_from(Vec3f w) const;
    const Material& material_;
    const std::vector<Texture>& textures_;
    const Wavelengths& wavelengths_;
    SurfaceHit hit_;
    bool even_;      // shading does not depend on where it is seen from
    Vec3f from_;     // of here_
    Bsdf here_;
    std::optional<Bsdf> there_;
};

}  // namespace dg
