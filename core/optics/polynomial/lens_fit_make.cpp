#include "optics/polynomial/lens_fit_make.h"

#include <cmath>

#include "math/error.h"
#include "math/linear_solve.h"
#include "optics/pupil.h"

namespace dg {
namespace {

constexpr int kMinDegree = 1, kMaxDegree = 13;
constexpr int kMinRays = 400;
constexpr int kRaysPerTerm = 6;
constexpr int kErrorRays = 4000;
constexpr int kLightDegree = 5;

/// Columns and right-hand sides of one least squares problem, row by row.
struct Equations {
    int columns = 0, sides = 0;
    std::vector<double> matrix{}, rhs{};

    std::vector<double> solve() const {
        return least_squares(matrix, int(rhs.size()) / sides, columns, rhs, sides);
    }
};

/// The point of a sample at which functions are fitted.
struct At {
    FitVariables variables;
    Vec2d f, q;
};

/// f A + q B: two equations a sample, the coefficients of A and B as neighbours.
template <typename Place, typename Vectors>
FitFunctions fit_axial(const std::vector<FitTerm>& terms, const std::vector<FitSample>& samples, int vectors,
                       Place place, Vectors outputs) {
    const int n = int(terms.size());
    Equations e{2 * n, vectors};
    std::vector<double> value(n);
    for (const FitSample& s : samples) {
        const At at = place(s);
        monomials(terms, at.variables, value.data());
        for (int k = 0; k < 2; ++k) {
            for (int t = 0; t < n; ++t) {
                e.matrix.push_back((k ? at.f.y : at.f.x) * value[t]);
                e.matrix.push_back((k ? at.q.y : at.q.x) * value[t]);
            }
            for (int v = 0; v < vectors; ++v) e.rhs.push_back(k ? outputs(s, v).y : outputs(s, v).x);
        }
    }
    const std::vector<double> x = e.solve();
    FitFunctions found{2 * vectors, terms, {}};
    for (int t = 0; t < n; ++t)
        for (int v = 0; v < vectors; ++v)
            for (int side = 0; side < 2; ++side) found.coefficients.push_back(x[(2 * t + side) * vectors + v]);
    return found;
}

/// Numbers over monomials: one equation a sample.
template <typename Place, typename Numbers>
FitFunctions fit_scalars(const std::vector<FitTerm>& terms, const std::vector<FitSample>& samples, int count,
                         Place place, Numbers outputs) {
    const int n = int(terms.size());
    Equations e{n, count};
    std::vector<double> value(n);
    for (const FitSample& s : samples) {
        monomials(terms, place(s).variables, value.data());
        e.matrix.insert(e.matrix.end(), value.begin(), value.end());
        for (int v = 0; v < count; ++v) e.rhs.push_back(outputs(s, v));
    }
    return {count, terms, e.solve()};
}

template <typename Place, typename Vectors>
FitBlock fit_vectors(const FitSymmetry& symmetry, int degree, const std::vector<FitSample>& samples, int count,
                     Place place, Vectors outputs) {
    if (symmetry.axial) return {fit_axial(axial_terms(degree), samples, count, place, outputs), {}};
    return {fit_scalars(free_terms(degree, symmetry, true, false), samples, count, place,
                        [&](const FitSample& s, int v) { return outputs(s, v).x; }),
            fit_scalars(free_terms(degree, symmetry, false, true), samples, count, place,
                        [&](const FitSample& s, int v) { return outputs(s, v).y; })};
}

std::vector<FitTerm> scalar_terms(const FitSymmetry& symmetry, int degree) {
    return symmetry.axial ? axial_terms(degree) : free_terms(degree, symmetry, false, false);
}

int rays_wanted(const LensFit& fit) {
    const int terms = fit.symmetry.axial ? int(axial_terms(fit.degree).size())
                                         : int(free_terms(fit.degree, fit.symmetry, true, false).size());
    return std::max(kMinRays, kRaysPerTerm * terms);
}

void check(const LensFitRequest& r) {
    if (r.degree < kMinDegree || r.degree > kMaxDegree || r.degree % 2 == 0)
        throw input_error("lens fit", "degree", "an odd number from 1 to 13", std::to_string(r.degree));
    if (r.segments < 1 || r.segments > 16)
        throw input_error("lens fit", "segments", "1 to 16", std::to_string(r.segments));
}

}  // namespace

FitSegment fit_segment(const LensFit& fit, const std::vector<FitSample>& clear,
                       const std::vector<FitSample>& wide, double u_low, double u_high) {
    FitSegment segment{u_low, u_high, {}, {}, {}};
    const auto place = [&](const FitSample& s) { return At{fit.variables(s.f, s.q, s.l, segment), s.f, s.q}; };
    FitSegment found = segment;
    found.rays = fit_vectors(fit.symmetry, fit.degree, clear, 2, place, [](const FitSample& s, int v) {
        return v == 0 ? s.direction : s.offset;
    });
    found.points = fit_vectors(fit.symmetry, fit.degree, wide, 1 + int(fit.mounts.size()), place,
                               [&](const FitSample& s, int v) {
                                   return v == 0 ? s.iris : s.met[fit.mounts[v - 1].surface];
                               });
    const int light = std::min(fit.degree, kLightDegree);
    found.light.x = fit_scalars(scalar_terms(fit.symmetry, light), clear, 1, place,
                                [](const FitSample& s, int) { return s.transmittance; });
    return found;
}

FitInverse fit_inverse(const LensFit& fit, const std::vector<FitSample>& clear) {
    FitInverse inverse;
    double direction = 0;
    for (const FitSample& s : clear) direction = std::max(direction, length(s.direction));
    inverse.direction = direction;
    // The offset that goes with a direction in the mean: the pupil wanders over the field.
    double dd = 0, de = 0, reach = 0;
    for (const FitSample& s : clear) dd += dot(s.direction, s.direction), de += dot(s.direction, s.offset);
    const double wander = dd > 0 ? de / dd : 0;
    for (const FitSample& s : clear) reach = std::max(reach, length(s.offset - s.direction * wander));
    inverse.pupil.by_film = Vec2d{1, 1} * (-wander * direction / reach);
    inverse.pupil.by_slope = Vec2d{1, 1} * (1 / reach);
    const auto place = [&](const FitSample& s) {
        const Vec2d g = s.direction * (1 / direction), h = inverse.pupil.q(g, s.offset);
        if (!fit.symmetry.axial) return At{{h.x, h.y, g.x, g.y, s.l}, g, h};
        return At{{dot(g, h), 2 * dot(h, h) - 1, 2 * dot(g, g) - 1, s.l, 0}, g, h};
    };
    inverse.rays = fit_vectors(fit.symmetry, fit.degree, clear, 2, place,
                               [](const FitSample& s, int v) { return v == 0 ? s.f : s.q; });
    return inverse;
}

LensFit make_lens_fit(const Tracer& tracer, const LensFitRequest& request) {
    check(request);
    LensFit fit;
    fit.lens = tracer.prescription().name, fit.degree = request.degree;
    const FitRays rays(tracer, request, fit);
    const Surface& front = tracer.prescription().surfaces.front();
    fit.front_z = tracer.vertices().front();
    fit.front_curvature = (vertex_curvature_x(front) + vertex_curvature_y(front)) / 2;
    const int count = rays_wanted(fit);
    fit.mounts = limiting_mounts(tracer, rays.draw(kErrorRays, 0, kErrorWidened, FitSpread::uniform, 0, 1));
    const int segments = fit.symmetry.axial ? request.segments : 1;
    for (int k = 0; k < segments; ++k) {
        const double low = double(k) / segments, high = double(k + 1) / segments;
        const auto clear = rays.draw(count, 0, kWidened, FitSpread::toward_edges, low, high);
        const auto wide = rays.draw(count, 0, kErrorWidened, FitSpread::toward_edges, low, high);
        fit.segments.push_back(fit_segment(fit, clear, wide, low, high));
    }
    fit.inverse = fit_inverse(fit, rays.draw(count, 0, kWidened, FitSpread::toward_edges, 0, 1));
    fit.error = measure_fit(rays, fit, kErrorRays);
    return fit;
}

}  // namespace dg
