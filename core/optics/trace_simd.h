// trace_simd.h -- the exact trace on batches of rays: float, structure of arrays, SIMD
// with run-time dispatch. What it does is trace.h and pupil.h; tests hold them equal on
// every target.
#pragma once
#include <cstddef>
#include <vector>

#include "optics/pupil_tables.h"
#include "optics/trace.h"

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
/// Samples that the guided sampler starts from: film point, lens sample, wavelength.
struct alignas(64) LensSamples {
    float x[kLensBatch], y[kLensBatch], u[kLensBatch], v[kLensBatch], nm[kLensBatch];
};

/// Film -> scene.
void trace_to_scene(const LensTables& lens, const FilmRays& in, SceneRays& out,
                    int count);
/// Scene -> film: in.pass is ignored, direction still points to the scene. Fills
/// out.x..my, and pass and iris of `in`.
void trace_to_film(const LensTables& lens, SceneRays& in, FilmRays& out, int count);

/// Draws rays by the aim (pupil.h) and traces them. `aim` receives A' J / (1+m^2)^2
/// (mm^2/mm^2: radiance to film irradiance) of every ray, `slopes` (if any) what was
/// traced.
void guided_rays(const LensTables& lens, const AimTables& aim, const LensSamples& in,
                 SceneRays& out, float* aim_weight, FilmRays* slopes, int count);
/// The same rays as they leave the film, not traced.
void aimed_rays(const LensTables& lens, const AimTables& aim, const LensSamples& in, FilmRays& out,
                float* aim_weight, int count);
/// The same weight for given film rays whose iris points are known: as if the aim had
/// drawn them.
void aim_weights(const LensTables& lens, const AimTables& aim, const FilmRays& rays,
                 const SceneRays& traced, float* aim_weight, int count);
/// Film slopes of given points of the iris (in.u, in.v: mm, meridional frame) with the
/// aim's Jacobian.
void aim_slopes(const LensTables& lens, const AimTables& aim, const LensSamples& in,
                FilmRays& out, float* jacobian, int count);

/// Name of the instruction set in use.
const char* simd_target_name();

}  // namespace dg
