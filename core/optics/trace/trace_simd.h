// trace_simd.h -- the exact trace on batches of rays: float, structure of arrays, SIMD
// with run-time dispatch. What it does is trace.h; tests hold them equal on every target.
#pragma once
#include <cstddef>
#include <vector>

#include "optics/trace/lens_tables.h"
#include "optics/trace/trace.h"

namespace dg {

/// Rays at a time; arrays are that long and aligned, so that kernels never see a tail.
inline constexpr int kLensBatch = 256;

struct alignas(64) FilmRays {
    float x[kLensBatch], y[kLensBatch];    // mm, lens frame, on the film
    float mx[kLensBatch], my[kLensBatch];  // slopes dx/dz, dy/dz
    float nm[kLensBatch];
};
struct alignas(64) SceneRays {
    float x[kLensBatch], y[kLensBatch], z[kLensBatch];     // mm, on the first surface
    float dx[kLensBatch], dy[kLensBatch], dz[kLensBatch];  // unit, toward the scene
    float pass[kLensBatch];  // transmittance, iris included; 0: stopped
    float iris_x[kLensBatch], iris_y[kLensBatch];  // mm
};

/// Film -> scene.
void trace_to_scene(const LensTables& lens, const FilmRays& in, SceneRays& out,
                    int count);
/// Scene -> film: in.pass is ignored, direction still points to the scene. Fills
/// out.x..my, and pass and iris of `in`.
void trace_to_film(const LensTables& lens, SceneRays& in, FilmRays& out, int count);

/// Name of the instruction set in use.
const char* simd_target_name();

}  // namespace dg
