// Random prescriptions, mostly absurd: each is refused or traced in bounded time, and no result is
// NaN. script/test-all raises their number by DG_RANDOM_LENSES.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <optional>

#include "optics/lens/lens_error.h"
#include "optics/lens/test_shapes.h"
#include "optics/trace/trace_simd.h"

using namespace dg;

namespace {

/// Random number of about the given scale; sometimes huge, tiny, or NaN.
double number(test::Random& u, double scale) {
    switch (u.below(200)) {
        case 0:
            return 0;
        case 1:
            return 1e6 * scale * u();
        case 2:
            return u.below(3) ? -scale : std::nan("");
        case 3:
            return u.below(3) ? scale : std::numeric_limits<double>::infinity();
        default:
            return scale * u();
    }
}

Surface any_surface(test::Random& u) {
    Surface s;
    s.curvature = u.below(4) ? number(u, u.below(8) ? 0.05 : 0.5) : 0;
    s.thickness = std::abs(number(u, 8));
    s.semi_diameter = u.below(8) ? std::abs(number(u, 12)) : 1e300 * 1e300;
    if (u.below(2)) s.glass.formula = ConstantIndex{1.75 + number(u, 0.3)};
    if (u.below(3) == 0) s.conic = number(u, 5);
    if (u.below(3) == 0)
        for (int i = u.below(8); i >= 0; --i) {
            const int power = 1 + u.below(20);
            s.asphere.push_back({power, number(u, 3) / std::pow(8, power)});
        }
    const char* kinds[] = {"aspheric", "aspheric", "cyl-x", "cyl-y", "toroid", "biconic"};
    if (u.below(2)) s.curvature_x = number(u, 0.05);
    if (u.below(9) == 0) s.conic_x = number(u, 3);
    set_kind(s, kinds[u.below(6)]);
    if (u.below(3) == 0)
        s.decenter = {number(u, 2), number(u, 2), number(u, 1)},
        s.tilt = {number(u, 20), number(u, 20), number(u, 90)};
    if (u.below(9) == 0) s.inner_semi_diameter = number(u, 1);
    if (u.below(9) == 0) s.semi_diameter_after = number(u, 10);
    return s;
}

Prescription any_lens(test::Random& u) {
    Prescription lens;
    lens.name = "random";
    const int count = 1 + u.below(12);
    for (int i = 0; i < count; ++i) lens.surfaces.push_back(any_surface(u));
    if (u.below(30)) lens.surfaces[std::size_t(u.below(count))].stop = true;
    return lens;
}

bool finite(const LensRay& r) {
    const Vec3d p = r.origin, d = r.direction;
    return std::isfinite(p.x + p.y + p.z) && std::abs(length(d) - 1) < 1e-9;
}

/// Traces random rays and returns the number that pass.
int trace_some(const Prescription& lens, test::Random& u) {
    const Tracer t(lens);
    const LensIndices n = t.at(550);
    const double end = t.vertices().back();
    int passed = 0;
    for (int i = 0; i < 12; ++i) {
        const Vec3d from{6 * u(), 6 * u(), -5}, to{6 * u(), 6 * u(), 0.5 * end};
        const Vec3d d =
            u.below(9) ? normalize(to - from) : Vec3d{0, u() < 0 ? 1. : 0., 1};
        const LensRay in{from, normalize(d)};
        const LensRay out{{from.x, from.y, end + 5}, {in.direction.x, 0, 0}};
        const LensRay back{out.origin, normalize(Vec3d{d.x, d.y, -d.z})};
        for (const bool toward_film : {true, false}) {
            TracedRay ray{toward_film ? in : back};
            const int stopped =
                t.follow(ray, toward_film, n, {u.below(2) == 0, nullptr, 0});
            if (stopped < 0) ++passed;
            CHECK(finite(ray.ray));
            CHECK(std::isfinite(ray.optical_path));
            CHECK((ray.transmittance >= 0 && ray.transmittance <= 1));
        }
        if (const auto j = t.jacobian(in, n, end + 10))
            for (const auto& row : *j)
                for (const double x : row) CHECK(!std::isnan(x));
    }
    return passed;
}

void trace_lanes(const Prescription& lens, test::Random& u, FilmRays& film,
                 SceneRays& scene) {
    const Tracer t(lens);
    const LensTables tables =
        make_lens_tables(t, t.vertices().back() + 30, true, nullptr, 0);
    for (int i = 0; i < 64; ++i) {
        film.x[i] = float(8 * u()), film.y[i] = float(8 * u()), film.nm[i] = 550;
        film.mx[i] = float(0.4 * u()), film.my[i] = float(0.4 * u());
    }
    trace_to_scene(tables, film, scene, 64);
    for (int i = 0; i < 64; ++i) {
        if (!(scene.pass[i] > 0)) {
            CHECK(!std::isnan(scene.pass[i]));
            continue;
        }
        CHECK(std::isfinite(scene.x[i] + scene.y[i] + scene.z[i]));
        CHECK(std::isfinite(scene.dx[i] + scene.dy[i] + scene.dz[i]));
    }
}

double thread_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Slowdown against a real processor, for tests under emulation (script/check-arm64).
double slowdown() {
    const char* times = std::getenv("DG_SLOWDOWN");
    return times ? std::atof(times) : 1;
}

/// Number of rays that pass a lens; empty if the lens is refused.
std::optional<int> rays_through(const Prescription& lens, test::Random u, FilmRays& film, SceneRays& scene) {
    try {
        const int passed = trace_some(lens, u);
        trace_lanes(lens, u, film, scene);
        return passed;
    } catch (const Error&) {
        return std::nullopt;
    }
}

}  // namespace

TEST_CASE("random prescriptions are refused or traced, without NaN and without delay") {
    const char* asked = std::getenv("DG_RANDOM_LENSES");
    const double longest_wanted = 0.05 * slowdown();   // s, for one lens
    const int count = asked ? std::atoi(asked) : 10000;
    const auto film = std::make_unique<FilmRays>();
    const auto scene = std::make_unique<SceneRays>();
    int refused = 0, traced = 0, passed = 0;
    double longest = 0;
    const double start = thread_seconds();
    for (int i = 0; i < count; ++i) {
        test::Random u{unsigned(i)};
        const Prescription lens = any_lens(u);
        CAPTURE(i);
        std::optional<int> through;
        const auto timed = [&] {
            const double before = thread_seconds();
            through = rays_through(lens, u, *film, *scene);
            return thread_seconds() - before;
        };
        double seconds = timed();
        // Retry slow lenses: a virtual machine's stall counts as the thread's time, but rarely
        // three times in a row.
        for (int again = 0; seconds >= longest_wanted && again < 2; ++again) seconds = std::min(seconds, timed());
        longest = std::max(longest, seconds);
        ++(through ? traced : refused);
        passed += through.value_or(0);
    }
    if (asked)
        MESSAGE(refused << " refused, " << traced << " traced, " << passed
                        << " rays passed, " << 1e3 * (thread_seconds() - start) / count
                        << " ms on average, " << 1e3 * longest << " ms at most");
    CHECK(traced > count / 10);
    CHECK(refused > count / 10);
    CHECK(passed > count / 10);
    CHECK(thread_seconds() - start < 1e-3 * count * slowdown());
    CHECK(longest < longest_wanted);
}
