// live_ghost.h -- a ghost of a small source for interactive previews: a mesh of exact rays, drawn by a large number of
// interpolated arrivals.
//
// A grid of rays finds the part of the front where the ghost's light enters, and estimates its brightness. A subset of
// the nodes stores derivatives of the landing with respect to wavelength and source point. Squares with an edge or with
// curved landings are refined if they are bright enough.
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
    /// The arguments except the sensor must outlive this. `known`: approximate region and spectra; may be null.
    LiveGhost(const MapRays& rays, const LiveSource& source, const Sensor& sensor, std::uint64_t key,
              const KnownGhost* known = nullptr);

    bool empty() const { return squares_.empty(); }
    /// Adds the approximate light of the ghost.
    void add_to(FlareTiles& tiles) const;
    /// Computes the worth of the ghost, which its number of arrivals is proportional to.
    double weigh(const FlareTiles& tiles);
    /// Worth of squares with steep transmittance.
    double steep_worth() const;
    /// Region and spectra for the cache, at a resolution for the ghost's `share` of `arrivals`.
    GhostPlace place(double arrivals, double share);
    /// Prepares drawing. `arrivals`: number of arrivals per unit of weigh().
    void refine(double arrivals);
    /// Draws the arrivals. `unit`: light of a pixel per light and unit area of the front's square.
    void draw(LightLayer& layer, float unit);

    std::size_t rays() const { return traced_; }
    std::size_t arrivals() const { return arrived_; }
    /// Number of arrivals by exact rays.
    std::size_t ray_arrivals() const { return by_rays_; }

  private:
    static constexpr int kSide = GhostGrid::kSide, kNodes = kSide * kSide;
    static constexpr int kSub = 4, kSubSide = kSub + 1, kSubNodes = kSubSide * kSubSide;   // finer grid of a square
    enum class Way : std::uint8_t { mesh, ray, dark };   // method for arrivals
    using Ways = std::array<Way, kSub * kSub>;
    struct Square {
        int x, y;
        float light = 0, root = 0;         // mean and RMS of the sampled light
        bool edge = false, lost = false;   // a ray is blocked; a ray has no landing
        bool steep = false;                // large variation of transmittance
        Vec2f px{};            // approximate landing
        double worth = 0;      // in arrivals
        int fine = -1;         // index of its first value in fine_; -1: no finer grid
        int ways = -1;         // index in ways_; -1: the same method for the whole square
        CellBlur blur{};
    };
    struct Few {               // data at a node of the coarse subset
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
        std::vector<int> few, node;   // indices in few_, and the grid node that is traced for each
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
    const KnownGhost* known_;          // may be null
    std::uint32_t first_;              // index of its first random number
    GhostGrid grid_;
    std::vector<float> planes_;        // values of the grid's nodes, field by field
    std::vector<float> fine_;          // values of the nodes of finer grids
    std::vector<Ways> ways_;           // for finer grids where rays are lost
    std::vector<Square> squares_;
    int step_ = 0, few_side_ = 0;      // squares between nodes of the coarse subset; its nodes along each axis
    std::vector<Few> few_;
    SheetSmooth smooth_{};
    std::size_t traced_ = 0, arrived_ = 0, by_rays_ = 0;
};

}  // namespace dg
