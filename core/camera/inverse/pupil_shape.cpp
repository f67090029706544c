#include "camera/inverse/pupil_shape.h"

#include <algorithm>
#include <cmath>

namespace dg {

PupilShape::Sight PupilShape::sight(Vec3d from_pupil, double w) const {
    Sight s;
    const double far = length(from_pupil);
    s.distance = w == 0 ? 1 : far;
    s.e = from_pupil * (1 / far);
    s.layer = w == 0 ? 0 : std::sqrt(nearest_ / far) * layers_;
    const double across = hypot(s.e.x, s.e.y), angle = atan2(across, -s.e.z);
    const Vec2d out = across > 0 ? Vec2d{s.e.x, s.e.y} * (1 / across) : Vec2d{1, 0};
    const Vec3d meridional{-s.e.z * out.x, -s.e.z * out.y, across},
        sagittal{-out.y, out.x, 0};
    if (axial_) {
        s.x = meridional, s.y = sagittal;
        s.angle = {angle, 0};
    } else {  // x and y of the camera, parallel-transported
        s.x = meridional * out.x - sagittal * out.y;
        s.y = meridional * out.y + sagittal * out.x;
        s.angle = out * angle;
    }
    return s;
}

/// Position in cells; empty for points outside the range of all camera rays.
std::optional<Vec3d> PupilShape::grid_place(const Sight& s) const {
    if (!(s.layer <= layers_)) return std::nullopt;
    const int i = std::min(int(s.layer), layers_ - 1);
    const double t = s.layer - i;
    const Angles &a = angles_[i], &b = angles_[i + 1];
    const Vec2d low = a.low + (b.low - a.low) * t, high = a.high + (b.high - a.high) * t;
    Vec3d place{(s.angle.x - low.x) / (high.x - low.x) * columns_, 0, s.layer};
    if (!axial_) place.y = (s.angle.y - low.y) / (high.y - low.y) * rows_;
    if (!(place.x >= 0 && place.x <= columns_ && place.y >= 0 && place.y <= rows_))
        return std::nullopt;
    return place;
}

PupilShape::Oval PupilShape::oval_at(Vec3d place) const {
    const int i = std::min(int(place.x), columns_ - 1),
              j = std::min(int(place.y), std::max(rows_ - 1, 0)),
              k = std::min(int(place.z), layers_ - 1);
    // Ovals change linearly with the inverse distance, which is the square of the layer.
    const double s = place.x - i, t = place.y - j,
                 r = (place.z * place.z - k * k) / (2 * k + 1);
    Oval sum;
    const auto add = [&](int x, int y, int z, double share) {
        const Oval& o = ovals_[(std::size_t(z) * (rows_ + 1) + y) * (columns_ + 1) + x];
        sum.center = sum.center + o.center * share, sum.half = sum.half + o.half * share;
    };
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y <= (axial_ ? 0 : 1); ++y)
            for (int x = 0; x < 2; ++x)
                add(i + x, j + y, k + z,
                    (x ? s : 1 - s) *
                        (axial_ ? 1
                         : y    ? t
                                : 1 - t) *
                        (z ? r : 1 - r));
    return sum;
}

std::size_t PupilShape::cell_at(Vec3d place) const {
    const int i = std::min(int(place.x), columns_ - 1),
              j = std::min(int(place.y), std::max(rows_ - 1, 0)),
              k = std::min(int(place.z), layers_ - 1);
    return (std::size_t(k) * std::max(rows_, 1) + j) * columns_ + i;
}

std::optional<PupilShape::Region> PupilShape::region(const Sight& s) const {
    const auto place = grid_place(s);
    if (!place) return std::nullopt;
    const Cell& cell = cells_[cell_at(*place)];
    if (!(cell.until.back() > 0)) return std::nullopt;
    return Region{&cell, oval_at(*place)};
}

std::optional<PupilView::Sample> PupilShape::sample(Vec3d p, double w, Vec2f u) const {
    const Sight s = sight(p - w * pupil_, w);
    const auto r = region(s);
    if (!r) return std::nullopt;
    const Cell& c = *r->cell;
    const float total = c.until.back(), target = u.x * total;
    const int k = std::min(
        int(std::upper_bound(c.until.begin(), c.until.end(), target) - c.until.begin()),
        kColumns - 1);
    const float before = k > 0 ? c.until[k - 1] : 0,
                within = (target - before) / (c.until[k] - before);
    const Vec2d at{c.first + (k + within) * c.width(),
                   c.low[k] + u.y * (c.high[k] - c.low[k])};
    const Vec3d q = s.x * (r->oval.center.x + r->oval.half.x * at.x) +
                    s.y * (r->oval.center.y + r->oval.half.y * at.y);
    const Vec3d way = s.e * s.distance - w * q;
    const double far = length(way);
    const Vec3d direction = way * (1 / far);
    const auto start = lens_.start(pupil_ + q, direction);
    if (!start || !(dot(p - w * *start, direction) > 0)) return std::nullopt;
    const double area = total * r->oval.half.x * r->oval.half.y;
    const double pdf = w == 0 ? 1 / area : far * far * far / (s.distance * area);
    return PupilView::Sample{to_float(*start), to_float(direction), float(pdf)};
}

float PupilShape::pdf(Vec3d p, double w, const Ray& ray) const {
    const Sight s = sight(p - w * pupil_, w);
    const auto r = region(s);
    if (!r) return 0;
    const Vec3d from = to_double(ray.origin) - pupil_, d = to_double(ray.direction);
    const Vec3d q = from - d * (dot(from, s.e) / dot(d, s.e));
    const Cell& c = *r->cell;
    const double x = (dot(q, s.x) - r->oval.center.x) / r->oval.half.x,
                 y = (dot(q, s.y) - r->oval.center.y) / r->oval.half.y;
    const double column = (x - c.first) / c.width();
    if (!(dot(d, s.e) > 0 && column >= 0 && column < kColumns)) return 0;
    const int k = int(column);
    if (!(y >= c.low[k] && y <= c.high[k])) return 0;
    const double area = c.until.back() * r->oval.half.x * r->oval.half.y;
    const double far = length(s.e * s.distance - w * q);
    return float(w == 0 ? 1 / area : far * far * far / (s.distance * area));
}

}  // namespace dg
