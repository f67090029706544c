#include "optics/stray/ghost_spots.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "math/error.h"

namespace dg {
namespace {

double front_radius(const Prescription& lens) {
    double r = clear_radius(lens.surfaces.front());
    if (std::isfinite(r)) return r;
    r = 0;
    for (const Surface& s : lens.surfaces)
        if (std::isfinite(clear_radius(s))) r = std::max(r, clear_radius(s));
    return 2 * r;
}

/// Wavelength for a uniform number u, distributed by the weights.
double wavelength_of(const GhostLight& light, double u) {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < light.nm.size(); ++k) {
        sum += light.weight[k];
        if (u < sum) return light.nm[k];
    }
    return light.nm.back();
}

/// Sub-rectangle of the unit square over the front of the lens.
struct Window {
    Vec2d low{0, 0}, size{1, 1};
    double area() const { return size.x * size.y; }
};

/// Bounds and number of the entry points of rays that reach the film.
struct Entries {
    Vec2d low{1, 1}, high{0, 0};
    int count = 0;
    void add(Vec2d p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        ++count;
    }
    void add(const Entries& other) {
        if (other.count == 0) return;
        add(other.low), add(other.high);
        count += other.count - 2;
    }
    /// Bounding window with a margin for rays missed between samples a step apart.
    Window window(const Window& in, int side) const {
        const double more = 0.05 + 2.0 / count;
        const Vec2d size = high - low, step{2 * in.size.x / side, 2 * in.size.y / side};
        const Vec2d margin{more * size.x + step.x, more * size.y + step.y};
        const Vec2d from{std::max(0.0, low.x - margin.x), std::max(0.0, low.y - margin.y)};
        return {from, {std::min(1.0, high.x + margin.x) - from.x, std::min(1.0, high.y + margin.y) - from.y}};
    }
};

constexpr int kEnoughRays = 256;    // rays at the film that suffice to locate a ghost
constexpr int kLeastRays = 8;         // least rays at the film that locate an entry window
constexpr int kMostZooms = 5;
constexpr int kMostRays = 1 << 24;
constexpr int kWideSide = 256;  // rays per side in windows that hardly any ray passes

class Bench {
  public:
    Bench(const GhostLens& lens, const GhostLight& light) : lens_(lens), light_(light) {
        half_ = front_radius(lens.tracer().prescription());
        const double sag_half = lens.tracer().form(0).height;   // infinite if unknown
        if (std::isfinite(sag_half)) half_ = hypot(half_, sag_half);
        side_ = std::max(1, int(std::lround(std::sqrt(double(light.rays)))));
    }

    /// Traces rays of one direction, on a regular grid over a window of the projected front
    /// surface. Calls use(x, y, transmittance) for each ray that reaches the film's plane; returns
    /// the share of the light per ray.
    template <typename Trace, typename Use>
    double follow(double angle, const Window& window, int side, Entries& entries, const Trace& trace,
                  const Use& use) const {
        const Vec3d along{0, std::sin(angle), std::cos(angle)}, across{0, std::cos(angle), -std::sin(angle)};
        auto batch = std::make_unique<Batch>();
        const int rays = side * side;
        const auto place = [&](int k) {
            return Vec2d{window.low.x + window.size.x * (k % side + fraction(0.754877666 * (k + 1))) / side,
                         window.low.y + window.size.y * (k / side + fraction(0.569840291 * (k + 1))) / side};
        };
        for (int begin = 0; begin < rays; begin += kLensBatch) {
            for (int i = 0; i < kLensBatch; ++i) {
                const int k = std::min(begin + i, rays - 1);
                const Vec2d at = place(k);
                const Vec3d p = Vec3d{half_ * (2 * at.x - 1), 0, 0} + half_ * (2 * at.y - 1) * across;
                batch->scene.x[i] = float(p.x), batch->scene.y[i] = float(p.y), batch->scene.z[i] = float(p.z);
                batch->scene.dx[i] = float(-along.x), batch->scene.dy[i] = float(-along.y);
                batch->scene.dz[i] = float(-along.z);
                batch->film.nm[i] = float(wavelength_of(light_, fraction(0.618033989 * (k + 1))));
            }
            trace(batch->scene, batch->film);
            for (int i = 0; i < std::min(kLensBatch, rays - begin); ++i) {
                if (!(batch->scene.pass[i] > 0)) continue;
                entries.add(place(begin + i));
                use(batch->film.x[i], batch->film.y[i], batch->scene.pass[i]);
            }
        }
        return window.area() / rays;
    }

    /// Entry points of a ghost's rays that reach the film's plane.
    Entries find_entries(const Mirrors& mirrors, const Window& window, int side) const {
        Entries entries;
        const auto steps = lens_.steps(mirrors);
        follow(light_.angle, window, side, entries,
               [&](SceneRays& in, FilmRays& out) { trace_ghost(lens_, steps, in, out, nullptr, kLensBatch); },
               [](double, double, double) {});
        return entries;
    }

    /// Entry windows of all ghosts. The front of a fisheye is a thousand times larger than its
    /// pupil, so the search zooms in: first on the entries of all ghosts together, then on the
    /// entries of each ghost.
    std::vector<Window> windows(const std::vector<Mirrors>& ghosts) const {
        Window all;
        std::vector<Entries> of(ghosts.size());
        int side = side_;
        for (int i = 0; i < kMostZooms; ++i) {
            Entries together;
            for (std::size_t g = 0; g < ghosts.size(); ++g)
                if (of[g].count < kEnoughRays) of[g] = find_entries(ghosts[g], all, side);
            for (const Entries& e : of) together.add(e);
            if (together.count < kEnoughRays && side < kWideSide) {
                side = kWideSide;
                continue;
            }
            if (together.count < kLeastRays) break;
            const Window closer = together.window(all, side);
            if (closer.area() > 0.5 * all.area()) break;
            all = closer, side = side_;
        }
        std::vector<Window> windows;
        for (const Entries& e : of) windows.push_back(e.count < kLeastRays ? all : e.window(all, side));
        return windows;
    }

    GhostSpot spot(const Mirrors& mirrors, const Window& window, double light_on_axis, bool with_points) const {
        GhostSpot spot{.mirrors = mirrors};
        double xx = 0;
        const auto steps = lens_.steps(mirrors);
        Entries entries;
        const double each =
            follow(light_.angle, window, side_, entries,
                   [&](SceneRays& in, FilmRays& out) {
                       trace_ghost(lens_, steps, in, out, nullptr, kLensBatch);
                   },
                   [&](double x, double y, double pass) {
                       spot.all += pass;
                       if (std::abs(x) > light_.film_half.x || std::abs(y) > light_.film_half.y) return;
                       spot.light += pass;
                       spot.center = spot.center + Vec2d{x, y} * pass;
                       xx += pass * (x * x + y * y);
                       if (with_points) spot.points.push_back({float(x), float(y), float(pass)});
                   });
        if (spot.light > 0) {
            spot.center = spot.center * (1 / spot.light);
            const Vec2d c = spot.center;
            spot.radius = std::sqrt(std::max(0.0, xx / spot.light - c.x * c.x - c.y * c.y));
            for (auto& p : spot.points) p[2] = float(p[2] / spot.light);
        }
        spot.light *= each / light_on_axis, spot.all *= each / light_on_axis;
        return spot;
    }

    /// Light that reaches the film's plane from a source on the axis, which enters around the
    /// centre.
    double light_on_axis() const {
        for (double size = 1;; size /= 2) {
            double sum = 0;
            Entries entries;
            const double each = follow(
                0, {{0.5 - size / 2, 0.5 - size / 2}, {size, size}}, side_, entries,
                [&](SceneRays& in, FilmRays& out) { trace_direct(in, out); },
                [&](double, double, double pass) { sum += pass; });
            if (entries.count >= side_ * side_ / 16 || size < 1e-3) return sum * each;
        }
    }

  private:
    struct Batch {
        SceneRays scene;
        FilmRays film;
    };
    static double fraction(double x) { return x - std::floor(x); }
    /// Traces without reflections through all surfaces except the sensor.
    void trace_direct(SceneRays& in, FilmRays& out) const {
        trace_ghost(lens_, lens_.steps({}), in, out, nullptr, kLensBatch);
    }

    const GhostLens& lens_;
    const GhostLight& light_;
    double half_;
    int side_;
};

}  // namespace

std::vector<GhostSpot> ghost_spots(const GhostLens& lens, const GhostLight& light, bool with_points) {
    if (light.nm.empty() || light.weight.size() != light.nm.size())
        throw input_error("ghosts", "wavelengths", "at least one, each with its weight",
                          std::to_string(light.nm.size()) + " and " + std::to_string(light.weight.size()));
    if (light.rays < 1 || light.rays > kMostRays)
        throw input_error("ghosts", "rays", "1 to " + std::to_string(kMostRays), std::to_string(light.rays));
    const Bench bench(lens, light);
    const double light_on_axis = bench.light_on_axis();
    if (!(light_on_axis > 0))
        throw Error(lens.tracer().prescription().name + ": flare: no light passes the lens");
    std::vector<GhostSpot> spots;
    const std::vector<Mirrors> ghosts = lens.two_bounces();
    const std::vector<Window> windows = bench.windows(ghosts);
    for (std::size_t i = 0; i < ghosts.size(); ++i)
        spots.push_back(bench.spot(ghosts[i], windows[i], light_on_axis, with_points));
    std::ranges::stable_sort(spots, std::ranges::greater{}, &GhostSpot::light);
    return spots;
}

}  // namespace dg
