#include "render/flare/maps/sheet_pass.h"

#include <algorithm>
#include <cmath>


namespace dg {
namespace {

// Arrivals per flare path: from maps; exact rays that correct maps; exact rays where maps have no light.
constexpr double kArrivals = 4, kDifferences = 0.125, kDark = 0.005;
constexpr double kTask = 1 << 16;   // arrivals
constexpr float kNear = 48;         // px: margin around the frame
constexpr float kVariance = 0.56f;  // relative variance of light moved by a node spacing (degree 4 B-spline)
constexpr int kDifferenceLevel = SheetLevel::kMost;   // differences are small and without fine detail
constexpr float kMm2 = 1e6f;        // in 1 m2

/// Chooses an integer level at random, for a smooth transition between levels.
int drawn_level(float level, float u) { return std::min(int(level + u), SheetLevel::kMost); }

std::unique_ptr<CoarseLight> coarse(const Picture& p, int values, int level, double mean) {
    return std::make_unique<CoarseLight>(p.density.region(), values, level, mean, p.settings.filter.variance());
}

}  // namespace

SheetPass::SheetPass(const Picture& picture, std::array<double, 2> indices, double per_sample, double per_count,
                     std::shared_ptr<const FlareGuide> guide)
    : picture_(picture), indices_(indices), per_sample_(per_sample), per_count_(per_count), guide_(std::move(guide)),
      density_(picture.density.without_shutter()),
      colors_(picture.film.responses()) {
    const Sensor& sensor = picture.settings.sensor;
    unit_ = float(kMm2 / std::get<ExactLens>(picture.camera.lens).h0() / sensor.mm2_per_px());
    plan();
    const double mean = guide_->sheets().mean() * unit_;
    for (int level = 0; level <= SheetLevel::kMost; ++level)
        coarse_[level] = coarse(picture, colors_.table.values(), level, mean);
}

/// Groups consecutive pieces into tasks with similar numbers of arrivals. Dark areas belong to the first task.
void SheetPass::plan() {
    const auto& sheets = guide_->sheets().sheets();
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        const auto pieces = std::uint32_t(sheets[s].pieces.size());
        std::uint32_t first = 0;
        double arrivals = 0;
        for (std::uint32_t p = 0; p < pieces; ++p) {
            arrivals += rate(Kind::map, sheets[s].pieces[p]) * (indices_[1] - indices_[0]);
            if (arrivals < kTask) continue;
            tasks_.push_back({s, first, p + 1}), first = p + 1, arrivals = 0;
        }
        if (first < pieces || pieces == 0) tasks_.push_back({s, first, pieces});
    }
}

double SheetPass::rate(Kind kind, const SheetPiece& piece) const {
    return (kind == Kind::difference ? piece.doubt * kDifferences : piece.share * kArrivals) * per_sample_;
}

/// Indices of a piece's arrivals that belong to the range of samples.
SheetPass::Range SheetPass::range(Kind kind, std::size_t sheet, std::uint32_t piece, double rate) const {
    const std::uint64_t seed =
        hash64(picture_.settings.seed, std::uint64_t(kind) << 56 | std::uint64_t(sheet) << 32 | piece);
    const double phase = hash_uniform(seed, 0x3f1a);
    const auto until = [&](double sample) { return std::uint64_t(std::floor(sample * rate + phase)); };
    return {seed, until(indices_[0]), until(indices_[1])};
}

float SheetPass::weight(double area, double rate) const { return float(unit_ * area / (rate * per_count_)); }

void SheetPass::draw(std::int64_t block) {
    auto& local = works_.local();
    if (!local) local = std::make_unique<Work>();
    Work& work = *local;
    const Task& task = tasks_[std::size_t(block)];
    const Sheet& sheet = guide_->sheets().sheets()[task.sheet];
    for (std::uint32_t c = task.first; c < task.last; ++c) draw_piece(work, task.sheet, c);
    trace(work, sheet);
    if (task.first == 0) draw_dark(work, task.sheet);
}

void SheetPass::draw_piece(Work& work, std::size_t sheet, std::uint32_t p) {
    const Sheet& s = guide_->sheets().sheets()[sheet];
    const SheetPiece& piece = s.pieces[p];
    const auto draw = [&](Kind kind, auto method) {
        const double each = rate(kind, piece);
        const Range r = range(kind, sheet, p, each);
        if (r.first < r.last) (this->*method)(work, s, piece, r, weight(area(s.map, piece), each));
    };
    if (s.map.cells()[piece.cell].exact) return draw(Kind::exact, &SheetPass::draw_exact);
    draw(Kind::map, &SheetPass::draw_map);
    draw(Kind::difference, &SheetPass::draw_difference);
}

const CellColor& SheetPass::color_of(Work& work, const Sheet& s, const SheetPiece& piece) const {
    const bool gray = piece.gray && !guide_->sheets().hidden(s.source);
    const std::pair wanted(&s.map.cells()[piece.cell], gray);
    if (work.color_of != wanted) work.color.emplace(s.map, *wanted.first, gray, colors_), work.color_of = wanted;
    return *work.color;
}

/// Draws arrivals from the map, with a shadow ray for each if the source is partly occluded.
void SheetPass::draw_map(Work& work, const Sheet& s, const SheetPiece& piece, const Range& r, float weight) {
    const GhostMap::Cell& cell = s.map.cells()[piece.cell];
    const SmallSource& small = source(s);
    const bool hidden = guide_->sheets().hidden(s.source);
    const CellColor& color = color_of(work, s, piece);
    const SheetLevel levels = this->levels(s);
    MapBatch& b = work.batch;
    const auto& u = work.numbers.of;
    work.numbers.each(r.seed, r.first, r.last, [&](std::uint64_t, int count) {
        work.from.clear();
        for (int i = 0; i < count; ++i) {
            const SmallSource::Point& p = small.point(u[CellNumbers::kPoint][i]);
            const float u_lambda = u[CellNumbers::kLambda][i];
            const float nm = color.gray() ? color.nm()
                             : hidden     ? Wavelengths::sample(u_lambda).nm[0]
                                          : color.nm(u_lambda);
            const Vec2f at = piece.at({u[CellNumbers::kAcross][i], u[CellNumbers::kDown][i]});
            b.set(i, at, p.shift, nm, p.moment.iris_opening);
            work.from.push_back(&p);
        }
        s.map.landings(cell, b, count);
        for (int i = 0; i < count; ++i) {
            if (!(b.left[i] > 0)) continue;
            const SmallSource::Point& p = *work.from[i];
            const Vec2f px{b.x[i], b.y[i]};
            const float times = weight * exposed(small, p, px);
            const int level = drawn_level(levels.of(cell.blur, b, i), u[CellNumbers::kLevel][i]);
            if (!hidden) {
                arrive(work, level, px, color.of(b, i, p.light, times));
                continue;
            }
            const MapRay ray{s.map.at(cell, {b.u[i], b.v[i]}), p.shift, b.nm[i]};
            const float clear = b.pass[i] * seen(work, s, ray, p, u[CellNumbers::kLambda][i]);
            FilmColor light{};
            colors_.table.add(light, p.light, b.nm[i], times * clear / wavelength_pdf(b.nm[i]));
            arrive(work, level, px, light);
        }
        work.counters.flare_arrivals += std::uint64_t(count);
        if (work.arrived > kTask) flush(work);
    });
}

/// Draws differences at common front points: the exact ray minus the map, for a single wavelength unless the cell is
/// gray.
void SheetPass::draw_difference(Work& work, const Sheet& s, const SheetPiece& piece, const Range& r, float weight) {
    const GhostMap::Cell& cell = s.map.cells()[piece.cell];
    const SmallSource& small = source(s);
    const bool hidden = guide_->sheets().hidden(s.source);
    const CellColor& color = color_of(work, s, piece);
    MapBatch& b = work.batch;
    const auto& u = work.numbers.of;
    work.numbers.each(r.seed, r.first, r.last, [&](std::uint64_t, int count) {
        const std::size_t begin = work.exact.size();
        for (int i = 0; i < count; ++i) {
            const Vec2f at = piece.at({u[CellNumbers::kAcross][i], u[CellNumbers::kDown][i]});
            const Exact& e = add_exact(work, s, s.map.at(cell, at), i, weight);
            b.set(i, at, e.ray.shift, color.gray() ? color.nm() : e.ray.nm, e.from->moment.iris_opening);
        }
        s.map.landings(cell, b, count);
        for (int i = 0; i < count; ++i) {
            Exact& e = work.exact[begin + std::size_t(i)];
            e.level = kDifferenceLevel;
            if (!(b.left[i] > 0)) continue;
            e.map.px = {b.x[i], b.y[i]};
            const float glass =
                color.gray() ? s.map.glass(cell, {b.u[i], b.v[i]}, b.middle[i], e.ray.nm) : b.glass[i];
            float pass = glass * b.left[i] * exposed(small, *e.from, e.map.px);
            if (hidden) pass *= seen(work, s, e.ray, *e.from, e.u_lambda);
            for (std::size_t k = 0; k < e.light.size(); ++k) e.map.light[k] = -pass * e.light[k];
        }
    });
}

/// Adds an exact ray with the random numbers i of `work`.
SheetPass::Exact& SheetPass::add_exact(Work& work, const Sheet& s, Vec2f at, int i, float weight) const {
    const auto& u = work.numbers.of;
    const SmallSource::Point& p = source(s).point(u[CellNumbers::kPoint][i]);
    const float u_lambda = u[CellNumbers::kLambda][i], nm = Wavelengths::sample(u_lambda).nm[0];
    work.exact.push_back({{at, p.shift, nm}, &p, u_lambda, {}, 0});
    colors_.table.add(work.exact.back().light, p.light, nm, weight / wavelength_pdf(nm));
    return work.exact.back();
}

void SheetPass::draw_exact(Work& work, const Sheet& s, const SheetPiece& piece, const Range& r, float weight) {
    const GhostMap::Cell& cell = s.map.cells()[piece.cell];
    const auto& u = work.numbers.of;
    work.numbers.each(r.seed, r.first, r.last, [&](std::uint64_t, int count) {
        for (int i = 0; i < count; ++i) {
            const Vec2f at = piece.at({u[CellNumbers::kAcross][i], u[CellNumbers::kDown][i]});
            add_exact(work, s, s.map.at(cell, at), i, weight).level =
                drawn_level(piece.level, u[CellNumbers::kLevel][i]);
        }
    });
}

/// Draws exact rays at front points without light in the map. Their light is splatted at the coarsest level, since they
/// are few and each is bright.
void SheetPass::draw_dark(Work& work, std::size_t sheet) {
    const Sheet& s = guide_->sheets().sheets()[sheet];
    const double rate = kDark * per_sample_ / double(guide_->sheets().sheets().size());
    const Range r = range(Kind::dark, sheet, 0, rate);
    const float weight = float(unit_ * 4 / (rate * per_count_));
    const auto& u = work.numbers.of;
    work.numbers.each(r.seed, r.first, r.last, [&](std::uint64_t, int count) {
        for (int i = 0; i < count; ++i) {
            const Vec2f at{2 * u[CellNumbers::kAcross][i] - 1, 2 * u[CellNumbers::kDown][i] - 1};
            if (s.is_dark(at)) add_exact(work, s, at, i, weight).level = kDifferenceLevel;
        }
    });
    trace(work, s);
}

/// Traces the gathered exact rays.
void SheetPass::trace(Work& work, const Sheet& s) {
    std::vector<MapRay> rays;
    for (const Exact& e : work.exact) rays.push_back(e.ray);
    const std::vector<MapLanding> landings = s.rays.trace(rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Exact& e = work.exact[i];
        float pass = s.rays.passed(landings[i], e.from->moment.iris_opening);
        if (pass > 0) pass *= exposed(source(s), *e.from, landings[i].px) * seen(work, s, e.ray, *e.from, e.u_lambda);
        FilmColor light = e.light;
        for (float& v : light) v *= pass;
        arrive(work, e.level, landings[i].px, light, &e.map);
        work.counters.flare_hits += pass > 0 && picture_.settings.sensor.holds(landings[i].px);
    }
    work.counters.flare_rays += rays.size(), work.counters.flare_paths += rays.size();
    work.exact.clear();
    flush(work);
}

void SheetPass::flush(Work& work) {
    work.arrived = 0;
    for (int level = 0; level <= SheetLevel::kMost; ++level) {
        if (!work.arrivals[level].empty()) coarse_[level]->add(work.arrivals[level]);
        work.arrivals[level].clear();
    }
}

/// Visibility of the source point along the ray, at its wavelength.
float SheetPass::seen(Work& work, const Sheet& s, const MapRay& ray, const SmallSource::Point& from,
                      float u_lambda) const {
    const auto shadow = s.rays.shadow(ray, from.from, from.moment.time);
    if (!shadow) return 0;
    ++work.counters.rays;
    const Wavelengths wavelengths = Wavelengths::sample(u_lambda);
    return flare_transmittance(picture_.scene, picture_.settings.path, from.from, *shadow, wavelengths)[0];
}

/// Shutter transmission: the mean over the exposure, or the value at the point's time for a moving source with a
/// rolling shutter.
float SheetPass::exposed(const SmallSource& small, const SmallSource::Point& from, Vec2f px) const {
    const Shutter& shutter = picture_.settings.shutter;
    if (!shutter.rolls() || !small.moves) return shutter.weight();
    const Sensor& sensor = picture_.settings.sensor;
    return shutter.opening(shutter.row_at(px, sensor.width, sensor.height), from.moment.time) / float(shutter.any_share());
}

/// Adds light at a position, and subtracts the map's light at its position.
void SheetPass::arrive(Work& work, int level, Vec2f px, const FilmColor& light, const Taken* map) {
    const Sensor& sensor = picture_.settings.sensor;
    const auto counts = [&](Vec2f at, const FilmColor& c) {
        return (c[0] != 0 || c[1] != 0 || c[2] != 0) && at.x > -kNear && at.y > -kNear &&
               at.x < float(sensor.width) + kNear && at.y < float(sensor.height) + kNear;
    };
    const bool one = counts(px, light), two = map && counts(map->px, map->light);
    float variance = 1;
    if (one && two) {
        const float moved = length(px - map->px) / float(1 << level);
        variance = std::min(1.f, kVariance * moved * moved);
    }
    ++work.arrived;
    if (one) work.arrivals[level].push_back({px, light, variance});
    if (two) work.arrivals[level].push_back({map->px, map->light, variance});
}

void SheetPass::finish(int threads) {
    CoarseLight::to_film(coarse_, picture_.film, density_, threads);
}

RenderCounters SheetPass::counters() const {
    RenderCounters sum;
    for (const auto& work : works_) sum += work->counters;
    return sum;
}

}  // namespace dg
