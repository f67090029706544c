#include "render/ray_on_film.h"

#include <algorithm>

namespace dg {
namespace {

// Up to this radius (px) each pixel gets its share of a splat: with the default filter that has 0.45 of the
// variance of a pixel that is chosen, integral of f^2 over that of f. Wider ones would cost more than that.
constexpr float kWideFilter = 2.5f;

}  // namespace

RayOnFilm::RayOnFilm(const FilmDensity& density, const Sensor& sensor,
                     std::span<const Reprojection> landings, float time)
    : film_density_(density), landings_(landings) {
    const double mm2_per_px = sensor.width_mm / sensor.width * sensor.height_mm / sensor.height;
    const float reach = density.filter().radius();
    bool passes = false, in_frame = false;
    for (std::size_t i = 0; i < landings.size(); ++i) {
        if (!(landings[i].etendue > 0)) continue;
        passes = true;
        const Vec2f px = sensor.px_from_mm(landings[i].film_mm);
        if (!(px.x > -reach && px.x < float(sensor.width) + reach && px.y > -reach &&
              px.y < float(sensor.height) + reach))
            continue;
        in_frame = true;
        at_[i].emplace(density, px, time);
        if (!(at_[i]->total() > 0)) continue;
        in_reach_ = true;
        density_ += double(at_[i]->total()) / landings[i].etendue;
    }
    density_ /= mm2_per_px * double(landings.size());
    exposure_ = density.integral() / mm2_per_px;
    off_frame_ = passes && !in_frame;
}

void RayOnFilm::splat(Film& film, Spectrum radiance, const Wavelengths& wavelengths, Vec2f u,
                      std::uint32_t sample) const {
    Spectrum response;
    for (int i = 0; i < kWavelengths; ++i)
        response.set(i, float(landings_[landings_.size() == 1 ? 0 : i].response * exposure_));
    if (film_density_.filter().radius() <= kWideFilter)
        splat_all(film, radiance * response, wavelengths, sample);
    else
        splat_chosen(film, radiance * response, wavelengths, u, sample);
}

void RayOnFilm::splat_all(Film& film, Spectrum light, const Wavelengths& wavelengths,
                          std::uint32_t sample) const {
    Footprint::Box all{1 << 30, 1 << 30, -(1 << 30), -(1 << 30)};
    for (std::size_t i = 0; i < landings_.size(); ++i) {
        if (!reaches(i)) continue;
        const Footprint::Box box = at_[i]->box();
        all = {std::min(all.x0, box.x0), std::min(all.y0, box.y0), std::max(all.x1, box.x1),
               std::max(all.y1, box.y1)};
    }
    for (int y = all.y0; y < all.y1; ++y)
        for (int x = all.x0; x < all.x1; ++x) {
            Spectrum weight;
            for (std::size_t i = 0; i < landings_.size(); ++i)
                if (reaches(i)) weight.set(int(i), at_[i]->value({x, y}));
            if (landings_.size() == 1) weight = Spectrum(weight[0]);
            if (weight.max() == 0 && weight.min() == 0) continue;
            film.splat(x, y, sample, wavelengths.to_xyz(light * weight));
        }
}

void RayOnFilm::splat_chosen(Film& film, Spectrum light, const Wavelengths& wavelengths, Vec2f u,
                             std::uint32_t sample) const {
    std::array<Landing, kWavelengths> found;
    int count = 0;
    for (int i = 0; i < kWavelengths; ++i) {
        const std::size_t from = landings_.size() == 1 ? 0 : i;
        if (!reaches(from)) continue;
        const Pixel pixel = at_[from]->choose(u);
        int k = 0;
        while (k < count && found[k].pixel != pixel) ++k;
        if (k == count) found[count++].pixel = pixel;
        found[k].weight.set(i, at_[from]->sign(pixel) * at_[from]->total());
    }
    for (int k = 0; k < count; ++k)
        film.splat(found[k].pixel.x, found[k].pixel.y, sample,
                   wavelengths.to_xyz(light * found[k].weight));
}

}  // namespace dg
