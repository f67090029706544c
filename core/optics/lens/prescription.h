// prescription.h -- a lens as a list of surfaces, the way a patent prints it.
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
    /// On every surface between air and glass. Old lenses were bare until about 1940,
    /// single-coated until about 1970; one layer of MgF2 lies between bare glass and
    /// modern multilayers.
    Coating coating = Coating::mgf2;
    double nominal_f_number = 0;  // 0: unknown

    int stop_index() const;                // of the surface at which the iris lies
    double last_vertex() const;            // z of the last surface, mm
    std::vector<double> vertices() const;  // z of each surface, mm
};

/// Nothing changes when the lens is turned about its axis.
bool is_axially_symmetric(const Prescription& lens);

/// Throws LensError naming lens, surface and value: no or two stops, a clear diameter
/// beyond the form, NaN, negative gaps, absurd sizes and indices.
void validate(const Prescription& lens);

/// Coating of a surface: its own or the lens's, made for its glass.
SurfaceCoating coating_at(const Prescription& lens, int surface);

/// Whether any of its media swallows light.
bool absorbs(const Prescription& lens);

/// "name: surface 3", the place in messages.
std::string surface_name(const Prescription& lens, int surface);

}  // namespace dg
