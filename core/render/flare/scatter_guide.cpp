#include "render/flare/scatter_guide.h"

#include <algorithm>
#include <numeric>

#include "math/hash.h"
#include "render/parallel.h"

namespace dg {
namespace {

constexpr double kBlind = 0.3;    // defensive share of paths, by the emitters' illuminance at the lens
constexpr double kBlindFront = 0.1;   // least uniform share of front points
constexpr int kFirst = 1 << 15, kSecond = 1 << 18;   // walks of both passes, all sources together
constexpr int kFewest = 64, kMost = 1 << 13;   // per source in the first pass
constexpr double kDim = 0.002;    // fraction of the light: dimmer sources skip the second pass
constexpr int kCells = 16;        // along each axis
constexpr int kSequence = -7;     // in place of a pixel row, in the sampler's scramble

/// Uniform point of FlareAim's square.
Vec2f on_square(Vec2f u) {
    return {2 * u.x - 1, 2 * u.y - 1};
}
constexpr double kSquarePdf = 0.25;

int cell_of(Vec2f at) {
    const auto cell = [](float x) { return std::clamp(int((x + 1) * 0.5f * kCells), 0, kCells - 1); };
    return cell(at.y) * kCells + cell(at.x);
}

}  // namespace

ScatterGuide::ScatterGuide(std::shared_ptr<const FlareAim> aim, const Scene& scene, const Camera& camera,
                           const RenderSettings& settings)
    : scene_(scene), camera_(camera), aim_(std::move(aim)) {
    const auto add = [&](const LensKind& kind) {
        const ExactLens& lens = std::get<ExactLens>(kind);
        states_.push_back({lens, lens.scatter(camera.sensor_stack, camera.scatter)});
    };
    if (camera.lens_motion.lenses.empty()) add(camera.lens);
    for (const LensKind& lens : camera.lens_motion.lenses) add(lens);
    if (camera.scatter.scatters() && aim_->sources().count() > 0) learn(settings.threads);
}

std::optional<FlareArrival> ScatterGuide::draw(float u_source, Vec2f front, const FlareAim::Random& u) const {
    const DiscreteSample source = sources_.sample(u_source);
    const Front& known = fronts_[source.index];
    const Vec2f at = known.sample(front);
    return aim_->aim(source.index, 0, at, known.pdf(at) * double(source.pmf), u);
}

Vec2f ScatterGuide::Front::sample(Vec2f u) const {
    const float even = float(blind);
    if (even >= 1) return on_square(u);
    if (u.x < even) return on_square({u.x / even, u.y});
    const Sample2D s = cells.sample({(u.x - even) / (1 - even), u.y});
    return on_square({s.x, s.y});
}

double ScatterGuide::Front::pdf(Vec2f at) const {
    if (blind >= 1) return kSquarePdf;
    return kSquarePdf * (blind + (1 - blind) * double(cells.pdf(0.5f * (at.x + 1), 0.5f * (at.y + 1))));
}

ScatterGuide::Landings ScatterGuide::trace(const FlareArrival& path, std::uint64_t seed) const {
    const float time = path.lens.ray.time;
    const State& state = states_[aim_->state_at(time)];
    const Vec2f shift = setting_at(camera_, time).film_shift_mm;   // film shift at that time
    Landings landings;
    for (int k = 0; k < kWavelengths; ++k) {
        const ExactLens::Scattered light =
            state.lens.reproject(path.lens, state.parts.at(path.wavelengths.nm[k]), state.parts, seed);
        landings.at[k] = light.landing, landings.blur2_mm2[k] = light.blur2_mm2;
        landings.at[k].film_mm = landings.at[k].film_mm - shift;
    }
    return landings;
}

/// Light that a walk at one wavelength adds to the frame; empty if it misses the frame.
std::optional<double> ScatterGuide::light_of(const FlareArrival& path, float nm, std::uint64_t seed) const {
    const State& state = states_[aim_->state_at(path.lens.ray.time)];
    const auto landing = state.lens.reproject(path.lens, state.parts.at(nm), state.parts, seed).landing;
    if (!aim_->on_frame(landing, path.lens.ray.time)) return std::nullopt;
    Spectrum radiance = path.radiance;
    if (!path.from.reflected) {   // reflected light was found by rays from the lens
        const Ray shadow = flare_shadow(path.from, to_world(camera_, path.lens.ray));
        if (!is_traceable(shadow)) return std::nullopt;
        radiance = radiance * scene_.visibility_along(shadow, path.wavelengths);
    }
    return double(path.wavelengths.to_xyz(radiance).y) * landing.response / path.density;
}

ScatterGuide::Found ScatterGuide::look(int source, int walks) const {
    Found found{.squares = std::vector<double>(kCells * kCells)};
    for (int i = 0; i < walks; ++i) {
        PathSampler sampler(source, kSequence, std::uint32_t(i), std::uint64_t(walks));
        const CameraRandom c = sampler.camera();
        const FlareAim::Random u{c.film.x, c.lambda, sampler.next_2d(), aim_->shutter().draw_any(c.time)};
        const auto path = aim_->aim(source, 0, on_square(c.lens), kSquarePdf, u);
        if (!path) continue;
        const float nm = path->wavelengths.nm[i % kWavelengths];
        const auto light = light_of(*path, nm, hash64(std::uint64_t(source), std::uint64_t(i)));
        if (!light) continue;
        ++found.hits;
        found.light += *light / walks;
        found.squares[cell_of(path->at)] += *light * *light / walks;
    }
    return found;
}

/// Weights cells by the root mean square of their light, blurred over neighbouring cells.
ScatterGuide::Front ScatterGuide::front_of(const Found& found) {
    Front front;
    if (!(found.light > 0)) return front;
    std::vector<float> weights(kCells * kCells);
    for (int r = 0; r < kCells; ++r)
        for (int c = 0; c < kCells; ++c) {
            double around = 0;
            for (int y = std::max(r - 1, 0); y <= std::min(r + 1, kCells - 1); ++y)
                for (int x = std::max(c - 1, 0); x <= std::min(c + 1, kCells - 1); ++x)
                    around += found.squares[y * kCells + x];
            weights[r * kCells + c] = float(std::sqrt((found.squares[r * kCells + c] + 0.05 * around)));
        }
    front.cells = Distribution2D(kCells, kCells, weights);
    front.blind = std::clamp(3 / std::sqrt(double(found.hits)), kBlindFront, 1.0);
    return front;
}

void ScatterGuide::learn(int threads) {
    const int count = aim_->sources().count();
    std::vector<Found> found(count);
    std::vector<double> brought(count), weights(count);
    parallel_tasks(threads, count, [&](std::int64_t s) {
        found[s] = look(int(s), std::clamp(kFirst / count, kFewest, kMost));
        brought[s] = aim_->sources().strength(int(s)) * aim_->visible_share(int(s));
    });
    double all = 0;
    for (const Found& f : found) all += f.light;
    const double all_brought = std::accumulate(brought.begin(), brought.end(), 0.0);
    fronts_.resize(count);
    parallel_tasks(threads, count, [&](std::int64_t s) {
        if (!(found[s].light > kDim * all)) return;
        found[s] = look(int(s), std::max(2 * kFewest, int(kSecond * found[s].light / all)));
        fronts_[s] = front_of(found[s]);
    });
    all = 0;
    for (const Found& f : found) all += f.light;
    light_ = all;
    const double blind = all > 0 ? kBlind : 1;
    for (int s = 0; s < count; ++s)
        weights[s] = blind * brought[s] / all_brought + (all > 0 ? (1 - blind) * found[s].light / all : 0);
    sources_ = DiscreteDistribution(std::span<const double>(weights));
}

}  // namespace dg
