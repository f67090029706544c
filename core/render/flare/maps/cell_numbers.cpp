// cell_numbers.cpp -- Owen-scrambled points in SIMD lanes.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/flare/maps/cell_numbers.cpp"
#include "render/flare/maps/cell_numbers.h"

#include <array>

#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using DU = hn::ScalableTag<std::uint32_t>;
using U = hn::Vec<DU>;

HWY_INLINE U word(std::uint32_t v) { return hn::Set(DU(), v); }

template <int kBits>
HWY_INLINE U swap(U v, std::uint32_t mask) {
    return hn::Or(hn::And(hn::ShiftRight<kBits>(v), word(mask)), hn::ShiftLeft<kBits>(hn::And(v, word(mask))));
}

/// reverse_bits32() and owen_scramble_reversed(), in lanes.
HWY_INLINE U reverse(U v) {
    v = swap<1>(v, 0x55555555u), v = swap<2>(v, 0x33333333u), v = swap<4>(v, 0x0f0f0f0fu);
    v = swap<8>(v, 0x00ff00ffu);
    return hn::Or(hn::ShiftRight<16>(v), hn::ShiftLeft<16>(v));
}
HWY_INLINE U scrambled(U v, std::uint32_t seed) {
    v = hn::Xor(v, hn::Mul(v, word(0x3d20adeau)));
    v = hn::Mul(hn::Add(v, word(seed)), word((seed >> 16) | 1u));
    v = hn::Xor(v, hn::Mul(v, word(0x05526c56u)));
    return hn::Xor(v, hn::Mul(v, word(0x53a22864u)));
}

/// Computes points from the low words `run` and the high bits.
void Fill(const std::uint32_t* run, std::uint32_t high, std::uint32_t seed, float* to, int count) {
    const DU d;
    const hn::RebindToFloat<DU> df;
    const hn::RebindToSigned<DU> di;
    for (int i = 0; i < count; i += int(hn::Lanes(d))) {
        const U bits = reverse(scrambled(hn::Xor(hn::LoadU(d, run + i), word(high)), seed));
        const auto whole = hn::ConvertTo(df, hn::BitCast(di, hn::ShiftRight<8>(bits)));   // unit_float()
        hn::StoreU(hn::Mul(whole, hn::Set(df, 0x1p-24f)), df, to + i);
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dg {
namespace {

HWY_EXPORT(Fill);

constexpr int kDimensions = CellNumbers::kDimensions, kRun = CellNumbers::kMost + CellNumbers::kMostLanes;
using Words = std::array<std::uint32_t, kDimensions>;
constexpr auto kDirections = sobol_directions();

/// Sobol words of a point, unscrambled and bit-reversed.
Words words(std::uint32_t i) {
    Words w{i, sobol_second_reversed(i), 0, 0, 0};
    for (int bit = 0; i >> bit; ++bit)
        if (i >> bit & 1) w[2] ^= kDirections[bit][0], w[3] ^= kDirections[bit][1], w[4] ^= kDirections[bit][2];
    return w;
}

/// Words of the first run of points. Later runs differ from it by the words of their first index.
const std::array<std::array<std::uint32_t, kRun>, kDimensions>& run() {
    static const auto made = [] {
        std::array<std::array<std::uint32_t, kRun>, kDimensions> all{};
        for (std::uint32_t i = 0; i < CellNumbers::kMost; ++i)
            for (int d = 0; d < kDimensions; ++d) all[d][i] = words(i)[d];
        return all;
    }();
    return made;
}

}  // namespace

int CellNumbers::fill(std::uint64_t seed, std::uint64_t first, std::uint64_t last) {
    const std::uint64_t begin = first / kMost * kMost;
    const int from = int(first - begin), count = int(std::min(last - first, begin + kMost - first));
    const Words high = words(std::uint32_t(begin));
    for (int d = 0; d < kDimensions; ++d) {
        const auto scramble = std::uint32_t(hash64(seed, (begin >> 32) * kDimensions + std::uint64_t(d)) >> 16);
        HWY_DYNAMIC_DISPATCH(Fill)(run()[d].data() + from, high[d], scramble, of[d], count);
    }
    return count;
}

}  // namespace dg
#endif  // HWY_ONCE
