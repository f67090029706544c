// live_ghost.h -- a ghost of a small source for a picture that passes by: a mesh of exact rays, drawn by many arrivals that
// cost an interpolation each.
//
// A grid of rays finds the part of the front that the ghost comes through, and about how much light it brings. Some of its
// nodes know how wavelength and point of the source change the landing. Squares with an edge, or in which landings bend,
// have a finer grid if they bring enough light.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/flare/flare_tiles.h"
#include "render/flare/live/ghost_grid.h"
#include "render/flare/live/ghost_place.h"
#include "render/flare/live/light_layer.h"
#include "render/flare/live/live_source.h"
#include "render/flare/live/mesh_patch.h"
#include "render/flare/maps/sheet_level.h"

namespace dg {

class LiveGhost {
  public:
    /// All but the sensor outlives this. `known`: where it comes in and how its glass is, about; null: nothing is known.
    LiveGhost(const MapRays& rays, const LiveSource& source, const Sensor& sensor, std::uint64_t key,
              const KnownGhost* known = nullptr);

    bool empty() const { return squares_.empty(); }
    /// Adds its light, about.
    void add_to(FlareTiles& tiles) const;
    /// How many arrivals it is worth beside other ghosts.
    double weigh(const FlareTiles& tiles);
    /// The part of it in squares with steep transmittance.
    double steep_worth() const;
    /// Where it comes in and how its glass is, as finely as so many arrivals are worth of which it gets a share.
    GhostPlace place(double arrivals, double share);
    /// Finds all that drawing takes, for so many arrivals for each unit of weigh().
    void refine(double arrivals);
    /// `unit`: light of a pixel for light and unit areas of the front's square.
    void draw(LightLayer& layer, float unit);

    std::size_t rays() const { return traced_; }
    std::size_t arrivals() const { return arrived_; }
    /// Arrivals that were rays of their own.
    std::size_t ray_arrivals() const { return by_rays_; }

  private:
    static constexpr int kSide = GhostGrid::kSide, kNodes = kSide * kSide;
    static constexpr int kSub = 4, kSubSide = kSub + 1, kSubNodes = kSubSide * kSubSide;   // squares of a finer grid
    enum class Way : std::uint8_t { mesh, ray, dark };   // of arrivals
    using Ways = std::array<Way, kSub * kSub>;
    struct Square {
        int x, y;
        float light = 0, root = 0;         // of what looks saw: mean, and root of the mean square
        bool edge = false, lost = false;   // some rays are stopped; some have no landing
        bool steep = false;                // transmittance changes much
        Vec2f px{};            // where it lands, about
        double worth = 0;      // arrivals
        int fine = -1;         // first value of its own nodes
        int ways = -1;         // of ways_: those of the squares of its finer grid; none: all are alike
        CellBlur blur{};
    };
    struct Few {               // at one of few nodes of the grid
        MeshPatch::Sets sets{};
        GhostPlace::Spectrum spectrum{};
        CellBlur blur{};
        bool sound = false, blurs = false;
    };

    std::vector<MapLanding> trace(const std::vector<MapRay>& rays) {
        traced_ += rays.size();
        return rays_.trace(rays);
    }
    void look(Square& square, MapBatch& batch, const GlassChange& glass);
    using GroupColors = std::array<Rgb, LiveSource::kGroups>;
    GroupColors colors_of(const Few& few, float times) const;
    bool apart(const Square& square, const MeshPatch& patch) const;
    struct Arrivals;
    void draw_mesh(LightLayer& layer, const SheetLevel& levels, const Square& square, const Arrivals& some, float times) const;
    void draw_rays(LightLayer& layer, const SheetLevel& levels, const Square& square, const Arrivals& some, float times);
    template <typename Place>
    void set(MapBatch& batch, const Arrivals& some, const Place& place) const;
    template <typename Color>
    void add(LightLayer& layer, const SheetLevel& levels, const Square& square, const MapBatch& batch, const Arrivals& some,
             const Color& color) const;
    void look_around();
    GhostPlace::Spectrum glass();
    std::optional<int> sound_near(int few) const;
    bool matters(int few) const;
    void divide(double own_arrivals);
    struct FewNodes {
        std::vector<int> few, node;   // of few_, and the node of the grid in whose place each is traced
    };
    FewNodes few_nodes() const;
    Vec2f place_of(int node) const { return grid_.at({float(node % kSide), float(node / kSide)}); }
    std::vector<GhostPlace::Spectrum> spectra(const std::vector<int>& nodes);
    void trace_sets(const FewNodes& nodes);
    void set_spectra(const FewNodes& nodes);
    void fill_few(const FewNodes& nodes);
    void find_blur();
    const CellBlur& blur_near(const Square& square) const;
    bool bends(const Square& square) const;
    bool is_steep(const Square& square) const;
    void refine(Square& square);
    Ways ways_of(const std::vector<MapLanding>& nodes) const;
    Way way(const Square& square, Vec2f at) const;
    MeshPatch patch(const Square& square) const;
    void land_by_rays(const Square& square, MapBatch& batch, int count);
    float least_level(const Square& square) const;
    Few few_at(Vec2f node) const;
    const MapLanding& node(int x, int y) const { return grid_.nodes[std::size_t(y) * kSide + x]; }

    const MapRays& rays_;
    const LiveSource& source_;
    Sensor sensor_;
    const KnownGhost* known_;          // or null
    std::uint32_t first_;              // of its numbers
    GhostGrid grid_;
    std::vector<float> planes_;        // of the grid's nodes, field by field
    std::vector<float> fine_;          // of the nodes of finer grids
    std::vector<Ways> ways_;           // of finer grids where rays are lost
    std::vector<Square> squares_;
    int step_ = 0, few_side_ = 0;      // squares from one of few nodes to the next; nodes across
    std::vector<Few> few_;
    SheetSmooth smooth_{};
    std::size_t traced_ = 0, arrived_ = 0, by_rays_ = 0;
};

}  // namespace dg
