// mixed.h -- separation of edge pixels in which a filter mixed two surfaces, while depth names a
// single surface.
//
// Light from the rim of a lamp in a pixel of the wall behind would be blurred like the wall. Within
// kMixed px of an edge, a pixel is modelled as a mixture of unmixed pixels on both sides of the
// edge, along its row or column. The fraction of the other surface is the least-squares fit to its
// colour; both parts sum to the pixel's light. Variation within its own surface, like noise and
// texture, is not attributed to mixing.
#pragma once
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "post/spread.h"

namespace dg {

inline constexpr int kMixed = 2;   // px, reach of renderers' pixel filters from an edge

/// Image split into the pixels' own surfaces and other surfaces: colours and coverage of each
/// pixel.
struct Unmixed {
    std::vector<float> own, own_cover, other, other_cover;
    std::vector<std::size_t> other_at;   // a pixel of the other surface
};

inline float square_distance(const float* a, const float* b) {
    float sum = 0;
    for (int c = 0; c < kSpreadColours; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sum;
}

/// Least-squares fraction of `there` in a pixel of surface `here` with variation `variation`
/// (squared): at most `most`, and small enough that no colour of the remainder is negative.
inline float share_of_other(const float* pixel, const float* here, const float* there, float variation,
                            float most) {
    float along = 0;
    for (int c = 0; c < kSpreadColours; ++c) along += (pixel[c] - here[c]) * (there[c] - here[c]);
    const float square = square_distance(here, there);
    float share = square > 0 ? std::clamp(along / square, 0.f, most) : 0.f;
    if (share * share * square <= 4 * variation) return 0;
    for (int c = 0; c < kSpreadColours; ++c)
        if (share * there[c] > std::max(pixel[c], 0.f)) share = std::max(pixel[c], 0.f) / there[c];
    return share;
}

class Mixtures {
  public:
    Mixtures(const SpreadPicture& picture, std::span<const float> nearness, float step)
        : picture_(picture), nearness_(nearness), step_(step) {}

    struct Found {
        float share = 0;
        std::size_t clear = 0;   // an unmixed pixel of the other surface
    };
    Found at(int x, int y) const {
        Found found;
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) look(x, y, dx, dy, found);
        return found;
    }

  private:
    bool inside(int x, int y) const { return x >= 0 && x < picture_.width && y >= 0 && y < picture_.height; }
    std::size_t index(int x, int y) const { return std::size_t(y) * picture_.width + x; }

    /// Farthest pixel within `count` steps that belongs to the surface at (x, y).
    std::size_t clear_of_edge(int x, int y, int dx, int dy, int count) const {
        const std::size_t first = index(x, y);
        std::size_t last = first;
        for (int k = 1; k <= count && inside(x + k * dx, y + k * dy); ++k) {
            const std::size_t next = index(x + k * dx, y + k * dy);
            if (!(std::abs(nearness_[next] - nearness_[first]) <= step_)) break;
            last = next;
        }
        return last;
    }
    void look(int x, int y, int dx, int dy, Found& found) const {
        const std::size_t i = index(x, y);
        for (int d = 1; d <= kMixed && inside(x + d * dx, y + d * dy); ++d) {
            const std::size_t n = index(x + d * dx, y + d * dy);
            if (!(std::abs(nearness_[n] - nearness_[i]) > step_)) continue;
            const std::size_t there = clear_of_edge(x + d * dx, y + d * dy, dx, dy, kMixed);
            const std::size_t here = clear_of_edge(x, y, -dx, -dy, kMixed + 1 - d);
            if (here == i || !picture_.finite(here) || !picture_.finite(there)) return;   // no reference
            float variation = 0;
            for (int k = 1; k <= 3 && inside(x - (kMixed + k) * dx, y - (kMixed + k) * dy); ++k) {
                const std::size_t beyond = index(x - (kMixed + k) * dx, y - (kMixed + k) * dy);
                if (std::abs(nearness_[beyond] - nearness_[i]) <= step_)
                    variation = std::max(variation, square_distance(picture_.at(here), picture_.at(beyond)));
            }
            // The centre of a pixel is on its own surface, and filters are narrow.
            const float share = share_of_other(picture_.at(i), picture_.at(here), picture_.at(there), variation,
                                               d == 1 ? 0.5f : 0.1f);
            if (share > found.share) found = {share, there};
            return;
        }
    }

    const SpreadPicture& picture_;
    std::span<const float> nearness_;
    float step_;
};

inline Unmixed unmixed(const SpreadPicture& picture, std::span<const float> nearness, float step) {
    const std::size_t count = nearness.size();
    Unmixed out{{picture.values.begin(), picture.values.end()}, std::vector<float>(count, 1.f),
                std::vector<float>(picture.values.size()), std::vector<float>(count),
                std::vector<std::size_t>(count)};
    const Mixtures mixtures(picture, nearness, step);
    oneapi::tbb::parallel_for(0, picture.height, [&](int y) {
        for (int x = 0; x < picture.width; ++x) {
            const std::size_t i = std::size_t(y) * picture.width + x;
            const Mixtures::Found found = picture.finite(i) ? mixtures.at(x, y) : Mixtures::Found{};
            if (!(found.share > 0)) continue;
            out.other_at[i] = found.clear;
            out.other_cover[i] = found.share;
            out.own_cover[i] = 1 - found.share;
            for (int c = 0; c < kSpreadColours; ++c) {
                out.other[kSpreadColours * i + c] = found.share * picture.at(found.clear)[c];
                out.own[kSpreadColours * i + c] -= out.other[kSpreadColours * i + c];
            }
        }
    });
    return out;
}

}  // namespace dg
