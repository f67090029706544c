#include "optics/prescription.h"

#include <cmath>
#include <sstream>

#include "optics/lens_error.h"

namespace dg {
namespace {

std::string number(double value) {
    std::ostringstream s;
    s << value;
    return s.str();
}

void check_range(const std::string& where, const char* what, double value, double low,
                 double high, const char* wanted) {
    if (!(value >= low && value <= high))
        throw input_error(where, what, wanted, number(value));
}

void check_surface(const Prescription& lens, int i) {
    const Surface& s = lens.surfaces[i];
    const std::string where = surface_name(lens, i);
    if (s.shape != Shape::conic || s.conic != 0 || !s.asphere.empty() || is_placed(s))
        throw lens_error("lens-surface", i, where, "form",
                         "a centred sphere or plane (so far)", "another");
    check_range(where, "curvature", s.curvature, -1e3, 1e3, "at most 1000 per mm");
    const bool last = i + 1 == int(lens.surfaces.size());
    check_range(where, "thickness", s.thickness, last ? -1e5 : 0, 1e5, "0 to 1e5 mm");
    if (!(s.semi_diameter > 0))
        throw input_error(where, "semi-diameter", "more than 0 mm",
                          number(s.semi_diameter));
    if (std::isfinite(s.semi_diameter) &&
        s.semi_diameter * std::abs(s.curvature) > 1 + 1e-9)
        throw input_error(where, "semi-diameter", "at most the radius of curvature",
                          number(s.semi_diameter) + " mm");
    check_glass(s.glass, where);
}

}  // namespace

bool is_axially_symmetric(const Prescription& lens) {
    for (const Surface& s : lens.surfaces)
        if (!is_axially_symmetric(s)) return false;
    return true;
}

std::string surface_name(const Prescription& lens, int surface) {
    return (lens.name.empty() ? "lens" : lens.name) + ": surface " +
           std::to_string(surface);
}

int Prescription::stop_index() const {
    for (int i = 0; i < int(surfaces.size()); ++i)
        if (surfaces[i].stop) return i;
    throw Error((name.empty() ? "lens" : name) + ": no surface is the stop");
}

std::vector<double> Prescription::vertices() const {
    std::vector<double> z;
    double sum = 0;
    for (const Surface& s : surfaces) {
        z.push_back(sum);
        sum += s.thickness;
    }
    return z;
}

double Prescription::last_vertex() const {
    return vertices().back();
}

void validate(const Prescription& lens) {
    const std::string name = lens.name.empty() ? "lens" : lens.name;
    if (lens.surfaces.empty())
        throw Error(name + ": wanted at least one surface, got none");
    if (lens.surfaces.size() > 1000)
        throw input_error(name, "surfaces", "at most 1000",
                          std::to_string(lens.surfaces.size()));
    check_glass(lens.object_medium, name + ": object medium");
    int stops = 0;
    for (int i = 0; i < int(lens.surfaces.size()); ++i) {
        check_surface(lens, i);
        stops += lens.surfaces[i].stop;
    }
    if (stops != 1)
        throw input_error(name, "stops", "exactly one", std::to_string(stops));
}

}  // namespace dg
