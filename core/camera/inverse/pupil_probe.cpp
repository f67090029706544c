#include "camera/inverse/pupil_probe.h"

#include <algorithm>
#include <cmath>

#include "math/hash.h"
#include "math/quasi_random.h"

namespace dg {
namespace {

constexpr double kFilmEdge = 1.03;  // film points beyond the edge are moved to the edge
constexpr int kHalvings = 6;

class Probe {
  public:
    Probe(const ExactLens& lens, bool axial) : lens_(lens), axial_(axial) {}

    /// Farthest passing rays along lines from the centre of the lens samples to their edge, by
    /// bisection.
    std::vector<CameraRay> rim(int count) const {
        std::vector<CameraSample> samples(count);
        std::vector<CameraRay> rays(count), best(count);
        std::vector<double> inner(count, 0), step(count, 1);
        for (int k = 0; k <= kHalvings; ++k) {
            for (int i = 0; i < count; ++i)
                samples[i] = sample(i, std::min(inner[i] + step[i], 1.0));
            lens_.generate(samples, rays);
            for (int i = 0; i < count; ++i) {
                const bool passed = rays[i].weight > 0;
                if (passed)
                    best[i] = rays[i], inner[i] = std::min(inner[i] + step[i], 1.0);
                step[i] *= 0.5;
            }
        }
        return best;
    }
    std::vector<CameraRay> within(int count) const {
        std::vector<CameraSample> samples(count);
        std::vector<CameraRay> rays(count);
        for (int i = 0; i < count; ++i)
            samples[i] = sample(i, std::sqrt(hash_uniform(9, i)));
        lens_.generate(samples, rays);
        return rays;
    }

  private:
    /// `out`: 0 at the centre of the lens samples, 1 at their edge.
    CameraSample sample(int i, double out) const {
        const auto u = quasi_random<4>(i);
        const double side = 4 * u[2], along = 2 * (side - std::floor(side)) - 1;
        const Vec2d edge[] = {{1, along}, {-1, along}, {along, 1}, {along, -1}};
        const Vec2d lens = edge[std::min(int(side), 3)] * out;
        return {film_point(u[0], u[1]),
                {float(0.5 + 0.499999 * lens.x), float(0.5 + 0.499999 * lens.y)},
                0,
                float(380 + 400 * u[3])};
    }
    Vec2f film_point(double u, double v) const {
        const ExactLensSettings& s = lens_.settings();
        const double radius = 1.02 * s.half_diagonal_mm;
        if (axial_) {
            const double r = radius * std::min(kFilmEdge * u, 0.999999), a = 2 * kPiD * v;
            return {float(r * std::cos(a)), float(r * std::sin(a))};
        }
        const auto across = [](double x) {
            return std::clamp(kFilmEdge * (2 * x - 1), -1.0, 1.0);
        };
        const bool whole = !(s.film_half_mm.x > 0 && s.film_half_mm.y > 0);
        const Vec2d half = whole ? Vec2d{radius, radius} : s.film_half_mm * 1.02;
        const Vec2d film = (whole ? Vec2d{} : s.film_center_mm) +
                           Vec2d{half.x * across(u), half.y * across(v)};
        return {float(film.x), float(film.y)};
    }

    const ExactLens& lens_;
    bool axial_;
};

}  // namespace

std::vector<CameraRay> probe_pupil(const ExactLens& lens, bool axial) {
    const Probe probe(lens, axial);
    const Iris::Kind iris = lens.settings().iris.kind();
    // Image-shaped irises are sampled pixel by pixel in no order, so they have no rim to bisect.
    const bool image = iris == Iris::Kind::image;
    const int count = (axial ? 6000 : 24000) * (iris == Iris::Kind::blades ? 2 : 1);
    std::vector<CameraRay> rays = probe.within(image ? 7 * count : 2 * count / 3);
    if (!image) {
        const std::vector<CameraRay> rim = probe.rim(count);
        rays.insert(rays.end(), rim.begin(), rim.end());
    }
    std::erase_if(rays, [](const CameraRay& r) { return !(r.weight > 0); });
    return rays;
}

}  // namespace dg
