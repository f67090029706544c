#include "optics/expansion/lens_fit_make.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "math/error.h"
#include "optics/aim/pupil.h"
#include "optics/expansion/fit_bend.h"
#include "optics/expansion/fit_vectors.h"
#include "optics/first_order/paraxial.h"

namespace dg {
namespace {

constexpr int kMinDegree = 1, kMaxDegree = 13, kMostSegments = 16;
constexpr int kMinRays = 400;
constexpr int kRaysPerTerm = 8;
// The direction is fitted to a third of its rays; a second fit adds the rays with the largest
// errors among the others (an eighth as many), which lowers the maximal error.
constexpr int kWatched = 3, kMissed = 8;
constexpr int kMountRays = 2000, kErrorRays = 2000;
// Margins: direction and transmittance are fitted little beyond the passing rays; iris and mount
// points farther, since they decide about clipping.
constexpr double kClearWidened = 1.015, kPointsWidened = 1.15;
// Accept more powers of l only if they lower the error to this fraction.
constexpr double kWorthIt = 2.0 / 3;
// Tolerance of the offset, fitted at the lowest degree that meets it: its displacement is at most
// the displacement from the direction's error at the focus distance (at least kFar), and at most
// kOffset (mm).
constexpr double kFar = 3000, kOffset = 1.5e-3;
// Tolerance of iris and mount points, relative to the radius of the edge. They use the fewest terms
// that meet it, and at least two ray degrees less than the direction.
constexpr double kEdge = 5e-4;
constexpr int kPointsBelow = 2, kLeastDegree = 3;
// Tolerance of the transmittance: the fewest terms with an error of kLight, or of kNearlyAll times
// the error of the complete basis.
constexpr double kLight = 5e-4, kNearlyAll = 1.2;

/// Evaluation point of a sample, with or without the segment's bend of q.
struct FitPoint {
    const LensFit& fit;
    const FitSegment& segment;
    bool bent;

    FitPlace operator()(const FitSample& s) const {
        const Vec2d q = bent ? fit.bent(segment, s.f, s.q, s.l) : s.q;
        return {fit.variables(s.f, q, s.l, segment), s.f, q};
    }
};

/// Fit of a vector over the samples.
template <typename Vector>
struct VectorFit {
    FitPoint place;
    const std::vector<FitSample>& samples;
    Vector vector;

    FitBlock of(const FitBasis& basis) const {
        return fit_vectors(place.fit.symmetry, basis, samples, 1, place,
                           [&](const FitSample& s, int) { return vector(s); });
    }
    double error(const FitBlock& block, const FitSample& s) const {
        const FitPlace at = place(s);
        Vec2d found;
        block_vectors(block, at.variables, place.fit.symmetry.axial, at.f, at.q, &found);
        return length(found - vector(s));
    }
    /// Root mean square error.
    double residual(const FitBlock& block) const {
        double sum = 0;
        for (const FitSample& s : samples) sum += std::pow(error(block, s), 2);
        return samples.empty() ? 0 : std::sqrt(sum / double(samples.size()));
    }
    /// Lowest degree with an error of at most `enough`, or else the highest.
    FitBasis least_basis(const FitBasis& most, double enough) const {
        FitBasis basis = most;
        for (basis.degree = std::min(kLeastDegree, most.degree);
             basis.degree < most.degree; basis.degree += 2)
            if (residual(of(basis)) <= enough) break;
        return basis;
    }
};
template <typename Vector>
VectorFit(FitPoint, const std::vector<FitSample>&, Vector) -> VectorFit<Vector>;

std::vector<FitSample> part(const std::vector<FitSample>& all, std::size_t first,
                            std::size_t last) {
    return {all.begin() + std::ptrdiff_t(first), all.begin() + std::ptrdiff_t(last)};
}

/// Samples plus the `watched` samples with the largest errors of the block.
template <typename Vector>
std::vector<FitSample> with_missed(const VectorFit<Vector>& fit, const FitBlock& block,
                                   const std::vector<FitSample>& watched) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < watched.size(); ++i)
        order.emplace_back(-fit.error(block, watched[i]), i);
    std::sort(order.begin(), order.end());
    std::vector<FitSample> all = fit.samples;
    for (std::size_t k = 0; k < std::min(order.size(), fit.samples.size() / kMissed); ++k)
        all.push_back(watched[order[k].second]);
    return all;
}

struct DirectionFit {
    FitBlock block;
    FitBasis basis;
    double error;
    std::vector<FitSample> samples;
};

DirectionFit fit_direction(const FitPoint& place, const std::vector<FitSample>& base,
                           const std::vector<FitSample>& watched, int terms) {
    const auto to_direction = [](const FitSample& s) { return s.direction; };
    const VectorFit direction{place, base, to_direction};
    FitBasis basis{place.fit.degree, 0, terms},
        more{place.fit.degree, kMostDispersion, terms};
    FitBlock found = direction.of(basis);
    const FitBlock with_more = direction.of(more);
    double left = direction.residual(found);
    if (const double less = direction.residual(with_more); less < kWorthIt * left)
        found = with_more, left = less, basis = more;
    const auto all = with_missed(direction, found, watched);
    return {VectorFit{place, all, to_direction}.of(basis), basis, left, all};
}

/// Fits the offset to its tolerance. In wide fields and without axial symmetry, where it matters
/// for the film position, it uses the basis of the direction.
FitBlock fit_offset(const FitPoint& place, const std::vector<FitSample>& base,
                    const DirectionFit& direction, const FitEffort& effort) {
    const auto to_offset = [](const FitSample& s) { return s.offset; };
    if (is_wide(base) || !place.fit.symmetry.axial)
        return VectorFit{place, direction.samples, to_offset}.of(direction.basis);
    const double enough =
        std::min(std::min(kFar, effort.focus) * direction.error, kOffset);
    const VectorFit offset{place, base, to_offset};
    return offset.of(offset.least_basis(direction.basis, enough));
}

/// Fits a point on the iris or a mount with its edge at `radius`.
template <typename Vector>
FitBlock fit_point(const FitPoint& place, const std::vector<FitSample>& wide, Vector vector,
                   double radius, int terms) {
    const int degree = place.fit.degree;
    const FitBasis most{std::min(degree, std::max(kLeastDegree, degree - kPointsBelow)),
                        0, terms};
    const VectorFit point{place, wide, vector};
    FitBasis basis = point.least_basis(most, kEdge * radius);
    if (place.fit.symmetry.axial) basis.enough = kEdge * radius;  // otherwise takes seconds
    return point.of(basis);
}

FitBlock fit_points(const FitPoint& place, const FitBlock& offset,
                    const std::vector<FitSample>& wide, int terms) {
    const LensFit& fit = place.fit;
    FitBlock all = offset;
    all = side_by_side(all, fit_point(
                                place, wide, [](const FitSample& s) { return s.iris; },
                                fit.iris_radius, terms));
    for (const FitMount& mount : fit.mounts)
        all = side_by_side(
            all,
            fit_point(
                place, wide, [&](const FitSample& s) { return s.met[mount.surface]; },
                mount.radius, terms));
    return all;
}

FitFunctions fit_light(const FitPoint& place, const std::vector<FitSample>& samples,
                       int terms) {
    const auto fit = [&](const FitBasis& basis) {
        return fit_scalars(light_terms(place.fit.symmetry), samples, 1, basis, place,
                           [](const FitSample& s, int) { return s.transmittance; });
    };
    if (terms > 0) return fit({1, 0, terms});
    const FitFunctions all = fit({});
    double sum = 0;
    for (const FitSample& s : samples) {
        double found = 0;
        all.evaluate(place(s).variables, &found);
        sum += (found - s.transmittance) * (found - s.transmittance);
    }
    const double left = std::sqrt(sum / double(samples.size()));
    return fit({1, 0, 0, std::max(kLight, kNearlyAll * left)});
}

int rays_wanted(const LensFit& fit) {
    const int terms =
        fit.symmetry.axial
            ? int(axial_terms(fit.degree, kMostDispersion).size())
            : int(free_terms(fit.degree, fit.symmetry, true, false, kMostDispersion).size());
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

/// Segment with its error.
struct Piece {
    FitSegment segment;
    double residual = 0;
};

Piece fit_piece(const FitRays& rays, const LensFit& fit, const FitEffort& effort,
                double low, double high) {
    const int count = rays_wanted(fit);
    FitDraw draw{.count = kWatched * count,
                 .widened = kClearWidened,
                 .toward_edges = true,
                 .u_low = low,
                 .u_high = high};
    const auto clear = rays.draw(draw);
    draw.count = count, draw.widened = kPointsWidened, draw.met = true;
    FitSegment domain{low, high, {}, {}, {}, {}};
    domain.bend = find_bend(fit, domain, clear);
    Piece piece{fit_segment(fit, clear, rays.draw(draw), domain, effort), 0};
    piece.residual = direction_residual(fit, piece.segment, clear);
    return piece;
}

/// Distance in mm from the front focus to the plane in focus.
double focused_at(const Tracer& tracer, double film_z) {
    const FirstOrder order = first_order(tracer.prescription());
    return std::abs(order.efl / magnification(order, film_z));
}

/// Halves the segment with the largest error until the requested number is reached.
std::vector<FitSegment> fit_segments(const FitRays& rays, const LensFit& fit,
                                     const LensFitRequest& request) {
    const FitEffort effort{request.terms, focused_at(rays.tracer(), fit.film.center.z)};
    std::vector<Piece> pieces{fit_piece(rays, fit, effort, 0, 1)};
    const int wanted = fit.symmetry.axial ? request.segments : 1;
    while (int(pieces.size()) < wanted) {
        const auto worst = std::max_element(
            pieces.begin(), pieces.end(),
            [](const Piece& a, const Piece& b) { return a.residual < b.residual; });
        const double low = worst->segment.u_low, high = worst->segment.u_high,
                     middle = (low + high) / 2;
        *worst = fit_piece(rays, fit, effort, low, middle);
        pieces.push_back(fit_piece(rays, fit, effort, middle, high));
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
                       const std::vector<FitSample>& wide, const FitSegment& domain,
                       const FitEffort& effort) {
    const FitPoint bent{fit, domain, true}, straight{fit, domain, false};
    const auto base = part(clear, 0, clear.size() / kWatched),
               watched = part(clear, base.size(), clear.size());
    FitSegment found = domain;
    const DirectionFit direction = fit_direction(bent, base, watched, effort.terms);
    found.direction = direction.block;
    found.points = fit_points(straight, fit_offset(straight, base, direction, effort),
                              wide, effort.terms);
    found.light.x = fit_light(straight, base, effort.terms);
    return found;
}

double direction_residual(const LensFit& fit, const FitSegment& segment,
                          const std::vector<FitSample>& samples) {
    double sum = 0;
    for (const FitSample& s : samples) {
        const Vec2d e = fit.direction(segment, s.f, s.q, s.l) - s.direction;
        sum += dot(e, e);
    }
    return samples.empty() ? 0 : std::sqrt(sum / double(samples.size()));
}

FitInverse fit_inverse(const LensFit& fit, const std::vector<FitSample>& clear) {
    FitInverse inverse;
    double direction = 0;
    for (const FitSample& s : clear) direction = std::max(direction, length(s.direction));
    inverse.direction = direction;
    // Mean offset per direction: the pupil moves over the field.
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
        if (!fit.symmetry.axial) return FitPlace{{h.x, h.y, g.x, g.y, s.l}, g, h};
        return FitPlace{{dot(g, h), 2 * dot(h, h) - 1, 2 * dot(g, g) - 1, s.l, 0}, g, h};
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
        const bool axial = fit.symmetry.axial;
        const FitBasis basis{fit.degree, kMostDispersion};
        const auto one = [&](bool bent, auto vector) {
            return fit_vectors(fit.symmetry, basis, mine, 1, FitPoint{fit, segment, bent},
                               [&](const FitSample& s, int) { return vector(s); });
        };
        segment.direction = one(true, [](const FitSample& s) { return s.direction; });
        segment.points = side_by_side(
            one(false, [](const FitSample& s) { return s.offset; }),
            vectors_of(segment.points, 1, 1 + int(fit.mounts.size()), axial));
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
