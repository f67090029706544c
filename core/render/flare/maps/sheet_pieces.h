// sheet_pieces.h -- the cells of a ghost's map, divided where edges run through them, as they are drawn: each piece by the
// light that looks at it see.
#pragma once
#include <vector>

#include "render/flare/flare_tiles.h"
#include "render/flare/maps/cell_numbers.h"
#include "render/flare/maps/ghost_map.h"
#include "render/flare/maps/sheet_level.h"
#include "render/flare/maps/small_source.h"

namespace dg {

/// A square of a cell.
struct SheetPiece {
    std::uint32_t cell;
    Vec2f low;             // in the cell
    float size;            // a share of the cell's
    float level;           // its light is smooth over 2^level px, in the mean
    bool gray = false;     // all wavelengths land together
    double share = 0;      // of all arrivals
    double doubt = 0;      // of all exact rays that ask whether the map is right

    Vec2f at(Vec2f u) const { return low + u * size; }   // in the cell
};

/// A unit of the front's square for each unit of a piece.
double area(const GhostMap& map, const SheetPiece& piece);
/// Sets a batch to places of a piece, by numbers, and points of the source.
void draw_places(MapBatch& batch, const SheetPiece& piece, const SmallSource& source, const CellNumbers& numbers,
                 int count);
/// The rays of a batch in a cell.
std::vector<MapRay> rays_of(const GhostMap& map, const GhostMap::Cell& cell, const MapBatch& batch, int count);

/// Pieces of one sheet, with what looks at them saw.
class SheetPieces {
  public:
    /// All outlives this. `key`: of the sheet, for random numbers.
    SheetPieces(const MapRays& rays, const GhostMap& map, const SmallSource& source, const Sensor& sensor,
                std::uint64_t key);

    const SheetSmooth& smooth() const { return smooth_; }
    /// By cell: it has no pieces, as no look came through the glass.
    const std::vector<bool>& unseen() const { return unseen_; }
    /// Adds the light that came to the frame, of a source of light 1.
    void add_to(FlareTiles& tiles, double times) const;
    /// The pieces, each with `times` its weight: the root of the mean square of its light over that of the frame, over the
    /// pitch of its level. So many arrivals make the least noise for their time, also where a part of a piece is dark.
    std::vector<SheetPiece> weighed(const FlareTiles& tiles, double times) const;

  private:
    /// A look: the share that gets through and comes to the frame, and that would if the way were free.
    struct Seen {
        Vec2f px;
        float light, open;
    };
    struct Looked {
        std::vector<Seen> seen;
        int lit = 0;
        float level = 0;   // mean
        float least_stop = 1e9f, most_stop = -1e9f;   // how far beyond edges
        Vec2f low{1e9f, 1e9f}, high{-1e9f, -1e9f};    // px
    };
    SheetSmooth smoothness() const;
    bool near(Vec2f px, float reach) const;
    void draw(MapBatch& batch, const SheetPiece& piece, int count) const;
    std::vector<MapLanding> trace(const MapBatch& batch, const GhostMap::Cell& cell, int count) const;
    bool beside(const Looked& looked) const;
    void divide(const SheetPiece& piece, int depth, const Looked* whole);
    static Looked in_the_dark(const Looked& whole);
    static float extent(const Looked& looked);
    bool is_small(const SheetPiece& piece, const Looked& looked) const;
    Looked look(const SheetPiece& piece, int count) const;
    void look_at_map(const SheetPiece& piece, int count, Looked& to) const;
    void look_by_rays(const SheetPiece& piece, int count, Looked& to) const;
    void see(Looked& to, Vec2f px, float glass, float pass, float stop) const;
    void keep(SheetPiece piece, int count, Looked looked, const Looked* whole);
    float spread(std::uint32_t cell);
    float wrong(std::uint32_t cell) const;

    const MapRays& rays_;
    const GhostMap& map_;
    const SmallSource& source_;
    const Sensor& sensor_;
    std::uint64_t key_;
    SheetSmooth smooth_;
    SheetLevel level_;
    std::vector<float> spread_;          // by cell, px: how far apart colours land; < 0: not known yet
    std::vector<bool> unseen_;           // by cell
    std::vector<float> wrong_;           // by cell
    std::vector<SheetPiece> pieces_;
    std::vector<int> looks_;             // by piece
    struct Doubt {
        double unseen;   // looks that a piece has beside those that saw light
        double wrong;    // how wrong the map is, as a share of the light
    };
    std::vector<Doubt> doubt_;           // by piece
    std::vector<std::size_t> end_;       // of a piece's, in seen_
    std::vector<Seen> seen_;
};

}  // namespace dg
