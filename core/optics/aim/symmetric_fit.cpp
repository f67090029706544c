#include "optics/aim/symmetric_fit.h"

#include <algorithm>
#include <cmath>

#include "math/quasi_random.h"

namespace dg {
namespace {

constexpr int kSearchRays = 16384;

}  // namespace

SymmetricRays::SymmetricRays(const Tracer& tracer, const AimRequest& request, double outer)
    : tracer_(tracer), request_(request), outer_(outer) {
    find_chiefs(request.film_radius);
}

void SymmetricRays::find_chiefs(double film_radius) {
    film_radius_ = film_radius;
    chiefs_.emplace(tracer_, FilmPlane{{0, 0, request_.film_z}}, FilmRectangle{{}, {film_radius, 0}});
}

Vec2d SymmetricRays::slope(double r, Vec2d iris) const {
    return chiefs_->slope({r / film_radius_, 0}, iris);
}

std::optional<Vec2d> SymmetricRays::trace_iris(double r, Vec2d m, double nm) const {
    return tracer_.to_iris({{r, 0, request_.film_z}, normalize(Vec3d{-m.x, -m.y, -1})},
                           tracer_.at(nm), kWidened);
}

/// Rays from all over the film through a slightly enlarged iris, traced to the stop.
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

/// Largest film radius (mm) from which any of many rays reaches the iris.
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

bool SymmetricRays::fit(Aim& aim, int k) {
    const int count = std::max(600, 5 * term_count(k));
    AimTables& t = aim.tables;
    std::vector<SlopeSample> samples = training(t, count, 0);
    if (int(samples.size()) < count / 2) {
        // The film is far larger than the image circle. The dark part needs no aim: film points
        // beyond the tables' radius get no rays.
        const double lit = 1.1 * lit_radius();
        if (lit > 0 && lit < t.film_radius) {
            t.film_radius = float(lit);
            find_chiefs(lit);
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
