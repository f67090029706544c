// dispersion.h -- four wavelengths through one scene ray. Glass sends them from one film point along
// different rays; so the hero's ray is kept, and each other wavelength is traced back through the lens
// along it, to a film point of its own. One path then serves all four.
//
// With D_j the density with which wavelength j as the hero would have drawn this ray, the balance
// heuristic over the four possible heroes weighs wavelength i by T_i / (mean_j D_j): unbiased, as every
// wavelength of a path is equally often its hero. Source: Veach 1997, section 9.2 (multi-sample model),
// and Wilkie et al. 2014, Hero Wavelength Spectral Sampling, EGSR.
//
// Which pixel a wavelength counts for is the filter's affair at its own film point. What that point has in
// common with the hero's stays in the hero's pixel as a share of the light, not as a chance; only the rest
// goes to another pixel. (Chances made half of the noise of the exact lens in a plain white world.)
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

/// A pixel that a path's light reaches, and the factor on the radiance of each wavelength.
struct Landing {
    Pixel pixel{};
    Spectrum weight{0.f};
};

/// All landings of a path; the first is in the hero's pixel.
class Landings {
  public:
    explicit Landings(Pixel hero) { all_[0].pixel = hero; }
    void add(Pixel pixel, int wavelength, float weight);
    const Landing* begin() const { return all_; }
    const Landing* end() const { return all_ + count_; }

  private:
    Landing all_[kWavelengths];   // each other wavelength brings one more pixel at most
    int count_ = 1;
};

/// Region of pixels that are drawn, with the filter and the shutter: how densely film points are drawn, and
/// when. Where a round draws n(p) samples of pixel p, all densities are n(p) |f(px - centre of p)| s_p(t):
/// then the sum of what lands in p is that of n(p) samples on average, a pixel that is not drawn gets
/// nothing, and neither does a line that a rolling shutter has shut at that time. (A shutter that is the
/// same for all pixels cancels.)
class FilmDensity {
  public:
    /// `counts`: n(p), rows of the region; empty: the same for every pixel.
    FilmDensity(const Filter& filter, const FilmLayout& region,
                std::span<const std::uint32_t> counts = {}, const Shutter* shutter = nullptr)
        : filter_(filter), region_(region), counts_(counts), shutter_(shutter) {}

    /// The same for all times together: each pixel as its counts and its filter have it.
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
    /// Mean over its window of what the shutter lets pass.
    float shutter_weight() const { return shutter_ ? shutter_->weight() : 1; }
    /// Integral of |f| s over film points and times, by which densities are divided.
    float integral() const { return float(filter_.absolute_integral()) * shutter_weight(); }
    /// The same integral for times drawn from all at which any line is open.
    double integral_of_any_time() const {
        const Shutter* shutter = rolling();
        return filter_.absolute_integral() * (shutter ? double(shutter->any_share() * shutter->weight()) : 1);
    }
    /// n of a pixel of the region; 1 where all are alike.
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

/// The filter as it lies around one film point at one time: the pixels in reach, each with n f s.
class Footprint {
  public:
    Footprint(const FilmDensity& density, Vec2f px, float time);

    /// Sum of n |f| s over the pixels in reach.
    float total() const { return total_; }
    /// n |f| s / total of a pixel; 0 where total is.
    float share(Pixel p) const;
    float sign(Pixel p) const;
    /// f s of a column and of a row, with its sign: their product is that of the pixel.
    float column(int x) const { return x_.of(x); }
    float row(int y) const { return y_.of(y); }
    /// The pixels in reach: [x0, x1) x [y0, y1).
    struct Box {
        int x0, y0, x1, y1;
    };
    Box box() const {
        return {x_.first, y_.first, x_.first + x_.count, y_.first + y_.count};
    }
    /// One by its share, with u in [0,1)^2; total() > 0.
    Pixel choose(Vec2f u) const;
    /// A pixel from what this footprint's shares have above those of `other`, with u in [0,1); `other`'s own
    /// pixel if they do not differ.
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
    float x_sum_ = 0;   // where counts are even
};

/// The hero's own record: where its film point is, and its density and transmittance.
struct Hero {
    Vec2f px;
    Pixel pixel;
    float time;          // fraction of the scene's interval
    float weight;        // exposure of the ray: aim weight x transmittance
    float aim_weight;    // the same without transmittance
};

/// Where the four wavelengths land; lane 0 is the hero.
Landings land(const FilmDensity& density, const Sensor& sensor, const Hero& hero,
              std::span<const Reprojection> others, float u);

}  // namespace dg
