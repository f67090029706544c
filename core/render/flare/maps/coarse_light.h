// coarse_light.h -- accumulates smooth light on a grid of nodes several pixels apart, which is cheaper than in pixels,
// and resamples it to pixels. Sums are integers, so that they are bit-identical in any order and for any split of the
// samples: light is rounded once, when it is added to a node, and resampling weights are fractions of powers of two.
#pragma once
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "film/film.h"
#include "render/dispersion.h"
#include "render/flare/maps/color_table.h"

namespace dg {

class CoarseLight {
  public:
    static constexpr int kMostLevel = 5;   // 32 px from node to node
    /// Distance outside the region from which light reaches it, px.
    static float reach(float level) { return 2.5f * std::exp2(level); }

    /// Light x px^2 at a position in the frame, px.
    struct Arrival {
        Vec2f px;
        FilmColor light;
        float variance = 1;   // factor on its square in the variance: less than 1 if another arrival cancels most of it
        /// R, G and B for the variance instead: the sum of arrivals that count as one with this, or 0.
        std::optional<Rgb> as_one{};
    };

    /// Variance of the kernel of a level, px2 along an axis.
    static constexpr float variance(int level) { return 5 / 12.f * float(1 << 2 * level); }
    /// Variance of the widest kernel for a frame, from a fraction of its diagonal.
    static float widest(const Sensor& sensor);
    /// Fractional level with a kernel of that variance on average, if the fractional part is the probability of the
    /// next level.
    static float level_of(float variance, int finest, int coarsest);

    /// Largest variance of a filter that level 0 can represent, px2 along an axis.
    static constexpr double kWidestFilter = 0.6;

    /// Nodes 2^level px apart, up to kMostLevel, over a region of the frame and a margin. `values`: number of colour
    /// components. `mean`: approximate light of a pixel, which determines the rounding step. `bright`: approximate
    /// limit of a single arrival's light in a pixel, if larger. `filter_variance`: px2 along an axis; level 0 has nodes
    /// at the pixels, and its kernel approximates the filter.
    CoarseLight(const FilmLayout& region, int values, int level, double mean, double filter_variance, double bright = 0);

    /// Adds arrivals, each to the four nodes around it (a tent). Thread-safe.
    void add(std::span<const Arrival> arrivals);
    /// Adds the light of levels to a film, multiplied by the number of samples of each pixel.
    static void to_film(std::span<const std::unique_ptr<CoarseLight>> levels, Film& film, const FilmDensity& density,
                        int threads);
    /// Adds the light to rows [first, last) of the film's region.
    void to_film(Film& film, const FilmDensity& density, int first, int last) const;

  private:
    static constexpr int kMargin = 2;      // nodes outside the frame
    static constexpr int kSquares = 3;     // squares of R, G and B, stored before the colour
    static constexpr int kBandRows = 8;    // rows of nodes per lock

    struct Node {
        int column, row;
        float x, y;   // position relative to the node, in node spacings
    };
    Vec2f in_nodes(Vec2f px) const;
    std::optional<Node> node_of(Vec2f px) const;
    void add(const Arrival& a, const Node& at);

    int level_, zero_x_, zero_y_, columns_, rows_, values_;   // zero: index of the node at 0; values: per node
    std::int64_t sharpen_;                  // factor on the second difference, in units of the weights
    int bits_, square_bits_;                // steps are 2^-bits
    double to_steps_, to_square_steps_;
    std::vector<std::int64_t> nodes_;
    std::vector<std::mutex> locks_;         // per band of rows
};

}  // namespace dg
