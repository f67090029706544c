#include "camera/lens_key.h"

#include "camera/byte_writer.h"

namespace dg {

// Structured bindings list all members, so that a new member fails to compile until this file
// handles it. The functions are outside the anonymous namespace so that the archives find them.

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
                 film_half, fitted] = s;
    a(f_stop, iris, focus, focus_from, half_diagonal, draw, film_z, tilt, film_center, film_half, fitted);
}
template <typename A>
void describe(A& a, const FittedGlass& g) {
    const auto& [degree] = g;
    a(degree);
}

std::string lens_key(const Prescription& lens, const ExactLensSettings& settings) {
    ByteWriter w;
    w(lens, settings);
    return w.bytes;
}

}  // namespace dg
