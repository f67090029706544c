// coarse_light.h -- smooth light on a grid of nodes some pixels apart, which takes far fewer sums than pixels do, and how
// it comes to the pixels. All of it is whole steps, so that no order and no part of the samples changes a bit: light is
// rounded once, when it is added to a node, and goes from nodes to pixels by weights that are fractions of powers of two.
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
    /// How far beside the region light may land and come to it, px.
    static float reach(float level) { return 2.5f * std::exp2(level); }

    /// Light x px^2 at a place of the frame, px.
    struct Arrival {
        Vec2f px;
        FilmColor light;
        float variance = 1;   // share of its square that counts: less where another arrival takes most of it away
        /// R, G and B whose squares count instead: all the light of those that arrive as one with this, or none.
        std::optional<Rgb> as_one{};
    };

    /// Variance of the kernel of a level, px2 along an axis.
    static constexpr float variance(int level) { return 5 / 12.f * float(1 << 2 * level); }
    /// Variance of the widest kernel that a frame takes: RMS, a share of its diagonal.
    static float widest(const Sensor& sensor);
    /// The level whose kernel has that variance in the mean, if the part after the point is the chance of the next one.
    static float level_of(float variance, int finest, int coarsest);

    /// A filter of a larger variance, px2 along an axis, is not drawn on level 0.
    static constexpr double kWidestFilter = 0.6;

    /// Nodes 2^level px apart, up to kMostLevel, over a part of the frame and some more. `values`: how many of a colour
    /// there are. `mean`: light of a pixel, about, as small parts of which values are rounded; `bright`: of a pixel by one
    /// arrival, at most, about, if that is more. `filter_variance`: px2 along an axis; light of level 0, whose nodes are the
    /// pixels, is as wide as that filter, and almost of its shape.
    CoarseLight(const FilmLayout& region, int values, int level, double mean, double filter_variance, double bright = 0);

    /// Adds them, each to the four nodes around it (a tent). From any thread at any time.
    void add(std::span<const Arrival> arrivals);
    /// Adds all light of some levels to a film, times the samples that were drawn of each pixel.
    static void to_film(std::span<const std::unique_ptr<CoarseLight>> levels, Film& film, const FilmDensity& density,
                        int threads);
    /// Adds it to rows [first, last) of the film's region.
    void to_film(Film& film, const FilmDensity& density, int first, int last) const;

  private:
    static constexpr int kMargin = 2;      // nodes beside the frame
    static constexpr int kSquares = 3;     // of R, G and B, before the colour
    static constexpr int kBandRows = 8;    // of nodes under one lock

    struct Node {
        int column, row;
        float x, y;   // a place from there, in pitches
    };
    Vec2f in_nodes(Vec2f px) const;
    std::optional<Node> node_of(Vec2f px) const;
    void add(const Arrival& a, const Node& at);

    int level_, zero_x_, zero_y_, columns_, rows_, values_;   // index of the node at 0; values: of a node
    std::int64_t sharpen_;                  // of the second difference, in parts of the weights
    int bits_, square_bits_;                // steps are 2^-bits
    double to_steps_, to_square_steps_;
    std::vector<std::int64_t> nodes_;
    std::vector<std::mutex> locks_;         // of bands of rows
};

}  // namespace dg
