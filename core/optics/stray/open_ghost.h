// open_ghost.h -- rays by one ghost that nothing stops: where they would land, how far they pass the edges of what
// lets light through, and where they cross the iris. Landings are smooth in the place where rays enter, and so is the
// distance from an edge, up to the edge and beyond: what a map of the ghost interpolates.
#pragma once
#include "optics/stray/ghost_lens.h"

namespace dg {

/// Ghosts cross the iris so often at most, by two reflections.
inline constexpr int kMostCrossings = 3;

struct alignas(64) OpenLandings {
    float x[kLensBatch], y[kLensBatch];   // mm, on the film
    /// Above 0 where an edge stops the ray: the largest of r^2 / R^2 - 1 over all clear apertures, and what stands for it
    /// where light misses a surface, is reflected totally, or runs back from a mirror.
    float beyond[kLensBatch];
    float sound[kLensBatch];              // 1: came to the film; 0: has no landing
    float lost_after[kLensBatch];         // of those without: steps to where they are lost
    float pass[kLensBatch];               // transmittance; edges and iris let all pass
    float iris_x[kMostCrossings][kLensBatch], iris_y[kMostCrossings][kLensBatch];   // mm
};

/// How often a ghost crosses the iris.
int crossings(const GhostLens& lens, const std::vector<GhostStep>& steps);

/// Traces as trace_ghost does; `in`: of rays that may start anywhere before the lens; a lens that is not tilted against its film.
void trace_open_ghost(const GhostLens& lens, const std::vector<GhostStep>& steps, const SceneRays& in,
                      const FilmRays& nm, OpenLandings& out, int count);

}  // namespace dg
