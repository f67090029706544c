#include <cmath>
#include <sstream>

#include "optics/lens/form.h"
#include "optics/lens/lens_error.h"
#include "optics/lens/prescription.h"

namespace dg {
namespace {

std::string number(double value) {
    std::ostringstream s;
    s << value;
    return s.str();
}

/// Surface under validation.
struct CheckedSurface {
    const Surface& s;
    int index;
    std::string name;

    [[noreturn]] void refuse(const char* what, const std::string& wanted,
                             const std::string& got,
                             const char* code = "lens-surface") const {
        throw lens_error(code, index, name, what, wanted, got);
    }
    void range(const char* what, double value, double low, double high,
               const char* wanted, const char* code = "lens-surface") const {
        if (!(value >= low && value <= high)) refuse(what, wanted, number(value), code);
    }
};

void check_form(const CheckedSurface& at) {
    const Surface& s = at.s;
    for (const double c : {s.curvature, s.curvature_x})
        at.range("curvature", c, -1e3, 1e3, "at most 1000 per mm");
    for (const double k : {s.conic, s.conic_x})
        at.range("conic constant", k, -1e6, 1e6, "-1e6 to 1e6");
    if (s.shape == Shape::toroid && s.conic_x != 0)
        at.refuse("conic constant of the x-z section", "0: a toroid is round there",
                  number(s.conic_x));
    for (const AsphereTerm& a : s.asphere) {
        if (a.power < 1 || a.power > 60)
            at.refuse("power of the asphere", "1 to 60", std::to_string(a.power));
        const double r = std::isfinite(clear_radius(s)) ? clear_radius(s) : 1;
        at.range("coefficient of the asphere", a.coefficient * std::pow(r, a.power), -1e4,
                 1e4, "at most 1e4 mm of sag at the rim");
    }
}

void check_ripple(const CheckedSurface& at) {
    const Ripple& r = at.s.ripple;
    if (r.rms_nm == 0) return;
    at.range("height of the ripple", r.rms_nm, 0, 1000, "0 to 1000 nm");
    at.range("period of the ripple", r.period_um, 5, 1e4, "5 to 10000 um");
}

void check_apertures(const CheckedSurface& at) {
    const Surface& s = at.s;
    if (!(s.semi_diameter > 0))
        at.refuse("semi-diameter", "more than 0 mm", number(s.semi_diameter));
    if (!(s.semi_diameter_after >= 0))
        at.refuse("semi-diameter behind", "more than 0 mm",
                  number(s.semi_diameter_after));
    if (!(s.inner_semi_diameter >= 0 && s.inner_semi_diameter < clear_radius(s)))
        at.refuse("inner semi-diameter", "0 to less than the semi-diameter",
                  number(s.inner_semi_diameter));
}

/// Checks that the sag is defined on the whole clear disc; for a sphere, that the clear radius is
/// at most the radius of curvature.
void check_domain(const CheckedSurface& at) {
    const double r = clear_radius(at.s);
    if (!std::isfinite(r)) return;
    const SurfaceForm form(at.s, 0);
    const int spokes = at.s.shape == Shape::conic ? 1 : 33;
    for (int i = 0; i < spokes; ++i) {
        const double angle = 0.5 * kPiD * i / std::max(1, spokes - 1);
        const double rim = r * (1 - 1e-6);
        if (!sag(form, rim * std::cos(angle), rim * std::sin(angle)).defined)
            at.refuse("semi-diameter", "at most what the curvature allows",
                      number(r) + " mm");
    }
}

void check_placement(const CheckedSurface& at) {
    const Vec3d d = at.s.decenter, t = at.s.tilt;
    for (const double mm : {d.x, d.y, d.z})
        at.range("decentre", mm, -1e4, 1e4, "at most 1e4 mm");
    for (const double degrees : {t.x, t.y})
        at.range("tilt", degrees, -89, 89, "at most 89 degrees");
    at.range("tilt about z", t.z, -360, 360, "at most 360 degrees");
}

void check_surface(const Prescription& lens, int i) {
    const CheckedSurface at{lens.surfaces[i], i, surface_name(lens, i)};
    check_ripple(at);
    check_apertures(at);
    check_form(at);
    check_placement(at);
    check_domain(at);
    const bool last = i + 1 == int(lens.surfaces.size());
    const double gap = at.s.thickness;
    at.range("thickness", gap, last ? -1e5 : 0, 1e5, "0 to 1e5 mm",
             gap < 0 ? "lens-overlap" : "lens-surface");
    check_glass(at.s.glass, at.name);
    at.range("reflectance", at.s.reflectance, 0, 1,
             "0 to 1: no surface can send back more light than arrives", "lens-coating");
}

}  // namespace

void validate(const Prescription& lens) {
    const std::string name = lens.name.empty() ? "lens" : lens.name;
    if (lens.surfaces.empty() || lens.surfaces.size() > 1000)
        throw lens_error("lens-surface", -1, name, "surfaces",
                         "at least one surface, at most 1000",
                         std::to_string(lens.surfaces.size()));
    check_glass(lens.object_medium, name + ": object medium");
    int stops = 0, last = -1;
    for (int i = 0; i < int(lens.surfaces.size()); ++i) {
        check_surface(lens, i);
        if (lens.surfaces[i].stop) ++stops, last = i;
    }
    if (stops != 1)
        throw lens_error(stops == 0 ? "lens-no-stop" : "lens-two-stops", last, name,
                         "stops", "exactly one", std::to_string(stops));
}

}  // namespace dg
