// axial.h -- how bright the middle of the film is: what exposures are divided by.
#pragma once
#include "optics/trace/trace.h"

namespace dg {

/// E / L on the axis at one wavelength, by quadrature in double; with T = 1 if `perfect`.
/// For a perfect lens this is pi sin^2(theta') (uniform radiance, on the axis).
double axial_irradiance(const Tracer& tracer, double film_z, const RadialOpening& opening,
                        double iris_radius, double wavelength_nm, bool perfect = false);

/// The same for any lens: over both angles about the direction with slope `chief` (a ray through the
/// iris). What is seen of the iris must be star-shaped about that.
double axial_irradiance(const Tracer& tracer, double film_z, const Iris& iris, double iris_radius,
                        Vec2d chief, double wavelength_nm, bool perfect = false);

}  // namespace dg
