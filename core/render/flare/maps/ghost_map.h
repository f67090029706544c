// ghost_map.h -- a ghost of a small source as a map from front points to film points, with clipping by mounts and iris,
// interpolated from exact rays in adaptive cells. Cells where interpolation fails, at the limit of traceable rays, are
// marked as exact, and rays have to be traced there.
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

/// A batch of rays into a cell, and their landings.
struct alignas(64) MapBatch {
    static constexpr int kSize = 256;
    float u[kSize], v[kSize];                // in the cell, [0, 1]
    float shift_x[kSize], shift_y[kSize];    // point on the source
    float nm[kSize];
    float opening[kSize];                    // of the iris, fraction of its radius
    float x[kSize], y[kSize];                // px
    float beyond[kSize];                     // as in OpenLandings
    float iris_x[kMostCrossings][kSize], iris_y[kMostCrossings][kSize];   // mm
    float middle[kSize], glass[kSize];       // transmittance of the glass at the middle wavelength and at nm
    float left[kSize], pass[kSize];          // transmittance of edges and iris; of edges, iris and glass; 0: blocked

    void set(int i, Vec2f at, Vec2f shift, float wavelength, float iris_opening) {
        u[i] = at.x, v[i] = at.y, shift_x[i] = shift.x, shift_y[i] = shift.y;
        nm[i] = wavelength, opening[i] = iris_opening;
    }
    /// Landing i. Its `pass` excludes edges and iris, as for exact rays.
    MapLanding landing(int i, int crossings) const {
        MapLanding l{{x[i], y[i]}, beyond[i], glass[i], true, 0, {}};
        for (int k = 0; k < crossings; ++k) l.iris[std::size_t(k)] = {iris_x[k][i], iris_y[k][i]};
        return l;
    }
};

class GhostMap {
  public:
    /// Tolerances: of landings and of edges of the ghost, each px and as a fraction of the source's blur; and of light,
    /// as a fraction.
    struct Accuracy {
        float landing_px = 0.2f, edge_px = 1.5f, of_blur = 1 / 30.f, light = 0.03f, color = 0.05f;
    };
    /// `reach`: margin around the frame, px. The data of `rays` must outlive this.
    GhostMap(const MapRays& rays, const Sensor& sensor, float reach, const Accuracy& accuracy);

    /// A cell that may send light to the frame.
    struct Cell {
        Vec2f low;            // lower corner in the region, [0, 1)^2
        float size;
        std::uint32_t data;   // index of its first value
        bool exact;           // rays have to be traced; the cell has no values
        CellBlur blur;        // not set for exact cells

        bool holds(Vec2f u) const {
            return u.x >= low.x && u.y >= low.y && u.x < low.x + size && u.y < low.y + size;
        }
    };
    const std::vector<Cell>& cells() const { return cells_; }
    /// Makes all cells exact; false if they were.
    bool give_up() {
        bool changed = false;
        for (Cell& cell : cells_) changed |= !std::exchange(cell.exact, true);
        return changed;
    }
    /// The rectangle of the front's square that contains the cells.
    const FlareRectangle& region() const { return region_; }
    /// Converts cell coordinates [0, 1]^2 to the front's square.
    Vec2f at(const Cell& cell, Vec2f u) const { return region_.at(cell.low + u * cell.size); }
    /// The cell at a point of the square; null: no light reaches the frame from there.
    const Cell* find(Vec2f at) const;
    /// Computes landings in a cell that is not exact; set() fills the inputs.
    void landings(const Cell& cell, MapBatch& batch, int count) const;

    int crossings() const { return crossings_; }
    /// Spectrum of a cell that is not exact: transmittance at its center relative to the middle wavelength, and
    /// differences at the corners, for kSpectrum wavelengths each.
    const float* fine(const Cell& cell) const { return values_.data() + cell.data + kNodes * stride(); }
    const float* corners(const Cell& cell) const { return fine(cell) + kFineSpectrum; }
    /// Transmittance of the glass at a point of a cell that is not exact; `middle`: transmittance there at the middle
    /// wavelength.
    float glass(const Cell& cell, Vec2f u, float middle, float nm) const;
    std::size_t rays() const { return rays_; }   // number of exact rays traced
    std::size_t bytes() const { return values_.size() * sizeof(float) + cells_.size() * sizeof(Cell); }

    static constexpr int kSide = 4;                     // nodes along an edge of a cell
    static constexpr int kNodes = kSide * kSide;
    static constexpr int kLambdas = 3, kSets = kLambdas + 2;   // wavelength nodes; plus the two axes of the source
    static constexpr int kBends = 3;
    static constexpr int kSpectrum = 24, kFine = 4;            // nodes of the transmittance; fine steps per node
    static constexpr int kFineSpectrum = kFine * (kSpectrum - 1) + 1;
    static constexpr int kFirstAcross = 4, kLevels = 7;       // coarsest cells along an axis; levels of cells

  private:
    friend class GhostMapMaker;
    GhostMap() = default;
    /// Values of a cell: per node and set, px x, px y, beyond and iris points, and the transmittance. Then the
    /// transmittance at its center in fine steps, as thin films make it oscillate, and its differences at the corners.
    /// Last the second-order terms of the fields over the source: x x, y y, x y.
    int fields() const { return 3 + 2 * crossings_; }
    int stride() const { return kSets * fields() + 1; }
    static std::uint32_t code(Vec2f u);   // Morton code, by which cells are sorted

    FlareRectangle region_;
    std::vector<Cell> cells_;
    std::vector<std::uint32_t> codes_;
    std::vector<float> values_;
    int crossings_ = 0;
    const IrisTables* iris_ = nullptr;
    std::size_t rays_ = 0;
};

}  // namespace dg
