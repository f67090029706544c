// ghost_map.h -- a ghost of a small source as a map: where light that enters at a place of the front lands, and what
// stops it, interpolated from exact rays in cells. Cells are as small as the ghost needs; where interpolation will not
// do, at the edge of where rays land at all, a cell says so, and rays there have to be traced.
//
// Sources: Hullin, Eisemann, Seidel, Lee 2011, Physically-Based Real-Time Lens Flare Rendering, TOG 30(4) (ghosts from
// interpolated rays; clipping after interpolation).
#pragma once
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "render/flare/flare_cells.h"
#include "render/flare/maps/cell_blur.h"
#include "render/flare/maps/map_rays.h"

namespace dg {

/// Rays into a cell, and what becomes of them.
struct alignas(64) MapBatch {
    static constexpr int kSize = 256;
    float u[kSize], v[kSize];                // in the cell, [0, 1]
    float shift_x[kSize], shift_y[kSize];    // of the source's point
    float nm[kSize];
    float opening[kSize];                    // of the iris, share of its radius
    float x[kSize], y[kSize];                // px
    float beyond[kSize];                     // as of OpenLandings
    float iris_x[kMostCrossings][kSize], iris_y[kMostCrossings][kSize];   // mm
    float middle[kSize], glass[kSize];       // transmittance of the middle wavelength and of this one, but for edges, iris
    float left[kSize], pass[kSize];          // what those leave of light, and with the glass; 0: stopped

    void set(int i, Vec2f at, Vec2f shift, float wavelength, float iris_opening) {
        u[i] = at.x, v[i] = at.y, shift_x[i] = shift.x, shift_y[i] = shift.y;
        nm[i] = wavelength, opening[i] = iris_opening;
    }
    /// One of them; `pass`: what edges and iris let through is left out, as rays have it.
    MapLanding landing(int i, int crossings) const {
        MapLanding l{{x[i], y[i]}, beyond[i], glass[i], true, 0, {}};
        for (int k = 0; k < crossings; ++k) l.iris[std::size_t(k)] = {iris_x[k][i], iris_y[k][i]};
        return l;
    }
};

class GhostMap {
  public:
    /// How far a landing may be off, px, and how far the edge of the ghost: at least, and as a share of the blur by the
    /// source's size; and how far its light, as a share.
    struct Accuracy {
        float landing_px = 0.2f, edge_px = 1.5f, of_blur = 1 / 30.f, light = 0.03f, color = 0.05f;
    };
    /// `reach`: px beside the frame that count. What the rays are made of outlives this.
    GhostMap(const MapRays& rays, const Sensor& sensor, float reach, const Accuracy& accuracy);

    /// A cell that may bring light to the frame.
    struct Cell {
        Vec2f low;            // its corner, in the region: [0, 1)^2
        float size;
        std::uint32_t data;   // first of its values
        bool exact;           // rays have to be traced: it has no values
        CellBlur blur;        // of an exact one: none

        bool holds(Vec2f u) const {
            return u.x >= low.x && u.y >= low.y && u.x < low.x + size && u.y < low.y + size;
        }
    };
    const std::vector<Cell>& cells() const { return cells_; }
    /// Makes all of them exact; false: they were.
    bool give_up() {
        bool changed = false;
        for (Cell& cell : cells_) changed |= !std::exchange(cell.exact, true);
        return changed;
    }
    /// The part of the front, out of the square of all of it, that holds the cells.
    const FlareRectangle& region() const { return region_; }
    /// The place of the square at a place of a cell, [0, 1]^2.
    Vec2f at(const Cell& cell, Vec2f u) const { return region_.at(cell.low + u * cell.size); }
    /// The cell of a place of the square; null: no light comes from there to the frame.
    const Cell* find(Vec2f at) const;
    /// Landings in a cell that is not exact; fills all but what set() does.
    void landings(const Cell& cell, MapBatch& batch, int count) const;

    int crossings() const { return crossings_; }
    /// Spectrum of a cell that is not exact: its middle's transmittance over wavelengths, relative to that of the middle
    /// one; and by corner what is to be added, of kSpectrum wavelengths each.
    const float* fine(const Cell& cell) const { return values_.data() + cell.data + kNodes * stride(); }
    const float* corners(const Cell& cell) const { return fine(cell) + kFineSpectrum; }
    /// Transmittance of the glass at a place of such a cell, of which `middle` is that of the middle wavelength.
    float glass(const Cell& cell, Vec2f u, float middle, float nm) const;
    std::size_t rays() const { return rays_; }   // that it took
    std::size_t bytes() const { return values_.size() * sizeof(float) + cells_.size() * sizeof(Cell); }

    static constexpr int kSide = 4;                     // nodes along a side of a cell
    static constexpr int kNodes = kSide * kSide;
    static constexpr int kLambdas = 3, kSets = kLambdas + 2;   // nodes of the wavelength; and of the source's two axes
    static constexpr int kBends = 3;
    static constexpr int kSpectrum = 24, kFine = 4;            // nodes of the transmittance; steps from one to the next
    static constexpr int kFineSpectrum = kFine * (kSpectrum - 1) + 1;
    static constexpr int kFirstAcross = 4, kLevels = 7;       // cells across the region; sizes of cells

  private:
    friend class GhostMapMaker;
    GhostMap() = default;
    /// Values of a cell: by node, of each set px x, px y, beyond and iris points, and the transmittance. Then that of
    /// its middle in fine steps, as films make it ripple; and by corner,
    /// what that is off there. Last how far from linear over the source its fields are: x x, y y, x y.
    int fields() const { return 3 + 2 * crossings_; }
    int stride() const { return kSets * fields() + 1; }
    static std::uint32_t code(Vec2f u);   // along the curve by which cells are sorted

    FlareRectangle region_;
    std::vector<Cell> cells_;
    std::vector<std::uint32_t> codes_;
    std::vector<float> values_;
    int crossings_ = 0;
    const IrisTables* iris_ = nullptr;
    std::size_t rays_ = 0;
};

}  // namespace dg
