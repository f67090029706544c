// fit_tables.cpp -- a fit in double, laid out for the kernels.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "optics/polynomial/lens_fit_simd.h"

namespace dg {
namespace {

constexpr double kAngleError = 1e-9;

int total(const FitTerm& t) {
    int sum = 0;
    for (const int p : t) sum += p;
    return sum;
}

/// The monomials of all blocks, and those that they are made from.
class Programmer {
  public:
    void want(const FitFunctions& f) {
        for (const FitTerm& t : f.terms) add(t);
    }
    FitProgram program() {
        std::vector<FitTerm> order(terms_.begin(), terms_.end());
        std::stable_sort(order.begin(), order.end(),
                         [](const FitTerm& a, const FitTerm& b) { return total(a) < total(b); });
        if (order.empty()) order.push_back({});
        FitProgram p;
        for (const FitTerm& t : order) {
            FitTerm parent = t;
            int variable = 0;
            for (int v = 0; v < 5; ++v)
                if (t[v] > 0) variable = v;
            if (total(t) > 0) --parent[variable];
            place_[t] = p.size();
            p.parent.push_back(place_[parent]), p.variable.push_back(variable);
        }
        return p;
    }
    FitFunctionTables tables(const FitFunctions& f) const {
        FitFunctionTables t;
        t.count = f.count;
        for (const FitTerm& term : f.terms) t.at.push_back(place_.at(term));
        t.coefficients.assign(f.coefficients.begin(), f.coefficients.end());
        return t;
    }
    FitBlockTables tables(const FitBlock& b) const { return {tables(b.x), tables(b.y)}; }

  private:
    void add(FitTerm t) {
        while (terms_.insert(t).second && total(t) > 0)
            for (int v = 4; v >= 0; --v)
                if (t[v] > 0) {
                    --t[v];
                    break;
                }
    }
    std::set<FitTerm> terms_;
    std::map<FitTerm, int> place_;
};

FitPupilTables pupil_tables(const FitPupil& p) {
    return {float(p.by_film.x), float(p.by_film.y),  float(p.by_slope.x),
            float(p.by_slope.y), float(p.shift.x), float(p.shift.y)};
}

FitSegmentTables segment_tables(const FitSegment& s) {
    FitSegmentTables t;
    t.u_low = float(s.u_low), t.u_high = float(s.u_high);
    t.u_scale = float(2 / (s.u_high - s.u_low));
    t.u_offset = float(-(s.u_low + s.u_high) / (s.u_high - s.u_low));
    Programmer p;
    for (const FitBlock* b : {&s.rays, &s.points, &s.light}) p.want(b->x), p.want(b->y);
    t.program = p.program();
    t.rays = p.tables(s.rays), t.points = p.tables(s.points), t.light = p.tables(s.light);
    for (const FitFunctionTables* f : {&t.rays.x, &t.rays.y})
        for (const int at : f->at) t.ray_size = std::max(t.ray_size, at + 1);
    return t;
}

/// Terms after which sum (-t)^n / (2n + 1)! is exact to kAngleError.
int angle_terms(double theta) {
    double term = 1;
    int n = 1;
    for (; n < 16 && term > kAngleError; ++n) term *= theta * theta / ((2 * n) * (2 * n + 1));
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
        t.outer2.push_back(float(m.radius * m.radius)), t.inner2.push_back(float(m.inner * m.inner));
    }
    for (const FitSegment& s : fit.segments) t.segments.push_back(segment_tables(s));
    t.inverse_direction = float(1 / fit.inverse.direction);
    t.inverse_pupil = pupil_tables(fit.inverse.pupil);
    Programmer p;
    p.want(fit.inverse.rays.x), p.want(fit.inverse.rays.y);
    t.inverse_program = p.program();
    t.inverse = p.tables(fit.inverse.rays);
    return t;
}

}  // namespace dg
