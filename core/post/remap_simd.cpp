// Sizeless vectors (SVE, RVV) cannot be members of structs; on Arm NEON serves.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "post/remap_simd.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "post/remap_tile.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D4 = hn::Full128<float>;
using V4 = hn::Vec<D4>;

struct Bounded {
    V4 value, low, high;  // four addends each
};

/// Four weights at t.
HWY_INLINE V4 weights_at(const V4 (&k)[4], float t) {
    const V4 v = hn::Set(D4(), t);
    return hn::MulAdd(hn::MulAdd(hn::MulAdd(k[3], v, k[2]), v, k[1]), v, k[0]);
}

/// A pixel's 4 x 4 values: weighed, not yet added across; and bounds of each column.
HWY_INLINE Bounded columns(const float* p, int stride, V4 wx, V4 wy) {
    const D4 d;
    const V4 a = hn::LoadU(d, p), b = hn::LoadU(d, p + stride),
             c = hn::LoadU(d, p + 2 * stride), e = hn::LoadU(d, p + 3 * stride);
    V4 sum = hn::Mul(a, hn::Broadcast<0>(wy));
    sum = hn::MulAdd(b, hn::Broadcast<1>(wy), sum);
    sum = hn::MulAdd(c, hn::Broadcast<2>(wy), sum);
    sum = hn::MulAdd(e, hn::Broadcast<3>(wy), sum);
    return {hn::Mul(sum, wx), hn::Min(hn::Min(a, b), hn::Min(c, e)),
            hn::Max(hn::Max(a, b), hn::Max(c, e))};
}

/// Rows of four vectors become columns.
HWY_INLINE void transpose(V4& a, V4& b, V4& c, V4& e) {
    const D4 d;
    const V4 ac_low = hn::InterleaveLower(d, a, c),
             ac_high = hn::InterleaveUpper(d, a, c);
    const V4 be_low = hn::InterleaveLower(d, b, e),
             be_high = hn::InterleaveUpper(d, b, e);
    a = hn::InterleaveLower(d, ac_low, be_low),
    b = hn::InterleaveUpper(d, ac_low, be_low);
    c = hn::InterleaveLower(d, ac_high, be_high),
    e = hn::InterleaveUpper(d, ac_high, be_high);
}

void Places(const RemapPlaces& p, RemapRow& row) {
    const hn::CappedTag<float, kTileWidth> d;
    const hn::RebindToSigned<decltype(d)> di;
    const auto half = hn::Set(d, -0.5f), one = hn::Set(d, 1);
    const auto right = hn::Set(d, float(p.width) - 0.5f),
               bottom = hn::Set(d, float(p.height) - 0.5f);
    const auto y = hn::Set(d, float(p.y));
    const auto stride = hn::Set(di, p.region->width);
    const auto left = hn::Set(di, p.x - 1 - p.region->x0),
               up = hn::Set(di, p.y - 1 - p.region->y0);
    for (int i = 0; i < kTileWidth; i += int(hn::Lanes(d))) {
        const auto dx = hn::LoadU(d, p.dx + i), dy = hn::LoadU(d, p.dy + i);
        const auto at_x =
            hn::Add(hn::Set(d, float(p.x)), hn::Add(hn::Iota(d, float(i)), dx));
        const auto at_y = hn::Add(y, dy);
        auto here =
            hn::And(hn::And(hn::Ge(at_x, half), hn::Le(at_x, right)),
                    hn::And(hn::Ge(at_y, half), hn::Le(at_y, bottom)));  // false for NaN
        if (p.sx != nullptr)
            here = hn::And(here, hn::And(hn::Eq(hn::LoadU(d, p.sx + i), one),
                                         hn::Eq(hn::LoadU(d, p.sy + i), one)));
        const auto x0 = hn::Floor(hn::IfThenElseZero(here, dx)),
                   y0 = hn::Floor(hn::IfThenElseZero(here, dy));
        hn::StoreU(hn::IfThenElseZero(here, hn::Sub(dx, x0)), d, row.tx + i);
        hn::StoreU(hn::IfThenElseZero(here, hn::Sub(dy, y0)), d, row.ty + i);
        const auto column =
            hn::Add(hn::Add(hn::ConvertTo(di, x0), hn::Iota(di, i)), left);
        const auto line = hn::Add(hn::ConvertTo(di, y0), up);
        const auto offset = hn::Add(hn::Mul(line, stride), column);
        const auto flag = hn::RebindMask(di, here);
        hn::StoreU(hn::IfThenElseZero(flag, offset), di, row.offset + i);
        hn::StoreU(hn::IfThenElseZero(flag, hn::Set(di, 1)), di, row.here + i);
    }
}

void Row(const float* plane, int stride, const RemapRow& row, const RemapWeights& weights,
         int count, float* out) {
    const D4 d;
    V4 k[4];
    for (int i = 0; i < 4; ++i) k[i] = hn::Load(d, weights.at[i]);
    for (int i = 0; i < count; i += 4) {
        Bounded p[4];
        for (int j = 0; j < 4; ++j)
            p[j] = columns(plane + row.offset[i + j], stride,
                           weights_at(k, row.tx[i + j]), weights_at(k, row.ty[i + j]));
        transpose(p[0].value, p[1].value, p[2].value, p[3].value);
        transpose(p[0].low, p[1].low, p[2].low, p[3].low);
        transpose(p[0].high, p[1].high, p[2].high, p[3].high);
        const V4 sum =
            hn::Add(hn::Add(p[0].value, p[1].value), hn::Add(p[2].value, p[3].value));
        const V4 low = hn::Min(hn::Min(p[0].low, p[1].low), hn::Min(p[2].low, p[3].low));
        const V4 high =
            hn::Max(hn::Max(p[0].high, p[1].high), hn::Max(p[2].high, p[3].high));
        const V4 held = hn::Min(hn::Max(sum, low), high);
        hn::StoreU(hn::IfThenElse(hn::IsNaN(sum), sum, held), d, out + i);  // NaN stays
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dg {
HWY_EXPORT(Row);
HWY_EXPORT(Places);

void remap_places(const RemapPlaces& p, RemapRow& row) {
    HWY_DYNAMIC_DISPATCH(Places)(p, row);
}

void remap_row(const float* plane, int stride, const RemapRow& row,
               const RemapWeights& weights, int count, float* out) {
    HWY_DYNAMIC_DISPATCH(Row)(plane, stride, row, weights, count, out);
}

}  // namespace dg
#endif
