// surface.h -- a surface of a lens: form, placement, and the medium behind it.
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

/// Base form, to which the asphere is added. conic: surface of revolution. biconic: curvature and
/// conic constant per section (0 curvature in one section gives a cylinder). toroid: the y-z
/// section revolved about an axis parallel to y through the centre of curvature of the x-z section.
enum class Shape { conic, biconic, toroid };

/// Sag term coefficient * r^power, r = hypot(x, y), in mm.
struct AsphereTerm {
    int power;
    double coefficient;
};

/// Surface of a lens, with the medium and distance behind it toward the film.
struct Surface {
    double curvature = 0;  // 1/mm, 0: plane; y-z section of biconic and toroid
    double thickness = 0;  // mm to the next vertex; after the last surface: to the film at infinity focus, 0
                           // unknown
    double semi_diameter = std::numeric_limits<double>::infinity();  // mm, clear
    Glass glass;                                                     // medium behind the surface
    bool stop = false;                                               // whether the iris is here

    Shape shape = Shape::conic;
    double conic = 0;                     // k: 0 sphere, -1 paraboloid
    double curvature_x = 0, conic_x = 0;  // x-z section of biconic and toroid
    std::vector<AsphereTerm> asphere{};   // terms added to the sag
    double inner_semi_diameter = 0;       // mm, radius of a central obstruction
    double semi_diameter_after = 0;       // mm, clear radius behind the surface; 0: the same
    /// Displacement in mm, and rotations in degrees about the vertex: about x, then about the
    /// rotated y, then about the rotated z. They move this surface and its apertures; the axis of
    /// the lens is unchanged.
    Vec3d decenter{}, tilt{};
    std::string coating{};  // name of a preset; empty: the coating of the lens
    Ripple ripple{};
    double reflectance = 0;  // of a partial mirror (a sensor), the same at all angles; the rest is recorded
};

/// Smaller of the clear radii in front of and behind the surface, mm.
inline double clear_radius(const Surface& s) {
    return s.semi_diameter_after > 0 ? std::min(s.semi_diameter, s.semi_diameter_after)
                                     : s.semi_diameter;
}

inline bool is_placed(const Surface& s) {
    return s.decenter != Vec3d{} || s.tilt != Vec3d{};
}

/// Whether the surface is unchanged by any rotation about the axis.
inline bool is_axially_symmetric(const Surface& s) {
    return s.shape == Shape::conic && !is_placed(s);
}

/// Curvature at the vertex in the y-z and x-z sections, including the asphere's r^2 term.
inline double vertex_curvature_y(const Surface& s) {
    double c = s.curvature;
    for (const AsphereTerm& a : s.asphere) c += a.power == 2 ? 2 * a.coefficient : 0;
    return c;
}
inline double vertex_curvature_x(const Surface& s) {
    return vertex_curvature_y(s) +
           (s.shape == Shape::conic ? 0 : s.curvature_x - s.curvature);
}

/// Sets the form from a lens file's kind: spherical, stop, aspheric, cyl-x (axis along x), cyl-y
/// (`curvature` then bends the x-z section), biconic or toroid. Throws Error for other names.
void set_kind(Surface& surface, const std::string& kind);

}  // namespace dg
