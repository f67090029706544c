// ghost_map_simd.cpp -- landings in a map cell, in SIMD lanes.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/flare/maps/ghost_map_simd.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "optics/trace/trace-inl.h"
#include "render/flare/maps/ghost_map_nodes.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

/// Weights of the Lagrange cubic through four equidistant nodes on [0, 1].
HWY_INLINE void weigh_side(V u, V (&w)[GhostMap::kSide]) {
    const V t = hn::Mul(u, constant(3)), a = hn::Sub(t, constant(1)), b = hn::Sub(t, constant(2)),
            c = hn::Sub(t, constant(3));
    const V ab = hn::Mul(a, b), tc = hn::Mul(t, c);
    w[0] = hn::Mul(hn::Mul(ab, c), constant(-1 / 6.f));
    w[1] = hn::Mul(hn::Mul(tc, b), constant(0.5f));
    w[2] = hn::Mul(hn::Mul(tc, a), constant(-0.5f));
    w[3] = hn::Mul(hn::Mul(ab, t), constant(1 / 6.f));
}

/// Weights of parabolas through the nodes of the wavelength, and of the two axes of the source.
HWY_INLINE void weigh_sets(const WavelengthScale& scale, V nm, V shift_x, V shift_y, V (&w)[GhostMap::kSets]) {
    const V inv_um = hn::Div(constant(1e3f), nm);
    const V l = hn::Mul(hn::MulAdd(hn::Mul(inv_um, inv_um), constant(scale.scale), constant(scale.offset)),
                        constant(1 / kLambdaStep));
    const V half = hn::Mul(l, constant(0.5f)), squared = hn::Mul(l, l);
    w[0] = hn::MulSub(half, l, half), w[1] = hn::Sub(constant(1), squared), w[2] = hn::MulAdd(half, l, half);
    w[3] = shift_x, w[4] = shift_y;
}

/// Interpolates linearly between nodes.
HWY_INLINE V between(const float* nodes, int count, V place) {
    const V below = hn::Clamp(hn::Floor(place), hn::Zero(D()), constant(float(count - 2)));
    const VI index = hn::ConvertTo(DI(), below);
    const V a = hn::GatherIndex(D(), nodes, index), b = hn::GatherIndex(D(), nodes + 1, index);
    return hn::MulAdd(hn::Sub(place, below), hn::Sub(b, a), a);
}

HWY_INLINE V transmittance(const float* fine, V middle, V u, V v, V nm) {
    constexpr float kPerNm = (GhostMap::kSpectrum - 1) / (kMaxWavelength - kMinWavelength);
    const V place = hn::Mul(hn::Sub(nm, constant(kMinWavelength)), constant(kPerNm));
    const auto corner = [&](int c) HWY_ATTR {
        return between(fine + GhostMap::kFineSpectrum + c * GhostMap::kSpectrum, GhostMap::kSpectrum, place);
    };
    // corner_weights(), in lanes
    const V c0 = corner(0), c1 = corner(1), c2 = corner(2), c3 = corner(3), half = constant(0.5f);
    const V low = hn::MulAdd(u, hn::Sub(c1, c0), c0), high = hn::MulAdd(u, hn::Sub(c3, c2), c2);
    const V du = hn::Sub(u, half), dv = hn::Sub(v, half);
    const V bend = hn::MulAdd(half, hn::MulAdd(du, du, hn::Mul(dv, dv)), constant(-0.25f));
    const V sum = hn::Add(hn::Add(c0, c1), hn::Add(c2, c3));
    const V off = hn::MulAdd(bend, sum, hn::MulAdd(v, hn::Sub(high, low), low));
    const V fine_here = between(fine, GhostMap::kFineSpectrum, hn::Mul(place, constant(GhostMap::kFine)));
    return hn::MulAdd(middle, fine_here, off);
}

void Landings(const float* values, int crossings, const IrisTables& iris, MapBatch& batch, int count) {
    const D d;
    static const WavelengthScale scale = WavelengthScale::visible();
    const int fields = 3 + 2 * crossings, stride = GhostMap::kSets * fields + 1;
    for (int i = 0; i < count; i += int(hn::Lanes(d))) {
        const V u = hn::Load(d, batch.u + i), v = hn::Load(d, batch.v + i), nm = hn::Load(d, batch.nm + i);
        V across[GhostMap::kSide], down[GhostMap::kSide], sets[GhostMap::kSets], weight[GhostMap::kNodes];
        weigh_side(u, across), weigh_side(v, down);
        weigh_sets(scale, nm, hn::Load(d, batch.shift_x + i), hn::Load(d, batch.shift_y + i), sets);
        for (int n = 0; n < GhostMap::kNodes; ++n)
            weight[n] = hn::Mul(across[n % GhostMap::kSide], down[n / GhostMap::kSide]);
        const auto over_cell = [&](int value) HWY_ATTR {
            V sum = hn::Zero(d);
            for (int n = 0; n < GhostMap::kNodes; ++n)
                sum = hn::MulAdd(weight[n], constant(values[n * stride + value]), sum);
            return sum;
        };
        const V x = sets[GhostMap::kLambdas], y = sets[GhostMap::kLambdas + 1];   // on the source
        const V bend[GhostMap::kBends] = {hn::MulSub(x, x, x), hn::MulSub(y, y, y), hn::Mul(x, y)};
        const float* const bends = values + GhostMap::kNodes * stride + GhostMap::kFineSpectrum + 4 * GhostMap::kSpectrum;
        const auto field = [&](int f) HWY_ATTR {
            V sum = hn::Zero(d);
            for (int b = 0; b < GhostMap::kBends; ++b)
                sum = hn::MulAdd(bend[b], constant(bends[b * fields + f]), sum);
            for (int s = 0; s < GhostMap::kSets; ++s) sum = hn::MulAdd(sets[s], over_cell(s * fields + f), sum);
            return sum;
        };
        const V beyond = field(2);
        M open = hn::Lt(beyond, hn::Zero(d));
        hn::Store(beyond, d, batch.beyond + i);
        const V middle = hn::Max(over_cell(stride - 1), hn::Zero(d));
        const V glass = hn::Max(transmittance(values + GhostMap::kNodes * stride, middle, u, v, nm), hn::Zero(d));
        const V wider = hn::Div(constant(1), hn::Load(d, batch.opening + i));
        V left = constant(1);   // transmittance of the iris
        for (int k = 0; k < crossings; ++k) {
            const V x = field(3 + 2 * k), y = field(4 + 2 * k);
            hn::Store(x, d, batch.iris_x[k] + i), hn::Store(y, d, batch.iris_y[k] + i);
            const V through = iris_transmission(iris, hn::Mul(x, wider), hn::Mul(y, wider));
            open = hn::And(open, hn::Gt(through, hn::Zero(d)));
            left = hn::Mul(left, through);
        }
        left = hn::IfThenElseZero(open, left);
        hn::Store(middle, d, batch.middle + i), hn::Store(glass, d, batch.glass + i);
        hn::Store(left, d, batch.left + i), hn::Store(hn::Mul(glass, left), d, batch.pass + i);
        hn::Store(field(0), d, batch.x + i), hn::Store(field(1), d, batch.y + i);
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dg {

HWY_EXPORT(Landings);

void GhostMap::landings(const Cell& cell, MapBatch& batch, int count) const {
    HWY_DYNAMIC_DISPATCH(Landings)(values_.data() + cell.data, crossings_, *iris_, batch, count);
}

}  // namespace dg
#endif  // HWY_ONCE
