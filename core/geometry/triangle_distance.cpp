#include "geometry/triangle_distance.h"

#include <algorithm>
#include <limits>

namespace dg {
namespace {

struct Segment {
    Vec3d begin, end;
};

Segment edge(const Triangle3d& t, std::size_t k) { return {t[k], t[(k + 1) % 3]}; }

/// The fraction of `along` at which its point is closest to `p`.
double closest(Vec3d p, Vec3d begin, Vec3d along) {
    const double squared = dot(along, along);
    return squared > 0 ? std::clamp(dot(p - begin, along) / squared, 0.0, 1.0) : 0;
}

double distance(Vec3d p, Segment s) {
    const Vec3d along = s.end - s.begin;
    return length(p - (s.begin + along * closest(p, s.begin, along)));
}

/// Distance between two segments. The closest points are both inside, or one is an end.
double distance(Segment s, Segment t) {
    double least = std::min({distance(s.begin, t), distance(s.end, t), distance(t.begin, s), distance(t.end, s)});
    const Vec3d a = s.end - s.begin, b = t.end - t.begin, between = t.begin - s.begin, normal = cross(a, b);
    const double squared = dot(normal, normal);
    if (!(squared > 0)) return least;
    const double u = dot(cross(between, b), normal) / squared, v = dot(cross(between, a), normal) / squared;
    if (u >= 0 && u <= 1 && v >= 0 && v <= 1) least = std::min(least, length(s.begin + a * u - (t.begin + b * v)));
    return least;
}

/// Whether the projection of a point along the normal falls into a triangle.
bool is_over(Vec3d p, const Triangle3d& t, Vec3d normal) {
    for (std::size_t k = 0; k < 3; ++k)
        if (dot(cross(t[(k + 1) % 3] - t[k], p - t[k]), normal) < 0) return false;
    return true;
}

bool pierces(Segment s, const Triangle3d& t) {
    const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
    const double begin = dot(s.begin - t[0], normal), end = dot(s.end - t[0], normal);
    if (!((begin < 0) != (end < 0))) return false;
    return is_over(s.begin + (s.end - s.begin) * (begin / (begin - end)), t, normal);
}

}  // namespace

double distance(Vec3d point, const Triangle3d& triangle) {
    const Vec3d normal = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    const double area = length(normal);
    if (area > 0 && is_over(point, triangle, normal)) return std::abs(dot(point - triangle[0], normal)) / area;
    return std::min({distance(point, edge(triangle, 0)), distance(point, edge(triangle, 1)),
                     distance(point, edge(triangle, 2))});
}

double distance(const Triangle3d& a, const Triangle3d& b) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        if (pierces(edge(a, i), b) || pierces(edge(b, i), a)) return 0;
        least = std::min({least, distance(a[i], b), distance(b[i], a)});
        for (std::size_t k = 0; k < 3; ++k) least = std::min(least, distance(edge(a, i), edge(b, k)));
    }
    return least;
}

}  // namespace dg
