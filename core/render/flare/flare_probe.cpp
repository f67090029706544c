#include "render/flare/flare_probe.h"

#include <algorithm>
#include <cmath>

#include "math/sampler.h"

namespace dg {
namespace {

constexpr float kGrowth = 0.25f;   // fraction of the size, at a side where light enters
constexpr int kSequence = -3;   // in place of a pixel row, in the sampler's scramble

/// A batch of rays through a ghost.
struct Batch {
    std::vector<FlareArrival> paths;
    std::vector<CameraRay> rays;
    std::vector<float> nm, lambda;
    std::vector<Reprojection> landings;

    void add(const FlareArrival& path, float u) {
        paths.push_back(path), rays.push_back(path.lens);
        nm.push_back(path.wavelengths.nm[0]), lambda.push_back(u);
    }
    void trace(const FlareAim& aim, int ghost) {
        landings.assign(rays.size(), Reprojection{});
        for (std::size_t begin = 0, end = 0; begin < rays.size(); begin = end) {   // runs of equal states
            const std::size_t state = aim.state_at(rays[begin].ray.time);
            while (end < rays.size() && aim.state_at(rays[end].ray.time) == state) ++end;
            const std::size_t n = end - begin;
            aim.trace(state, ghost, std::span(rays).subspan(begin, n), std::span(nm).subspan(begin, n),
                      std::span(landings).subspan(begin, n));
        }
    }
    void clear() { paths.clear(), rays.clear(), nm.clear(), lambda.clear(); }
};

/// Distance from the frame, px; infinite for rays that do not reach the film plane.
float beside_frame(const Sensor& sensor, const Reprojection& landing) {
    if (!(landing.transmittance > 0)) return std::numeric_limits<float>::infinity();
    const Vec2f px = sensor.px_from_mm(landing.film_mm);
    const float x = std::max({0.f, -px.x, px.x - float(sensor.width)}),
                y = std::max({0.f, -px.y, px.y - float(sensor.height)});
    return hypot(x, y);
}

void collect(const FlareAim& aim, const Batch& batch, FlareFound& found) {
    for (std::size_t i = 0; i < batch.paths.size(); ++i) {
        const FlareArrival& path = batch.paths[i];
        const auto px = aim.on_frame(batch.landings[i], path.lens.ray.time);
        if (!px) {
            const float apart = beside_frame(aim.sensor(), batch.landings[i]);
            if (apart < found.near_px) found.near_px = apart, found.near_at = path.at;
            continue;
        }
        Spectrum light{0.f};   // of the traced wavelength
        light.set(0, kWavelengths * path.radiance[0] * float(batch.landings[i].response / path.density));
        const Vec3f xyz = path.wavelengths.to_xyz(light);
        const Rgb rgb = rgb_from_xyz(xyz);
        found.low = {std::min(found.low.x, path.at.x), std::min(found.low.y, path.at.y)};
        found.high = {std::max(found.high.x, path.at.x), std::max(found.high.y, path.at.y)};
        found.hits.push_back({path.at, *px, batch.lambda[i], xyz.y, std::sqrt(dot(rgb, rgb) / 3),
                              1 / float(found.probe.count)});
    }
}

}  // namespace

std::size_t cell_of(const FlareRectangle& where, Vec2f at, int across) {
    const Vec2f in = where.in(at);
    const int c = std::clamp(int(in.x * float(across)), 0, across - 1),
              r = std::clamp(int(in.y * float(across)), 0, across - 1);
    return std::size_t(r) * across + c;
}

FlareFound probe_flare(const FlareAim& aim, const FlareProbe& probe) {
    FlareFound found{probe};
    Batch batch;
    const auto follow = [&] {
        batch.trace(aim, probe.ghost);
        collect(aim, batch, found);
        batch.clear();
    };
    const double pdf = 1 / probe.where.area();
    const int sequence = probe.source * aim.ghosts() + probe.ghost;
    for (int i = probe.first; i < probe.first + probe.count; ++i) {
        PathSampler sampler(sequence, kSequence, std::uint32_t(i), 0);
        const CameraRandom c = sampler.camera();
        const FlareAim::Random u{
            c.film.x, {Spectrum(c.lambda), 1.f}, sampler.next_2d(), aim.shutter().draw_any(c.time)};
        Vec2f in = c.lens;
        if (probe.cells) {
            const Sample2D cell = probe.cells->sample(in);
            in = {cell.x, cell.y};
        }
        const auto path = aim.aim(probe.source, probe.ghost, probe.where.at(in), pdf, u);
        if (!path) continue;
        batch.add(*path, c.lambda);
        if (batch.rays.size() == kLensBatch) follow();
    }
    follow();
    return found;
}

void FlareFound::add(const FlareFound& other) {
    probe.count += other.probe.count;
    hits.insert(hits.end(), other.hits.begin(), other.hits.end());
    reach(other);
}

void FlareFound::share(const std::vector<double>& rays, int across) {
    for (Hit& hit : hits) {
        const double own = rays[cell_of(probe.where, hit.at, across)];
        hit.share = float(1 / (own * double(rays.size())));
    }
}

void FlareFound::reach(const FlareFound& other) {
    low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y)};
    high = {std::max(high.x, other.high.x), std::max(high.y, other.high.y)};
}

FlareRectangle FlareFound::grown(int across) const {
    const FlareRectangle& old = probe.where;
    const Vec2f cell = old.size * (1 / float(across)), more = old.size * kGrowth;
    Vec2f from = old.low, to = old.low + old.size;
    if (low.x < from.x + cell.x) from.x = std::max(-1.f, from.x - more.x);
    if (low.y < from.y + cell.y) from.y = std::max(-1.f, from.y - more.y);
    if (high.x > to.x - cell.x) to.x = std::min(1.f, to.x + more.x);
    if (high.y > to.y - cell.y) to.y = std::min(1.f, to.y + more.y);
    return {from, to - from};
}

FlareRectangle FlareFound::narrowed() const {
    const FlareRectangle& old = probe.where;
    const float step = 1.5f / std::sqrt(float(probe.count)), more = 0.05f + 2 / float(hits.size());
    const Vec2f size = high - low, end = old.low + old.size;
    const Vec2f margin{more * size.x + step * old.size.x, more * size.y + step * old.size.y};
    const Vec2f from{std::max(old.low.x, low.x - margin.x), std::max(old.low.y, low.y - margin.y)};
    return {from, {std::min(end.x, high.x + margin.x) - from.x, std::min(end.y, high.y + margin.y) - from.y}};
}

}  // namespace dg
