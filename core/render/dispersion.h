// dispersion.h -- film points of four wavelengths that share a scene ray. Dispersion in the lens would give each
// wavelength of a film point a different scene ray. Instead the path keeps the hero's ray, and each secondary
// wavelength is traced along this ray back through the lens to a separate film point. One path serves all four.
//
// With D_j the density of this ray if wavelength j had been the hero, the balance heuristic over the four possible
// heroes weighs wavelength i by T_i / (mean_j D_j). This is unbiased, since each wavelength of a path is the hero with
// the same probability. Source: Veach 1997, section 9.2 (multi-sample model), and Wilkie et al. 2014, Hero Wavelength
// Spectral Sampling, EGSR.
//
// The filter around a wavelength's film point determines its pixel. The overlap with the filter at the hero's film
// point stays in the hero's pixel as a deterministic share; only the excess is moved to another pixel, chosen at
// random. (Random choices for all of it caused half of the noise of the exact lens under a uniform white sky.)
#pragma once
#include <cstdint>
#include <span>

#include "camera/exact.h"
#include "camera/sensor.h"
#include "camera/shutter.h"
#include "film/film.h"
#include "film/filter.h"
#include "spectrum/spectrum.h"

namespace dg {

struct Pixel {
    int x, y;
    friend bool operator==(Pixel, Pixel) = default;
};

/// A pixel that receives light of a path, and the factor on the radiance of each wavelength.
struct Landing {
    Pixel pixel{};
    Spectrum weight{0.f};
};

/// Landings of a path. The first is in the hero's pixel.
class Landings {
  public:
    explicit Landings(Pixel hero) { all_[0].pixel = hero; }
    void add(Pixel pixel, int wavelength, float weight);
    const Landing* begin() const { return all_; }
    const Landing* end() const { return all_ + count_; }

  private:
    Landing all_[kWavelengths];   // the hero's pixel, and at most one per secondary wavelength
    int count_ = 1;
};

/// Density of film points and times over a region of pixels, from the filter and the shutter. For a round with n(p)
/// samples of pixel p the density is n(p) |f(px - centre of p)| s_p(t). Then pixel p receives the light of n(p) samples
/// on average, and a pixel that is not drawn, or a line that a rolling shutter has closed at that time, receives
/// nothing. (A shutter that is the same for all pixels cancels.)
class FilmDensity {
  public:
    /// `counts`: n(p), row by row of the region; empty: the same for every pixel.
    FilmDensity(const Filter& filter, const FilmLayout& region,
                std::span<const std::uint32_t> counts = {}, const Shutter* shutter = nullptr)
        : filter_(filter), region_(region), counts_(counts), shutter_(shutter) {}

    /// The density of film points alone, without times.
    FilmDensity without_shutter() const {
        FilmDensity all = *this;
        all.shutter_ = nullptr;
        return all;
    }
    const Filter& filter() const { return filter_; }
    const FilmLayout& region() const { return region_; }
    bool even() const { return counts_.empty(); }
    /// The shutter if its lines are not all open at once, else null.
    const Shutter* rolling() const { return shutter_ && shutter_->rolls() ? shutter_ : nullptr; }
    /// Mean transmission of the shutter over its window.
    float shutter_weight() const { return shutter_ ? shutter_->weight() : 1; }
    /// Normalization of the density: the integral of |f| s over film points and times.
    float integral() const { return float(filter_.absolute_integral()) * shutter_weight(); }
    /// The integral for times drawn uniformly from all times at which any line is open.
    double integral_of_any_time() const {
        const Shutter* shutter = rolling();
        return filter_.absolute_integral() * (shutter ? double(shutter->any_share() * shutter->weight()) : 1);
    }
    /// n(p) of a pixel of the region; 1 if all are equal.
    float count(Pixel p) const {
        if (even()) return 1;
        return float(counts_[std::size_t(p.y - region_.offset_y) * region_.width + p.x -
                             region_.offset_x]);
    }

  private:
    const Filter& filter_;
    const FilmLayout& region_;
    std::span<const std::uint32_t> counts_;
    const Shutter* shutter_;
};

/// Values n f s of all pixels whose filter covers a film point, at one time.
class Footprint {
  public:
    Footprint(const FilmDensity& density, Vec2f px, float time);

    /// Sum of n |f| s over the pixels in reach.
    float total() const { return total_; }
    /// n |f| s / total of a pixel; 0 if total is 0.
    float share(Pixel p) const;
    float sign(Pixel p) const;
    /// Signed f s of a column and of a row; a pixel has their product.
    float column(int x) const { return x_.of(x); }
    float row(int y) const { return y_.of(y); }
    /// The pixels in reach: [x0, x1) x [y0, y1).
    struct Box {
        int x0, y0, x1, y1;
    };
    Box box() const {
        return {x_.first, y_.first, x_.first + x_.count, y_.first + y_.count};
    }
    /// Samples a pixel by its share, with u in [0,1)^2; requires total() > 0.
    Pixel choose(Vec2f u) const;
    /// Samples a pixel by the excess of this footprint's shares over the shares of `other`, with u in [0,1); returns
    /// `own` if there is no excess.
    Pixel choose_excess(const Footprint& other, Pixel own, float u) const;

  private:
    static constexpr int kReach = 34;   // px along an axis, for the widest filter
    struct Axis {
        int first = 0, count = 0;
        float f[kReach];
        float of(int i) const {
            return i >= first && i < first + count ? f[i - first] : 0;
        }
        float sum() const;
    };
    static void fill(Axis& axis, const Filter& filter, float at, int first, int count);
    static void expose(Axis& axis, const Shutter& shutter, float time);

    const FilmDensity& density_;
    Axis x_, y_;
    float total_ = 0, per_total_ = 0;
    float x_sum_ = 0;   // used if all counts are equal
};

/// The hero wavelength's film point, density and transmittance.
struct Hero {
    Vec2f px;
    Pixel pixel;
    float time;          // fraction of the scene's interval
    float weight;        // exposure of the ray: aim weight x transmittance
    float aim_weight;    // exposure of the ray without transmittance
};

/// Landings of the four wavelengths; lane 0 is the hero.
Landings land(const FilmDensity& density, const Sensor& sensor, const Hero& hero,
              std::span<const Reprojection> others, float u);

}  // namespace dg
