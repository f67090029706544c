// smooth_surface.h -- the smooth surface that a triangle with vertex normals stands for, against blocks along the shadow
// terminator.
//
// A facet that faces away from a light, or that lies in the shadow of its neighbours, is black although its vertex
// normals face the light. So the BSDF is evaluated with the smooth normal alone (use_smooth_normal), and light is
// gathered at a point lifted to the smooth surface. Source: Hanika 2021, Hacking the Shadow Terminator (Ray Tracing
// Gems II, chapter 4): the point is projected onto the tangent planes of the three vertices, and the projections are
// interpolated. They lie twice too high over a quadratic surface, so we use half of the lift.
//
// Camera paths only: a light path arrives at the triangle itself, and camera paths have the full weight of light from
// behind it (PathVertex::scattering). Surfaces that transmit light keep their triangles.
#pragma once
#include "scene/instance_record.h"

namespace dg {

/// Vector (m, world) from a hit of a smooth triangle to the smooth surface, on the side of hit.wo. 0 where that surface
/// is concave. The placement may be InstanceRecord::where().
Vec3f lift_to_smooth(const InstanceRecord& record, const Placement& placement, const SurfaceHit& hit);

}  // namespace dg
