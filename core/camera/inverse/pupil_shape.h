// pupil_shape.h -- see pupil_view.h: where the light of a point passes an exact lens.
//
// A point is looked at along e from the middle of the (paraxial) entrance pupil; the
// region lies on the plane across e through that middle, so it works beyond 90 degrees.
// It is an oval frame that changes evenly with the direction and the nearness of the
// point, and within the frame, cell by cell, columns that hold all that passes.
// Directions: by their angle from straight ahead, in the meridional frame for lenses that
// are the same on all sides, else as vectors. Nearness: the pupil's distance to the glass
// over that to the point.
//
// All of it is found from camera rays, at all wavelengths: nothing is assumed of the
// lens.
#pragma once
#include <array>

#include "camera/inverse/pupil_view.h"

namespace dg {

class PupilShape {
  public:
    explicit PupilShape(const ExactLens& lens);

    std::optional<PupilView::Sample> sample(Vec3d p, double w, Vec2f u) const;
    float pdf(Vec3d p, double w, const Ray& ray) const;

  private:
    static constexpr int kColumns = 32;

    /// A point as it is seen from the pupil.
    struct Sight {
        Vec3d e, x, y;    // unit: toward it, and across
        double distance;  // m; of points at infinity 1
        double layer;     // by nearness
        Vec2d angle;      // from straight ahead
    };
    struct Oval {
        Vec2d center{}, half{};  // m, along x and y of a sight
    };
    /// Columns of one width from `first` to `last`, in units of the oval.
    struct Cell {
        float first = 0, last = 0;
        std::array<float, kColumns> low, high;
        std::array<float, kColumns>
            until;  // area up to the end of a column; the last is 0: nothing passes

        float width() const { return (last - first) / kColumns; }
    };
    struct Region {
        const Cell* cell;
        Oval oval;
    };
    struct Angles {
        Vec2d low{1e9, 1e9}, high{-1e9, -1e9};
    };
    /// Record of a camera ray about the points along it.
    struct Record {
        Vec2d angle, at;  // at: where it meets the plane of the region
        double layer;
    };

    struct Placed {
        Vec3d place;  // in cells
        Vec2d in_oval;
    };

    struct Member {
        std::size_t cell;
        Vec2f at;  // in its oval
    };

    Sight sight(Vec3d from_pupil, double w) const;
    std::optional<Vec3d> grid_place(const Sight& sight) const;
    Oval oval_at(Vec3d place) const;
    std::size_t cell_at(Vec3d place) const;
    std::optional<Region> region(const Sight& sight) const;

    // The set-up, in this order.
    std::vector<Record> look_back(const ExactLens& lens);
    void bound_angles(const std::vector<Record>& records);
    std::optional<Placed> placed(const Record& record) const;
    void fit_ovals(const std::vector<Record>& records);
    void fill_ovals(std::vector<int>& count);
    std::vector<Member> members(const std::vector<Record>& records) const;
    std::vector<std::vector<std::size_t>> shared_with(
        const std::vector<Member>& members) const;
    void fit_cells(const std::vector<Record>& records);
    static Cell covered(std::vector<Vec2f> top, std::vector<Vec2f> bottom, float margin);

    ExactLens lens_;
    bool axial_;
    Vec3d pupil_;         // camera frame, m
    double nearest_ = 0;  // m: no point is nearer
    int columns_, rows_,
        layers_;  // cells; rows_ is 0 if the lens is the same on all sides
    std::vector<Angles> angles_;  // by layer
    std::vector<Oval> ovals_;     // at the corners of cells
    std::vector<Cell> cells_;
};

}  // namespace dg
