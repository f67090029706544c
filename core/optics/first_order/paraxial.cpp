#include "optics/first_order/paraxial.h"

#include <cmath>
#include <sstream>

#include "optics/lens/lens_error.h"

namespace dg {
namespace {

/// Ray transfer matrix on (height, n x slope).
struct Matrix {
    double a = 1, b = 0, c = 0, d = 1;
    friend Matrix operator*(const Matrix& l, const Matrix& r) {
        return {l.a * r.a + l.b * r.c, l.a * r.b + l.b * r.d, l.c * r.a + l.d * r.c,
                l.c * r.b + l.d * r.d};
    }
};

/// Matrix from just before surface `first` to surface `last`, with or without the last refraction.
Matrix system(const Prescription& lens, double nm, Section section, int first, int last,
              bool refract_last) {
    const auto curvature = [&](const Surface& s) {
        return section == Section::x ? vertex_curvature_x(s) : vertex_curvature_y(s);
    };
    Matrix m;
    double n =
        refractive_index(first ? lens.surfaces[first - 1].glass : lens.object_medium, nm);
    for (int i = first; i <= last; ++i) {
        const double after = refractive_index(lens.surfaces[i].glass, nm);
        if (i < last || refract_last)
            m = Matrix{1, 0, -(after - n) * curvature(lens.surfaces[i]), 1} * m;
        n = after;
        if (i < last) m = Matrix{1, lens.surfaces[i].thickness / n, 0, 1} * m;
    }
    return m;
}

std::string metres(double m) {
    std::ostringstream s;
    s.precision(4);
    s << m << " m";
    return s.str();
}

}  // namespace

FirstOrder first_order(const Prescription& lens, double nm, Section section) {
    const int last = int(lens.surfaces.size()) - 1, stop = lens.stop_index();
    const double n0 = refractive_index(lens.object_medium, nm);
    const double n1 = refractive_index(lens.surfaces[last].glass, nm);
    const Matrix m = system(lens, nm, section, 0, last, true);
    const double power = -m.c, z1 = lens.last_vertex();
    if (!(std::abs(power) > 1e-9))
        throw LensError(lens.name + ": the lens is afocal: it has no focal length", "lens-afocal");
    FirstOrder f{};
    f.wavelength_nm = nm;
    f.efl = n1 / power;
    f.bfl = n1 * m.a / power;
    f.ffl = -n0 * m.d / power;
    f.front_focal_z = f.ffl;
    f.back_focal_z = z1 + f.bfl;
    f.front_principal_z = f.ffl + n0 / power;
    f.back_principal_z = f.back_focal_z - n1 / power;
    f.front_nodal_z = f.ffl + n1 / power;
    f.back_nodal_z = f.back_focal_z - n0 / power;
    // Pupils: images of the stop's centre through the parts of the lens in front of it and behind
    // it.
    const Matrix front = system(lens, nm, section, 0, stop, false);
    const Matrix rear = system(lens, nm, section, stop, last, true);
    f.entrance_pupil_z = n0 * front.b / front.a;
    f.entrance_magnification = 1 / front.a;
    f.exit_pupil_z = z1 - n1 * rear.b / rear.d;
    f.exit_magnification = 1 / rear.d;
    f.stop_semi_diameter = clear_radius(lens.surfaces[stop]);
    if (!std::isfinite(f.stop_semi_diameter) && lens.nominal_f_number > 0)
        f.stop_semi_diameter =
            std::abs(0.5 * f.efl / lens.nominal_f_number / f.entrance_magnification);
    f.entrance_pupil_diameter =
        2 * f.stop_semi_diameter * std::abs(f.entrance_magnification);
    f.exit_pupil_diameter = 2 * f.stop_semi_diameter * std::abs(f.exit_magnification);
    f.f_number = std::abs(f.efl) / f.entrance_pupil_diameter;
    return f;
}

double widest_f_stop(const Prescription&, const FirstOrder& f) {
    return f.f_number;
}

double iris_radius(const Prescription& lens, const FirstOrder& f, double f_stop) {
    if (!std::isfinite(f.stop_semi_diameter))
        throw lens_error("lens-no-stop", lens.stop_index(), lens.name, "size of the stop",
                         "a finite semi-diameter, or a nominal f-number",
                         std::to_string(f.stop_semi_diameter));
    if (!(f_stop > 0) || !std::isfinite(f_stop))
        throw input_error(lens.name, "f-stop", "a positive number",
                          std::to_string(f_stop));
    const double widest = widest_f_stop(lens, f);
    if (!(f_stop >= 0.99 * widest)) {
        std::ostringstream wanted, got;
        wanted.precision(3), got.precision(4);
        wanted << "f/" << widest << " or narrower (the widest of this lens)";
        got << "f/" << f_stop;
        throw lens_error("lens-f-stop", -1, lens.name, "f-stop", wanted.str(), got.str());
    }
    return std::abs(0.5 * f.efl / f_stop / f.entrance_magnification);
}

namespace {

void check_converging(const Prescription& lens, const FirstOrder& f) {
    if (!(f.efl > 0))
        throw lens_error("lens-afocal", -1, lens.name, "focal length",
                         "a converging lens", std::to_string(f.efl) + " mm");
}

}  // namespace

double closest_focus_m(const Prescription& lens, const FirstOrder& f, FocusFrom from) {
    check_converging(lens, f);
    // The object is one focal length in front of the front focus, the image one behind the rear
    // focus.
    const double focal = std::sqrt(f.efl * (f.front_principal_z - f.front_focal_z));
    const double mm = from == FocusFrom::pupil ? focal + f.entrance_pupil_z - f.front_focal_z
                                               : 2 * focal + f.back_focal_z - f.front_focal_z;
    return std::max(0.0, mm) * 1e-3;
}

double film_position(const Prescription& lens, const FirstOrder& f, double distance_m,
                     FocusFrom from) {
    check_converging(lens, f);
    if (std::isnan(distance_m) || distance_m <= 0)
        throw input_error(lens.name, "focus distance", "a positive number of metres",
                          std::to_string(distance_m));
    if (std::isinf(distance_m)) return f.back_focal_z;
    // x: distance from object to front focus. x = f is 1:1, the closest focus for unit focusing.
    const double focal2 = f.efl * (f.front_principal_z - f.front_focal_z);
    const double x_min = std::sqrt(focal2);
    const double mm = 1e3 * distance_m;
    double x;
    if (from == FocusFrom::pupil) {
        x = mm - (f.entrance_pupil_z - f.front_focal_z);
    } else {
        // Distance from object to film: x + f^2/x + (rear focus - front focus).
        const double t = mm - (f.back_focal_z - f.front_focal_z);
        x = t >= 2 * x_min ? 0.5 * (t + std::sqrt(t * t - 4 * focal2)) : 0;
    }
    if (!(x >= x_min * (1 - 1e-9)))
        throw lens_error(
            "lens-focus-near", -1, lens.name, "focus distance",
            metres(closest_focus_m(lens, f, from)) + " or more (the nearest possible)",
            metres(distance_m));
    return f.back_focal_z + focal2 / x;
}

}  // namespace dg
