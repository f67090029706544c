// ray_on_film.h -- film points of the wavelengths of a scene ray: the density with which camera samples draw the ray,
// and the splats of a light path along it.
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
    /// A single landing serves all wavelengths. Landings that no camera sample could draw count as blocked.
    RayOnFilm(const FilmDensity& density, const Sensor& sensor,
              std::span<const Reprojection> landings, float time);

    /// Density of camera samples, per m2 sr of rays and sample index; see camera_first_ray.h.
    double camera_density() const { return density_; }
    /// Whether the filter of a pixel of the region covers a landing.
    bool in_reach() const { return in_reach_; }
    /// Whether light passes the lens, but no landing is in reach of the frame.
    bool off_frame() const { return off_frame_; }

    /// Adds radiance x response to all pixels with a filter that covers the landing. For wide filters, adds each
    /// wavelength to a single pixel, chosen by its share with u in [0,1)^2; all wavelengths use the same u, so that
    /// most choose the same pixel.
    void splat(Film& film, Spectrum radiance, const Wavelengths& wavelengths, Vec2f u,
               std::uint32_t sample, Layer layer = Layer::splats) const;

    /// Light added to a pixel.
    struct Splat {
        Pixel pixel{};
        Spectrum light{0.f};
    };
    /// Chooses one pixel per wavelength for every filter width, as camera samples do; returns the number of splats.
    int choose(Spectrum radiance, Vec2f u, std::array<Splat, kWavelengths>& splats) const;
    /// Sum of squares of the values added by splat(), relative to choose().
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
    Vec2f low_{1e9f, 1e9f}, high_{-1e9f, -1e9f};   // px: bounds of the landings on the frame
    double density_ = 0, exposure_;
    bool in_reach_ = false, off_frame_ = false;
};

}  // namespace dg
