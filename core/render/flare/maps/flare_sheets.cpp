#include "render/flare/maps/flare_sheets.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "math/sampler.h"
#include "render/flare/maps/coarse_light.h"
#include "render/flare/maps/sheet_error.h"
#include "render/parallel.h"
#include "render/solids_near_camera.h"

namespace dg {
namespace {

constexpr double kShare = 0.15;         // least share of all light of a source with maps, which take seconds
constexpr int kShadows = 256, kSequence = -7;
constexpr double kMostError = 0.01;     // limit for all maps
constexpr double kMostOfOne = 0.004, kLeastOfOne = 0.0004;   // limit per map, halved while the total is too large

bool serves(const Camera& camera, const RenderSettings& settings) {
    return camera.lens_motion.times.empty() && camera.setting.values.empty() &&
           !std::get<ExactLens>(camera.lens).is_dirty() && settings.filter.variance() <= CoarseLight::kWidestFilter &&
           settings.flare.learned && settings.flare.maps;
}

/// Small sources with enough light to justify maps.
std::vector<SmallSource> choose_sources(const FlareAim& aim) {
    std::vector<SmallSource> chosen;
    double all = 0;
    for (int s = 0; s < aim.sources().count(); ++s) all += aim.sources().strength(s);
    for (int s = 0; s < aim.sources().count(); ++s) {
        if (!(aim.sources().strength(s) > kShare * all)) continue;
        auto small = small_source(aim, s);
        if (small && small->luminance() > 0) chosen.push_back(std::move(*small));
    }
    return chosen;
}

bool is_hidden(const FlareAim& aim, const SmallSource& source, const PathSettings& settings) {
    const MapRays rays(aim.camera(), aim.sensor(), aim.ghost_lens(), aim.steps(0), source.shape);
    for (int i = 0; i < kShadows; ++i) {
        PathSampler sampler(source.source, kSequence, std::uint32_t(i), 0);
        const CameraRandom u = sampler.camera();
        const SmallSource::Point& p = source.point(u.time);
        const auto shadow = rays.shadow({u.lens * 2 - Vec2f{1, 1}, p.shift, 0}, p.from, p.moment.time);
        const Wavelengths wavelengths = Wavelengths::sample(u.lambda);
        if (shadow && flare_transmittance(aim.scene(), settings, p.from, *shadow, wavelengths).min() < 1) return true;
    }
    return false;
}

}  // namespace

FlareSheets::FlareSheets(const FlareAim& aim, const RenderSettings& settings) {
    if (aim.pairs() == 0 || !serves(aim.camera(), settings)) return;
    sources_ = choose_sources(aim);
    PathSettings path = settings.path;
    const std::vector<std::uint32_t> solids_near = solids_near_camera(aim.scene(), aim.camera());
    path.solids_near = solids_near;
    for (const SmallSource& source : sources_) hidden_.push_back(is_hidden(aim, source, path));
    make_maps(aim, settings);
    divide(settings);
    if (error_ <= kMostError) return;
    failed_ = true;
    sheets_.clear(), sources_.clear(), hidden_.clear();
}

void FlareSheets::make_maps(const FlareAim& aim, const RenderSettings& settings) {
    const int pairs = aim.pairs();
    std::vector<std::optional<Sheet>> all(sources_.size() * std::size_t(pairs));
    parallel_tasks(settings.threads, std::int64_t(all.size()), [&](std::int64_t i) {
        const int source = int(i) / pairs, ghost = int(i) % pairs;
        const MapRays rays(aim.camera(), aim.sensor(), aim.ghost_lens(), aim.steps(ghost), sources_[source].shape);
        GhostMap::Accuracy accuracy;
        accuracy.of_blur *= sources_[source].filled;
        GhostMap map(rays, aim.sensor(), CoarseLight::reach(SheetLevel::kMost), accuracy);
        all[i].emplace(Sheet{source, ghost, rays, std::move(map)});
    });
    for (std::optional<Sheet>& s : all) sheets_.push_back(std::move(*s));
}

/// Divides all maps into pieces, and again for inaccurate maps, which are drawn by exact rays.
void FlareSheets::divide(const RenderSettings& settings) {
    std::vector<std::optional<SheetPieces>> pieces(sheets_.size());
    const auto cut = [&](std::size_t i) {
        const Sheet& s = sheets_[i];
        pieces[i].emplace(s.rays, s.map, sources_[s.source], settings.sensor, std::uint64_t(i));
    };
    parallel_tasks(settings.threads, std::int64_t(pieces.size()), [&](std::int64_t i) { cut(std::size_t(i)); });
    FlareTiles tiles(settings.sensor);
    for (std::size_t i = 0; i < pieces.size(); ++i) pieces[i]->add_to(tiles, sources_[sheets_[i].source].luminance());
    tiles.finish();
    mean_ = tiles.mean() / tiles.area();
    take(pieces, tiles);
    SheetErrors errors = sheet_errors(*this, tiles, settings);
    for (double most = kMostOfOne; most > kLeastOfOne; most /= 2) {
        const int before = by_rays_;
        for (std::size_t i = 0; i < sheets_.size(); ++i)
            if (errors.of_sheet[i] > most && sheets_[i].map.give_up()) cut(i), ++by_rays_;
        if (by_rays_ > before) take(pieces, tiles), errors = sheet_errors(*this, tiles, settings);
        if (errors.all <= kMostError) break;
    }
    error_ = errors.all;
}

/// Keeps pieces that may send light, and computes their shares of all arrivals.
void FlareSheets::take(const std::vector<std::optional<SheetPieces>>& pieces, const FlareTiles& tiles) {
    double sum = 0, doubts = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        Sheet& s = sheets_[i];
        s.smooth = pieces[i]->smooth(), s.unseen = pieces[i]->unseen();
        s.pieces = pieces[i]->weighed(tiles, sources_[s.source].luminance());
        for (const SheetPiece& p : s.pieces) sum += p.share, doubts += p.doubt;
    }
    for (Sheet& s : sheets_)
        for (SheetPiece& p : s.pieces) p.share /= sum, p.doubt = doubts > 0 ? p.doubt / doubts : 0;
}

bool FlareSheets::has(int source) const {
    return std::ranges::any_of(sources_, [&](const SmallSource& s) { return s.source == source; });
}

}  // namespace dg
