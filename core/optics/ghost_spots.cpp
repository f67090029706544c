#include "optics/ghost_spots.h"

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

/// The wavelength of ray i: of n, as many of each as its share.
double wavelength_of(const GhostLight& light, double u) {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < light.nm.size(); ++k) {
        sum += light.weight[k];
        if (u < sum) return light.nm[k];
    }
    return light.nm.back();
}

class Bench {
  public:
    Bench(const GhostLens& lens, const GhostLight& light) : lens_(lens), light_(light) {
        half_ = front_radius(lens.tracer().prescription());
        const double sag_half = lens.tracer().form(0).height;   // infinite: not known
        if (std::isfinite(sag_half)) half_ = std::hypot(half_, sag_half);
        side_ = std::max(1, int(std::lround(std::sqrt(double(light.rays)))));
    }

    /// Rays along one direction, evenly over a square that holds the front of the lens as it is seen from
    /// there: calls use(x, y, transmittance) for all that come to the film's plane; what share of the light
    /// one ray is.
    template <typename Trace, typename Use>
    double follow(double angle, const Trace& trace, const Use& use) const {
        const Vec3d along{0, std::sin(angle), std::cos(angle)}, across{0, std::cos(angle), -std::sin(angle)};
        auto batch = std::make_unique<Batch>();
        const int rays = side_ * side_;
        for (int begin = 0; begin < rays; begin += kLensBatch) {
            for (int i = 0; i < kLensBatch; ++i) {
                const int k = std::min(begin + i, rays - 1);
                const double u = (k % side_ + fraction(0.754877666 * (k + 1))) / side_,
                             v = (k / side_ + fraction(0.569840291 * (k + 1))) / side_;
                const Vec3d p = Vec3d{half_ * (2 * u - 1), 0, 0} + half_ * (2 * v - 1) * across;
                batch->scene.x[i] = float(p.x), batch->scene.y[i] = float(p.y), batch->scene.z[i] = float(p.z);
                batch->scene.dx[i] = float(-along.x), batch->scene.dy[i] = float(-along.y);
                batch->scene.dz[i] = float(-along.z);
                batch->film.nm[i] = float(wavelength_of(light_, fraction(0.618033989 * (k + 1))));
            }
            trace(batch->scene, batch->film);
            for (int i = 0; i < std::min(kLensBatch, rays - begin); ++i)
                if (batch->scene.pass[i] > 0) use(batch->film.x[i], batch->film.y[i], batch->scene.pass[i]);
        }
        return 1.0 / rays;
    }

    GhostSpot spot(const Mirrors& mirrors, double straight, bool with_points) const {
        GhostSpot spot{.mirrors = mirrors};
        double xx = 0;
        const auto steps = lens_.steps(mirrors);
        const double each =
            follow(light_.angle,
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
        spot.light *= each / straight, spot.all *= each / straight;
        return spot;
    }

    /// What comes to the film's plane of a source straight ahead.
    double straight() const {
        double sum = 0;
        const double each = follow(
            0,
            [&](SceneRays& in, FilmRays& out) {
                trace_straight(in, out);
            },
            [&](double, double, double pass) { sum += pass; });
        return sum * each;
    }

  private:
    struct Batch {
        SceneRays scene;
        FilmRays film;
    };
    static double fraction(double x) { return x - std::floor(x); }
    /// By no mirrors: through all surfaces but the sensor's.
    void trace_straight(SceneRays& in, FilmRays& out) const {
        trace_ghost(lens_, lens_.steps({}), in, out, nullptr, kLensBatch);
    }

    const GhostLens& lens_;
    const GhostLight& light_;
    double half_;
    int side_;
};

}  // namespace

std::vector<GhostSpot> ghost_spots(const GhostLens& lens, const GhostLight& light, bool with_points) {
    const Bench bench(lens, light);
    const double straight = bench.straight();
    if (!(straight > 0))
        throw input_error(lens.tracer().prescription().name, "flare", "a lens that light passes", "none");
    std::vector<GhostSpot> spots;
    for (const Mirrors& mirrors : lens.two_bounces()) spots.push_back(bench.spot(mirrors, straight, with_points));
    std::ranges::stable_sort(spots, std::ranges::greater{}, &GhostSpot::light);
    return spots;
}

}  // namespace dg
