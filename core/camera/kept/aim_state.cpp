#include "camera/kept/aim_state.h"

#include <cstdio>

#include "camera/kept/archive.h"
#include "optics/trace/trace_simd.h"

namespace dg {

// Structured bindings list all members, so that a new member fails to compile until this file
// handles it. The functions are outside the anonymous namespace so that the archives find them.

/// Version of the method; increase it when the same lens would get another aim or fit.
constexpr int kAimVersion = 4;

template <typename A>
void describe(A& a, const ConstantIndex& g) {
    const auto& [n] = g;
    a(n);
}
template <typename A>
void describe(A& a, const AbbeGlass& g) {
    const auto& [nd, vd] = g;
    a(nd, vd);
}
template <typename A>
void describe(A& a, const TableGlass& g) {
    const auto& [nm, n] = g;
    a(nm, n);
}
template <typename A>
void describe(A& a, const SellmeierGlass& g) {
    const auto& [b, c, constant] = g;
    a(b, c, constant);
}
template <typename A>
void describe(A& a, const PolynomialGlass& g) {
    const auto& [coefficient, power] = g;
    a(coefficient, power);
}
template <typename A>
void describe(A& a, const PartialGlass& g) {
    const auto& [nd, vd, p_gf] = g;
    a(nd, vd, p_gf);
}
template <typename A>
void describe(A& a, const MatchedGlass& g) {
    const auto& [formula, against_vacuum, nd, scale, formula_nd] = g;
    a(formula, against_vacuum, nd, scale, formula_nd);
}
template <typename A>
void describe(A& a, const Absorption& g) {
    const auto& [nm, per_mm] = g;
    a(nm, per_mm);
}
template <typename A>
void describe(A& a, const Glass& g) {
    const auto& [formula, name, absorption, against_vacuum] = g;
    (void)name;
    a(formula, absorption, against_vacuum);
}
template <typename A>
void describe(A& a, const AsphereTerm& t) {
    const auto& [power, coefficient] = t;
    a(power, coefficient);
}
template <typename A>
void describe(A& a, const Surface& s) {
    const auto& [curvature, thickness, semi, glass, stop, shape, conic, curvature_x, conic_x,
                 asphere, inner, after, decenter, tilt, coating, ripple, reflectance] = s;
    (void)reflectance;   // camera rays are not reflected
    a(curvature, thickness, semi, glass, stop, shape, conic, curvature_x, conic_x, asphere, inner,
      after, decenter, tilt, coating, ripple.rms_nm, ripple.period_um, ripple.seed);
}
template <typename A>
void describe(A& a, const Prescription& lens) {
    const auto& [name, object_medium, surfaces, coating, nominal_f_number] = lens;
    (void)name;
    a(object_medium, surfaces, coating, nominal_f_number);
}
template <typename A>
void describe(A& a, const Iris& iris) {
    const auto& [edge, apothem, center, arc_radius, bend, fan] = iris.blades();
    const auto& [width, height, pixel, values, support, in_support] = iris.picture();
    (void)in_support;
    a(iris.kind(), edge, apothem, center, arc_radius, bend, fan, width, height, pixel, values,
      support);
}
template <typename A>
void describe(A& a, const ExactLensSettings& s) {
    const auto& [f_stop, iris, focus, focus_from, half_diagonal, draw, film_z, tilt, film_center,
                 film_half, fitted, cache] = s;
    (void)cache;
    a(f_stop, iris, focus, focus_from, half_diagonal, draw, film_z, tilt, film_center, film_half, fitted);
}
template <typename A>
void describe(A& a, const FittedGlass& g) {
    const auto& [degree] = g;
    a(degree);
}

template <typename A, Either<FreeAimTables> T>
void describe(A& a, T& t) {
    auto& [degree, coefficients, center_x, center_y, half_x, half_y, normal, region, area, column_x,
           column_low, column_high] = t;
    a(degree, coefficients, center_x, center_y, half_x, half_y, normal, region, area, column_x,
      column_low, column_high);
}
template <typename A, Either<AimTables> T>
void describe(A& a, T& t) {
    auto& [degree, coefficients, film_radius, iris_scale, enlargement, shape_area, all_shape, region,
           area, column_x, column_half, free] = t;
    a(degree, coefficients, film_radius, iris_scale, enlargement, shape_area, all_shape, region, area,
      column_x, column_half, free);
}
template <typename A, Either<AimState> T>
void describe(A& a, T& s) {
    auto& [aim, h0, transmittance, fit] = s;
    auto& [slopes, free_slopes, tables, fit_error, iris_error, fallback_segments, covered] =
        aim;
    a(slopes.k, slopes.coefficients, free_slopes.degree, free_slopes.coefficients, tables, fit_error,
      iris_error, fallback_segments, covered, h0, transmittance, fit);
}

namespace {

std::string digits(std::uint64_t a, std::uint64_t b) {
    char text[33];
    std::snprintf(text, sizeof text, "%016llx%016llx", (unsigned long long)a,
                  (unsigned long long)b);
    return text;
}

std::string digest(std::string_view bytes) {
    return digits(hash_bytes(bytes, 1), hash_bytes(bytes, 2));
}

/// Whether sizes and indices are within the kernels' bounds.
bool consistent(const Aim& aim) {
    const AimTables& t = aim.tables;
    const FreeAimTables& f = t.free;
    const std::size_t cells = kFilmCells * kFilmCells, columns = cells * (kColumns + 1);
    if (f.degree > 0)
        return f.degree <= 15 && f.coefficients.size() == 2 * std::size_t(free_term_count(f.degree)) &&
               f.region.size() == cells && f.area.size() == cells && f.column_x.size() == columns &&
               f.column_low.size() == columns && f.column_high.size() == columns;
    return t.degree >= 3 && t.degree <= 6 &&
           t.coefficients.size() == 2 * std::size_t(term_count(t.degree));
}

}  // namespace

std::string aim_key(const Prescription& lens, const ExactLensSettings& settings) {
    ByteWriter w;
    w(kAimVersion, std::string(simd_target_name()), lens, settings);
    return digest(w.bytes);
}

std::string to_bytes(const AimState& state, const std::string& key) {
    ByteWriter w;
    w(state);
    return key + digest(w.bytes) + w.bytes;
}

std::optional<AimState> aim_from_bytes(const std::string& bytes, const std::string& key) {
    constexpr std::size_t kDigits = 32;
    if (bytes.size() < 2 * kDigits || bytes.compare(0, kDigits, key) != 0) return std::nullopt;
    const std::string_view rest = std::string_view(bytes).substr(2 * kDigits);
    if (bytes.compare(kDigits, kDigits, digest(rest)) != 0) return std::nullopt;
    AimState state;
    ArchiveReader r(rest);
    r(state);
    if (!r.ok || !r.rest.empty() || !consistent(state.aim)) return std::nullopt;
    return state;
}

}  // namespace dg
