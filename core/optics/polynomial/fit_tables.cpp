// fit_tables.cpp -- a fit in double, laid out for the kernels.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "optics/polynomial/lens_fit_simd.h"

namespace dg {
namespace {

constexpr double kAngleError = 1e-8;

int total(const FitTerm& t) {
    int sum = 0;
    for (const int p : t) sum += p;
    return sum;
}

/// The last variable in a monomial, by which it is made from its parent.
int last_variable(const FitTerm& t) {
    int last = 0;
    for (int v = 0; v < 5; ++v)
        if (t[v] > 0) last = v;
    return last;
}
FitTerm parent_of(FitTerm t) {
    if (total(t) > 0) --t[last_variable(t)];
    return t;
}

/// The monomials of all blocks, and those that they are made from.
class Programmer {
  public:
    void want(const FitFunctions& f) {
        for (const FitTerm& t : f.terms) add(t);
    }
    /// Degree after degree, by variable, in the order of the parents: so those that share
    /// a variable follow one another as their parents do, and a complete basis has one
    /// run for each degree and variable.
    FitProgram program() {
        add({});
        std::map<std::array<int, 3>, FitTerm>
            order;  // degree, variable, place of the parent
        FitProgram p;
        p.size = 0;
        for (int degree = 0; p.size < int(terms_.size()); ++degree) {
            order.clear();
            for (const FitTerm& t : terms_)
                if (total(t) == degree)
                    order[{degree, last_variable(t), place_[parent_of(t)]}] = t;
            for (const auto& [key, t] : order) {
                if (degree > 0) extend(p, key[2], key[1]);
                place_[t] = p.size++;
            }
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
        while (terms_.insert(t).second) t = parent_of(t);
    }
    static void extend(FitProgram& p, int parent, int variable) {
        if (!p.runs.empty()) {
            FitRun& last = p.runs.back();
            if (last.variable == variable && last.parent + last.count == parent) {
                ++last.count;
                return;
            }
        }
        p.runs.push_back({p.size, parent, 1, variable});
    }
    std::set<FitTerm> terms_;
    std::map<FitTerm, int> place_;
};

/// A function by the powers of one variable, highest first, that variable taken out.
std::vector<FitFunctions> by_power(const FitFunctions& f, int variable) {
    int most = 0;
    for (const FitTerm& t : f.terms) most = std::max(most, t[variable]);
    std::vector<FitFunctions> parts(most + 1, FitFunctions{1, {}, {}});
    for (std::size_t i = 0; i < f.terms.size(); ++i) {
        FitTerm rest = f.terms[i];
        FitFunctions& part = parts[most - rest[variable]];
        rest[variable] = 0;
        part.terms.push_back(rest), part.coefficients.push_back(f.coefficients[i]);
    }
    return parts;
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
    Programmer p;
    const std::vector<FitFunctions> light = by_power(s.light.x, axial ? 3 : 4);
    for (const FitBlock* b : {&s.rays, &s.points}) p.want(b->x), p.want(b->y);
    for (const FitFunctions& f : light) p.want(f);
    t.program = p.program();
    t.rays = p.tables(s.rays), t.points = p.tables(s.points);
    for (const FitFunctions& f : light) t.light.powers.push_back(p.tables(f));
    int last = 0;
    for (const FitFunctionTables* f : {&t.rays.x, &t.rays.y})
        for (const int at : f->at) last = std::max(last, at);
    for (const FitRun& run : t.program.runs) t.ray_runs += run.first <= last;
    return t;
}

/// Terms after which sum (-t)^n / (2n + 1)! is exact to kAngleError.
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
    Programmer p;
    p.want(fit.inverse.rays.x), p.want(fit.inverse.rays.y);
    t.inverse_program = p.program();
    t.inverse = p.tables(fit.inverse.rays);
    return t;
}

}  // namespace dg
