// aim_simd.h -- the aim on batches of rays, beside the trace of trace_simd.h. What it does is pupil.h; tests hold
// them equal on every target.
#pragma once
#include "optics/aim/aim_tables.h"
#include "optics/trace/trace_simd.h"

namespace dg {

/// Samples that the guided sampler starts from: film point, lens sample, wavelength.
struct alignas(64) LensSamples {
    float x[kLensBatch], y[kLensBatch], u[kLensBatch], v[kLensBatch], nm[kLensBatch];
};

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

}  // namespace dg
