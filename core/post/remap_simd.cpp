#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "post/remap_simd.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "post/remap_tile.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
// Vectors consist of blocks of four lanes. A block holds four neighbours in a row of the source, or
// four pixels of the result.
using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;
constexpr int kLanes = int(hn::MaxLanes(D()));

HWY_INLINE V sum_of(V a, V b) { return hn::Add(a, b); }
HWY_INLINE V least_of(V a, V b) { return hn::Min(a, b); }
HWY_INLINE V most_of(V a, V b) { return hn::Max(a, b); }

/// Four values at offsets 0, 4, 8 ..., one offset per block.
template <class Tag>
HWY_INLINE hn::Vec<Tag> blocks_at(Tag d, const float* p, const std::int32_t* offset) {
    if constexpr (hn::MaxLanes(d) == 4) {
        return hn::LoadU(d, p + offset[0]);
    } else {
        const hn::Half<Tag> half;
        return hn::Combine(d, blocks_at(half, p, offset + hn::MaxLanes(half)),
                           blocks_at(half, p, offset));
    }
}

/// Reduces each block of p[k] by `fold` to lane k of that block.
template <V (*fold)(V, V)>
HWY_INLINE V folded(const V (&p)[4]) {
    const D d;
    const hn::Repartition<std::uint64_t, D> pairs;
    const auto a = hn::BitCast(pairs, fold(hn::InterleaveLower(d, p[0], p[1]),
                                           hn::InterleaveUpper(d, p[0], p[1])));
    const auto b = hn::BitCast(pairs, fold(hn::InterleaveLower(d, p[2], p[3]),
                                           hn::InterleaveUpper(d, p[2], p[3])));
    return fold(hn::BitCast(d, hn::InterleaveLower(pairs, a, b)),
                hn::BitCast(d, hn::InterleaveUpper(pairs, a, b)));
}

/// Transposes within each block: lane j of block k to lane k of block j.
HWY_INLINE void transpose(V (&p)[4]) {
    const D d;
    const hn::Repartition<std::uint64_t, D> pairs;
    const auto a = hn::BitCast(pairs, hn::InterleaveLower(d, p[0], p[1]));
    const auto b = hn::BitCast(pairs, hn::InterleaveLower(d, p[2], p[3]));
    const auto c = hn::BitCast(pairs, hn::InterleaveUpper(d, p[0], p[1]));
    const auto e = hn::BitCast(pairs, hn::InterleaveUpper(d, p[2], p[3]));
    p[0] = hn::BitCast(d, hn::InterleaveLower(pairs, a, b));
    p[1] = hn::BitCast(d, hn::InterleaveUpper(pairs, a, b));
    p[2] = hn::BitCast(d, hn::InterleaveLower(pairs, c, e));
    p[3] = hn::BitCast(d, hn::InterleaveUpper(pairs, c, e));
}

/// Weights of kLanes pixels; block k of a vector belongs to pixels k, k + 4, .... `across` has the
/// weights of four columns per block, `down` the weight of a row repeated four times.
struct Weights {
    V across[4], down[4][4];

    HWY_INLINE Weights(const RemapWeights& w, const float* tx, const float* ty) {
        const D d;
        const V x = hn::LoadU(d, tx), y = hn::LoadU(d, ty);
        for (int i = 0; i < 4; ++i) across[i] = cubic(w, i, x);
        transpose(across);
        for (int j = 0; j < 4; ++j) {
            const V weight = cubic(w, j, y);
            down[0][j] = hn::Broadcast<0>(weight), down[1][j] = hn::Broadcast<1>(weight);
            down[2][j] = hn::Broadcast<2>(weight), down[3][j] = hn::Broadcast<3>(weight);
        }
    }

  private:
    static HWY_INLINE V cubic(const RemapWeights& w, int i, V t) {
        const D d;
        const V a = hn::MulAdd(hn::Set(d, w.at[3][i]), t, hn::Set(d, w.at[2][i]));
        return hn::MulAdd(hn::MulAdd(a, t, hn::Set(d, w.at[1][i])), t,
                          hn::Set(d, w.at[0][i]));
    }
};

/// Filters kLanes pixels of a channel: weighted sum of 4 x 4 values, clamped to their range.
HWY_INLINE V filtered(const float* plane, int stride, const std::int32_t* offset,
                      const Weights& w) {
    const D d;
    V sum[4], low[4], high[4];
    for (int k = 0; k < 4; ++k) {
        const V a = blocks_at(d, plane, offset + k),
                b = blocks_at(d, plane + stride, offset + k),
                c = blocks_at(d, plane + 2 * stride, offset + k),
                e = blocks_at(d, plane + 3 * stride, offset + k);
        V s = hn::Mul(a, w.down[k][0]);
        s = hn::MulAdd(b, w.down[k][1], s);
        s = hn::MulAdd(c, w.down[k][2], s);
        sum[k] = hn::Mul(hn::MulAdd(e, w.down[k][3], s), w.across[k]);
        low[k] = hn::Min(hn::Min(a, b), hn::Min(c, e));
        high[k] = hn::Max(hn::Max(a, b), hn::Max(c, e));
    }
    const V s = folded<sum_of>(sum);
    const V held = hn::Min(hn::Max(s, folded<least_of>(low)), folded<most_of>(high));
    return hn::IfThenElse(hn::IsNaN(s), s, held);  // propagates NaN
}

void Row(std::span<const RemapChannel> channels, int stride, const RemapRow& row,
         const RemapWeights& weights) {
    for (int i = 0; i < kTileWidth; i += kLanes) {
        const Weights w(weights, row.tx + i, row.ty + i);
        for (const RemapChannel& c : channels)
            hn::StoreU(filtered(c.plane, stride, row.offset + i, w), D(), c.out + i);
    }
}

/// Source positions of kLanes pixels from i on, and whether they are inside.
struct Places {
    V dx, dy, x, y;
    hn::Mask<D> here;  // false for NaN

    HWY_INLINE Places(const RemapPlaces& p, int i) {
        const D d;
        dx = hn::LoadU(d, p.dx + i), dy = hn::LoadU(d, p.dy + i);
        x = hn::Add(hn::Set(d, float(p.x)), hn::Add(hn::Iota(d, float(i)), dx));
        y = hn::Add(hn::Set(d, float(p.y)), dy);
        here = hn::And(hn::Lt(hn::Iota(d, float(i)), hn::Set(d, float(p.count))),
                       hn::And(inside(x, p.width), inside(y, p.height)));
    }

  private:
    static HWY_INLINE hn::Mask<D> inside(V at, int size) {
        const D d;
        return hn::And(hn::Ge(at, hn::Set(d, -0.5f)),
                       hn::Le(at, hn::Set(d, float(size) - 0.5f)));
    }
};

int FindPlaces(const RemapPlaces& p, RemapRow& row) {
    const D d;
    const hn::RebindToSigned<D> di;
    const auto one = hn::Set(d, 1);
    const auto stride = hn::Set(di, p.region->width);
    const auto left = hn::Set(di, p.x - 1 - p.region->x0),
               up = hn::Set(di, p.y - 1 - p.region->y0);
    int filled = 0;
    for (int i = 0; i < kTileWidth; i += kLanes) {
        const Places at(p, i);
        auto here = at.here;
        if (p.sx != nullptr)
            here = hn::And(here, hn::And(hn::Eq(hn::LoadU(d, p.sx + i), one),
                                         hn::Eq(hn::LoadU(d, p.sy + i), one)));
        filled += int(hn::CountTrue(d, here));
        const auto x0 = hn::Floor(hn::IfThenElseZero(here, at.dx)),
                   y0 = hn::Floor(hn::IfThenElseZero(here, at.dy));
        hn::StoreU(hn::IfThenElseZero(here, hn::Sub(at.dx, x0)), d, row.tx + i);
        hn::StoreU(hn::IfThenElseZero(here, hn::Sub(at.dy, y0)), d, row.ty + i);
        const auto column =
            hn::Add(hn::Add(hn::ConvertTo(di, x0), hn::Iota(di, i)), left);
        const auto line = hn::Add(hn::ConvertTo(di, y0), up);
        const auto offset = hn::Add(hn::Mul(line, stride), column);
        const auto flag = hn::RebindMask(di, here);
        hn::StoreU(hn::IfThenElseZero(flag, offset), di, row.offset + i);
        hn::StoreU(hn::IfThenElseZero(flag, hn::Set(di, 1)), di, row.here + i);
    }
    return filled;
}

void Bounds(const RemapPlaces& p, RemapBounds& bounds) {
    const D d;
    V left = hn::Set(d, bounds.left), right = hn::Set(d, bounds.right),
      up = hn::Set(d, bounds.up), down = hn::Set(d, bounds.down);
    for (int i = 0; i < kTileWidth; i += kLanes) {
        const Places at(p, i);
        left = hn::IfThenElse(at.here, hn::Min(left, at.x), left);
        right = hn::IfThenElse(at.here, hn::Max(right, at.x), right);
        up = hn::IfThenElse(at.here, hn::Min(up, at.y), up);
        down = hn::IfThenElse(at.here, hn::Max(down, at.y), down);
    }
    bounds = {hn::GetLane(hn::MinOfLanes(d, left)), hn::GetLane(hn::MaxOfLanes(d, right)),
              hn::GetLane(hn::MinOfLanes(d, up)), hn::GetLane(hn::MaxOfLanes(d, down))};
}

}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dg {
HWY_EXPORT(Row);
HWY_EXPORT(FindPlaces);
HWY_EXPORT(Bounds);

int remap_places(const RemapPlaces& p, RemapRow& row) {
    return HWY_DYNAMIC_DISPATCH(FindPlaces)(p, row);
}

void remap_bounds(const RemapPlaces& p, RemapBounds& bounds) {
    HWY_DYNAMIC_DISPATCH(Bounds)(p, bounds);
}

void remap_row(std::span<const RemapChannel> channels, int stride, const RemapRow& row,
               const RemapWeights& weights) {
    HWY_DYNAMIC_DISPATCH(Row)(channels, stride, row, weights);
}

}  // namespace dg
#endif
