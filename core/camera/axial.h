// axial.h -- irradiance at the centre of the film, the normalization of exposures.
#pragma once
#include "optics/trace/trace.h"

namespace dg {

/// E / L on the axis at one wavelength, by quadrature in double; with T = 1 if `perfect`. pi
/// sin^2(theta') for a perfect lens.
double axial_irradiance(const Tracer& tracer, double film_z, const RadialOpening& opening,
                        double iris_radius, double wavelength_nm, bool perfect = false);

/// E / L for any lens: quadrature over the hemisphere about the direction of slope `chief` (a ray
/// through the iris). The visible part of the iris must be star-shaped about it.
double axial_irradiance(const Tracer& tracer, double film_z, const Iris& iris, double iris_radius,
                        Vec2d chief, double wavelength_nm, bool perfect = false);

}  // namespace dg
