// test_shapes.h -- surfaces of every form and singlets made of them, for tests.
#pragma once
#include <random>
#include <string>

#include "optics/lens/prescription.h"

namespace dg::test {

class Random {
  public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double operator()() { return uniform_(engine_); }  // uniform in [-1, 1]
    double between(double a, double b) { return a + (b - a) * 0.5 * (1 + (*this)()); }
    int below(int n) { return int(engine_() % unsigned(n)); }

  private:
    std::mt19937 engine_;
    std::uniform_real_distribution<double> uniform_{-1, 1};
};

inline constexpr int kForms = 10;
inline const char* form_name(int form) {
    static const char* names[kForms] = {
        "sphere", "conic",   "even asphere",    "odd",           "cyl-x", "cyl-y",
        "toroid", "biconic", "biconic asphere", "strong asphere"};
    return names[form];
}

/// Surface with a radius of 30-90 mm and a clear radius of 10 mm; most rays pass.
inline Surface surface_of_form(int form, Random& u) {
    Surface s;
    const auto bend = [&] { return (u() < 0 ? -1 : 1) / u.between(30, 90); };
    s.curvature = bend();
    s.semi_diameter = 10;
    const char* kinds[] = {"aspheric", "aspheric", "aspheric", "aspheric", "cyl-x",
                           "cyl-y",    "toroid",   "biconic",  "biconic",  "aspheric"};
    if (form != 0) s.conic = u.between(-3, 1);
    if (form == 9) {  // slopes up to 45 degrees, as in phone cameras
        s.curvature = (u() < 0 ? -1 : 1) / u.between(15, 40);
        s.asphere = {
            {4, 1.5e-4 * u()}, {6, 1e-6 * u()}, {8, 4e-9 * u()}, {10, 2e-11 * u()}};
    }
    if (form >= 6 && form < 9) s.curvature_x = bend();
    if (form >= 7 && form < 9) s.conic_x = u.between(-3, 1);
    if (form == 2 || form == 8)
        s.asphere = {
            {4, 2e-6 * u()}, {6, 2e-8 * u()}, {8, 1e-10 * u()}, {10, 1e-12 * u()}};
    if (form == 3)
        s.asphere = {{2, 1e-3 * u()}, {3, 1e-4 * u()}, {4, 2e-6 * u()}, {5, 1e-7 * u()}};
    set_kind(s, kinds[form]);
    return s;
}

/// Singlet with two faces of the given form and the stop behind it. `placed` adds small
/// displacements and rotations.
inline Prescription singlet_of_form(int form, Random& u, bool placed) {
    Prescription lens;
    lens.name = form_name(form);
    for (int i = 0; i < 2; ++i) {
        Surface s = surface_of_form(form, u);
        s.thickness = 5;
        if (i == 0) s.glass.formula = ConstantIndex{1.6};
        if (placed) {
            s.decenter = {u(), u(), 0.2 * u()};
            s.tilt = {3 * u(), 3 * u(), 30 * u()};
        }
        lens.surfaces.push_back(s);
    }
    Surface stop;
    stop.thickness = 40, stop.stop = true, stop.semi_diameter = 9;
    if (form == 1) stop.curvature = 1.0 / 50;                // stop on a curved surface
    if (form == 3) stop.glass.formula = AbbeGlass{1.5, 60};  // stop on the face of a prism
    lens.surfaces.push_back(stop);
    return lens;
}

}  // namespace dg::test
