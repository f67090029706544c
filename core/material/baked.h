// baked.h -- tables of albedos as constants. The build computes them: bake/bake_albedo.cpp writes their source.
#pragma once
#include "material/charlie.h"
#include "material/ggx_albedo.h"
#include "material/indexed_albedo.h"

namespace dg::baked {

extern const GgxAlbedo ggx;
extern const CharlieAlbedo charlie;
/// Glass and rough coats, in the lanes of GlassLobes (glass_albedo.h).
extern const IndexedAlbedo glass_ggx, glass_beckmann;
/// Lanes of CaughtBelow (glass_albedo.h): shares of passed and of incident light; two are 0.
extern const IndexedAlbedo caught_ggx, caught_beckmann;

}  // namespace dg::baked
