#include "render/ray_on_film.h"

namespace dg {

RayOnFilm::RayOnFilm(const FilmDensity& density, const Sensor& sensor,
                     std::span<const Reprojection> landings, float time)
    : landings_(landings) {
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
    std::array<Landing, kWavelengths> found;
    int count = 0;
    for (int i = 0; i < kWavelengths; ++i) {
        const std::size_t from = landings_.size() == 1 ? 0 : i;
        if (!at_[from] || !(at_[from]->total() > 0)) continue;
        const Pixel pixel = at_[from]->choose(u);
        const float weight = at_[from]->sign(pixel) * at_[from]->total() *
                             float(landings_[from].response * exposure_);
        int k = 0;
        while (k < count && found[k].pixel != pixel) ++k;
        if (k == count) found[count++].pixel = pixel;
        found[k].weight.set(i, weight);
    }
    for (int k = 0; k < count; ++k)
        film.splat(found[k].pixel.x, found[k].pixel.y, sample,
                   wavelengths.to_xyz(radiance * found[k].weight));
}

}  // namespace dg
