#include "optics/aim/symmetric_fit.h"

#include <algorithm>
#include <cmath>

#include "math/quasi_random.h"
#include "optics/lens/lens_error.h"

namespace dg {
namespace {

constexpr int kSearchRays = 16384;

}  // namespace

SymmetricRays::SymmetricRays(const Tracer& tracer, const AimRequest& request, double outer)
    : tracer_(tracer), request_(request), outer_(outer) {
    const double h = 1e-4, nm = kDesignWavelength;
    const auto film =
        tracer.to_iris({{h, 0, request.film_z}, {0, 0, -1}}, tracer.at(nm), 1);
    const auto slope = tracer.to_iris(
        {{0, 0, request.film_z}, normalize(Vec3d{-h, 0, -1})}, tracer.at(nm), 1);
    if (!film || !slope || slope->x == 0)
        throw LensError(tracer.prescription().name +
                            ": no ray leads from the film's centre to the iris",
                        "lens-no-light");
    by_film_ = film->x / h, by_slope_ = slope->x / h;
}

Vec2d SymmetricRays::slope(double r, Vec2d iris) const {
    return {(iris.x - by_film_ * r) / by_slope_, iris.y / by_slope_};
}

std::optional<Vec2d> SymmetricRays::trace_iris(double r, Vec2d m, double nm) const {
    return tracer_.to_iris({{r, 0, request_.film_z}, normalize(Vec3d{-m.x, -m.y, -1})},
                           tracer_.at(nm), kWidened);
}

/// Rays over the film and somewhat more than the iris, traced to the stop.
std::vector<SlopeSample> SymmetricRays::training(const AimTables& t, int count, int first) const {
    std::vector<SlopeSample> samples;
    const WavelengthScale scale = WavelengthScale::visible();
    for (int n = first; int(samples.size()) < count && n < first + 8 * count; ++n) {
        const auto q = quasi_random<4>(n);
        const double r = std::sqrt(q[0]) * t.film_radius, nm = 380 + 400 * q[3];
        const Vec2d target = 1.3 * outer_ * concentric_disc({q[1], q[2]});
        const Vec2d m = slope(r, target);
        const auto iris = trace_iris(r, m, nm);
        if (!iris) continue;
        const Vec2d a = *iris * (1 / double(t.iris_scale));
        if (dot(a, a) <= 1) samples.push_back({r / t.film_radius, a, scale(nm), m});
    }
    return samples;
}

/// The farthest film point (mm) from which a ray reaches the iris, among many.
double SymmetricRays::lit_radius() const {
    double lit = 0;
    for (int n = 0; n < kSearchRays; ++n) {
        const auto q = quasi_random<4>(n);
        const double r = q[0] * request_.film_radius;
        const Vec2d target = 1.3 * outer_ * concentric_disc({q[1], q[2]});
        const Vec2d m = slope(r, target);
        if (r > lit && trace_iris(r, m, 380 + 400 * q[3])) lit = r;
    }
    return lit;
}

bool SymmetricRays::fit(Aim& aim, int k) const {
    const int count = std::max(600, 5 * term_count(k));
    AimTables& t = aim.tables;
    std::vector<SlopeSample> samples = training(t, count, 0);
    if (int(samples.size()) < count / 2) {
        // A film far wider than the image circle: what lies in the dark needs no aim, and
        // film points beyond the tables' radius get no ray.
        const double lit = 1.1 * lit_radius();
        if (lit > 0 && lit < t.film_radius) {
            t.film_radius = float(lit);
            samples = training(t, count, 0);
        }
    }
    t.degree = k;
    if (int(samples.size()) < 2 * term_count(k)) {
        aim.slopes = {k, std::vector<double>(2 * term_count(k))};
        t.coefficients.assign(aim.slopes.coefficients.size(), 0.f);
        return false;
    }
    aim.slopes = fit_slopes(samples, k);
    t.coefficients.assign(aim.slopes.coefficients.begin(),
                          aim.slopes.coefficients.end());
    aim.fit_error = aim.iris_error = 0;
    for (const SlopeSample& s : training(t, 500, 100000)) {
        const SlopeValue v = aim.slopes.evaluate(s.r, s.a, s.l);
        aim.fit_error = std::max(aim.fit_error, length(v.m - s.m));
        aim.iris_error = std::max(aim.iris_error, length(v.step(v.m - s.m)));
    }
    set_enlargement(t, request_, aim.iris_error);
    return true;
}

}  // namespace dg
