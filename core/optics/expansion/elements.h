// elements.h -- the pieces of a construction kit: each the Taylor expansion of its exact
// transfer about a base ray. Lengths in mm; z runs the way that light goes, so that a
// radius is positive when the centre lies ahead.
#pragma once
#include "optics/expansion/ray_map.h"
#include "optics/lens/form.h"

namespace dg {

/// From a plane to another one, `distance` ahead.
RayMap propagation(double distance, int degree, const RayNumbers& about = {});

/// From the plane that touches the surface at its vertex to itself, from a medium of
/// index n1 into one of index n2. Place and ripple of the form are left out.
RayMap refraction(const SurfaceForm& form, double n1, double n2, int degree,
                  const RayNumbers& about = {});

/// The same, reflected.
RayMap reflection(const SurfaceForm& form, int degree, const RayNumbers& about = {});

/// Into the frame of a surface that is moved or turned (surface.h), to its plane z = 0;
/// `back`: out of that frame, from its plane z = 0 to the one of the frame before.
RayMap placement(const Vec3d& decenter, const Vec3d& tilt, bool back, int degree,
                 const RayNumbers& about = {});

}  // namespace dg
