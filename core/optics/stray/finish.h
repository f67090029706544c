// finish.h -- BRDF of blackened metal: barrel, edges of the glass, iris blades.
//
// Lambertian term plus a glossy lobe about the mirror direction (harvey_shack.h), which grows
// toward grazing incidence like the reflectance of a binder of index 1.5 (Schlick 1994, An
// Inexpensive BRDF Model). Both terms are reciprocal. The default is a matte black paint with an
// albedo of 3 to 5 % under uniform illumination and a gloss at grazing angles, as measured on
// Aeroglaze (Chemglaze) Z306. Source: Pompea and Breault 2010, Black Surfaces for Optical Systems,
// in Handbook of Optics, 3rd ed., vol. IV, ch. 6.
#pragma once
#include <vector>

#include "optics/stray/harvey_shack.h"

namespace dg {

struct Finish {
    double diffuse = 0.03;   // Lambertian albedo
    double gloss = 0.005;    // albedo of the lobe at normal incidence; many times higher near grazing
    HarveyShack lobe{0.1, -2.5};
};

/// Finish prepared for evaluation and sampling. Directions are unit vectors away from the surface,
/// in a frame with the normal along z.
class FinishScatter {
  public:
    FinishScatter() = default;
    /// Throws an Error with `where` for values out of range, or for an albedo above 1.
    FinishScatter(const Finish& finish, const char* where);

    /// BRDF, per sr; 0 for directions below the surface.
    double value(const Vec3d& in, const Vec3d& out) const;
    /// Albedo for light from a direction with this cosine.
    double albedo(double cosine) const;
    const HarveyShack& lobe() const { return finish_.lobe; }
    bool is_black() const { return finish_.diffuse == 0 && finish_.gloss == 0; }

    /// Samples the BRDF; `u_lobe` selects the diffuse or the glossy term.
    Vec3d sample(const Vec3d& in, double u_lobe, Vec2d u) const;
    /// Density of sample(), per sr.
    double pdf(const Vec3d& in, const Vec3d& out) const;

  private:
    double lobe_chance(double cosine) const;
    double glossy_albedo(double cosine) const;

    Finish finish_;
    double scale_ = 0;   // gloss / integral of the lobe
    std::vector<double> albedo_;   // at equal steps of the cosine
};

}  // namespace dg
