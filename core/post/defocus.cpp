#include "post/defocus.h"

#include <limits>

#include "math/error.h"
#include "post/hidden.h"
#include "post/mixed.h"
#include "post/spread.h"

namespace dg {
namespace {

constexpr float kStep = 1;   // px, difference of radii from which a surface occludes another
constexpr double kLayersPerE = 4;   // layers per factor e of the radius; the same number per px near the focus

class DefocusKernel {
  public:
    static constexpr bool kRunningSums = true;

    DefocusKernel(const IrisShape& iris, std::span<const float> radius) : kernels_(iris, radius), radius_(radius) {}

    bool takes_part(std::size_t i) const { return std::isfinite(radius_[i]); }
    float reach(std::size_t i) const { return kernels_.reach(radius_[i]); }
    int layer(std::size_t i) const { return int(std::lround(kLayersPerE * asinh(radius_[i]))); }

    void spread(std::size_t i, int x, int y, const SpreadLight& light, SpreadLayer& to) const {
        const IrisKernel& k = kernels_.at(radius_[i]);
        const int top = std::max(k.top, to.y0 - y), bottom = std::min(k.bottom, to.y1 - 1 - y);
        if (top > bottom || x + k.right < to.x0 || x + k.left >= to.x1) return;
        const auto first = k.steps.begin() + k.begin(top), last = k.steps.begin() + k.begin(bottom + 1);
        const bool inside = x + k.left >= to.x0 && x + k.right + 1 < to.x1;
        if (inside) {
            SpreadLight* const origin = to.light.data() + std::ptrdiff_t(y - to.y0) * kSpreadTile + (x - to.x0);
            for (auto s = first; s != last; ++s)
                origin[std::ptrdiff_t(s->dy) * kSpreadTile + s->dx].add(light, s->change);
            return;
        }
        for (auto s = first; s != last; ++s) {   // changes left of the tile apply at its edge
            const int at = std::max(x + s->dx, to.x0);
            if (at < to.x1) to.row(y + s->dy)[at - to.x0].add(light, s->change);
        }
    }

  private:
    IrisKernels kernels_;
    std::span<const float> radius_;
};

/// Depth of the search behind edges: the largest displacement between surfaces as seen from the rim
/// of the lens.
float parallax(std::span<const float> radius) {
    float low = 0, high = 0;
    for (const float r : radius)
        if (std::isfinite(r)) low = std::min(low, r), high = std::max(high, r);
    return high - low;
}

}  // namespace

std::vector<float> defocus(int width, std::span<const float> values, std::span<const float> radius,
                           const IrisShape& iris, SpreadRows rows) {
    const int height = width > 0 ? int(radius.size() / width) : 0;
    DG_CHECK(values.size(), ==, kSpreadColours * radius.size());
    const SpreadPicture picture{width, height, values};
    const Unmixed parts = unmixed(picture, radius, kStep);
    const SpreadPicture own{width, height, parts.own, parts.own_cover};
    const double rim = iris.outer_radius;
    HiddenSurface hidden = hidden_surface(
        {radius, kStep, float(rim) * parallax(radius) + 1}, own, radius, 1,
        [&](std::size_t near, std::size_t far) { return float(rim) * (radius[near] - radius[far]); });
    for (std::size_t i = 0; i < radius.size(); ++i)
        if (!(hidden.weights[i] > 0)) hidden.numbers[i] = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> other(radius.size());
    for (std::size_t i = 0; i < radius.size(); ++i) other[i] = radius[parts.other_at[i]];
    const DefocusKernel own_kernel(iris, radius), other_kernel(iris, other), hidden_kernel(iris, hidden.numbers);
    const SpreadSource<DefocusKernel> seen[] = {{own, own_kernel},
                                                {{width, height, parts.other, parts.other_cover}, other_kernel}};
    const SpreadSource<DefocusKernel> behind{{width, height, hidden.values}, hidden_kernel};
    return spread<DefocusKernel>(picture, seen, behind, rows);
}

}  // namespace dg
