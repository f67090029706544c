// prescription.h -- a lens as a list of surfaces, the way a patent prints it.
//
// Lens frame, for everything in optics/: mm; +z runs along the axis from the object to
// the film; z = 0 at the first vertex; a curvature is positive when the centre lies
// toward +z.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "optics/coating.h"
#include "optics/glass.h"

namespace dg {

/// One surface and what follows it toward the film.
struct Surface {
    double curvature = 0;  // 1/mm; 0 is a plane
    double thickness = 0;  // mm to the next vertex; of the last surface: to the film at
                           // infinity focus, 0 unknown
    double semi_diameter = std::numeric_limits<double>::infinity();  // mm, clear
    Glass glass;                                                     // after the surface
    bool stop = false;                                               // the iris lies here
    std::string kind = "spherical";  // "spherical" or "stop" (a plane)
};

struct Prescription {
    std::string name;
    Glass object_medium;  // before the first surface
    std::vector<Surface> surfaces;
    /// On every surface between air and glass. Old lenses were bare until about 1940,
    /// single-coated until about 1970; one layer of MgF2 lies between bare glass and
    /// modern multilayers.
    Coating coating = Coating::mgf2;
    double nominal_f_number = 0;  // 0: unknown

    int stop_index() const;                // of the surface at which the iris lies
    double last_vertex() const;            // z of the last surface, mm
    std::vector<double> vertices() const;  // z of each surface, mm
};

/// Throws Error naming lens, surface and value: kinds that are not supported, no or two
/// stops, a clear diameter beyond the sphere, NaN, negative gaps, absurd indices.
void validate(const Prescription& lens);

/// "name: surface 3", the place in messages.
std::string surface_name(const Prescription& lens, int surface);

}  // namespace dg
