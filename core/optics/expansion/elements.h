// elements.h -- building blocks of polynomial systems: Taylor expansions of exact ray transfers
// about a base ray. Lengths in mm. z points in the direction of travel, so a radius is positive
// when the centre of curvature is ahead.
#pragma once
#include "optics/expansion/ray_map.h"
#include "optics/lens/form.h"

namespace dg {

/// Transfer to a parallel plane at `distance` ahead.
RayMap propagation(double distance, int degree, const RayNumbers& about = {});

/// Refraction from index n1 to n2, between points on the tangent plane of the surface's vertex.
/// Ignores placement and ripple of the form.
RayMap refraction(const SurfaceForm& form, double n1, double n2, int degree,
                  const RayNumbers& about = {});

/// Reflection, between points on the tangent plane of the surface's vertex.
RayMap reflection(const SurfaceForm& form, int degree, const RayNumbers& about = {});

/// Transform to the frame of a displaced or rotated surface (surface.h), onto its plane z = 0;
/// `back`: the inverse transform, onto the plane z = 0 of the outer frame.
RayMap placement(const Vec3d& decenter, const Vec3d& tilt, bool back, int degree,
                 const RayNumbers& about = {});

}  // namespace dg
