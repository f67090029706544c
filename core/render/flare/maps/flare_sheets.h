// flare_sheets.h -- ghosts of small sources as maps, with sampling weights of their cells; built once per picture.
//
// Noise per time is lowest if the number of arrivals in a part of the frame is proportional to the ghost's light
// relative to the brightness of the flare there. So a cell is sampled by its light over the light where it lands.
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
        int source, ghost;               // indices in sources() and of the aim
        MapRays rays;
        GhostMap map;
        std::vector<SheetPiece> pieces{};
        SheetSmooth smooth{};
        std::vector<bool> unseen{};      // per cell: no sample came through

        /// Whether no cell is known to send light from a point of the square.
        bool is_dark(Vec2f at) const {
            const GhostMap::Cell* const cell = map.find(at);
            return !cell || unseen[std::size_t(cell - map.cells().data())];
        }
    };

    /// Builds no maps if the lens changes during the exposure or is dirty, if the filter is wide, or if there are no
    /// small sources. The aim must outlive this.
    FlareSheets(const FlareAim& aim, const RenderSettings& settings);

    bool empty() const { return sheets_.empty(); }
    const std::vector<Sheet>& sheets() const { return sheets_; }
    const std::vector<SmallSource>& sources() const { return sources_; }
    /// Whether a source of the aim has maps.
    bool has(int source) const;
    /// Whether a part of a source's light is occluded.
    bool hidden(int source) const { return hidden_[source]; }
    /// Approximate mean light per pixel, as the sources' light times transmittance and area in the square.
    double mean() const { return mean_; }
    /// RMS error of the maps over tiles of the frame, relative to the light of a tile or a tenth of the mean, estimated
    /// from exact rays.
    double error() const { return error_; }
    /// Number of ghosts with inaccurate maps, which are drawn by exact rays.
    int by_rays() const { return by_rays_; }
    /// Whether the error was too large, so that no maps are used.
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
