#include "optics/lens/stop.h"

#include <string>

#include "math/error.h"

namespace dg {
namespace {

constexpr int kArcPieces = 16;

double cross(Vec2d a, Vec2d b) {
    return a.x * b.y - a.y * b.x;
}
Vec2d unit(double angle) {
    return {std::cos(angle), std::sin(angle)};
}

/// Point at parameter t in [0,1] on the edge of blade 0, rotated so that the middle of the edge is
/// on +x.
Vec2d edge_point(const Iris::Blades& b, double half_chord, double t) {
    if (b.bend == 0) return {b.apothem, half_chord * (2 * t - 1)};
    const double half = asin(std::min(1.0, half_chord / b.arc_radius));
    const double angle = half * (2 * t - 1);
    return {b.center + b.bend * b.arc_radius * std::cos(angle),
            b.arc_radius * std::sin(angle)};
}

/// Parameter of the next corner, such that the triangle (origin, from, next) has the given area; 2
/// if the edge ends first.
double next_corner(const Iris::Blades& b, double half_chord, double from, double area) {
    const Vec2d p = edge_point(b, half_chord, from);
    if (0.5 * cross(p, edge_point(b, half_chord, 1)) < area) return 2;
    double low = from, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double t = 0.5 * (low + high);
        (0.5 * cross(p, edge_point(b, half_chord, t)) < area ? low : high) = t;
    }
    return 0.5 * (low + high);
}

/// Edge parameters at the corners of triangles with equal areas.
std::vector<double> equal_area_corners(const Iris::Blades& b, double half_chord,
                                       int pieces) {
    double low = 0, high = 4;
    std::vector<double> corners;
    for (int i = 0; i < 60; ++i) {
        const double area = 0.5 * (low + high);
        corners.assign(1, 0.0);
        while (int(corners.size()) < pieces && corners.back() <= 1)
            corners.push_back(next_corner(b, half_chord, corners.back(), area));
        const bool too_big =
            corners.back() > 1 || next_corner(b, half_chord, corners.back(), area) > 1;
        (too_big ? high : low) = area;
        if (corners.back() > 1) continue;
    }
    corners.assign(1, 0.0);
    while (int(corners.size()) < pieces)
        corners.push_back(next_corner(b, half_chord, corners.back(), low));
    return corners;
}

/// Factor by which the fan must grow so that its chords enclose an outward arc.
double cover_factor(const Iris::Blades& b, double half_chord,
                    const std::vector<double>& corners) {
    double factor = 1;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const double end = i + 1 < corners.size() ? corners[i + 1] : 1;
        const Vec2d p = edge_point(b, half_chord, corners[i]),
                    q = edge_point(b, half_chord, end);
        const Vec2d normal{q.y - p.y, p.x - q.x};
        for (int j = 1; j < 32; ++j) {
            const Vec2d arc =
                edge_point(b, half_chord, corners[i] + (end - corners[i]) * j / 32);
            factor = std::max(factor, dot(normal, arc) / dot(normal, p));
        }
    }
    return b.bend > 0 ? factor * (1 + 1e-5) : 1;
}

}  // namespace

Vec2d concentric_disc(Vec2d u) {
    const double a = 2 * u.x - 1, b = 2 * u.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    if (std::abs(a) > std::abs(b)) return a * unit(kPiD / 4 * b / a);
    return b * unit(kPiD / 2 - kPiD / 4 * a / b);
}

Iris Iris::polygon(int blades, double rotation_deg, double curvature) {
    if (blades < 3 || blades > 64)
        throw input_error("iris", "blades", "3 to 64", std::to_string(blades));
    if (!(curvature >= -1 && curvature <= 1))
        throw input_error("iris", "blade curvature", "-1 to 1",
                          std::to_string(curvature));
    if (!std::isfinite(rotation_deg))
        throw input_error("iris", "blade rotation", "finite degrees",
                          std::to_string(rotation_deg));
    Iris iris;
    iris.kind_ = Kind::blades;
    Blades& b = iris.blades_;
    b.bend = curvature > 1e-6 ? 1 : curvature < -1e-6 ? -1 : 0;
    const double half = kPiD / blades;
    // Area with corners on the unit circle: the polygon, and one circular segment per blade.
    double area = blades * std::sin(half) * std::cos(half), arc = 0;
    if (b.bend) {
        arc = 1 / std::abs(curvature);
        const double angle = 2 * asin(std::min(1.0, std::sin(half) / arc));
        area += b.bend * blades * 0.5 * arc * arc * (angle - std::sin(angle));
    }
    const double corner = std::sqrt(kPiD / area), half_chord = corner * std::sin(half);
    b.apothem = corner * std::cos(half);
    b.arc_radius = arc * corner;
    const double depth =
        std::sqrt(std::max(0.0, b.arc_radius * b.arc_radius - half_chord * half_chord));
    b.center = b.apothem - b.bend * depth;
    const auto corners = equal_area_corners(b, half_chord, b.bend ? kArcPieces : 1);
    const double grow = cover_factor(b, half_chord, corners);
    for (int i = 0; i < blades; ++i) {
        b.edge.push_back(unit(rotation_deg * kPiD / 180 + (2 * i + 1) * half));
        const Vec2d ex = b.edge.back(), ey{-ex.y, ex.x};
        for (const double t : corners) {
            const Vec2d p = grow * edge_point(b, half_chord, t);
            b.fan.push_back(p.x * ex + p.y * ey);
        }
    }
    b.fan.push_back(b.fan.front());
    return iris;
}

Iris Iris::image(int width, int height, std::vector<float> values) {
    if (width < 1 || height < 1 || width > 4096 || height > 4096 ||
        values.size() != std::size_t(width) * height)
        throw input_error("iris image", "size", "1 to 4096 pixels a side, one value each",
                          std::to_string(width) + " x " + std::to_string(height) + ", " +
                              std::to_string(values.size()) + " values");
    double sum = 0;
    for (const float v : values) {
        if (!(v >= 0 && v <= 1))
            throw input_error("iris image", "value", "0 to 1", std::to_string(v));
        sum += v;
    }
    if (!(sum > 0)) throw Error("iris image: wanted an opening, got only black pixels");
    Iris iris;
    iris.kind_ = Kind::image;
    Image& m = iris.image_;
    m.width = width, m.height = height;
    m.pixel = std::sqrt(kPiD / sum);
    m.values = std::move(values);
    // Sampling support: open pixels, dilated by a border of 1.5 % of the half diagonal for the
    // enlarged iris.
    const int border = 1 + int(0.015 * 0.5 * hypot(width, height));
    std::vector<char> rows(m.values.size());
    m.in_support.assign(m.values.size(), 0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (m.values[y * width + x] > 0)
                for (int i = std::max(0, x - border);
                     i <= std::min(width - 1, x + border); ++i)
                    rows[y * width + i] = 1;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (rows[y * width + x])
                for (int i = std::max(0, y - border);
                     i <= std::min(height - 1, y + border); ++i)
                    m.in_support[i * width + x] = 1;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (m.in_support[y * width + x])
                m.support.push_back(
                    {(x - 0.5 * width) * m.pixel, (0.5 * height - y - 1) * m.pixel});
    return iris;
}

double Iris::transmission(Vec2d p) const {
    if (kind_ == Kind::round) return dot(p, p) <= 1;
    if (kind_ == Kind::image) {
        const double x = std::floor(p.x / image_.pixel + 0.5 * image_.width);
        const double y = std::floor(0.5 * image_.height - p.y / image_.pixel);
        if (!(x >= 0 && x < image_.width && y >= 0 && y < image_.height)) return 0;
        return image_.values[int(y) * image_.width + int(x)];
    }
    for (const Vec2d e : blades_.edge) {
        if (blades_.bend <= 0 && dot(e, p) > blades_.apothem) return 0;
        const Vec2d d = p - blades_.center * e;
        const double past = dot(d, d) - blades_.arc_radius * blades_.arc_radius;
        if (blades_.bend * past > 0) return 0;
    }
    return 1;
}

Vec2d Iris::sample(Vec2d u, double enlargement) const {
    if (kind_ == Kind::round) return enlargement * concentric_disc(u);
    if (kind_ == Kind::image) {
        const double scaled = u.x * image_.support.size();
        const std::size_t i = std::min(image_.support.size() - 1, std::size_t(scaled));
        return enlargement *
               (image_.support[i] + image_.pixel * Vec2d{scaled - double(i), u.y});
    }
    const int triangles = int(blades_.fan.size()) - 1;
    const double scaled = u.x * triangles;
    const int i = std::clamp(int(scaled), 0, triangles - 1);
    const double r = enlargement * std::sqrt(u.y), t = scaled - i;
    return r * ((1 - t) * blades_.fan[i] + t * blades_.fan[i + 1]);
}

double Iris::sampling_area(double enlargement) const {
    const double scale = enlargement * enlargement;
    if (kind_ == Kind::round) return scale * kPiD;
    if (kind_ == Kind::image)
        return scale * image_.support.size() * image_.pixel * image_.pixel;
    double area = 0;
    for (std::size_t i = 0; i + 1 < blades_.fan.size(); ++i)
        area += 0.5 * cross(blades_.fan[i], blades_.fan[i + 1]);
    return scale * area;
}

bool Iris::in_sampling_region(Vec2d p, double enlargement) const {
    p = p * (1 / enlargement);
    if (kind_ == Kind::round) return dot(p, p) <= 1;
    if (kind_ == Kind::image) {
        const double x = std::floor(p.x / image_.pixel + 0.5 * image_.width);
        const double y = std::floor(0.5 * image_.height - p.y / image_.pixel);
        if (!(x >= 0 && x < image_.width && y >= 0 && y < image_.height)) return false;
        return image_.in_support[int(y) * image_.width + int(x)];
    }
    for (std::size_t i = 0; i + 1 < blades_.fan.size(); ++i) {
        const Vec2d a = blades_.fan[i], b = blades_.fan[i + 1];
        if (cross(a, p) >= 0 && cross(p, b) >= 0) return cross(b - a, p - a) >= 0;
    }
    return false;
}

double Iris::outer_radius() const {
    double r = kind_ == Kind::round ? 1 : 0;
    for (const Vec2d p : blades_.fan) r = std::max(r, length(p));
    for (const Vec2d p : image_.support)
        for (int corner = 0; corner < 4; ++corner)
            r = std::max(r, length(p + image_.pixel * Vec2d{double(corner & 1),
                                                            double(corner >> 1)}));
    return r;
}

double Iris::inner_radius() const {
    if (kind_ == Kind::round) return 1;
    if (kind_ == Kind::image || blades_.edge.empty()) return 0;
    const double middle = blades_.bend == 0 ? blades_.apothem : blades_.center + blades_.bend * blades_.arc_radius;
    return std::clamp(middle, 0.0, outer_radius());
}

RadialOpening::RadialOpening(const Iris& iris) : outer_(iris.outer_radius()) {
    if (iris.kind() == Iris::Kind::round) return;
    constexpr int kRadii = 1024;
    // All blades are alike, so the mean over one blade suffices.
    const int turns = iris.kind() == Iris::Kind::blades ? int(iris.blades().edge.size()) : 1;
    const int azimuths = 720 / turns;
    for (int i = 0; i <= kRadii; ++i) {
        const double q = outer_ * i / kRadii;
        double sum = 0;
        for (int j = 0; j < azimuths; ++j)
            sum += iris.transmission(q * unit(2 * kPiD * (j + 0.5) / (azimuths * turns)));
        table_.push_back(sum / azimuths);
    }
}

double RadialOpening::at(double q) const {
    if (table_.empty()) return q <= 1;
    const double x = q / outer_ * double(table_.size() - 1);
    const std::size_t i = std::size_t(x);
    if (!(x >= 0) || i + 1 >= table_.size()) return q <= outer_ ? table_.back() : 0;
    return table_[i] + (x - double(i)) * (table_[i + 1] - table_[i]);
}

}  // namespace dg
