// glass_albedo.h -- how much light rough glass returns by index, angle and roughness, for light that meets one
// facet alone. What it returns less than 1 facets block; a glass that keeps its energy returns it otherwise
// (bsdf_glass.h). What the outside reflects is what a rough coat reflects (bsdf_coated.h).
#pragma once
#include "material/facets.h"
#include "material/indexed_albedo.h"

namespace dg {

/// Mean of Fresnel's reflectance over diffuse light that arrives at the denser side of an interface of relative index
/// n >= 1 from the thinner one. From the denser side 1 - mean is 1 / n^2 of that. Source: Duntley 1942, The Optical
/// Properties of Diffusing Materials, J. Opt. Soc. Am. 32(2), the integral of Fresnel's equations in closed form.
float mean_fresnel(float n);

/// Share of light from a cosine that facets block, for the thinner and the denser side; what the thinner side reflects
/// with Fresnel's curve from 0 at normal incidence to 1 in place of the reflectance, and with a reflectance of 1.
struct GlassLobes {
    float missing_thin = 0, missing_dense = 0, curve = 0, facets = 1;

    /// Share that the thinner side of an interface of this reflectance at normal incidence reflects.
    float reflected(float f0) const { return f0 * facets + (1 - f0) * curve; }
};

/// One index and the facets of one interface. Facets of two roughnesses count as round ones by the direction that
/// they are seen from (StretchedGgx::alpha_toward).
class GlassAlbedo {
  public:
    /// The first one of all of a distribution fills its table (0.3 s).
    GlassAlbedo(float n, const Facets& facets);

    GlassLobes toward(Vec3f w, float cosine) const;
    const GlassLobes& mean() const { return mean_; }   // weighted by cos

  private:
    float n_;
    StretchedGgx facets_;
    Distribution distribution_;
    IndexedAlbedo::Row row_;   // of round ones
    GlassLobes mean_;
};

/// Light that goes through a smooth coat of index n to a white metal and comes back to it inside, where the coat
/// reflects it totally or in part: its share of what came in, and that of what comes from a cosine; the mean of the
/// latter. bsdf_coated.h says more.
struct CaughtBelow {
    IndexedAlbedo::Row row;

    CaughtBelow(float n, float alpha, Distribution distribution);
    float of_passed(float cosine) const { return row.at(cosine)[0]; }
    float mean() const { return row.mean[1]; }
};

/// Mean share of diffuse light that round facets of reflectance 1 let pass.
float mean_passed(float alpha, Distribution distribution);

}  // namespace dg
