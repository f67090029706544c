// cell_color.h -- the colour that a cell of a ghost's map gives to light: of all wavelengths at once where they land
// together, else of one at a time, drawn by the light that it brings.
#pragma once
#include <array>

#include "render/flare/maps/color_table.h"
#include "render/flare/maps/ghost_map.h"

namespace dg {

/// Tables that all cells share.
struct CellColors {
    ColorTable table;
    std::vector<ColorTable::Parts> fine, coarse;   // nodes of the spectra of a map
    explicit CellColors(const Responses& responses)
        : table(responses), fine(table.nodes(GhostMap::kFineSpectrum)), coarse(table.nodes(GhostMap::kSpectrum)) {}
};

class CellColor {
  public:
    /// Takes a cell that is not exact. `gray`: its colours count as one place. All outlives this.
    CellColor(const GhostMap& map, const GhostMap::Cell& cell, bool gray, const CellColors& colors);

    /// All wavelengths go the way of nm().
    bool gray() const { return gray_nm_ > 0; }
    float nm() const { return gray_nm_; }
    /// One of the wavelengths, by u in [0, 1).
    float nm(float u) const;
    /// Light of one of a batch of landings, times so much: all of it if it is gray, or an estimate from the
    /// wavelength that nm(u) drew.
    FilmColor of(const MapBatch& batch, int i, Rgb light, float times) const;

  private:
    static constexpr int kSteps = 64, kCorners = 4;

    void draw_by(const float* fine);
    void sum_up(const float* fine, const float* corners);

    const CellColors& colors_;
    float gray_nm_ = 0;
    ColorTable::Parts middle_{};                          // per transmittance of the middle wavelength
    std::array<ColorTable::Parts, kCorners> corners_{};   // to be added
    std::array<float, kSteps + 1> quantile_{};            // nm
};

}  // namespace dg
