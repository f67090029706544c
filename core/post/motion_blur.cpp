#include "post/motion_blur.h"

#include <limits>
#include <string>

#include "math/error.h"
#include "math/vec.h"
#include "post/hidden.h"
#include "post/mixed.h"

namespace dg {
namespace {

constexpr double kGauss = 0.28867513459481288;   // 1 / sqrt(12)
constexpr double kFarthest = 1e5;   // px of motion; faster pixels cross any image unseen
constexpr double kMostLayers = 1e9;

class MotionKernel {
  public:
    static constexpr bool kRunningSums = false;

    /// `motion`: four numbers per pixel, to the next frame and back to the previous.
    MotionKernel(std::span<const float> motion, std::span<const float> nearness, double layers_per_step,
                 const ShutterTime& shutter)
        : motion_(motion), nearness_(nearness), layers_(layers_per_step), shutter_(shutter),
          frames_(std::max(std::abs(shutter.open), std::abs(shutter.close))) {}

    bool takes_part(std::size_t i) const {
        const float* m = motion_.data() + 4 * i;
        const double way = double(std::abs(m[0])) + std::abs(m[1]) + std::abs(m[2]) + std::abs(m[3]);
        return std::isfinite(nearness_[i]) && frames_ * way <= kFarthest;   // false for NaN
    }
    float reach(std::size_t i) const {
        return 1 + float(std::max(length(place(i, shutter_.open)), length(place(i, shutter_.close))));
    }
    /// Largest displacement between two pixels.
    float parting(std::size_t i, std::size_t j) const {
        return float(std::max(length(place(i, shutter_.open) - place(j, shutter_.open)),
                              length(place(i, shutter_.close) - place(j, shutter_.close))));
    }
    int layer(std::size_t i) const {
        return int(std::lround(std::clamp(layers_ * nearness_[i], -kMostLayers, kMostLayers)));
    }

    void spread(std::size_t i, int x, int y, const SpreadLight& light, SpreadLayer& to) const {
        const double times[] = {shutter_.open, std::clamp(0.0, shutter_.open, shutter_.close), shutter_.close};
        for (int k = 0; k < 2; ++k) {
            const bool first = k == 0;   // an exposure of zero length is an instant
            if (times[k] < times[k + 1] || (first && times[0] == times[2]))
                draw_line(i, {double(x), double(y)}, times[k], times[k + 1], light, to);
        }
    }

  private:
    Vec2d place(std::size_t i, double frames) const {
        const float* m = motion_.data() + 4 * i + (frames < 0 ? 2 : 0);
        return std::abs(frames) * Vec2d{m[0], m[1]};
    }
    double fraction(double time) const {
        return shutter_.close > shutter_.open ? (time - shutter_.open) / (shutter_.close - shutter_.open) : 0;
    }

    /// Splats straight motion between two moments. Between grid lines of pixel centres, the
    /// bilinear weights are quadratic in time, so two-point Gauss-Legendre quadrature is exact.
    void draw_line(std::size_t i, Vec2d pixel, double from, double till, const SpreadLight& light,
                   SpreadLayer& to) const {
        const Vec2d begin = pixel + place(i, from), way = pixel + place(i, till) - begin;
        const auto crossing = [](double at, double along) {   // time to the next grid line, and between grid lines
            const double left = along > 0 ? std::floor(at) + 1 - at : at - std::ceil(at) + 1;
            const double per_line = along == 0 ? 2 : 1 / std::abs(along);
            return Vec2d{left * per_line, per_line};
        };
        Vec2d across = crossing(begin.x, way.x), down = crossing(begin.y, way.y);
        double done = 0, arrived = shutter_.until(fraction(from));
        while (done < 1) {
            const double next = std::min({across.x, down.x, 1.0});
            if (across.x <= next) across.x += across.y;
            if (down.x <= next) down.x += down.y;
            const double then = next < 1 || till < shutter_.close ? shutter_.until(fraction(from + next * (till - from))) : 1;
            for (const double place : {0.5 - kGauss, 0.5 + kGauss})
                draw(begin + way * (done + place * (next - done)), light, 0.5 * (then - arrived), to);
            done = next, arrived = then;
        }
    }

    /// Bilinear splat onto four pixels.
    static void draw(Vec2d at, const SpreadLight& light, double weight, SpreadLayer& to) {
        const double left = std::floor(at.x), top = std::floor(at.y);
        const double u = at.x - left, v = at.y - top;
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const int x = int(left) + i, y = int(top) + j;
                const double share = (i ? u : 1 - u) * (j ? v : 1 - v);
                if (share > 0 && x >= to.x0 && x < to.x1 && y >= to.y0 && y < to.y1)
                    to.row(y)[x - to.x0].add(light, weight * share);
            }
    }

    std::span<const float> motion_, nearness_;
    double layers_;
    const ShutterTime& shutter_;
    double frames_;
};

void check(const ShutterTime& shutter) {
    if (!(std::isfinite(shutter.open) && std::isfinite(shutter.close) && shutter.open <= shutter.close))
        throw input_error("motion blur", "shutter", "times that do not decrease",
                          std::to_string(shutter.open) + " to " + std::to_string(shutter.close));
    if (shutter.arrived.size() < 2)
        throw input_error("motion blur", "light that has arrived", "at least two shares",
                          std::to_string(shutter.arrived.size()));
}

std::vector<float> both_ways(const PixelMotion& motion) {
    std::vector<float> out(2 * motion.next.size());
    for (std::size_t i = 0; i < motion.next.size() / 2; ++i)
        for (int c = 0; c < 2; ++c) {
            out[4 * i + c] = motion.next[2 * i + c];
            out[4 * i + 2 + c] = motion.last[2 * i + c];
        }
    return out;
}

}  // namespace

double ShutterTime::until(double fraction) const {
    const double place = fraction * double(arrived.size() - 1);
    const std::size_t i = std::min(std::size_t(place), arrived.size() - 2);
    return arrived[i] + (place - double(i)) * (arrived[i + 1] - arrived[i]);
}

std::vector<float> motion_blur(int width, std::span<const float> values, const PixelMotion& motion,
                               std::span<const float> nearness, float step, const ShutterTime& shutter,
                               SpreadRows rows) {
    const int height = width > 0 ? int(nearness.size() / width) : 0;
    DG_CHECK(values.size(), ==, kSpreadColours * nearness.size());
    DG_CHECK(motion.next.size(), ==, 2 * nearness.size());
    DG_CHECK(motion.last.size(), ==, 2 * nearness.size());
    check(shutter);
    if (!(step > 0 && std::isfinite(step)))
        throw input_error("motion blur", "step", "> 0", std::to_string(step));
    const SpreadPicture picture{width, height, values};
    const std::vector<float> paths = both_ways(motion);
    const MotionKernel kernel(paths, nearness, 1 / step, shutter);
    const Unmixed parts = unmixed(picture, nearness, step);
    const SpreadPicture own{width, height, parts.own, parts.own_cover};
    float farthest = 0;
    for (std::size_t i = 0; i < nearness.size(); ++i)
        if (kernel.takes_part(i)) farthest = std::max(farthest, kernel.reach(i));
    const HiddenSurface hidden = hidden_surface(
        {nearness, step, 2 * farthest}, own, paths, 4,
        [&](std::size_t near, std::size_t far) { return kernel.parting(near, far); });
    std::vector<float> behind(hidden.weights.size());   // a single layer
    for (std::size_t i = 0; i < behind.size(); ++i)
        if (!(hidden.weights[i] > 0)) behind[i] = std::numeric_limits<float>::quiet_NaN();
    const MotionKernel hidden_kernel(hidden.numbers, behind, 1, shutter);
    std::vector<float> other_nearness(nearness.size()), other_paths(paths.size());
    for (std::size_t i = 0; i < nearness.size(); ++i) {
        other_nearness[i] = nearness[parts.other_at[i]];
        std::copy_n(paths.begin() + 4 * parts.other_at[i], 4, other_paths.begin() + 4 * i);
    }
    const MotionKernel other_kernel(other_paths, other_nearness, 1 / step, shutter);
    const SpreadSource<MotionKernel> seen[] = {{own, kernel},
                                               {{width, height, parts.other, parts.other_cover}, other_kernel}};
    const SpreadSource<MotionKernel> hidden_source{{width, height, hidden.values}, hidden_kernel};
    return spread<MotionKernel>(picture, seen, hidden_source, rows);
}

}  // namespace dg
