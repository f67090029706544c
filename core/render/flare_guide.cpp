#include "render/flare_guide.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "math/hash.h"
#include "render/light_arrival.h"
#include "render/parallel.h"

namespace dg {
namespace {

constexpr float kBlindPair = 0.02f;   // share of paths whose source and ghost are not learned
constexpr float kBlindCell = 0.02f;   // and whose place on the front is not, at least
constexpr std::size_t kMostFour = 1024;   // ghosts by four reflections
constexpr double kProbes = 1 << 20;   // rays of the first look, all pairs together
constexpr int kFewest = 32, kMost = 1024;  // of one pair
constexpr double kPooled = 0.1;       // share of a source's paths that goes to ghosts as those of all sources do
constexpr double kKnown = 0.998;      // of the light: pairs that bring it are looked at again
constexpr std::size_t kMostPairs = 4096;
constexpr int kCoarse = 16, kFine = 32;   // cells across
constexpr double kStrong = 0.003;     // of the light: such a pair gets fine cells
constexpr int kPerCell = 4;           // rays
constexpr int kLook = 256;            // rays of a look where cells should lie

/// Axes across a direction that turn with it from straight ahead (-z) without a jump but straight behind.
struct Across {
    Vec3d x, y;
    explicit Across(Vec3d e) {
        const double k = 1 / std::max(1 - e.z, 1e-9);
        x = {1 - k * e.x * e.x, -k * e.x * e.y, e.x};
        y = {-k * e.x * e.y, 1 - k * e.y * e.y, e.y};
    }
};

float luminance_of(const FlareArrival& path) {
    return path.wavelengths.to_xyz(path.radiance).y;
}

}  // namespace

Ray flare_shadow(const FlarePoint& from, const Ray& from_lens) {
    if (from.at_infinity) return from_lens;
    const float cosine = from.delta ? 1 : std::abs(dot(from.point.normal, from_lens.direction));
    return shadow_ray(from.point.position, cosine, from_lens);
}

/// Rays of one pair, over a rectangle of the front.
struct FlareGuide::Probe {
    int source, ghost;
    int count;
    Rectangle where{};
};

/// What they brought.
struct FlareGuide::Found {
    double flux = 0;
    Vec2f low{1e9f, 1e9f}, high{-1e9f, -1e9f};   // of the front
    int hits = 0, count = 0;
    double sum[5] = {};            // of film points: x, y, xx, yy, xy
    std::vector<Vec2f> at{};       // hits on the front, and their light
    std::vector<float> light{};

    /// That is lit, px: the ellipse of the film points' spread, which for a disc is the disc.
    double area() const {
        if (hits < 2) return 1;
        const double n = hits, mx = sum[0] / n, my = sum[1] / n;
        const double xx = sum[2] / n - mx * mx, yy = sum[3] / n - my * my, xy = sum[4] / n - mx * my;
        return std::max(1.0, 4 * kPiD * std::sqrt(std::max(0.0, xx * yy - xy * xy)));
    }
    /// How many paths should go there: the error of a pixel, relative to what it shows, is least if paths are
    /// as dense on the film as the root of its light.
    double weight() const { return std::sqrt(flux * area()); }
};

FlareGuide::FlareGuide(const Scene& scene, const Camera& camera, const RenderSettings& settings)
    : scene_(scene),
      camera_(camera),
      sensor_(settings.sensor),
      shutter_(settings.shutter),
      reach_(settings.filter.radius()),
      threads_(settings.threads),
      times_(camera.lens_motion.times) {
    if (times_.empty()) add_state(camera, std::get<ExactLens>(camera.lens));
    for (const LensKind& lens : camera.lens_motion.lenses) add_state(camera, std::get<ExactLens>(lens));
    mirrors_ = states_.front().ghosts.two_bounces();
    if (settings.flare.order >= 4) {
        const auto more = states_.front().ghosts.four_bounces(kMostFour);
        mirrors_.insert(mirrors_.end(), more.begin(), more.end());
    }
    for (State& state : states_)
        for (const Mirrors& mirrors : mirrors_) state.steps.push_back(state.ghosts.steps(mirrors));
    const ExactLens::Ball first = states_.front().lens.front_ball();
    center_ = first.center;
    for (const State& state : states_) {
        const ExactLens::Ball ball = state.lens.front_ball();
        radius_ = std::max(radius_, ball.radius + length(ball.center - center_));
    }
    sources_ = FlareSources(scene.lights(), views());
    if (!mirrors_.empty() && sources_.count() > 0) learn();
}

void FlareGuide::add_state(const Camera& camera, const ExactLens& lens) {
    states_.push_back({lens, lens.ghosts(camera.sensor_stack), {}});
}

/// All around, at some moments.
std::vector<ViewCone> FlareGuide::views() const {
    std::vector<ViewCone> views;
    const bool still = !camera_.world_from_camera.moves();
    for (int i = 0; i < (still ? 1 : 5); ++i) {
        const float time = still ? 0.5f : 0.25f * float(i);
        const Vec3d eye = camera_.world_from_camera.at(time).origin;
        views.push_back({{to_float(eye), float(length(center_) + radius_)}, time});
    }
    return views;
}

std::size_t FlareGuide::state_at(float time) const {
    if (times_.empty()) return 0;
    const KeyPlace p = place_among(times_, time);
    return p.share < 0.5 ? p.left : p.right;
}

void FlareGuide::trace(std::size_t state, int ghost, std::span<const CameraRay> rays,
                       std::span<const float> nm, std::span<Reprojection> out) const {
    const State& s = states_[state];
    s.lens.reproject(rays, nm, s.ghosts, s.steps[ghost], out);
    if (camera_.setting.values.empty()) return;
    for (std::size_t i = 0; i < out.size(); ++i)   // the film lay elsewhere then
        out[i].film_mm = out[i].film_mm - setting_at(camera_, rays[i].ray.time).film_shift_mm;
}

std::optional<Vec2f> FlareGuide::on_frame(const Reprojection& landing, float time) const {
    if (!(landing.transmittance > 0)) return std::nullopt;
    const Vec2f px = sensor_.px_from_mm(landing.film_mm);
    if (!(px.x > -reach_ && px.x < float(sensor_.width) + reach_ && px.y > -reach_ &&
          px.y < float(sensor_.height) + reach_))
        return std::nullopt;
    if (!shutter_.rolls()) return px;
    const int line = int(std::floor(shutter_.scans_columns() ? px.x : px.y));
    const int lines = shutter_.scans_columns() ? sensor_.width : sensor_.height;
    for (int i = -1; i <= 1; ++i)   // the filter reaches some lines
        if (shutter_.opening(std::clamp(line + i, 0, lines - 1), time) > 0) return px;
    return std::nullopt;
}

Vec2f FlareGuide::Cells::sample(Vec2f u) const {
    const float half = 0.5f * blind;
    if (u.x < half) return Rectangle{}.at({u.x / half, u.y});
    if (u.x < blind) return outer.at({(u.x - half) / half, u.y});
    const Sample2D s = weights.sample({(u.x - blind) / (1 - blind), u.y});
    return inner.at({s.x, s.y});
}

double FlareGuide::Cells::pdf(Vec2f at) const {
    const Vec2f in = inner.in(at);
    return 0.5 * blind * (1 / Rectangle{}.area() + (outer.holds(at) ? 1 / outer.area() : 0)) +
           (1 - blind) * double(weights.pdf(in.x, in.y)) / inner.area();
}

std::optional<FlareArrival> FlareGuide::draw(const Random& u) const {
    const DiscreteSample pair = pairs_.sample(u.pair);
    const int source = pair.index / ghosts(), ghost = pair.index % ghosts();
    const int known = cells_of_pair_[pair.index];
    const Vec2f at = known < 0 ? Rectangle{}.at(u.front) : cells_[known].sample(u.front);
    const double pdf = known < 0 ? 1 / Rectangle{}.area() : cells_[known].pdf(at);
    return aimed(source, ghost, at, pdf * double(pair.pmf), u);
}

/// pdf: of pair and place, per unit of the square.
std::optional<FlareArrival> FlareGuide::aimed(int source, int ghost, Vec2f at, double pdf,
                                              const Random& u) const {
    const float time = u.moment.time;
    const Affine3d pose = camera_.world_from_camera.at(time);
    const Viewpoint view{to_float(pose.origin), float(length(center_) + radius_)};
    const auto from = sources_.sample(source, u.select, u.point, time, view);
    if (!from) return std::nullopt;
    const Affine3d to_camera = inverse(pose);
    const Vec3d position = to_double(from->point.position);
    const Vec3d p = from->at_infinity ? to_camera.vector(position) : to_camera.point(position);
    const Vec3d toward = from->at_infinity ? p : p - center_;
    const double distance = from->at_infinity ? 1 : length(toward);
    if (!(distance > radius_ * (from->at_infinity ? 0 : 1))) return std::nullopt;   // within the glass
    const Vec3d e = toward / distance;
    const Across across(e);
    const Vec3d q = center_ + radius_ * (double(at.x) * across.x + double(at.y) * across.y);
    const Vec3d way = from->at_infinity ? e : p - q;
    const double d2 = from->at_infinity ? 1 : length_squared(way);
    const Vec3d direction = way / std::sqrt(d2);
    const auto start = states_[state_at(time)].lens.start(q, direction);
    if (!start) return std::nullopt;
    FlareArrival path;
    path.lens.ray = {.origin = to_float(*start), .direction = to_float(direction), .time = time};
    path.lens.iris_opening = u.moment.iris_opening * setting_at(camera_, time).iris_opening;
    const Vec3f world = to_float(pose.vector(direction));
    const bool area = !from->at_infinity && !from->delta;
    const double cosine = area ? std::abs(dot(from->point.normal, world)) : 1;
    // Per m2 of the square, then per sr at the point (or per m2 across the ray), then per m2 sr.
    path.density = double(from->point.pdf) * pdf / (radius_ * radius_) * d2 / dot(direction, e) / cosine;
    if (!(path.density > 0) || !std::isfinite(path.density)) return std::nullopt;
    const Rgb value = from->delta
                          ? sources_.delta_value(*from, to_float(pose.point(*start)), time)
                          : scene_.emission(from->point, -world, time);
    if (!(max_component(value) > 0)) return std::nullopt;
    path.ghost = ghost, path.at = at, path.from = *from;
    path.wavelengths = Wavelengths::sample(u.lambda);
    path.radiance = path.wavelengths.emission(value);
    return path;
}

FlareGuide::Found FlareGuide::probe(const Probe& probe) const {
    std::vector<FlareArrival> paths;
    std::vector<CameraRay> rays;
    std::vector<float> nm;
    Found found;
    found.count = probe.count;
    const double pdf = 1 / probe.where.area();
    const auto follow = [&] {
        std::vector<Reprojection> landings(rays.size());
        std::size_t begin = 0;
        while (begin < rays.size()) {   // states of the lens, one after the other
            const std::size_t state = state_at(rays[begin].ray.time);
            std::size_t end = begin;
            while (end < rays.size() && state_at(rays[end].ray.time) == state) ++end;
            trace(state, probe.ghost, std::span(rays).subspan(begin, end - begin),
                  std::span(nm).subspan(begin, end - begin),
                  std::span(landings).subspan(begin, end - begin));
            begin = end;
        }
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto px = on_frame(landings[i], rays[i].ray.time);
            if (!px) continue;
            const FlareArrival& path = paths[i];
            const double light = landings[i].response * luminance_of(path) / path.density / probe.count;
            ++found.hits, found.flux += light;
            found.low = {std::min(found.low.x, path.at.x), std::min(found.low.y, path.at.y)};
            found.high = {std::max(found.high.x, path.at.x), std::max(found.high.y, path.at.y)};
            const double x = px->x, y = px->y;
            const double moments[5] = {x, y, x * x, y * y, x * y};
            for (int k = 0; k < 5; ++k) found.sum[k] += moments[k];
            found.at.push_back(path.at), found.light.push_back(float(light));
        }
        paths.clear(), rays.clear(), nm.clear();
    };
    const int sequence = probe.source * ghosts() + probe.ghost;
    for (int i = 0; i < probe.count; ++i) {
        PathSampler sampler(sequence, -3, std::uint32_t(i), 0);
        const CameraRandom c = sampler.camera();
        const Vec2f at = probe.where.at(c.lens);
        const Random u{0, c.film.x, c.lambda, {}, sampler.next_2d(), shutter_.draw_any(c.time)};
        auto path = aimed(probe.source, probe.ghost, at, pdf, u);
        if (!path || !(luminance_of(*path) > 0)) continue;
        paths.push_back(*path), rays.push_back(path->lens);
        nm.push_back(path->wavelengths.nm[i % kWavelengths]);
        if (rays.size() == kLensBatch) follow();
    }
    follow();
    return found;
}

/// Of some rays from a source to the front; never 0, as few were looked at.
double FlareGuide::visible_share(int source) const {
    int seen = 0, all = 0;
    for (int i = 0; i < 64; ++i) {
        PathSampler sampler(source, -5, std::uint32_t(i), 0);
        const CameraRandom c = sampler.camera();
        const Vec2f at{2 * c.lens.x - 1, 2 * c.lens.y - 1};
        const Random u{0, c.film.x, c.lambda, {}, sampler.next_2d(), shutter_.draw_any(c.time)};
        const auto path = aimed(source, 0, at, 0.25, u);
        if (!path) continue;
        ++all;
        const Ray ray = flare_shadow(path->from, to_world(camera_, path->lens.ray));
        seen += is_traceable(ray) && !scene_.visibility_along(ray, path->wavelengths).is_black();
    }
    return all ? std::max(0.02, double(seen) / all) : 0.02;
}

void FlareGuide::learn() {
    std::vector<double> strength(sources_.count());
    parallel_tasks(threads_, sources_.count(), [&](std::int64_t s) {
        strength[s] = sources_.strength(int(s)) * visible_share(int(s));
    });
    const double all = std::accumulate(strength.begin(), strength.end(), 0.0);
    std::vector<Found> found(std::size_t(sources_.count()) * ghosts());
    parallel_tasks(threads_, std::int64_t(found.size()), [&](std::int64_t i) {
        const int source = int(i / ghosts());
        const double rays = kProbes * strength[source] / all / ghosts();
        const int count = std::clamp(int(rays) / 8 * 8, kFewest, kMost);
        found[i] = probe({source, int(i % ghosts()), count});
    });
    refine(found);
}

/// Pairs by what is not learned: strength of the source, and reflectances straight on.
std::vector<double> FlareGuide::blind() const {
    std::vector<double> bright;
    for (const Mirrors& mirrors : mirrors_) {
        double r = 1;
        for (const int i : mirrors) r *= states_.front().ghosts.reflectance(i);
        bright.push_back(r);
    }
    std::vector<double> weights;
    for (int s = 0; s < sources_.count(); ++s)
        for (const double r : bright) weights.push_back(sources_.strength(s) * r);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& w : weights) w /= sum;
    return weights;
}

/// Looks again at what brings nearly all of the light, where it enters.
void FlareGuide::refine(const std::vector<Found>& found) {
    std::vector<std::size_t> order;
    double flux = 0, known = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        flux += found[i].flux;
        if (found[i].hits > 0) order.push_back(i);
    }
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) { return found[i].flux; });
    std::size_t kept = 0;
    while (kept < order.size() && kept < kMostPairs && known < kKnown * flux) known += found[order[kept++]].flux;
    std::vector<double> weights(found.size());
    for (std::size_t i = 0; i < found.size(); ++i) weights[i] = found[i].weight();
    cells_.resize(kept), cells_of_pair_.assign(found.size(), -1);
    std::vector<Found> fine(kept);
    parallel_tasks(threads_, std::int64_t(kept), [&](std::int64_t k) {
        const std::size_t i = order[k];
        const bool strong = found[i].flux > kStrong * flux;
        const int across = strong ? kFine : kCoarse;
        const Probe again{int(i) / ghosts(), int(i) % ghosts(), kPerCell * across * across};
        cells_[k] = cells_of(again, found[i], fine[k]);
    });
    for (std::size_t k = 0; k < kept; ++k) {
        if (fine[k].hits == 0) continue;
        cells_of_pair_[order[k]] = int(k);
        weights[order[k]] = fine[k].weight();
    }
    pool(weights);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const std::vector<double> even = blind();
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = sum > 0 ? (1 - kBlindPair) * weights[i] / sum + kBlindPair * even[i] : even[i];
    pairs_ = DiscreteDistribution(std::span<const double>(weights));
}

/// Of a dim source few rays were looked at: which ghosts it has is known better from all sources together.
void FlareGuide::pool(std::vector<double>& weights) const {
    std::vector<double> of_ghost(ghosts());
    double all = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) of_ghost[i % ghosts()] += weights[i], all += weights[i];
    if (!(all > 0)) return;
    for (int s = 0; s < sources_.count(); ++s) {
        double* own = weights.data() + std::size_t(s) * ghosts();
        const double sum = std::accumulate(own, own + ghosts(), 0.0);
        for (int g = 0; g < ghosts(); ++g) own[g] = (1 - kPooled) * own[g] + kPooled * sum * of_ghost[g] / all;
    }
}

/// A rectangle that holds what was found to let light in, and as much around it as the rays may have missed.
FlareGuide::Rectangle FlareGuide::narrowed(const Rectangle& old, const Found& found) {
    const float step = 1.5f / std::sqrt(float(found.count)), more = 0.05f + 2 / float(found.hits);
    const Vec2f size = found.high - found.low, end = old.low + old.size;
    const Vec2f margin{more * size.x + step * old.size.x, more * size.y + step * old.size.y};
    const Vec2f low{std::max(old.low.x, found.low.x - margin.x), std::max(old.low.y, found.low.y - margin.y)};
    return {low,
            {std::min(end.x, found.high.x + margin.x) - low.x, std::min(end.y, found.high.y + margin.y) - low.y}};
}

/// What enters through the cells of the rectangle that lets light in.
FlareGuide::Cells FlareGuide::cells_of(const Probe& wide, const Found& found, Found& fine) const {
    Cells cells;
    cells.outer = narrowed({}, found);
    Probe probe{wide.source, wide.ghost, kLook, cells.outer};
    for (int i = 0; i < 2; ++i) {   // closer, while it is small in what was looked at
        const Found closer = this->probe(probe);
        if (closer.hits == 0) break;
        const Rectangle next = narrowed(probe.where, closer);
        const bool done = next.area() > 0.5f * probe.where.area();
        probe.where = next;
        if (done) break;
    }
    probe.count = wide.count;
    fine = this->probe(probe);
    cells.inner = probe.where;
    cells.blind = std::clamp(2 / std::sqrt(float(std::max(fine.hits, 1))), kBlindCell, 0.5f);
    const int across = int(std::lround(std::sqrt(double(probe.count) / kPerCell)));
    std::vector<float> light(std::size_t(across) * across), spread(light.size());
    for (std::size_t i = 0; i < fine.at.size(); ++i) {
        const Vec2f in = cells.inner.in(fine.at[i]);
        const int c = std::clamp(int(in.x * float(across)), 0, across - 1),
                  r = std::clamp(int(in.y * float(across)), 0, across - 1);
        light[std::size_t(r) * across + c] += fine.light[i];
    }
    // A cell whose rays all missed may be lit at its edge where its neighbours are.
    for (int r = 0; r < across; ++r)
        for (int c = 0; c < across; ++c) {
            float around = 0;
            for (int k = 0; k < 9; ++k) {
                const int y = r + k / 3 - 1, x = c + k % 3 - 1;
                if (x >= 0 && x < across && y >= 0 && y < across)
                    around += light[std::size_t(y) * across + x];
            }
            const float own = light[std::size_t(r) * across + c];
            spread[std::size_t(r) * across + c] = own + 0.02f * around;
        }
    if (fine.flux > 0) cells.weights = Distribution2D(across, across, spread);
    return cells;
}

}  // namespace dg
