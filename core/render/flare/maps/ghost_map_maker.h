// ghost_map_maker.h -- builds the cells of a ghost's map from coarse to fine: cells that are dark or land outside the
// frame are dropped, cells that are not smooth are divided.
#pragma once
#include <limits>
#include <vector>

#include "render/flare/maps/ghost_map.h"

namespace dg {

class GhostMapMaker {
  public:
    GhostMapMaker(GhostMap& map, const MapRays& rays, const Sensor& sensor, float reach,
                  const GhostMap::Accuracy& accuracy);
    void make();

  private:
    using Rays = std::vector<MapRay>;
    using Landings = std::vector<MapLanding>;
    struct Draft {
        Vec2f low;
        float size;
        int level;
    };
    /// Classification of a draft; `lost`: a ray has no landing.
    enum class Verdict { dark, smooth, rough, lost };
    struct Range {
        float low = std::numeric_limits<float>::infinity(), high = -low;
        void add(float v) { low = std::min(low, v), high = std::max(high, v); }
        float size() const { return high - low; }
        bool holds_zero() const { return low < 0 && high > 0; }
    };
    /// Scales for relative errors.
    struct Scale {
        Range beyond, x, y;   // over the cell
        CellBlur blur;
        float light, slack;
    };

    static constexpr int kTests = 3;   // near the maxima of a cubic's interpolation error
    static constexpr Vec2f kTestAt[kTests] = {{1 / 6.f, 1 / 6.f}, {5 / 6.f, 0.5f}, {0.5f, 5 / 6.f}};
    static constexpr int kSeen = GhostMap::kNodes + kTests;   // rays from the source's center in the first look
    static constexpr int kLook = kSeen + 2;                   // with two rays from the source's rim
    static constexpr int kMiddle = 1;                         // index of the middle node of the wavelength
    static const int kMore;                                   // rays that complete a cell

    Landings trace(const Rays& rays) {
        map_.rays_ += rays.size();
        return rays_.trace(rays);
    }
    Vec2f at(const Draft& d, Vec2f u) const { return map_.region_.at(d.low + u * d.size); }
    // ghost_map_make.cpp
    bool zoom();
    void find_sound();
    void propose(const Draft& d, std::vector<Draft>& to) const;
    void look(const Draft& d, Rays& rays) const;
    void refine(const std::vector<Draft>& drafts, std::vector<Draft>& next);
    void give_up(const Draft& d) { map_.cells_.push_back({d.low, d.size, 0, true, {}}); }
    void divide(const Draft& d, std::vector<Draft>& next);
    void sort();
    // ghost_map_judge.cpp
    Verdict judge(const MapLanding* seen, int level, CellBlur& blur) const;
    bool dark_square(const MapLanding* const (&corner)[4]) const;
    bool surely_stopped(const MapLanding* nodes, float margin) const;
    float change_around(const MapLanding* nodes, int node) const;
    bool dark(const MapLanding* seen, int level, const CellBlur& blur) const;
    bool beside(const Range& x, const Range& y, float more) const;
    bool smooth(const MapLanding* seen, const CellBlur& blur) const;
    MapLanding by_cubics(const MapLanding* nodes, Vec2f u) const;
    bool agree(const MapLanding& map, const MapLanding& ray, const Scale& of) const;
    // ghost_map_fill.cpp
    void complete(const Draft& d, Rays& rays) const;
    bool add(const Draft& d, const MapLanding* seen, const MapLanding* more, const CellBlur& blur);
    void add_nodes(const MapLanding* seen, const MapLanding* more);
    void add_spectra(const MapLanding* seen, const MapLanding* fine, const MapLanding* corners);
    void add_bends(const MapLanding* star);
    bool colors_agree(const GhostMap::Cell& cell, const MapLanding* exact);
    Landings in_middle(const GhostMap::Cell& cell);

    GhostMap& map_;
    const MapRays& rays_;
    const Sensor& sensor_;
    float reach_;
    GhostMap::Accuracy accuracy_;
    MapBatch batch_{};
    std::vector<bool> near_sound_;   // per square
};

}  // namespace dg
