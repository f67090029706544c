// flare_sheets.h -- the ghosts of small sources as maps, with how densely each cell of each is drawn: found once for a
// picture.
//
// The least noise for its time has as many arrivals on a piece of the frame as the ghost has of its light, relative to
// how bright the flare is there: so a cell is drawn by its light, over the light where it lands.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "render/flare/flare_tiles.h"
#include "render/flare/maps/ghost_map.h"
#include "render/flare/maps/sheet_pieces.h"
#include "render/flare/maps/small_source.h"

namespace dg {

class FlareSheets {
  public:
    struct Sheet {
        int source, ghost;               // among sources(); of the aim
        MapRays rays;
        GhostMap map;
        std::vector<SheetPiece> pieces{};
        SheetSmooth smooth{};
        std::vector<bool> unseen{};      // by cell

        /// No cell is known to bring light from a place of the square.
        bool is_dark(Vec2f at) const {
            const GhostMap::Cell* const cell = map.find(at);
            return !cell || unseen[std::size_t(cell - map.cells().data())];
        }
    };

    /// None where the lens changes or is dirty, where the filter is wide, and where nothing small shines. The aim outlives
    /// this.
    FlareSheets(const FlareAim& aim, const RenderSettings& settings);

    bool empty() const { return sheets_.empty(); }
    const std::vector<Sheet>& sheets() const { return sheets_; }
    const std::vector<SmallSource>& sources() const { return sources_; }
    /// Whether a source of the aim has maps.
    bool has(int source) const;
    /// Something is in the way of some of a source's light.
    bool hidden(int source) const { return hidden_[source]; }
    /// Light of a pixel in the mean, about: of the sources' light times transmittances and unit areas of the square.
    double mean() const { return mean_; }
    /// RMS error of the maps over tiles of the frame, relative to the light of a tile or a tenth of the mean; as far as
    /// rays tell that were traced for this.
    double error() const { return error_; }
    /// Ghosts whose map was too wrong: all their light comes by rays.
    int by_rays() const { return by_rays_; }
    /// It was too large, and there are no maps for it.
    bool failed() const { return failed_; }

  private:
    void make_maps(const FlareAim& aim, const RenderSettings& settings);
    void divide(const RenderSettings& settings);
    void take(const std::vector<std::optional<SheetPieces>>& pieces, const FlareTiles& tiles);

    std::vector<SmallSource> sources_;
    std::vector<bool> hidden_;
    std::vector<Sheet> sheets_;
    double mean_ = 0, error_ = 0;
    int by_rays_ = 0;
    bool failed_ = false;
};

}  // namespace dg
