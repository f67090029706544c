#include "optics/first_order/seidel.h"

#include <algorithm>
#include <cmath>

#include "optics/lens/lens_error.h"

namespace dg {
namespace {

/// Paraxial ray at a surface: height, and slope before refraction.
struct Ray {
    double h, u;
};

/// Coefficient of r^4 of the sag, relative to the sphere with the curvature at the vertex.
double fourth_order_depth(const Surface& s) {
    const auto cube = [](double c) { return c * c * c; };
    double depth = ((1 + s.conic) * cube(s.curvature) - cube(vertex_curvature_y(s))) / 8;
    for (const AsphereTerm& term : s.asphere)
        depth += term.power == 4 ? term.coefficient : 0;
    return depth;
}

SeidelSums& operator+=(SeidelSums& a, const SeidelSums& b) {
    a.s1 += b.s1, a.s2 += b.s2, a.s3 += b.s3, a.s4 += b.s4, a.s5 += b.s5;
    a.c1 += b.c1, a.c2 += b.c2;
    return a;
}

/// Index of a medium, and its decrease from the short to the long wavelength.
struct Medium {
    double n, dn;
};

/// Contributions of a surface; u2 is the slope of the marginal ray behind it.
SeidelSums sums_at(const Surface& s, Ray marginal, Ray chief, double u2, double invariant,
                   Medium before, Medium behind) {
    const auto [n, dn] = before;
    const auto [n2, dn2] = behind;
    const double c = vertex_curvature_y(s), h = marginal.h, hc = chief.h;
    const double a = n * (h * c + marginal.u), ac = n * (hc * c + chief.u);
    const double bend = u2 / n2 - marginal.u / n, petzval = c * (1 / n2 - 1 / n);
    SeidelSums out{.s1 = -a * a * h * bend,
                   .s2 = -a * ac * h * bend,
                   .s3 = -ac * ac * h * bend,
                   .s4 = -invariant * invariant * petzval};
    // This form has no division by a, which vanishes where the marginal ray has normal incidence.
    out.s5 = -ac * (ac * ac * h * (1 / (n2 * n2) - 1 / (n * n)) +
                    (invariant - ac * h) * hc * petzval);
    const double asphere = 8 * (n2 - n) * fourth_order_depth(s) * h;
    out.s1 += asphere * h * h * h, out.s2 += asphere * h * h * hc;
    out.s3 += asphere * h * hc * hc, out.s5 += asphere * hc * hc * hc;
    const double colour = dn2 / n2 - dn / n;
    out.c1 = a * h * colour, out.c2 = ac * h * colour;
    return out;
}

}  // namespace

Seidel seidel(const Prescription& lens, double nm, const SeidelRays& rays, double short_nm,
              double long_nm) {
    const FirstOrder f = first_order(lens, nm);
    if (!std::ranges::all_of(lens.surfaces,
                             [](const Surface& s) { return is_axially_symmetric(s); }))
        throw lens_error("lens-surface", -1, lens.name, "Seidel sums",
                         "a lens with axial symmetry",
                         "cylinders, toroids or surfaces off the axis");
    if (!std::isfinite(f.entrance_pupil_z))
        throw lens_error("lens-pupil", -1, lens.name, "Seidel sums",
                         "an entrance pupil at a finite distance",
                         "a lens that is telecentric toward the object");
    const auto dispersion = [&](const Glass& g) {
        return refractive_index(g, short_nm) - refractive_index(g, long_nm);
    };
    const double slope = rays.pupil_radius / rays.object_distance;
    Ray marginal{rays.pupil_radius - slope * f.entrance_pupil_z, slope};
    Ray chief{-rays.field_slope * f.entrance_pupil_z, rays.field_slope};
    double n = refractive_index(lens.object_medium, nm), dn = dispersion(lens.object_medium);
    Seidel out{};
    out.invariant = n * (marginal.u * chief.h - chief.u * marginal.h);
    for (const Surface& s : lens.surfaces) {
        const double n2 = refractive_index(s.glass, nm), dn2 = dispersion(s.glass);
        const double power = (n2 - n) * vertex_curvature_y(s);
        const auto refracted = [&](Ray r) { return (n * r.u - r.h * power) / n2; };
        out.surfaces.push_back(sums_at(s, marginal, chief, refracted(marginal), out.invariant,
                                       {n, dn}, {n2, dn2}));
        out.total += out.surfaces.back();
        for (Ray* r : {&marginal, &chief}) {
            r->u = refracted(*r);
            r->h += s.thickness * r->u;
        }
        n = n2, dn = dn2;
    }
    out.image_convergence = n * marginal.u;
    return out;
}

}  // namespace dg
