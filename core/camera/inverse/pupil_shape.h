// pupil_shape.h -- region of the pupil of an exact lens through which light from a point passes
// (see pupil_view.h).
//
// The point is seen in direction e from the centre of the (paraxial) entrance pupil. The region is
// on the plane across e through that centre, so it is defined beyond 90 degrees too. It consists of
// an oval frame, interpolated over direction and nearness of the point, and of columns in the
// frame, per cell, that contain all passing rays. Directions: the angle from -z, in the meridional
// frame for axially symmetric lenses, otherwise as vectors. Nearness: distance from pupil to glass,
// divided by the distance to the point.
//
// The region is measured with camera rays at all wavelengths; it makes no assumptions about the
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

    /// Point as seen from the pupil.
    struct Sight {
        Vec3d e, x, y;    // unit vectors: toward the point, and across
        double distance;  // m; 1 for points at infinity
        double layer;     // by nearness
        Vec2d angle;      // from -z
    };
    struct Oval {
        Vec2d center{}, half{};  // m, along x and y of a sight
    };
    /// Columns of equal width from `first` to `last`, in units of the oval.
    struct Cell {
        float first = 0, last = 0;
        std::array<float, kColumns> low, high;
        std::array<float, kColumns>
            until;  // cumulative area at the end of each column; last value 0: empty

        float width() const { return (last - first) / kColumns; }
    };
    struct Region {
        const Cell* cell;
        Oval oval;
    };
    struct Angles {
        Vec2d low{1e9, 1e9}, high{-1e9, -1e9};
    };
    /// Sample of a camera ray: its position for a point along the ray.
    struct Record {
        Vec2d angle, at;  // at: intersection with the plane of the region
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

    // Set-up steps, in order.
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
    double nearest_ = 0;  // m: minimal distance of points
    int columns_, rows_,
        layers_;  // cells; rows_ is 0 for axially symmetric lenses
    std::vector<Angles> angles_;  // by layer
    std::vector<Oval> ovals_;     // at the corners of cells
    std::vector<Cell> cells_;
};

}  // namespace dg
