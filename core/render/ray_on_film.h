// ray_on_film.h -- where the wavelengths of one scene ray land on the film, seen from either side: how
// densely camera samples draw the ray, and what a light path along it adds to which pixels.
#pragma once
#include <array>
#include <optional>
#include <span>

#include "camera/sensor.h"
#include "film/film.h"
#include "render/dispersion.h"
#include "spectrum/wavelengths.h"

namespace dg {

class RayOnFilm {
  public:
    /// One landing: all wavelengths land alike. Those that no camera sample could draw count as stopped.
    RayOnFilm(const FilmDensity& density, const Sensor& sensor,
              std::span<const Reprojection> landings, float time);

    /// Density of camera samples, per m2 sr of rays and sample index; see camera_first_ray.h.
    double camera_density() const { return density_; }
    /// Some pixel of the region is in reach.
    bool in_reach() const { return in_reach_; }
    /// Something passes the lens, but all of it out of reach of the whole frame.
    bool off_frame() const { return off_frame_; }

    /// Adds radiance x response to all pixels whose filter it reaches. Of a wide filter to one pixel per
    /// wavelength, chosen by its share with u in [0,1)^2: the same u for all, so that most are one value.
    void splat(Film& film, Spectrum radiance, const Wavelengths& wavelengths, Vec2f u,
               std::uint32_t sample, Layer layer = Layer::splats) const;

    /// Light that comes to one pixel.
    struct Splat {
        Pixel pixel{};
        Spectrum light{0.f};
    };
    /// Chooses what splat() adds, whatever the filter, as camera samples do; returns how many there are.
    int choose(Spectrum radiance, Vec2f u, std::array<Splat, kWavelengths>& splats) const;
    /// The sum of squares of what splat() adds, over that of what is chosen.
    float spread() const;

  private:
    Spectrum response() const;
    void splat_all(Film& film, Spectrum light, const Wavelengths& wavelengths,
                   std::uint32_t sample, Layer layer) const;
    void splat_color(Film& film, Spectrum light, const Wavelengths& wavelengths, std::uint32_t sample,
                     Layer layer, const Footprint& at) const;
    void splat_box(Film& film, Spectrum light, const Wavelengths& wavelengths, std::uint32_t sample,
                   Layer layer, std::size_t first, std::size_t last) const;
    Footprint::Box box(std::size_t first, std::size_t last) const;
    bool reaches(std::size_t landing) const { return at_[landing] && at_[landing]->total() > 0; }

    const FilmDensity& film_density_;
    std::span<const Reprojection> landings_;
    std::array<std::optional<Footprint>, kWavelengths> at_;
    Vec2f low_{1e9f, 1e9f}, high_{-1e9f, -1e9f};   // px: of those that land on the frame
    double density_ = 0, exposure_;
    bool in_reach_ = false, off_frame_ = false;
};

}  // namespace dg
