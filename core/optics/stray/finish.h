// finish.h -- how blackened metal sends light back: the barrel, the edges of the glass, the blades of the iris.
//
// A part goes to all sides alike (Lambert), a part into a lobe about the mirror image (harvey_shack.h) which
// grows toward grazing light as the reflectance of a binder of index 1.5 does (Schlick 1994, An Inexpensive
// BRDF Model). Both are the same when light goes the other way. The default is a matte black paint: 3 to 5 %
// over all directions and a gloss at grazing angles, as is measured of Aeroglaze (Chemglaze) Z306. Source:
// Pompea and Breault 2010, Black Surfaces for Optical Systems, in Handbook of Optics, 3rd ed., vol. IV, ch. 6.
#pragma once
#include <vector>

#include "optics/stray/harvey_shack.h"

namespace dg {

struct Finish {
    double diffuse = 0.03;   // share of light that is sent to all sides
    double gloss = 0.005;    // and into the lobe, straight on; near grazing it grows to many times that
    HarveyShack lobe{0.1, -2.5};
};

/// A finish ready to be used. Directions are unit vectors in a frame whose z is the normal; both point away from
/// the surface.
class FinishScatter {
  public:
    FinishScatter() = default;
    /// Throws Error that names `where`: values out of range, or more light sent back than arrives.
    FinishScatter(const Finish& finish, const char* where);

    /// Reflected radiance over irradiance, per sr; 0 from or to below.
    double value(const Vec3d& in, const Vec3d& out) const;
    /// Share of light that is sent back.
    double albedo(double cosine) const;
    const HarveyShack& lobe() const { return finish_.lobe; }
    bool is_black() const { return finish_.diffuse == 0 && finish_.gloss == 0; }

    /// `u_lobe` chooses the part.
    Vec3d sample(const Vec3d& in, double u_lobe, Vec2d u) const;
    /// Density of sample(), per sr.
    double pdf(const Vec3d& in, const Vec3d& out) const;

  private:
    double lobe_chance(double cosine) const;
    double glossy_albedo(double cosine) const;

    Finish finish_;
    double scale_ = 0;   // gloss over the lobe's integral
    std::vector<double> albedo_;   // at even steps of the cosine
};

}  // namespace dg
