#include "render/ray_on_film.h"

#include <algorithm>

namespace dg {
namespace {

// Up to this filter radius (px) a splat is distributed over all pixels: with the default filter this has 0.45 of the
// variance of a chosen pixel (integral of f^2 over integral of f). Wider filters would cost more time than they save.
constexpr float kWideFilter = 2.5f;
constexpr int kWidestBox = 12;   // px: in smaller boxes, the wavelengths of a path are added as one value per pixel

}  // namespace

RayOnFilm::RayOnFilm(const FilmDensity& density, const Sensor& sensor,
                     std::span<const Reprojection> landings, float time)
    : film_density_(density), landings_(landings) {
    const double mm2_per_px = sensor.mm2_per_px();
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
        low_ = {std::min(low_.x, px.x), std::min(low_.y, px.y)};
        high_ = {std::max(high_.x, px.x), std::max(high_.y, px.y)};
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
                      std::uint32_t sample, Layer layer) const {
    if (film_density_.filter().radius() <= kWideFilter) {
        splat_all(film, radiance * response(), wavelengths, sample, layer);
        return;
    }
    std::array<Splat, kWavelengths> splats;
    const int count = choose(radiance, u, splats);
    for (int k = 0; k < count; ++k)
        film.splat(splats[k].pixel.x, splats[k].pixel.y, sample, wavelengths, splats[k].light, layer);
}

Spectrum RayOnFilm::response() const {
    Spectrum response;
    for (int i = 0; i < kWavelengths; ++i)
        response.set(i, float(landings_[landings_.size() == 1 ? 0 : i].response * exposure_));
    return response;
}

float RayOnFilm::spread() const {
    if (film_density_.filter().radius() > kWideFilter) return 1;
    for (std::size_t i = 0; i < landings_.size(); ++i) {
        if (!reaches(i)) continue;
        const Footprint::Box box = at_[i]->box();
        float squares = 0;
        for (int y = box.y0; y < box.y1; ++y)
            for (int x = box.x0; x < box.x1; ++x) {
                const float share = at_[i]->share({x, y});
                squares += share * share;
            }
        return squares;
    }
    return 1;
}

void RayOnFilm::splat_all(Film& film, Spectrum light, const Wavelengths& wavelengths,
                          std::uint32_t sample, Layer layer) const {
    if (landings_.size() == 1) return splat_box(film, light, wavelengths, sample, layer, 0, 1);
    // Uses positions in the frame, so that a pixel's sums are bit-identical for every region that is drawn.
    const float most = kWidestBox - 1 - 2 * film_density_.filter().radius();
    if (high_.x - low_.x <= most && high_.y - low_.y <= most)
        return splat_box(film, light, wavelengths, sample, layer, 0, landings_.size());
    for (std::size_t i = 0; i < landings_.size(); ++i)   // landings far apart
        if (reaches(i)) splat_box(film, light, wavelengths, sample, layer, i, i + 1);
}

/// Bounds of the pixels in reach of landings [first, last).
Footprint::Box RayOnFilm::box(std::size_t first, std::size_t last) const {
    Footprint::Box all{1 << 30, 1 << 30, -(1 << 30), -(1 << 30)};
    for (std::size_t i = first; i < last; ++i) {
        if (!reaches(i)) continue;
        const Footprint::Box box = at_[i]->box();
        all = {std::min(all.x0, box.x0), std::min(all.y0, box.y0), std::max(all.x1, box.x1),
               std::max(all.y1, box.y1)};
    }
    return all;
}

/// Splats a single wavelength, which has the same colour in all pixels.
void RayOnFilm::splat_color(Film& film, Spectrum light, const Wavelengths& wavelengths, std::uint32_t sample,
                            Layer layer, const Footprint& at) const {
    const Footprint::Box box = at.box();
    const std::size_t width = std::size_t(box.x1 - box.x0);
    const Vec3f xyz = wavelengths.to_xyz(light);
    const bool seen = film.count_of(Layer::channels) > 0;
    const Spectrum sensor = seen ? film.responses().of(wavelengths, light) : Spectrum();
    std::array<Vec3f, kWidestBox> row;
    std::array<Spectrum, kWidestBox> channels;
    for (int y = box.y0; y < box.y1; ++y) {
        const Vec3f in_row = xyz * at.row(y);
        for (int x = box.x0; x < box.x1; ++x) row[x - box.x0] = in_row * at.column(x);
        for (int x = box.x0; seen && x < box.x1; ++x)
            channels[x - box.x0] = sensor * (at.row(y) * at.column(x));
        film.splat_row(box.x0, y, sample, std::span(row.data(), width), layer,
                       std::span(channels.data(), seen ? width : 0));
    }
}

/// Splats landings [first, last) as one value per pixel.
void RayOnFilm::splat_box(Film& film, Spectrum light, const Wavelengths& wavelengths,
                          std::uint32_t sample, Layer layer, std::size_t first,
                          std::size_t last) const {
    const Footprint::Box all = box(first, last);
    const int width = all.x1 - all.x0, height = all.y1 - all.y0;
    Spectrum columns[kWidestBox], rows[kWidestBox];
    for (std::size_t i = first; i < last; ++i) {
        if (!reaches(i)) continue;
        for (int x = 0; x < width; ++x) columns[x].set(int(i), at_[i]->column(all.x0 + x));
        for (int y = 0; y < height; ++y) rows[y].set(int(i), at_[i]->row(all.y0 + y));
    }
    if (last - first == 1 && landings_.size() > 1 && film.count_of(Layer::bands) == 0 && film_density_.even()) {
        Spectrum own{0.f};
        own.set(int(first), light[int(first)]);
        return splat_color(film, own, wavelengths, sample, layer, *at_[first]);
    }
    for (int y = 0; y < height; ++y) {
        if (landings_.size() == 1) rows[y] = Spectrum(rows[y][0]);
        const Spectrum in_row = light * rows[y];
        for (int x = 0; x < width; ++x) {
            const Pixel p{all.x0 + x, all.y0 + y};
            const Spectrum share = landings_.size() == 1 ? Spectrum(columns[x][0]) : columns[x];
            const Spectrum value = in_row * share * film_density_.count(p);
            if (value.max() == 0 && value.min() == 0) continue;
            film.splat(p.x, p.y, sample, wavelengths, value, layer);
        }
    }
}

int RayOnFilm::choose(Spectrum radiance, Vec2f u,
                      std::array<Splat, kWavelengths>& splats) const {
    const Spectrum light = radiance * response();
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
        splats[k] = {found[k].pixel, light * found[k].weight};
    return count;
}

}  // namespace dg
