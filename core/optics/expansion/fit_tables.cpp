// fit_tables.cpp -- converts a fit from double to the tables of the kernels.
#include <algorithm>
#include <cmath>
#include <vector>

#include "optics/expansion/lens_fit_simd.h"

namespace dg {
namespace {

constexpr double kAngleError = 1e-8;
constexpr int kAxialVariables = 4, kFreeVariables = 5;

/// Appends the Horner nodes of terms that share their powers of the variables before `variable`.
class Nest {
  public:
    Nest(FitHorner& to, const FitFunctions& from, int first, int variables)
        : to_(to), from_(from), first_(first), variables_(variables) {}

    void add(const std::vector<int>& terms, int variable) {
        int most = 0;
        bool even = false, odd = false;
        for (const int t : terms) {
            const int power = from_.terms[t][variable];
            most = std::max(most, power), (power % 2 ? odd : even) = true;
        }
        const bool squares = variables_ == kFreeVariables && most > 0 && even != odd;
        const int step = squares ? 2 : 1;
        to_.nodes.push_back((most / step + 1) +
                            (squares ? (odd ? kFitOdd : kFitEven) : 0));
        for (int power = most; power >= 0; power -= step) {
            std::vector<int> part;
            for (const int t : terms)
                if (from_.terms[t][variable] == power) part.push_back(t);
            if (variable + 1 < variables_)
                add(part, variable + 1);
            else
                for (int k = 0; k < to_.count; ++k)
                    to_.coefficients.push_back(
                        part.empty() ? 0.0f : coefficient(part.front(), k));
        }
    }
    float coefficient(int term, int k) const {
        return float(from_.coefficients[std::size_t(term) * from_.count + first_ + k]);
    }

  private:
    FitHorner& to_;
    const FitFunctions& from_;
    int first_, variables_;
};

/// Horner scheme of `count` functions starting at `first`, without terms that they do not use.
FitHorner horner_tables(const FitFunctions& f, int first, int count, bool axial) {
    FitHorner h{count, {}, {}};
    std::vector<int> used;
    for (int t = 0; t < int(f.terms.size()); ++t)
        for (int k = 0; k < count; ++k)
            if (f.coefficients[std::size_t(t) * f.count + first + k] != 0) {
                used.push_back(t);
                break;
            }
    Nest(h, f, first, axial ? kAxialVariables : kFreeVariables).add(used, 0);
    return h;
}

/// Tables of the i-th vector of a block.
FitVectorTables vector_tables(const FitBlock& b, int i, bool axial) {
    if (axial) return {horner_tables(b.x, 2 * i, 2, true), {}};
    return {horner_tables(b.x, i, 1, false), horner_tables(b.y, i, 1, false)};
}

FitPupilTables pupil_tables(const FitPupil& p) {
    return {float(p.by_film.x),  float(p.by_film.y), float(p.by_slope.x),
            float(p.by_slope.y), float(p.shift.x),   float(p.shift.y)};
}

FitSegmentTables segment_tables(const FitSegment& s, bool axial) {
    FitSegmentTables t;
    t.u_low = float(s.u_low), t.u_high = float(s.u_high);
    t.u_scale = float(2 / (s.u_high - s.u_low));
    t.u_offset = float(-(s.u_low + s.u_high) / (s.u_high - s.u_low));
    t.bends = s.bend.x.count > 0;
    if (t.bends) t.bend = vector_tables(s.bend, 0, axial);
    t.direction = vector_tables(s.direction, 0, axial);
    t.offset = vector_tables(s.points, 0, axial);
    t.iris = vector_tables(s.points, 1, axial);
    const int points = s.points.x.count / (axial ? 2 : 1);
    for (int i = 2; i < points; ++i)
        t.mounts.push_back(vector_tables(s.points, i, axial));
    t.light = horner_tables(s.light.x, 0, 1, axial);
    return t;
}

/// Number of terms for which the series sum (-t)^n / (2n + 1)! is exact to kAngleError.
int angle_terms(double theta) {
    double term = 1;
    int n = 1;
    for (; n < kMostAngleTerms && term > kAngleError; ++n)
        term *= theta * theta / ((2 * n) * (2 * n + 1));
    return n;
}

}  // namespace

FitTables make_fit_tables(const LensFit& fit, const IrisTables& iris) {
    FitTables t;
    t.axial = fit.symmetry.axial, t.scale = fit.scale, t.iris = iris;
    t.center_x = float(fit.film_center.x), t.center_y = float(fit.film_center.y);
    t.half_x = float(fit.film_half.x), t.half_y = float(fit.film_half.y);
    t.pupil = pupil_tables(fit.pupil);
    t.pupil_z = float(fit.entrance_pupil_z - fit.front_z);
    t.front_curvature = float(fit.front_curvature);
    t.angle_terms = angle_terms(1.2 * fit.inverse.direction);
    for (const FitMount& m : fit.mounts) {
        t.outer2.push_back(float(m.radius * m.radius)),
            t.inner2.push_back(float(m.inner * m.inner));
    }
    for (const FitSegment& s : fit.segments)
        t.segments.push_back(segment_tables(s, t.axial));
    t.inverse_direction = float(1 / fit.inverse.direction);
    t.inverse_pupil = pupil_tables(fit.inverse.pupil);
    t.inverse_film = vector_tables(fit.inverse.rays, 0, t.axial);
    t.inverse_pupil_point = vector_tables(fit.inverse.rays, 1, t.axial);
    return t;
}

}  // namespace dg
