#include "optics/expansion/fit_bend.h"

#include <cmath>

#include "math/linear_solve.h"
#include "optics/expansion/fit_vectors.h"

namespace dg {
namespace {

constexpr int kLeastDegree = 5;
/// Ray degrees of the bend, and of the polynomials that rate it in the search. A good bend at low
/// degree is also good at higher degrees.
struct BendDegrees {
    int bend, search;
};
BendDegrees bend_degrees(bool axial, int degree) {
    if (axial) return {5, std::min(degree, 7)};
    return degree < 9 ? BendDegrees{3, 5} : BendDegrees{5, 7};  // higher degrees take seconds
}
constexpr int kRounds = 6;
constexpr int kRaysPerTerm = 8;
constexpr double kEnough = 0.97;   // stop when a round leaves more than this fraction of the error
constexpr double kLongest = 0.25;  // limit on a coefficient's step
constexpr double kDamping = 1e-3;

/// Terms that are not linear transformations of q.
std::vector<FitTerm> bend_terms(const FitSymmetry& symmetry, int degree, bool odd_x) {
    std::vector<FitTerm> terms;
    const auto all = symmetry.axial ? axial_terms(degree)
                                    : free_terms(degree, symmetry, odd_x, !odd_x);
    const int least = symmetry.axial ? 1 : 2, l = symmetry.axial ? 3 : 4;
    for (const FitTerm& t : all)
        if (t[l] == 0 && t[0] + t[1] + t[2] + t[3] >= least) terms.push_back(t);
    return terms;
}

/// Coefficients of a bend in one list, and their derivatives of q.
struct Bend {
    FitBlock block;
    bool axial;

    Bend(const FitSymmetry& symmetry, int degree) : axial(symmetry.axial) {
        block.x = {axial ? 2 : 1, bend_terms(symmetry, degree, true), {}};
        block.x.coefficients.resize(block.x.terms.size() * block.x.count);
        if (axial) return;
        block.y = {1, bend_terms(symmetry, degree, false), {}};
        block.y.coefficients.resize(block.y.terms.size());
    }
    int size() const {
        return int(block.x.coefficients.size() + block.y.coefficients.size());
    }
    double& at(int i) {
        const int n = int(block.x.coefficients.size());
        return i < n ? block.x.coefficients[i] : block.y.coefficients[i - n];
    }
    std::vector<Vec2d> shifts(const FitVariables& v, Vec2d f, Vec2d q) const {
        std::vector<double> x(block.x.terms.size()), y(block.y.terms.size());
        monomials(block.x.terms, v, x.data()), monomials(block.y.terms, v, y.data());
        std::vector<Vec2d> all;
        for (const double m : x) {
            all.push_back(axial ? f * m : Vec2d{m, 0});
            if (axial) all.push_back(q * m);
        }
        for (const double m : y) all.push_back({0, m});
        return all;
    }
};

class BendSearch {
  public:
    BendSearch(const LensFit& fit, const FitSegment& segment,
               const std::vector<FitSample>& clear)
        : fit_(fit),
          tried_(segment),
          degrees_(bend_degrees(fit.symmetry.axial, fit.degree)),
          best_(fit.symmetry, degrees_.bend),
          samples_(clear) {
        // Otherwise dispersion errors would mask the others at low degrees.
        basis_ = {degrees_.search, fit.symmetry.axial && degrees_.search < 7 ? 1 : 0};
        const std::size_t rays =
            kRaysPerTerm *
            (fit.symmetry.axial
                 ? axial_terms(basis_.degree, basis_.dispersion).size()
                 : free_terms(basis_.degree, fit.symmetry, true, false).size());
        if (samples_.size() > rays) samples_.resize(rays);
    }

    FitBlock search() {
        fit_directions(best_);
        double least = fit_directions(best_), damping = kDamping;
        std::vector<double> matrix = normal_, slope = slope_;
        for (int round = 0; round < kRounds; ++round) {
            Bend next = best_;
            const std::vector<double> step = damped_step(matrix, slope, damping);
            for (int i = 0; i < next.size(); ++i) next.at(i) += step[i];
            const double left = fit_directions(next);
            if (!(left < least)) {
                damping *= 30;
                continue;
            }
            const bool enough = left > kEnough * least;
            best_ = next, least = left, matrix = normal_, slope = slope_, damping /= 3;
            if (enough) break;
        }
        return best_.block;
    }

  private:
    FitPlace place(const FitSample& s) const {
        const Vec2d q = fit_.bent(tried_, s.f, s.q, s.l);
        return {fit_.variables(s.f, q, s.l, tried_), s.f, q};
    }

    /// Derivatives of the direction by each coefficient of the bend, with the polynomials of the
    /// previous round: [sample][coefficient].
    std::vector<std::vector<Vec2d>> derivatives(const Bend& bend) const {
        constexpr double h = 1e-4;
        std::vector<std::vector<Vec2d>> all;
        for (const FitSample& s : samples_) {
            const Vec2d q = fit_.bent(tried_, s.f, s.q, s.l);
            const auto direction = [&](Vec2d at) {
                Vec2d v;
                block_vectors(directions_, fit_.variables(s.f, at, s.l, tried_),
                              bend.axial, s.f, at, &v);
                return v;
            };
            const Vec2d x =
                (direction(q + Vec2d{h, 0}) - direction(q - Vec2d{h, 0})) * (0.5 / h);
            const Vec2d y =
                (direction(q + Vec2d{0, h}) - direction(q - Vec2d{0, h})) * (0.5 / h);
            auto shifts = bend.shifts(fit_.variables(s.f, s.q, s.l, tried_), s.f, s.q);
            for (Vec2d& d : shifts) d = x * d.x + y * d.y;
            all.push_back(std::move(shifts));
        }
        return all;
    }

    /// Root of the residual sum of squares after the linear fit. From the second call on, also
    /// builds the normal equations of the next step.
    double fit_directions(const Bend& bend) {
        tried_.bend = bend.block;
        const int n = directions_.x.count > 0 ? bend.size() : 0;
        const auto change = n ? derivatives(bend) : std::vector<std::vector<Vec2d>>();
        const FitBlock all = fit_vectors(
            fit_.symmetry, basis_, samples_, 1 + n,
            [&](const FitSample& s) { return place(s); },
            [&](const FitSample& s, int v) {
                return v == 0 ? s.direction : change[&s - samples_.data()][v - 1];
            });
        normal_.assign(std::size_t(n) * n, 0), slope_.assign(n, 0);
        double sum = 0;
        std::vector<Vec2d> found(1 + n);
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const FitPlace at = place(samples_[i]);
            block_vectors(all, at.variables, bend.axial, at.f, at.q, found.data());
            const Vec2d left = samples_[i].direction - found[0];
            sum += dot(left, left);
            for (int a = 0; a < n; ++a) found[1 + a] = change[i][a] - found[1 + a];
            for (int a = 0; a < n; ++a) {
                slope_[a] += dot(found[1 + a], left);
                for (int b = 0; b < n; ++b)
                    normal_[std::size_t(a) * n + b] += dot(found[1 + a], found[1 + b]);
            }
        }
        directions_ = vectors_of(all, 0, 1, bend.axial);
        return std::sqrt(sum);
    }

    static std::vector<double> damped_step(std::vector<double> matrix,
                                           const std::vector<double>& slope,
                                           double damping) {
        const int n = int(slope.size());
        for (int i = 0; i < n; ++i) {
            double& d = matrix[std::size_t(i) * n + i];
            d = d > 0 ? d * (1 + damping) : 1;
        }
        std::vector<double> step = least_squares(matrix, n, n, slope, 1);
        double longest = 0;
        for (const double s : step) longest = std::max(longest, std::abs(s));
        if (longest > kLongest)
            for (double& s : step) s *= kLongest / longest;
        return step;
    }

    const LensFit& fit_;
    FitSegment tried_;
    BendDegrees degrees_;
    Bend best_;
    std::vector<FitSample> samples_;
    FitBasis basis_;
    FitBlock directions_;
    std::vector<double> normal_, slope_;
};

}  // namespace

FitBlock find_bend(const LensFit& fit, const FitSegment& segment,
                   const std::vector<FitSample>& clear) {
    const bool mirrors = fit.symmetry.mirror_x && fit.symmetry.mirror_y;
    if (fit.degree < kLeastDegree || !mirrors || is_wide(clear)) return {};
    return BendSearch(fit, segment, clear).search();
}

}  // namespace dg
