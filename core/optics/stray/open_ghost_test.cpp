#include "optics/stray/open_ghost.h"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <random>

#include "optics/first_order/paraxial.h"
#include "optics/lens/test_lenses.h"
#include "optics/trace/test_targets.h"

using namespace dg;

namespace {

GhostLens ghosts_of(const Prescription& lens) {
    const FirstOrder order = first_order(lens);
    const double film = film_position(lens, order, std::numeric_limits<double>::infinity(), FocusFrom::pupil);
    return {lens, {{0, 0, film}}, Iris::polygon(6, 10, 0.3), 0.7 * order.stop_semi_diameter, {}, 21.6};
}

/// Rays toward the front in roughly one direction, over more than the glass.
struct Rays {
    SceneRays in;
    FilmRays film;
    void fill(std::mt19937& rng, double radius) {
        std::uniform_real_distribution<float> u(-1, 1);
        for (int i = 0; i < kLensBatch; ++i) {
            const Vec3d d = normalize(Vec3d{0.2 * u(rng), 0.2 * u(rng), 1});
            in.x[i] = float(radius) * u(rng), in.y[i] = float(radius) * u(rng), in.z[i] = -3;
            in.dx[i] = float(-d.x), in.dy[i] = float(-d.y), in.dz[i] = float(-d.z);
            film.nm[i] = 400 + 300 * std::abs(u(rng));
        }
    }
};

/// Whether the iris transmits the ray at all crossings.
bool through_iris(const GhostLens& ghosts, const OpenLandings& o, int crossings, int i, double widened) {
    for (int k = 0; k < crossings; ++k) {
        const Vec2d at{o.iris_x[k][i], o.iris_y[k][i]};
        if (!(ghosts.iris().transmission(at * (1 / (ghosts.iris_radius() * widened))) > 0)) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("an open ghost lands where the ghost does, and says which rays edges and iris stop") {
    const auto rays = std::make_unique<Rays>();
    const auto open = std::make_unique<OpenLandings>();
    test::for_each_target([&] {
        std::mt19937 rng(3);
        int passed = 0, stopped = 0, near = 0, differ = 0;
        for (const Prescription& lens : {test::tessar(), test::check_lens(), test::wide_angle(), test::fisheye()}) {
            const GhostLens ghosts = ghosts_of(lens);
            for (const Mirrors& mirrors : ghosts.two_bounces()) {
                const std::vector<GhostStep> steps = ghosts.steps(mirrors);
                const int n = crossings(ghosts, steps);
                REQUIRE((n == 1 || n == 3));
                rays->fill(rng, lens.surfaces[0].semi_diameter);
                trace_open_ghost(ghosts, steps, rays->in, rays->film, *open, kLensBatch);
                trace_ghost(ghosts, steps, rays->in, rays->film, nullptr, kLensBatch);
                for (int i = 0; i < kLensBatch; ++i) {
                    const bool sound = open->sound[i] > 0, inside = open->beyond[i] < 0;
                    CHECK((sound || !inside));
                    const bool wanted = rays->in.pass[i] > 0;
                    const bool wide = inside && through_iris(ghosts, *open, n, i, 1.001),
                               narrow = inside && through_iris(ghosts, *open, n, i, 0.999);
                    if (wide != narrow || std::abs(open->beyond[i]) < 1e-4f) {
                        ++near;
                        continue;
                    }
                    differ += wide != wanted, stopped += !wanted;
                    if (!wanted || !wide) continue;
                    ++passed;
                    const float far = std::hypot(open->x[i], open->y[i]) + 20;
                    CHECK(std::hypot(rays->film.x[i] - open->x[i], rays->film.y[i] - open->y[i]) < 1e-5f * far);
                    CHECK(open->pass[i] / rays->in.pass[i] == doctest::Approx(1).epsilon(1e-4));
                }
            }
        }
        CHECK(passed > 1000);
        CHECK(stopped > 1000);
        CHECK(near < 0.02 * stopped);
        CHECK(differ == 0);
    });
}
