#include "render/flare/maps/coarse_light.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "math/hash.h"
#include "render/parallel.h"
#include "spectrum/wavelengths.h"

namespace dg {
namespace {

constexpr int kFraction = 30;       // bits of the step below the mean
constexpr int kSharpenBits = 8;     // bits of the weights of level 0
constexpr float kMost = 1 << 20;    // nodes: limit of the distance from the frame
constexpr double kTent = 1 / 6.0;   // variance of a tent
constexpr int kRowsOfTask = 32;         // film rows per task
constexpr double kOfFrame = 1 / 70.0;   // fraction of the diagonal: RMS width of the widest kernel along an axis

/// Exponent of the step, `bits` below a value, but limited by the bits that weights leave in a sum.
int bits_below(double value, int bits, int most) {
    const double wanted = value > 0 ? bits - std::floor(std::log2(value)) : 0;
    return int(std::clamp(wanted, -40.0, double(most)));
}

/// Integral of the squared kernel along an axis, in nodes. The kernel is a B-spline of degree 4, the convolution of a
/// tent and a quadratic B-spline; on level 0, a tent minus c times its second difference.
double square_of_kernel(int level, double c) {
    if (level > 0) return 0.43041478;
    return ((1 + 2 * c) * (1 + 2 * c) + 2 * c * c) * 2 / 3 - 4 * c * (1 + 2 * c) / 6;
}

/// Hash of a position, in [0, 1).
double chance_of(Vec2f px) {
    const std::uint64_t x = std::bit_cast<std::uint32_t>(px.x), y = std::bit_cast<std::uint32_t>(px.y);
    return hash_uniform(x << 32 | y, 0);
}

/// Fractional bits of the weights along an axis.
int weight_bits(int level) { return level > 0 ? 3 + 2 * level : kSharpenBits; }

/// The three nodes around a pixel center and their weights, times 2^weight_bits: a quadratic B-spline. On level 0,
/// where nodes are pixels, weights that widen a tent to the variance of the filter.
struct Weights {
    int first;
    std::array<std::int64_t, 3> of;
    /// `zero`: index of the node at 0.
    Weights(int pixel, int level, std::int64_t sharpen, int zero) {
        if (level == 0) {
            of = {-sharpen, (1 << kSharpenBits) + 2 * sharpen, -sharpen}, first = pixel + zero - 1;
            return;
        }
        const std::int64_t p = std::int64_t(1) << level, twice = 2 * std::int64_t(pixel) + 1;   // pixel center
        const std::int64_t nearest = (twice + p) >> (level + 1);                                // rounded, in nodes
        const std::int64_t n = twice - nearest * 2 * p;                                         // in [-p, p)
        of = {(p - n) * (p - n), 6 * p * p - 2 * n * n, (p + n) * (p + n)};
        first = int(nearest) + zero - 1;
    }
};

}  // namespace

float CoarseLight::widest(const Sensor& sensor) {
    const double width = kOfFrame * hypot(sensor.width, sensor.height);
    return float(width * width);
}

float CoarseLight::level_of(float variance, int finest, int coarsest) {
    const float squared = std::clamp(variance, CoarseLight::variance(finest), CoarseLight::variance(coarsest)) /
                          CoarseLight::variance(0);
    int k = finest;
    float own = float(1 << 2 * finest);   // 4^k
    while (k + 1 < coarsest && squared >= 4 * own) ++k, own *= 4;
    return float(k) + std::clamp((squared - own) / (3 * own), 0.f, 1.f);
}

CoarseLight::CoarseLight(const FilmLayout& region, int values, int level, double mean, double filter_variance,
                         double bright)
    : level_(level), zero_x_(kMargin - (region.offset_x >> level)), zero_y_(kMargin - (region.offset_y >> level)),
      columns_(((region.offset_x + region.width) >> level) + zero_x_ + 2 + kMargin),
      rows_(((region.offset_y + region.height) >> level) + zero_y_ + 2 + kMargin),
      values_(kSquares + values), sharpen_(std::lround((kTent - filter_variance) / 2 * (1 << kSharpenBits))),
      bits_(bits_below(mean, kFraction, ValueSum::kBits - 2 * weight_bits(level))),
      square_bits_(bits_below(std::max(mean * mean, bright * bright), kFraction,
                              SquareSum::kBits - 2 * weight_bits(level))),
      to_steps_(std::ldexp(1.0, bits_ - 2 * level)), nodes_(std::size_t(columns_) * rows_ * values_),
      locks_(rows_ / kBandRows + 1) {
    const double square = square_of_kernel(level, double(sharpen_) / (1 << kSharpenBits));
    to_square_steps_ = std::ldexp(square * square, square_bits_ - 4 * level);
}

/// Position in node spacings, with node kMargin at 0 for every region of the frame. Nodes of level 0 are at pixel
/// centers.
Vec2f CoarseLight::in_nodes(Vec2f px) const {
    const float per_pitch = 1 / float(1 << level_), zero = kMargin - (level_ == 0 ? 0.5f : 0);
    return {px.x * per_pitch + zero, px.y * per_pitch + zero};
}

/// The upper left of the four nodes around a position; empty if it is too far from the region.
std::optional<CoarseLight::Node> CoarseLight::node_of(Vec2f px) const {
    const Vec2f at = in_nodes(px);
    if (!(at.x >= 0 && at.y >= 0 && at.x < kMost && at.y < kMost)) return std::nullopt;
    const int x = int(at.x), y = int(at.y), column = x - kMargin + zero_x_, row = y - kMargin + zero_y_;
    if (column < 0 || row < 0 || column + 1 >= columns_ || row + 1 >= rows_) return std::nullopt;
    return Node{column, row, at.x - float(x), at.y - float(y)};
}

/// Adds arrivals band by band, to share locks.
void CoarseLight::add(std::span<const Arrival> arrivals) {
    std::vector<std::uint32_t> begin(locks_.size() + 1), order(arrivals.size());
    std::vector<std::optional<Node>> nodes(arrivals.size());
    for (std::size_t i = 0; i < arrivals.size(); ++i)
        if ((nodes[i] = node_of(arrivals[i].px))) ++begin[nodes[i]->row / kBandRows + 1];
    for (std::size_t k = 1; k < begin.size(); ++k) begin[k] += begin[k - 1];
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (std::size_t i = 0; i < arrivals.size(); ++i)
        if (nodes[i]) order[next[nodes[i]->row / kBandRows]++] = std::uint32_t(i);
    for (std::size_t band = 0; band + 1 < begin.size(); ++band) {
        if (begin[band] == begin[band + 1]) continue;
        const std::lock_guard own(locks_[band]);   // the last row also adds to the first row of the band below
        const std::unique_lock below = band + 1 < locks_.size() ? std::unique_lock(locks_[band + 1])
                                                                : std::unique_lock<std::mutex>();
        for (std::uint32_t k = begin[band]; k < begin[band + 1]; ++k) add(arrivals[order[k]], *nodes[order[k]]);
    }
}

/// Truncates light to whole steps; the error is far below the noise. Squares of dim arrivals may be below a step: for
/// arrivals that count as one, they are rounded stochastically.
void CoarseLight::add(const Arrival& a, const Node& at) {
    const Rgb rgb = a.as_one ? *a.as_one : rgb_from_xyz({a.light[0], a.light[1], a.light[2]});
    const double up = a.as_one ? chance_of(a.px) : 0;
    double steps[kSquares + std::tuple_size_v<FilmColor>];
    for (int c = 0; c < kSquares; ++c) steps[c] = to_square_steps_ * double(a.variance) * double(rgb[c]) * rgb[c];
    for (int c = kSquares; c < values_; ++c) steps[c] = to_steps_ * double(a.light[c - kSquares]);
    const double fx = at.x, fy = at.y;
    for (int k = 0; k < 4; ++k) {
        const double w = (k & 1 ? fx : 1 - fx) * (k & 2 ? fy : 1 - fy);
        std::int64_t* const node = &nodes_[(std::size_t(at.row + (k >> 1)) * columns_ + at.column + (k & 1)) * values_];
        for (int c = 0; c < kSquares; ++c) node[c] += std::int64_t(steps[c] * w + up);
        for (int c = kSquares; c < values_; ++c) node[c] += std::int64_t(steps[c] * w);
    }
}

void CoarseLight::to_film(std::span<const std::unique_ptr<CoarseLight>> levels, Film& film, const FilmDensity& density,
                          int threads) {
    const FilmLayout& region = density.region();
    const int bands = (region.height + kRowsOfTask - 1) / kRowsOfTask;
    parallel_tasks(threads, bands, [&](std::int64_t band) {
        const int first = region.offset_y + int(band) * kRowsOfTask;
        const int last = std::min(first + kRowsOfTask, region.offset_y + region.height);
        for (const auto& light : levels) light->to_film(film, density, first, last);
    });
}

void CoarseLight::to_film(Film& film, const FilmDensity& density, int first, int last) const {
    const FilmLayout& region = density.region();
    const int weight_bits = 2 * dg::weight_bits(level_), channels = values_ - kSquares - 3;
    std::vector<Int128> down(std::size_t(columns_) * values_);
    std::vector<Film::FlareSteps> row(region.width);
    std::vector<Int128> own_channels(std::size_t(channels) * region.width);
    for (int y = first; y < last; ++y) {
        const Weights wy(y, level_, sharpen_, zero_y_);
        const std::size_t width = std::size_t(columns_) * values_;
        const std::int64_t* const nodes = &nodes_[wy.first * width];
        for (std::size_t i = 0; i < width; ++i)
            down[i] = Int128(wy.of[0]) * nodes[i] + Int128(wy.of[1]) * nodes[i + width] +
                      Int128(wy.of[2]) * nodes[i + 2 * width];
        for (int x = 0; x < region.width; ++x) {
            const Weights wx(region.offset_x + x, level_, sharpen_, zero_x_);
            const auto count = std::int64_t(density.count({region.offset_x + x, y}));
            const auto steps = [&](int c, int bits, std::int64_t times) {
                const Int128* const at = &down[std::size_t(wx.first) * values_ + c];
                const Int128 sum = wx.of[0] * at[0] + wx.of[1] * at[values_] + wx.of[2] * at[2 * values_];
                return Int128(UInt128(sum * times) << (bits - weight_bits));
            };
            const int bits = ValueSum::kBits - bits_, square_bits = SquareSum::kBits - square_bits_;
            for (int c = 0; c < 3; ++c) {
                row[x].squares[c] = steps(c, square_bits, count * count);
                row[x].xyz[c] = steps(kSquares + c, bits, count);
            }
            for (int c = 0; c < channels; ++c)
                own_channels[std::size_t(x) * channels + c] = steps(kSquares + 3 + c, bits, count);
        }
        film.add_flare_row(region.offset_x, y, row, own_channels);
    }
}

}  // namespace dg
