// glass_albedo.h -- directional albedo of single scattering at rough glass, by index, angle and roughness. The
// difference to 1 is blocked by facets; glass with compensation scatters it diffusely (bsdf_glass.h). The reflectance
// of the outside also serves for rough coats (bsdf_coated.h).
#pragma once
#include "material/facets.h"
#include "material/indexed_albedo.h"

namespace dg {

/// Mean Fresnel reflectance for diffuse light from the thinner side of an interface of relative index n >= 1. For light
/// from the denser side, 1 - mean is smaller by 1 / n^2. Source: Duntley 1942, The Optical Properties of Diffusing
/// Materials, J. Opt. Soc. Am. 32(2), the integral of Fresnel's equations in closed form.
float mean_fresnel(float n);

/// Albedos at a cosine: shares of light that facets block, for the thinner and the denser side; reflection of the
/// thinner side with the Fresnel curve rescaled to start at 0, and with a reflectance of 1.
struct GlassLobes {
    float missing_thin = 0, missing_dense = 0, curve = 0, facets = 1;

    /// Reflectance of the thinner side. `f0`: reflectance at normal incidence.
    float reflected(float f0) const { return f0 * facets + (1 - f0) * curve; }
};

/// Albedos for an index and facets. Anisotropic facets use the isotropic table with the roughness for the direction
/// (StretchedGgx::alpha_toward).
class GlassAlbedo {
  public:
    GlassAlbedo(float n, const Facets& facets);

    GlassLobes toward(Vec3f w, float cosine) const;
    const GlassLobes& mean() const { return mean_; }   // cosine-weighted

  private:
    float n_;
    StretchedGgx facets_;
    Distribution distribution_;
    IndexedAlbedo::Row row_;   // for isotropic facets
    GlassLobes mean_;
};

/// Light that enters a smooth coat of index n over a white metal and is reflected back to the metal by the inside of
/// the coat: its share of diffuse light, its share for a cosine, and the mean. See bsdf_coated.h.
struct CaughtBelow {
    IndexedAlbedo::Row row;

    CaughtBelow(float n, float alpha, Distribution distribution);
    float of_passed(float cosine) const { return row.at(cosine)[0]; }
    float mean() const { return row.mean[1]; }
};

/// Mean share of diffuse light that isotropic facets of reflectance 1 do not block.
float mean_passed(float alpha, Distribution distribution);

}  // namespace dg
