// mipmap.cpp -- computes each level from the level before.
#include "material/mipmap.h"

#include <algorithm>
#include <array>

#include "material/srgb.h"
#include "material/texture.h"

namespace dg {
namespace {

/// Texels covered by a texel of the smaller level along an axis: two for n = 2 m; 2 + 1/m for n = 2 m + 1, so three,
/// with partial weights for the outer texels.
struct Span {
    int first, count;
    std::array<float, 3> weight;
};
Span span_under(int i, int n, int m) {
    if (n == m) return {i, 1, {1, 0, 0}};
    if (n == 2 * m) return {2 * i, 2, {0.5f, 0.5f, 0}};
    const float total = float(n);
    return {2 * i, 3, {float(m - i) / total, float(m) / total, float(i + 1) / total}};
}

/// Values of a level, and their conversion to linear light.
template <typename T>
struct Image {
    T* values;
    int width, height, channels;
    bool srgb;

    bool is_alpha(int c) const { return channels % 2 == 0 && c == channels - 1; }
    T* row(int y) const { return values + static_cast<std::size_t>(y) * width * channels; }
};

float decode(float v, bool) { return v; }
float decode(std::uint8_t v, bool srgb) {
    return (srgb ? kDecode.srgb : kDecode.linear)[v];
}
void encode(float v, bool, float& to) { to = v; }
void encode(float v, bool srgb, std::uint8_t& to) {
    to = srgb ? srgb_code(v) : static_cast<std::uint8_t>(std::min(v, 1.f) * 255 + 0.5f);
}

/// General case: any size, any format.
template <typename T>
void shrink_texel(const Image<const T>& from, const Span& sx, const Span& sy,
                  bool weigh_by_alpha, T* to, bool srgb) {
    float plain[4] = {}, weighed[4] = {}, weights = 0;
    const int n = from.channels;
    for (int j = 0; j < sy.count; ++j) {
        for (int i = 0; i < sx.count; ++i) {
            const T* p = from.row(sy.first + j) + (sx.first + i) * n;
            const float share = sy.weight[j] * sx.weight[i];
            const float w = weigh_by_alpha ? share * decode(p[n - 1], false) : 0;
            for (int c = 0; c < n; ++c) {
                const float v = decode(p[c], srgb && !from.is_alpha(c));
                plain[c] += share * v;
                weighed[c] += w * v;
            }
            weights += w;
        }
    }
    for (int c = 0; c < n; ++c) {
        const bool alpha = from.is_alpha(c);
        const float v = weights > 0 && !alpha ? weighed[c] / weights : plain[c];
        encode(v, srgb && !alpha, to[c]);
    }
}

/// Common case: 8-bit values and even sizes, with integer sums of four.
template <int kChannels>
void shrink_row(const std::uint8_t* upper, const std::uint8_t* lower, std::uint8_t* to,
                int width, bool srgb, int half) {
    constexpr bool kAlpha = kChannels % 2 == 0;
    const SrgbSums& sums = srgb_sums();
    for (int x = 0; x < width; ++x) {
        for (int c = 0; c < kChannels; ++c) {
            const int a = upper[c], b = upper[c + kChannels];
            const int d = lower[c], e = lower[c + kChannels];
            if (srgb && !(kAlpha && c == kChannels - 1))
                to[c] = sums.code[sums.light[a] + sums.light[b] + sums.light[d] + sums.light[e]];
            else
                to[c] = static_cast<std::uint8_t>((a + b + d + e + half) >> 2);
        }
        upper += 2 * kChannels, lower += 2 * kChannels, to += kChannels;
    }
}

bool shrink_even(const Image<const float>&, const Image<float>&) { return false; }
bool shrink_even(const Image<const std::uint8_t>& from, const Image<std::uint8_t>& to) {
    if (from.width != 2 * to.width || from.height != 2 * to.height) return false;
    constexpr auto kRows = std::array{shrink_row<1>, shrink_row<2>, shrink_row<3>, shrink_row<4>};
    // Rounds halves up and down in alternate rows, so that the mean does not drift.
    for (int y = 0; y < to.height; ++y)
        kRows[from.channels - 1](from.row(2 * y), from.row(2 * y + 1), to.row(y), to.width,
                                 from.srgb, 1 + (y & 1));
    return true;
}

template <typename T>
void shrink(const Image<const T>& from, const Image<T>& to, bool weigh_by_alpha) {
    if (!weigh_by_alpha && shrink_even(from, to)) return;
    std::vector<Span> columns;
    for (int x = 0; x < to.width; ++x)
        columns.push_back(span_under(x, from.width, to.width));
    for (int y = 0; y < to.height; ++y) {
        const Span sy = span_under(y, from.height, to.height);
        T* p = to.row(y);
        for (const Span& sx : columns) {
            shrink_texel(from, sx, sy, weigh_by_alpha, p, from.srgb);
            p += to.channels;
        }
    }
}

template <typename T>
void fill(const Texture& texture, const T* pixels, bool weigh_by_alpha, Pyramid& pyramid) {
    std::size_t size = 0;
    for (int w = texture.width, h = texture.height; w > 1 || h > 1;) {
        w = std::max(w / 2, 1), h = std::max(h / 2, 1);
        pyramid.levels.push_back({w, h, size});
        size += static_cast<std::size_t>(w) * h * texture.channels;
    }
    std::vector<T> values(size);
    Image<const T> from{pixels, texture.width, texture.height, texture.channels, texture.srgb};
    for (const Pyramid::Level& level : pyramid.levels) {
        const Image<T> to{values.data() + level.offset, level.width, level.height,
                          texture.channels, texture.srgb};
        shrink(from, to, weigh_by_alpha && texture.channels % 2 == 0);
        from = {to.values, to.width, to.height, to.channels, to.srgb};
    }
    pyramid.values = std::move(values);
}

}  // namespace

std::shared_ptr<const Pyramid> build_pyramid(const Texture& texture, bool weigh_by_alpha) {
    if (texture.width < 2 && texture.height < 2) return nullptr;
    auto pyramid = std::make_shared<Pyramid>();
    std::visit(
        [&](const auto& pixels) {
            fill(texture, pixels.data(), weigh_by_alpha, *pyramid);
        },
        texture.pixels);
    return pyramid;
}

}  // namespace dg
