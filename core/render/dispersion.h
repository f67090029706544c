// dispersion.h -- four wavelengths through one scene ray. Glass sends them from one film point along
// different rays; so the hero's ray is kept, and each other wavelength is traced back through the lens
// along it, to a film point of its own. One path then serves all four.
//
// With D_j the density with which wavelength j as the hero would have drawn this ray, the balance
// heuristic over the four possible heroes weighs wavelength i by T_i / (mean_j D_j): unbiased, as every
// wavelength of a path is equally often its hero. Source: Veach 1997, section 9.2 (multi-sample model),
// and Wilkie et al. 2014, Hero Wavelength Spectral Sampling, EGSR.
#pragma once
#include <array>
#include <optional>
#include <span>

#include "camera/exact.h"
#include "camera/sensor.h"
#include "film/film.h"
#include "film/filter.h"
#include "spectrum/spectrum.h"

namespace dg {

struct Pixel {
    int x, y;
};

/// Where one wavelength of the path lands, and its factor on the radiance.
struct Landing {
    Pixel pixel{};
    float weight = 0;   // 0: stopped, or outside the region
};

/// Region of pixels that are drawn, with the filter: says how densely film points are drawn, and which
/// pixel a film point counts for.
class FilmDensity {
  public:
    FilmDensity(const Filter& filter, const FilmLayout& region) : filter_(filter), region_(region) {}

    /// Sum over the region's pixels of |f(px - centre)|.
    float total(Vec2f px) const;
    /// |f(px - centre)| of one pixel, 0 outside the region.
    float of(Vec2f px, Pixel pixel) const;
    float sign(Vec2f px, Pixel pixel) const;
    /// A pixel for the film point `px`, distributed as of(px, .) / total(px), and equal to `kept` as
    /// often as that distribution allows when `kept` was drawn for the near-by point `kept_px`.
    std::optional<Pixel> choose(Vec2f px, Vec2f kept_px, Pixel kept, float u) const;
    /// Integral of |f|: 1 for filters without negative lobes.
    float absolute_integral() const;

  private:
    const Filter& filter_;
    const FilmLayout& region_;
};

/// The hero's own record: where its film point is, and its density and transmittance.
struct Hero {
    Vec2f px;
    Pixel pixel;
    float weight;        // exposure of the ray: aim weight x transmittance
    float aim_weight;    // the same without transmittance
};

/// Landings of the four wavelengths; lane 0 is the hero.
std::array<Landing, kWavelengths> land(const FilmDensity& density, const Sensor& sensor,
                                       const Hero& hero,
                                       std::span<const Reprojection> others, float u);

}  // namespace dg
