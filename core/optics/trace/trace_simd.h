// trace_simd.h -- Tracer (trace.h) on batches of rays: float, structure of arrays, SIMD with
// run-time dispatch. Tests compare both on every instruction set.
#pragma once
#include <cstddef>
#include <vector>

#include "optics/trace/lens_tables.h"
#include "optics/trace/trace.h"

namespace dg {

/// Length of the aligned arrays of rays, so that kernels need no tail loop.
inline constexpr int kLensBatch = 256;

struct alignas(64) FilmRays {
    float x[kLensBatch], y[kLensBatch];    // mm, lens frame, on the film
    float mx[kLensBatch], my[kLensBatch];  // slopes dx/dz, dy/dz
    float nm[kLensBatch];
};
struct alignas(64) SceneRays {
    float x[kLensBatch], y[kLensBatch], z[kLensBatch];     // mm, on the first surface
    float dx[kLensBatch], dy[kLensBatch], dz[kLensBatch];  // unit, toward the scene
    float pass[kLensBatch];  // transmittance including the iris; 0: clipped
    float iris_x[kLensBatch], iris_y[kLensBatch];  // mm
};

/// Traces from the film to the scene.
void trace_to_scene(const LensTables& lens, const FilmRays& in, SceneRays& out,
                    int count);
/// Traces from the scene to the film. Input directions point to the scene; in.pass is ignored.
/// Fills out.x to out.my, and pass and iris of `in`.
void trace_to_film(const LensTables& lens, SceneRays& in, FilmRays& out, int count);

/// Name of the active instruction set.
const char* simd_target_name();

}  // namespace dg
