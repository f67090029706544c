// quadrature.h -- the tables of baked.h, computed. Only the program that writes them and tests use this.
#pragma once
#include "material/baked.h"
#include "material/facets.h"

namespace dg::bake {

GgxAlbedo ggx();
CharlieAlbedo charlie();
IndexedAlbedo glass(Distribution distribution);
IndexedAlbedo caught(Distribution distribution);

}  // namespace dg::bake
