// surface.h -- one surface of a lens: its form, where it stands, and what follows it.
//
// Lens frame, for everything in optics/: mm; +z runs along the axis from the object to
// the film; z = 0 at the first vertex; a curvature is positive when the centre lies
// toward +z.
#pragma once
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "math/vec.h"
#include "optics/lens/glass.h"
#include "optics/lens/ripple.h"

namespace dg {

/// Base form, to which the asphere is added. conic: of revolution. biconic: each section
/// has a curvature and a conic constant of its own (a cylinder has one curvature 0).
/// toroid: the y-z section turned about an axis parallel to y, through the centre of the
/// x-z section.
enum class Shape { conic, biconic, toroid };

/// coefficient * r^power, r = hypot(x, y), in mm.
struct AsphereTerm {
    int power;
    double coefficient;
};

/// One surface and what follows it toward the film.
struct Surface {
    double curvature = 0;  // 1/mm; 0 is a plane. Of the y-z section, unless it is a conic
    double thickness = 0;  // mm to the next vertex; of the last surface: to the film at
                           // infinity focus, 0 unknown
    double semi_diameter = std::numeric_limits<double>::infinity();  // mm, clear
    Glass glass;                                                     // after the surface
    bool stop = false;                                               // the iris lies here

    Shape shape = Shape::conic;
    double conic = 0;                     // k: 0 sphere, -1 paraboloid
    double curvature_x = 0, conic_x = 0;  // x-z section of biconic and toroid
    std::vector<AsphereTerm> asphere{};   // added to the sag
    double inner_semi_diameter = 0;       // mm, of a central obstruction
    double semi_diameter_after = 0;       // mm, of the medium behind; 0: the same
    /// mm, and degrees at the vertex: about x, then about the y that turned with it, then
    /// about that z. This surface and its apertures alone; the axis goes on as before.
    Vec3d decenter{}, tilt{};
    std::string coating{};  // empty: the lens's
    Ripple ripple{};
    double reflectance = 0;  // of a mirror in part, at all angles, that records the rest: a sensor
};

/// Light passes the smaller of both sides, mm.
inline double clear_radius(const Surface& s) {
    return s.semi_diameter_after > 0 ? std::min(s.semi_diameter, s.semi_diameter_after)
                                     : s.semi_diameter;
}

inline bool is_placed(const Surface& s) {
    return s.decenter != Vec3d{} || s.tilt != Vec3d{};
}

/// Looks the same after any turn about the axis.
inline bool is_axially_symmetric(const Surface& s) {
    return s.shape == Shape::conic && !is_placed(s);
}

/// Curvatures at the vertex, with the asphere's share of the power (its term in r^2).
inline double vertex_curvature_y(const Surface& s) {
    double c = s.curvature;
    for (const AsphereTerm& a : s.asphere) c += a.power == 2 ? 2 * a.coefficient : 0;
    return c;
}
inline double vertex_curvature_x(const Surface& s) {
    return vertex_curvature_y(s) +
           (s.shape == Shape::conic ? 0 : s.curvature_x - s.curvature);
}

/// The form that a file's kind names: spherical, stop, aspheric, cyl-x (axis along x),
/// cyl-y (curvature is that of the x-z section), biconic, toroid. Error on others.
void set_kind(Surface& surface, const std::string& kind);

}  // namespace dg
