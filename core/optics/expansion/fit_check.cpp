// fit_check.cpp -- consistency checks of a fit read from a file, so that no kernel reads out of
// bounds.
#include <cmath>
#include <string>

#include "math/error.h"
#include "optics/expansion/lens_fit.h"

namespace dg {
namespace {

constexpr int kMostPower = 15, kMostTerms = 8192, kMostMounts = 16, kMostSegments = 16;

Error bad(const std::string& what, const std::string& wanted, std::size_t got) {
    return input_error("lens fit", what, wanted, std::to_string(got));
}

void check(const FitFunctions& f, const std::string& what, int count) {
    if (f.count != count)
        throw bad(what, std::to_string(count) + " functions", std::size_t(f.count));
    if (f.terms.empty() || f.terms.size() > kMostTerms)
        throw bad(what, "1 to " + std::to_string(kMostTerms) + " monomials",
                  f.terms.size());
    if (f.coefficients.size() != f.terms.size() * std::size_t(count))
        throw bad(what, "a coefficient for each monomial and function",
                  f.coefficients.size());
    for (const FitTerm& t : f.terms)
        for (const int power : t)
            if (power < 0 || power > kMostPower)
                throw input_error("lens fit", what, "powers from 0 to 15",
                                  std::to_string(power));
    for (const double c : f.coefficients)
        if (!std::isfinite(c))
            throw input_error("lens fit", what, "finite coefficients", "NaN or infinity");
}

void check(const FitBlock& b, const std::string& what, int vectors, bool axial) {
    check(b.x, what, axial ? 2 * vectors : vectors);
    if (!axial) check(b.y, what, vectors);
}

}  // namespace

void check_lens_fit(const LensFit& fit) {
    const bool axial = fit.symmetry.axial;
    if (fit.mounts.size() > kMostMounts)
        throw bad("mounts", "at most 16", fit.mounts.size());
    if (fit.segments.empty() || fit.segments.size() > kMostSegments)
        throw bad("segments", "1 to 16", fit.segments.size());
    for (const FitSegment& s : fit.segments) {
        if (!(s.u_low < s.u_high))
            throw input_error(
                "lens fit", "segment", "u that increases",
                std::to_string(s.u_low) + " to " + std::to_string(s.u_high));
        if (s.bend.x.count + s.bend.y.count > 0) check(s.bend, "bend", 1, axial);
        check(s.direction, "direction", 1, axial);
        check(s.points, "points", 2 + int(fit.mounts.size()), axial);
        check(s.light.x, "light", 1);
    }
    check(fit.inverse.rays, "inverse", 2, axial);
    if (!(fit.film_half.x > 0 && fit.film_half.y > 0))
        throw input_error("lens fit", "film", "a half size above 0",
                          std::to_string(fit.film_half.x));
}

}  // namespace dg
