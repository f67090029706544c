// aim_simd.h -- aimed rays (pupil.h) in batches, for the kernels of trace_simd.h. Tests compare
// them with the scalar version on every instruction set.
#pragma once
#include "optics/aim/aim_tables.h"
#include "optics/trace/trace_simd.h"

namespace dg {

/// Input of the aimed sampler: film point (mm), two uniform numbers, wavelength (nm).
struct alignas(64) LensSamples {
    float x[kLensBatch], y[kLensBatch], u[kLensBatch], v[kLensBatch], nm[kLensBatch];
};

/// Samples rays with the aim (pupil.h) and traces them. `aim` receives the weight A' J / (1+m^2)^2
/// of each ray (mm^2/mm^2, from radiance to film irradiance); `slopes`, if not null, receives the
/// film rays.
void guided_rays(const LensTables& lens, const AimTables& aim, const LensSamples& in,
                 SceneRays& out, float* aim_weight, FilmRays* slopes, int count);
/// Samples the same rays without tracing them.
void aimed_rays(const LensTables& lens, const AimTables& aim, const LensSamples& in, FilmRays& out,
                float* aim_weight, int count);
/// Weights that the aim would give to film rays with known iris points.
void aim_weights(const LensTables& lens, const AimTables& aim, const FilmRays& rays,
                 const SceneRays& traced, float* aim_weight, int count);
/// Film slopes toward given iris points (in.u, in.v: mm, meridional frame), and the Jacobian of the
/// map.
void aim_slopes(const LensTables& lens, const AimTables& aim, const LensSamples& in,
                FilmRays& out, float* jacobian, int count);

}  // namespace dg
