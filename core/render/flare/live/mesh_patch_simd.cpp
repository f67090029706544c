// mesh_patch_simd.cpp -- landings of a patch of a ghost's mesh, in SIMD lanes.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/flare/live/mesh_patch_simd.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "optics/trace/trace-inl.h"
#include "render/flare/live/mesh_patch.h"
#include "render/flare/maps/ghost_map_nodes.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

/// Position in a square, and index of the square's first node.
struct InSquare {
    VI node;
    V u, v;
};

HWY_INLINE InSquare in_square(const MeshPatch& p, V u, V v) {
    if (p.squares == 1) return {hn::Zero(DI()), u, v};
    const V across = constant(float(p.squares)), last = constant(float(p.squares - 1));
    const V x = hn::Mul(u, across), y = hn::Mul(v, across);
    const V column = hn::Min(hn::Floor(x), last), row = hn::Min(hn::Floor(y), last);
    const V node = hn::MulAdd(row, constant(float(p.row)), column);
    return {hn::ConvertTo(DI(), node), hn::Sub(x, column), hn::Sub(y, row)};
}

HWY_INLINE V at_node(const MeshPatch& p, const float* from, const InSquare& s) {
    return p.squares == 1 ? constant(*from) : hn::GatherIndex(D(), from, s.node);
}

HWY_INLINE V bilinear(const MeshPatch& p, int field, const InSquare& s) {
    const float* const a = p.nodes + field * p.plane;
    const V a0 = at_node(p, a, s), b0 = at_node(p, a + p.row, s);
    const V above = hn::MulAdd(s.u, hn::Sub(at_node(p, a + 1, s), a0), a0);
    const V below = hn::MulAdd(s.u, hn::Sub(at_node(p, a + p.row + 1, s), b0), b0);
    return hn::MulAdd(s.v, hn::Sub(below, above), above);
}

void Land(const MeshPatch& p, const IrisTables& iris, MapBatch& b, int count) {
    const D d;
    static const WavelengthScale scale = WavelengthScale::visible();
    for (int i = 0; i < count; i += int(hn::Lanes(d))) {
        const InSquare s = in_square(p, hn::Load(d, b.u + i), hn::Load(d, b.v + i));
        const V inv_um = hn::Div(constant(1e3f), hn::Load(d, b.nm + i));
        const V l = hn::Mul(hn::MulAdd(hn::Mul(inv_um, inv_um), constant(scale.scale), constant(scale.offset)),
                            constant(1 / kLambdaStep));
        const V half = hn::Mul(l, constant(0.5f));   // a parabola through the nodes
        const V w[MeshPatch::kSets] = {hn::MulSub(half, l, half), hn::MulAdd(half, l, half), hn::Load(d, b.shift_x + i),
                                       hn::Load(d, b.shift_y + i)};
        const auto field = [&](int f) HWY_ATTR {
            V sum = bilinear(p, f, s);
            for (int k = 0; k < MeshPatch::kSets; ++k) sum = hn::MulAdd(w[k], constant(p.sets[k][f]), sum);
            return sum;
        };
        const V beyond = field(2);
        M open = hn::Lt(beyond, hn::Zero(d));
        hn::Store(beyond, d, b.beyond + i);
        const V wider = hn::Div(constant(1), hn::Load(d, b.opening + i));
        const V glass = hn::Sub(bilinear(p, MeshPatch::pass_field(p.crossings), s), constant(p.glass.pass));
        V left = hn::Max(hn::MulAdd(glass, constant(p.glass.per_pass), constant(1)), hn::Zero(d));
        for (int k = 0; k < p.crossings; ++k) {
            const V x = field(3 + 2 * k), y = field(4 + 2 * k);
            hn::Store(x, d, b.iris_x[k] + i), hn::Store(y, d, b.iris_y[k] + i);
            const V through = iris_transmission(iris, hn::Mul(x, wider), hn::Mul(y, wider));
            open = hn::And(open, hn::Gt(through, hn::Zero(d)));
            left = hn::Mul(left, through);
        }
        hn::Store(hn::IfThenElseZero(open, left), d, b.left + i);
        hn::Store(field(0), d, b.x + i), hn::Store(field(1), d, b.y + i);
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dg {

HWY_EXPORT(Land);

void MeshPatch::land(const IrisTables& iris, MapBatch& batch, int count) const {
    HWY_DYNAMIC_DISPATCH(Land)(*this, iris, batch, count);
}

}  // namespace dg
#endif  // HWY_ONCE
