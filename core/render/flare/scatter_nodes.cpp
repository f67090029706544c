#include "render/flare/scatter_nodes.h"

#include <algorithm>
#include <cmath>

#include "spectrum/wavelengths.h"

namespace dg {
namespace {

constexpr float kShare = 0.1f;          // fraction of the variance of a blur
constexpr double kArrive = 1 / 16.0;    // approximate fraction of paths that reach the frame
constexpr double kBright = 32;          // ratio of a bright path to a typical path

}  // namespace

bool ScatterNodes::serve(const Picture& picture, const ScatterGuide& guide) {
    return picture.settings.scatter.nodes && guide.light() > 0 && picture.film.count_of(Layer::bands) == 0 &&
           picture.settings.filter.variance() <= CoarseLight::kWidestFilter;
}

ScatterNodes::ScatterNodes(const Picture& picture, const ScatterGuide& guide)
    : picture_(picture), px2_per_mm2_(float(1 / picture.settings.sensor.mm2_per_px())),
      exposure_(picture.density.integral() * px2_per_mm2_), values_(3 + picture.film.count_of(Layer::channels)) {
    const Sensor& sensor = picture.settings.sensor;
    most_ = std::min(CoarseLight::widest(sensor), CoarseLight::variance(CoarseLight::kMostLevel));
    const double all = guide.light() * px2_per_mm2_, mean = all / sensor.width / sensor.height;
    const double bright = kBright * all / (kArrive * picture.settings.scatter.per_sample);
    for (int level = kFinest; level < kLevels; ++level)
        coarse_[level] = std::make_unique<CoarseLight>(picture.density.region(), values_, level, mean,
                                                       picture.settings.filter.variance(), bright / (1 << 2 * level));
}

/// Combines both bounds smoothly.
int ScatterNodes::level_of(float blur2_mm2, float u) const {
    const float own = kShare * blur2_mm2 * px2_per_mm2_, variance = own * most_ / (own + most_);
    if (!(variance >= CoarseLight::variance(kFinest))) return 0;
    return int(CoarseLight::level_of(variance, kFinest, CoarseLight::kMostLevel) + u);
}

/// Whether a pixel of the region is in reach.
bool ScatterNodes::reaches(Vec2f px, float reach) const {
    const FilmLayout& region = picture_.density.region();
    const float left = float(region.offset_x), top = float(region.offset_y);
    return px.x > left - reach && px.x < left + float(region.width) + reach && px.y > top - reach &&
           px.y < top + float(region.height) + reach;
}

/// Shutter opening at the line where light lands, or at the nearest line.
float ScatterNodes::exposed(Vec2f px, float time) const {
    const Shutter* shutter = picture_.density.rolling();
    if (!shutter) return 1;
    const Sensor& sensor = picture_.settings.sensor;
    return shutter->opening(shutter->row_at(px, sensor.width, sensor.height), time);
}

ScatterNodes::Places ScatterNodes::take(ScatterGuide::Landings& landings, float time, float u) const {
    Places places;
    for (int k = 0; k < kWavelengths; ++k) {
        Reprojection& landing = landings.at[k];
        const int level = landing.transmittance > 0 ? level_of(landings.blur2_mm2[k], u) : 0;
        if (level == 0) continue;
        landing.etendue = 0;
        const Vec2f px = picture_.settings.sensor.px_from_mm(landing.film_mm);
        if (!reaches(px, CoarseLight::reach(float(level)))) continue;
        const float light = exposure_ * landing.response * exposed(px, time);
        if (light > 0) places.all[places.count++] = {k, level, px, light};
    }
    return places;
}

/// Wavelengths that land within a node spacing of each other count as a single arrival for the variance, as in a pixel.
void ScatterNodes::add(Work& work, const Places& places, const Wavelengths& wavelengths, Spectrum light,
                       std::uint32_t sample) const {
    Film& film = picture_.film;
    int of = 0;              // level of the first landing in the group
    std::size_t first = 0;
    for (const Places::Place& place : std::span(places.all.data(), std::size_t(places.count))) {
        Spectrum own{0.f};
        own.set(place.wavelength, light[place.wavelength] * place.light);
        const Vec3f xyz = wavelengths.to_xyz(own);
        if (!fits_film(xyz.x) || !fits_film(xyz.y) || !fits_film(xyz.z)) {
            film.splat_row(int(std::floor(place.px.x)), int(std::floor(place.px.y)), sample, std::span(&xyz, 1), Layer::flare);
            continue;
        }
        FilmColor color{xyz.x, xyz.y, xyz.z};
        const Spectrum channels = values_ > 3 ? film.responses().of(wavelengths, own) : Spectrum();
        for (int c = 3; c < values_; ++c) color[c] = channels[c - 3];
        const Rgb rgb = rgb_from_xyz(xyz);
        std::vector<CoarseLight::Arrival>& own_level = work[place.level];
        const bool joins = of == place.level && length(place.px - own_level[first].px) < float(1 << of);
        if (joins) own_level[first].as_one = *own_level[first].as_one + rgb;
        else of = place.level, first = own_level.size();
        own_level.push_back({place.px, color, 1, joins ? Rgb{0, 0, 0} : rgb});
    }
}

void ScatterNodes::flush(Work& work) const {
    for (int level = kFinest; level < kLevels; ++level) {
        if (!work[level].empty()) coarse_[level]->add(work[level]);
        work[level].clear();
    }
}

void ScatterNodes::finish(int threads) const {
    CoarseLight::to_film(std::span(coarse_).subspan(kFinest), picture_.film, picture_.density, threads);
}

}  // namespace dg
