#include "motion/hull.h"

#include <cmath>

namespace dg {

Vec3d Hull::node(int face, int i, int j) {
    const int axis = face / 2;
    Vec3d d;
    d[axis] = face % 2 ? -1 : 1;
    d[(axis + 1) % 3] = 2.0 * i / kCells - 1;
    d[(axis + 2) % 3] = 2.0 * j / kCells - 1;
    return d;
}

Hull::Hull(std::span<const Vec3f> points) {
    if (points.empty()) return;
    box_ = {to_double(points[0]), to_double(points[0])};
    for (const Vec3f p : points) {
        for (int k = 0; k < 3; ++k) {
            box_.min[k] = std::min(box_.min[k], double(p[k]));
            box_.max[k] = std::max(box_.max[k], double(p[k]));
        }
    }
    std::vector<Vec3f> offsets;
    offsets.reserve(points.size());
    for (const Vec3f p : points) {
        const Vec3d offset = to_double(p) - center();
        radius_ = std::max(radius_, length(offset));
        offsets.push_back(to_float(offset));
    }
    const float rounding = 0x1p-21f * float(radius_);
    for (int face = 0; face < 6; ++face) {
        for (int i = 0; i <= kCells; ++i) {
            for (int j = 0; j <= kCells; ++j) {
                const Vec3f d = to_float(node(face, i, j));
                float most = 0;  // positive, as the centre is inside
                for (const Vec3f p : offsets) most = std::max(most, dot(d, p));
                reach_[face][i][j] = most + rounding;
            }
        }
    }
}

Hull Hull::grown(double radius) const {
    Hull all = *this;
    for (int k = 0; k < 3; ++k) all.box_.min[k] -= radius, all.box_.max[k] += radius;
    all.radius_ += radius;
    for (int face = 0; face < 6; ++face)
        for (int i = 0; i <= kCells; ++i)
            for (int j = 0; j <= kCells; ++j)
                all.reach_[face][i][j] += float(1.000001 * radius * length(node(face, i, j)));
    return all;
}

double Hull::reach(Vec3d d) const {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(d[k]) > std::abs(d[axis])) axis = k;
    const double size = std::abs(d[axis]);
    if (!(size > 0)) return 0;
    const auto place = [&](double v) { return (v / size + 1) * (kCells / 2.0); };
    const double u = place(d[(axis + 1) % 3]), v = place(d[(axis + 2) % 3]);
    const int i = std::clamp(int(u), 0, kCells - 1), j = std::clamp(int(v), 0, kCells - 1);
    const double s = u - i, t = v - j;
    const Face& f = reach_[2 * axis + (d[axis] < 0)];
    const double far = (1 - s) * ((1 - t) * f[i][j] + t * f[i][j + 1]) +
                       s * ((1 - t) * f[i + 1][j] + t * f[i + 1][j + 1]);
    return dot(d, center()) + size * far;
}

}  // namespace dg
