// sheet_pieces.h -- divides the cells of a ghost's map at edges into pieces, and weights the pieces by their light,
// estimated from samples.
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
    Vec2f low;             // lower corner in the cell
    float size;            // fraction of the cell's size
    float level;           // mean level of the node spacing, 2^level px
    bool gray = false;     // all wavelengths land together
    double share = 0;      // share of all arrivals
    double doubt = 0;      // share of the exact rays that correct maps

    Vec2f at(Vec2f u) const { return low + u * size; }   // cell coordinates
};

/// Area of a piece in the front's square.
double area(const GhostMap& map, const SheetPiece& piece);
/// Fills a batch with points of a piece and of the source.
void draw_places(MapBatch& batch, const SheetPiece& piece, const SmallSource& source, const CellNumbers& numbers,
                 int count);
/// Exact rays for a batch in a cell.
std::vector<MapRay> rays_of(const GhostMap& map, const GhostMap::Cell& cell, const MapBatch& batch, int count);

/// Pieces of a sheet, with their samples.
class SheetPieces {
  public:
    /// The arguments must outlive this. `key`: seed of the sheet.
    SheetPieces(const MapRays& rays, const GhostMap& map, const SmallSource& source, const Sensor& sensor,
                std::uint64_t key);

    const SheetSmooth& smooth() const { return smooth_; }
    /// Per cell: true if it has no pieces because no sample came through the lens.
    const std::vector<bool>& unseen() const { return unseen_; }
    /// Adds the light that reached the frame, for a source of light 1.
    void add_to(FlareTiles& tiles, double times) const;
    /// The pieces with their weights, scaled by `times`: RMS of the piece's light relative to the light of the frame,
    /// over the node spacing. Arrivals in proportion minimize noise per time, also for partly dark pieces.
    std::vector<SheetPiece> weighed(const FlareTiles& tiles, double times) const;

  private:
    /// A sample: the transmitted share that reaches the frame, and the same without clipping.
    struct Seen {
        Vec2f px;
        float light, open;
    };
    struct Looked {
        std::vector<Seen> seen;
        int lit = 0;
        float level = 0;   // mean
        float least_stop = 1e9f, most_stop = -1e9f;   // clip values
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
    std::vector<float> spread_;          // per cell, px: distance between landings of wavelengths; < 0: not known yet
    std::vector<bool> unseen_;           // per cell
    std::vector<float> wrong_;           // per cell
    std::vector<SheetPiece> pieces_;
    std::vector<int> looks_;             // per piece
    struct Doubt {
        double unseen;   // pseudo-count of samples with light, for pieces without any
        double wrong;    // error of the map, as a fraction of the light
    };
    std::vector<Doubt> doubt_;           // per piece
    std::vector<std::size_t> end_;       // per piece: end of its samples in seen_
    std::vector<Seen> seen_;
};

}  // namespace dg
