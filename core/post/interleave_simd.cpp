#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "post/interleave_simd.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "post/interleave.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;

/// Calls `step` at multiples of the vector length; the last vector may overlap the previous.
/// Returns the number of pixels done: all, or none if they do not fill a vector.
template <typename Step>
HWY_INLINE int in_vectors(int count, const Step& step) {
    const int lanes = int(hn::Lanes(D()));
    if (count < lanes) return 0;
    for (int i = 0; i + lanes <= count; i += lanes) step(i);
    if (count % lanes != 0) step(count - lanes);
    return count;
}

void Split(const float* from, int count, int channels, float* to, std::size_t plane) {
    const D d;
    int done = 0;
    if (channels == 1)
        done = in_vectors(count, [&](int i) HWY_ATTR {
            hn::StoreU(hn::LoadU(d, from + i), d, to + i);
        });
    if (channels == 3)
        done = in_vectors(count, [&](int i) HWY_ATTR {
            hn::Vec<D> a, b, c;
            hn::LoadInterleaved3(d, from + 3 * i, a, b, c);
            hn::StoreU(a, d, to + i);
            hn::StoreU(b, d, to + plane + i);
            hn::StoreU(c, d, to + 2 * plane + i);
        });
    if (channels == 4)
        done = in_vectors(count, [&](int i) HWY_ATTR {
            hn::Vec<D> a, b, c, e;
            hn::LoadInterleaved4(d, from + 4 * i, a, b, c, e);
            hn::StoreU(a, d, to + i);
            hn::StoreU(b, d, to + plane + i);
            hn::StoreU(c, d, to + 2 * plane + i);
            hn::StoreU(e, d, to + 3 * plane + i);
        });
    for (int c = 0; c < channels; ++c)
        for (int i = done; i < count; ++i) to[c * plane + i] = from[i * channels + c];
}

void Join(const float* from, std::size_t plane, int count, int channels, float* to) {
    const D d;
    int done = 0;
    if (channels == 1)
        done = in_vectors(count, [&](int i) HWY_ATTR {
            hn::StoreU(hn::LoadU(d, from + i), d, to + i);
        });
    if (channels == 3)
        done = in_vectors(count, [&](int i) HWY_ATTR {
            hn::StoreInterleaved3(hn::LoadU(d, from + i), hn::LoadU(d, from + plane + i),
                                  hn::LoadU(d, from + 2 * plane + i), d, to + 3 * i);
        });
    if (channels == 4)
        done = in_vectors(count, [&](int i) HWY_ATTR {
            hn::StoreInterleaved4(hn::LoadU(d, from + i), hn::LoadU(d, from + plane + i),
                                  hn::LoadU(d, from + 2 * plane + i),
                                  hn::LoadU(d, from + 3 * plane + i), d, to + 4 * i);
        });
    for (int i = done; i < count; ++i)
        for (int c = 0; c < channels; ++c) to[i * channels + c] = from[c * plane + i];
}

}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dg {
HWY_EXPORT(Split);
HWY_EXPORT(Join);

void split_channels(const float* from, int count, int channels, float* to,
                    std::size_t plane) {
    HWY_DYNAMIC_DISPATCH(Split)(from, count, channels, to, plane);
}

void join_channels(const float* from, std::size_t plane, int count, int channels,
                   float* to) {
    HWY_DYNAMIC_DISPATCH(Join)(from, plane, count, channels, to);
}

}  // namespace dg
#endif
