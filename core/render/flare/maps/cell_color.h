// cell_color.h -- colour of light in a map cell: integrated over all wavelengths if they land together, else from a
// single wavelength, sampled by its contribution.
#pragma once
#include <array>

#include "render/flare/maps/color_table.h"
#include "render/flare/maps/ghost_map.h"

namespace dg {

/// Tables shared by all cells.
struct CellColors {
    ColorTable table;
    std::vector<ColorTable::Parts> fine, coarse;   // at the nodes of a map's spectra
    explicit CellColors(const Responses& responses)
        : table(responses), fine(table.nodes(GhostMap::kFineSpectrum)), coarse(table.nodes(GhostMap::kSpectrum)) {}
};

class CellColor {
  public:
    /// `cell` must not be exact. `gray`: all wavelengths land at the same point. The arguments must outlive this.
    CellColor(const GhostMap& map, const GhostMap::Cell& cell, bool gray, const CellColors& colors);

    /// Whether all wavelengths land at the point of nm().
    bool gray() const { return gray_nm_ > 0; }
    float nm() const { return gray_nm_; }
    /// Samples a wavelength, nm, with u in [0, 1).
    float nm(float u) const;
    /// Colour of landing i of a batch, scaled by `times`: integrated over wavelengths if gray, else an estimate from
    /// the wavelength that nm(u) sampled.
    FilmColor of(const MapBatch& batch, int i, Rgb light, float times) const;

  private:
    static constexpr int kSteps = 64, kCorners = 4;

    void draw_by(const float* fine);
    void sum_up(const float* fine, const float* corners);

    const CellColors& colors_;
    float gray_nm_ = 0;
    ColorTable::Parts middle_{};                          // per transmittance at the middle wavelength
    std::array<ColorTable::Parts, kCorners> corners_{};   // differences at the corners
    std::array<float, kSteps + 1> quantile_{};            // nm
};

}  // namespace dg
