#include "optics/polynomial/lens_fit_make.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "math/error.h"
#include "optics/polynomial/fit_equations.h"
#include "optics/pupil.h"

namespace dg {
namespace {

constexpr int kMinDegree = 1, kMaxDegree = 13, kMostSegments = 16;
constexpr int kMinRays = 400;
constexpr int kRaysPerTerm = 8;
constexpr int kMountRays = 2000, kErrorRays = 2000;
// Rays and light are fitted to what passes and very little beyond; iris and mounts to
// more, since they say what does not pass.
constexpr double kClearWidened = 1.015, kPointsWidened = 1.15;
// More powers of l are worth their time if they lower the error to this part of what it
// was.
constexpr double kWorthIt = 0.8;
// Iris and mounts decide who passes: two degrees less still place them a hundred times
// better than a pixel of the bokeh needs.
constexpr int kPointsBelow = 2, kLeastPoints = 3;

struct FitBasis {
    int degree = 1, dispersion = 0;
    int keep = 0;  // terms of each vector; 0: all
};

/// The point of a sample at which functions are fitted.
struct At {
    FitVariables variables;
    Vec2d f, q;
};

/// Without the terms that no function uses.
FitFunctions packed(const FitFunctions& f) {
    FitFunctions used{f.count, {}, {}};
    for (std::size_t t = 0; t < f.terms.size(); ++t) {
        const auto first = f.coefficients.begin() + std::ptrdiff_t(t) * f.count;
        if (std::all_of(first, first + f.count, [](double c) { return c == 0; }))
            continue;
        used.terms.push_back(f.terms[t]);
        used.coefficients.insert(used.coefficients.end(), first, first + f.count);
    }
    return used.terms.empty() ? f : used;
}

std::vector<double> solve(const FitEquations& e, int keep) {
    return keep > 0 ? e.solve_sparse(keep) : e.solve();
}

/// f A + q B: two equations a sample, the coefficients of A and B as neighbours.
template <typename Place, typename Vectors>
FitFunctions fit_axial(const std::vector<FitTerm>& terms,
                       const std::vector<FitSample>& samples, int vectors, int keep,
                       Place place, Vectors outputs) {
    const int n = int(terms.size());
    FitEquations e{2 * n, vectors};
    std::vector<double> value(n);
    for (const FitSample& s : samples) {
        const At at = place(s);
        monomials(terms, at.variables, value.data());
        for (int k = 0; k < 2; ++k) {
            for (int t = 0; t < n; ++t) {
                e.matrix.push_back((k ? at.f.y : at.f.x) * value[t]);
                e.matrix.push_back((k ? at.q.y : at.q.x) * value[t]);
            }
            for (int v = 0; v < vectors; ++v)
                e.rhs.push_back(k ? outputs(s, v).y : outputs(s, v).x);
        }
    }
    const std::vector<double> x = solve(e, keep);
    FitFunctions found{2 * vectors, terms, {}};
    for (int t = 0; t < n; ++t)
        for (int v = 0; v < vectors; ++v)
            for (int side = 0; side < 2; ++side)
                found.coefficients.push_back(x[(2 * t + side) * vectors + v]);
    return packed(found);
}

/// Numbers over monomials: one equation a sample.
template <typename Place, typename Numbers>
FitFunctions fit_scalars(const std::vector<FitTerm>& terms,
                         const std::vector<FitSample>& samples, int count, int keep,
                         Place place, Numbers outputs) {
    const int n = int(terms.size());
    FitEquations e{n, count};
    std::vector<double> value(n);
    for (const FitSample& s : samples) {
        monomials(terms, place(s).variables, value.data());
        e.matrix.insert(e.matrix.end(), value.begin(), value.end());
        for (int v = 0; v < count; ++v) e.rhs.push_back(outputs(s, v));
    }
    return packed({count, terms, solve(e, keep)});
}

template <typename Place, typename Vectors>
FitBlock fit_vectors(const FitSymmetry& symmetry, const FitBasis& basis,
                     const std::vector<FitSample>& samples, int count, Place place,
                     Vectors outputs) {
    const int keep = basis.keep, more = basis.dispersion;
    if (symmetry.axial)
        return {fit_axial(axial_terms(basis.degree, more), samples, count, keep, place,
                          outputs),
                {}};
    return {fit_scalars(free_terms(basis.degree, symmetry, true, false, more), samples,
                        count, keep, place,
                        [&](const FitSample& s, int v) { return outputs(s, v).x; }),
            fit_scalars(free_terms(basis.degree, symmetry, false, true, more), samples,
                        count, keep, place,
                        [&](const FitSample& s, int v) { return outputs(s, v).y; })};
}

FitBlock fit_rays_block(const LensFit& fit, const FitSegment& segment,
                        const std::vector<FitSample>& samples, const FitBasis& basis) {
    return fit_vectors(
        fit.symmetry, basis, samples, 2,
        [&](const FitSample& s) {
            return At{fit.variables(s.f, s.q, s.l, segment), s.f, s.q};
        },
        [](const FitSample& s, int v) { return v == 0 ? s.direction : s.offset; });
}

int rays_wanted(const LensFit& fit) {
    const int terms =
        fit.symmetry.axial
            ? int(axial_terms(fit.degree, 1).size())
            : int(free_terms(fit.degree, fit.symmetry, true, false, 1).size());
    return std::max({kMinRays, kRaysPerTerm * terms,
                     kRaysPerTerm * int(light_terms(fit.symmetry).size())});
}

void check(const LensFitRequest& r) {
    if (r.degree < kMinDegree || r.degree > kMaxDegree || r.degree % 2 == 0)
        throw input_error("lens fit", "degree", "an odd number from 1 to 13",
                          std::to_string(r.degree));
    if (r.segments < 1 || r.segments > kMostSegments)
        throw input_error("lens fit", "segments", "1 to 16", std::to_string(r.segments));
    if (r.terms < 0)
        throw input_error("lens fit", "terms", "at least 1, or 0: all",
                          std::to_string(r.terms));
}

/// One range of film radii, and how well it is fitted.
struct Piece {
    FitSegment segment;
    double residual = 0;
};

Piece fit_piece(const FitRays& rays, const LensFit& fit, int terms, double low,
                double high) {
    const int count = rays_wanted(fit);
    FitDraw draw{.count = count,
                 .widened = kClearWidened,
                 .toward_edges = true,
                 .u_low = low,
                 .u_high = high};
    const auto clear = rays.draw(draw);
    draw.widened = kPointsWidened, draw.met = true;
    Piece piece{fit_segment(fit, clear, rays.draw(draw), low, high, terms), 0};
    piece.residual = direction_residual(fit, piece.segment, clear);
    return piece;
}

/// Halves the worst piece until there are as many as asked for.
std::vector<FitSegment> fit_segments(const FitRays& rays, const LensFit& fit,
                                     const LensFitRequest& request) {
    std::vector<Piece> pieces{fit_piece(rays, fit, request.terms, 0, 1)};
    const int wanted = fit.symmetry.axial ? request.segments : 1;
    while (int(pieces.size()) < wanted) {
        const auto worst = std::max_element(
            pieces.begin(), pieces.end(),
            [](const Piece& a, const Piece& b) { return a.residual < b.residual; });
        const double low = worst->segment.u_low, high = worst->segment.u_high,
                     middle = (low + high) / 2;
        *worst = fit_piece(rays, fit, request.terms, low, middle);
        pieces.push_back(fit_piece(rays, fit, request.terms, middle, high));
    }
    std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
        return a.segment.u_low < b.segment.u_low;
    });
    std::vector<FitSegment> segments;
    for (Piece& p : pieces) segments.push_back(std::move(p.segment));
    return segments;
}

}  // namespace

FitSegment fit_segment(const LensFit& fit, const std::vector<FitSample>& clear,
                       const std::vector<FitSample>& wide, double u_low, double u_high,
                       int terms) {
    FitSegment found{u_low, u_high, {}, {}, {}};
    const auto place = [&](const FitSample& s) {
        return At{fit.variables(s.f, s.q, s.l, found), s.f, s.q};
    };
    found.rays = fit_rays_block(fit, found, clear, {fit.degree, 0, terms});
    FitSegment more = found;
    more.rays = fit_rays_block(fit, found, clear, {fit.degree, 1, terms});
    if (direction_residual(fit, more, clear) <
        kWorthIt * direction_residual(fit, found, clear))
        found = more;
    const int points =
        std::min(fit.degree, std::max(kLeastPoints, fit.degree - kPointsBelow));
    found.points =
        fit_vectors(fit.symmetry, {points, 0, terms}, wide, 1 + int(fit.mounts.size()),
                    place, [&](const FitSample& s, int v) {
                        return v == 0 ? s.iris : s.met[fit.mounts[v - 1].surface];
                    });
    found.light.x = fit_scalars(light_terms(fit.symmetry), clear, 1, terms, place,
                                [](const FitSample& s, int) { return s.transmittance; });
    return found;
}

double direction_residual(const LensFit& fit, const FitSegment& segment,
                          const std::vector<FitSample>& samples) {
    double sum = 0;
    for (const FitSample& s : samples) {
        const Vec2d e = fit.scene_vectors(segment, s.f, s.q, s.l).direction - s.direction;
        sum += dot(e, e);
    }
    return samples.empty() ? 0 : std::sqrt(sum / double(samples.size()));
}

FitInverse fit_inverse(const LensFit& fit, const std::vector<FitSample>& clear) {
    FitInverse inverse;
    double direction = 0;
    for (const FitSample& s : clear) direction = std::max(direction, length(s.direction));
    inverse.direction = direction;
    // The offset that goes with a direction in the mean: the pupil wanders over the
    // field.
    double dd = 0, de = 0, reach = 0;
    for (const FitSample& s : clear)
        dd += dot(s.direction, s.direction), de += dot(s.direction, s.offset);
    const double wander = dd > 0 ? de / dd : 0;
    for (const FitSample& s : clear)
        reach = std::max(reach, length(s.offset - s.direction * wander));
    inverse.pupil.by_film = Vec2d{1, 1} * (-wander * direction / reach);
    inverse.pupil.by_slope = Vec2d{1, 1} * (1 / reach);
    const auto place = [&](const FitSample& s) {
        const Vec2d g = s.direction * (1 / direction), h = inverse.pupil.q(g, s.offset);
        if (!fit.symmetry.axial) return At{{h.x, h.y, g.x, g.y, s.l}, g, h};
        return At{{dot(g, h), 2 * dot(h, h) - 1, 2 * dot(g, g) - 1, s.l, 0}, g, h};
    };
    inverse.rays =
        fit_vectors(fit.symmetry, {fit.degree}, clear, 2, place,
                    [](const FitSample& s, int v) { return v == 0 ? s.f : s.q; });
    return inverse;
}

LensFit refit_rays(const LensFit& fit, const std::vector<FitRay>& rays,
                   const std::vector<FitDirection>& scene) {
    std::vector<FitSample> samples(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        FitSample& s = samples[i];
        s.f = fit.unit_film(rays[i].film), s.q = fit.pupil.q(s.f, rays[i].slope);
        s.l = fit.scale(rays[i].wavelength_nm);
        s.direction = scene[i].direction, s.offset = scene[i].offset;
    }
    LensFit other = fit;
    other.error = {};
    for (FitSegment& segment : other.segments) {
        std::vector<FitSample> mine;
        for (const FitSample& s : samples)
            if (&fit.segment_at(s.f) - fit.segments.data() ==
                &segment - other.segments.data())
                mine.push_back(s);
        segment.rays = fit_rays_block(fit, segment, mine, {fit.degree, 1});
    }
    other.inverse = fit_inverse(other, samples);
    return other;
}

LensFit make_lens_fit(const Tracer& tracer, const LensFitRequest& request) {
    check(request);
    LensFit fit;
    fit.lens = tracer.prescription().name, fit.degree = request.degree;
    const FitRays rays(tracer, request, fit);
    const Surface& front = tracer.prescription().surfaces.front();
    fit.front_z = tracer.vertices().front();
    fit.front_curvature = (vertex_curvature_x(front) + vertex_curvature_y(front)) / 2;
    fit.mounts = limiting_mounts(
        tracer, rays.draw({.count = kMountRays, .widened = kErrorWidened, .met = true}));
    fit.segments = fit_segments(rays, fit, request);
    fit.inverse = fit_inverse(
        fit, rays.draw(
                 {.count = rays_wanted(fit), .widened = kWidened, .toward_edges = true}));
    fit.error = measure_fit(rays, fit, kErrorRays);
    return fit;
}

}  // namespace dg
