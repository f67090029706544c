// prescription.h -- a lens as a list of surfaces, as patents print it.
#pragma once
#include <string>
#include <vector>

#include "optics/lens/coating.h"
#include "optics/lens/surface.h"

namespace dg {

struct Prescription {
    std::string name;
    Glass object_medium;  // before the first surface
    std::vector<Surface> surfaces;
    /// Coating of every surface between air and glass. Lenses were bare until about 1940 and
    /// single-coated until about 1970; one layer of MgF2 reflects less than bare glass and more
    /// than modern multilayers.
    Coating coating = Coating::mgf2;
    double nominal_f_number = 0;  // 0: unknown

    int stop_index() const;                // index of the surface with the iris
    double last_vertex() const;            // z of the last surface, mm
    std::vector<double> vertices() const;  // z of each surface, mm
};

/// Whether the lens is unchanged by any rotation about its axis.
bool is_axially_symmetric(const Prescription& lens);

/// Throws LensError with lens, surface and value for a missing or second stop, a clear diameter
/// larger than the surface's domain, NaN, negative gaps, and implausible sizes or indices.
void validate(const Prescription& lens);

/// Films of a surface, designed for its glass; the surface's coating replaces the coating of the
/// lens.
SurfaceCoating coating_at(const Prescription& lens, int surface);

/// Whether any medium of the lens absorbs light.
bool absorbs(const Prescription& lens);

/// Surface name in messages: "name: surface 3".
std::string surface_name(const Prescription& lens, int surface);

}  // namespace dg
