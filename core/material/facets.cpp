#include "material/facets.h"

#include "material/beckmann.h"

namespace dg {
namespace {

StretchedBeckmann beckmann_of(const StretchedGgx& g) { return {g.tangent, g.bitangent, g.alpha_t, g.alpha_b}; }

}  // namespace

Facet Facets::reflecting_beckmann(Vec3f n, Vec3f wo, Vec3f wi, float cos_o, float cos_i) const {
    return reflecting_facet(n, wo, wi, cos_o, cos_i, beckmann_of(ggx));
}

Facet Facets::refracting_beckmann(Vec3f n, Vec3f wo, Vec3f wi, float cos_o, float cos_i, float eta) const {
    return refracting_facet(n, wo, wi, cos_o, cos_i, beckmann_of(ggx), eta);
}

Vec3f Facets::sample_beckmann(Vec3f n, Vec3f wo, Vec2f u) const {
    return sample_visible_beckmann(Frame{ggx.tangent, ggx.bitangent, n}, wo, Vec2f{ggx.alpha_t, ggx.alpha_b}, u);
}

}  // namespace dg
