// open_ghost.h -- unclipped ghost rays: landing point on the film, distance beyond the clear
// apertures, and iris crossings. Landing points and distances are smooth functions of the entry
// point, across the edges of apertures too, so that a map of the ghost can interpolate them.
#pragma once
#include "optics/stray/ghost_lens.h"

namespace dg {

/// Largest number of iris crossings of a ghost with two reflections.
inline constexpr int kMostCrossings = 3;

struct alignas(64) OpenLandings {
    float x[kLensBatch], y[kLensBatch];   // mm, on the film
    /// Positive if an aperture clips the ray: maximum of r^2 / R^2 - 1 over all clear apertures. A
    /// miss, total reflection or backward travel after a mirror gives a comparable positive value.
    float beyond[kLensBatch];
    float sound[kLensBatch];              // 1: reached the film's plane; 0: lost on the way
    float lost_after[kLensBatch];         // for lost rays: number of steps before the loss
    float pass[kLensBatch];               // transmittance without clipping by apertures and iris
    float iris_x[kMostCrossings][kLensBatch], iris_y[kMostCrossings][kLensBatch];   // mm
};

/// Number of iris crossings of a ghost.
int crossings(const GhostLens& lens, const std::vector<GhostStep>& steps);

/// Traces like trace_ghost. `in`: rays with any origin in front of the lens. The film must not be
/// tilted.
void trace_open_ghost(const GhostLens& lens, const std::vector<GhostStep>& steps, const SceneRays& in,
                      const FilmRays& nm, OpenLandings& out, int count);

}  // namespace dg
