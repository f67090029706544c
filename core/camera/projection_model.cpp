#include "camera/projection_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "math/error.h"

namespace dg {
namespace {

using Kind = ProjectionModel::Kind;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kNewton = 40;
constexpr double kExact = 1e-13;   // relative tolerance of points
constexpr double kSame = 1e-6;     // relative tolerance of a round trip
constexpr int kFoldSteps = 4096;

double square(double x) {
    return x * x;
}

/// Half of the range of a unified model's inverse (Usenko et al. 2018, equations 34 and 43).
double widest(double alpha) {
    return alpha <= 0.5 ? alpha / (1 - alpha) : (1 - alpha) / alpha;
}

/// Bisects for the zero of a slope that is positive at `low` and not at `high`; returns the last
/// position with a positive slope.
template <class Slope>
double last_rising(Slope slope, double low, double high) {
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (slope(middle) > 0 ? low : high) = middle;
    }
    return low;
}

/// Solves function(x) = value for a function that increases up to `high`, by Newton's method within
/// a bracket.
template <class Function, class Slope>
double solved(Function function, Slope slope, double value, double high) {
    double low = 0, x = std::min(value, high);
    for (int i = 0; i < kNewton; ++i) {
        const double miss = function(x) - value;
        if (std::abs(miss) <= kExact * std::max(value, 1e-3)) break;
        (miss > 0 ? high : low) = x;
        const double next = x - miss / slope(x);
        x = next > low && next < high ? next : 0.5 * (low + high);
    }
    return x;
}

using Matrix = std::array<double, 9>;

Vec3d times(const Matrix& m, Vec3d v) {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
            m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix c{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    return c;
}

/// Homography of a tilted sensor: rotation by the angles, then projection from the lens (OpenCV's
/// tauX, tauY).
Matrix tilt_matrix(double x, double y) {
    const double cx = std::cos(x), sx = std::sin(x), cy = std::cos(y), sy = std::sin(y);
    const Matrix about_x{1, 0, 0, 0, cx, sx, 0, -sx, cx}, about_y{cy, 0, -sy, 0, 1, 0, sy, 0, cy};
    const Matrix r = product(about_y, about_x);
    return product({r[8], 0, -r[2], 0, r[8], -r[5], 0, 0, 1}, r);
}

Matrix inverse(const Matrix& m) {
    const auto minor = [&](int a, int b, int c, int d) { return m[a] * m[d] - m[b] * m[c]; };
    const double det = m[0] * minor(4, 5, 7, 8) - m[1] * minor(3, 5, 6, 8) + m[2] * minor(3, 4, 6, 7);
    Matrix out{minor(4, 5, 7, 8), -minor(1, 2, 7, 8), minor(1, 2, 4, 5), -minor(3, 5, 6, 8), minor(0, 2, 6, 8),
               -minor(0, 2, 3, 5), minor(3, 4, 6, 7), -minor(0, 1, 6, 7), minor(0, 1, 3, 4)};
    for (double& x : out) x /= det;
    return out;
}

Vec2d seen(Vec3d v) {
    return {v.x / v.z, v.y / v.z};
}

/// Applies the homography of a tilted sensor or its inverse; empty beyond the horizon of its plane.
std::optional<Vec2d> through(const Matrix& tilt, Vec2d p) {
    const Vec3d v = times(tilt, {p.x, p.y, 1});
    return v.z > 0 ? std::optional(seen(v)) : std::nullopt;
}

/// Faces of the cube in image order: viewing axis, and the axes of the image.
struct Face {
    Vec3d ahead, right, down;
};
constexpr Face kFaces[6] = {
    {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},  {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}},
};

Vec2d on_cube(Vec3d d) {
    const double a[3] = {std::abs(d.x), std::abs(d.y), std::abs(d.z)};
    const int axis = a[0] >= a[1] && a[0] >= a[2] ? 0 : a[1] >= a[2] ? 1 : 2;
    const int face = 2 * axis + ((axis == 0 ? d.x : axis == 1 ? d.y : d.z) < 0);
    const Face& f = kFaces[face];
    const double scale = 0.5 / dot(d, f.ahead);
    return {face - 2.5 + scale * dot(d, f.right), scale * dot(d, f.down)};
}

std::optional<Vec3d> from_cube(Vec2d p) {
    if (!(std::abs(p.x) < 3 && std::abs(p.y) <= 0.5)) return std::nullopt;
    const int face = std::clamp(int(std::floor(p.x + 3)), 0, 5);
    const Face& f = kFaces[face];
    return normalize(f.ahead + 2 * (p.x - (face - 2.5)) * f.right + 2 * p.y * f.down);
}

}  // namespace

ProjectionModel::ProjectionModel(Kind kind, std::array<double, kMost> parameters)
    : kind_(kind), k_(parameters), largest_angle_(kPiD), largest_radius_(kInfinity),
      ideal_end_(kInfinity) {
    for (const double x : k_)
        if (!std::isfinite(x)) throw input_error("projection", "parameters", "finite numbers", "NaN or infinity");
    const auto within = [&](int i, const char* name, double low, double high) {
        if (!(k_[i] >= low && k_[i] <= high))
            throw input_error("projection", name, std::to_string(low) + " .. " + std::to_string(high),
                              std::to_string(k_[i]));
    };
    switch (kind_) {
    case Kind::opencv:
        std::copy_n(k_.begin(), 8, radial_.begin());
        within(12, "tilt_x", -1.5, 1.5), within(13, "tilt_y", -1.5, 1.5);
        tilts_ = k_[12] != 0 || k_[13] != 0;
        tilt_ = tilt_matrix(k_[12], k_[13]);
        untilt_ = inverse(tilt_);
        break;
    case Kind::opencv_inverse: std::copy_n(k_.begin(), 8, radial_.begin()); break;
    case Kind::omni:
        within(0, "xi", 0, 100);
        radial_ = {k_[1], k_[2], k_[3], k_[4], 0, 0, 0, 0};
        break;
    case Kind::double_sphere: within(0, "xi", -1, 100), within(1, "alpha", 0, 1); break;
    case Kind::eucm: within(0, "alpha", 0, 1), within(1, "beta", 1e-6, 1e6); break;
    case Kind::fov: within(0, "w", 1e-6, kPiD); break;
    default: break;
    }
    leans_ = radial_[2] != 0 || radial_[3] != 0 ||
             (kind_ == Kind::opencv && std::any_of(k_.begin() + 8, k_.begin() + 12, [](double s) { return s != 0; }));
    find_fold();
}

bool ProjectionModel::is_wide() const {
    switch (kind_) {
    case Kind::rectilinear: case Kind::opencv: case Kind::opencv_inverse: case Kind::fov: return false;
    default: return true;
    }
}

/// Finds the largest angle and radius: where a radial model folds back or its domain ends.
void ProjectionModel::find_fold() {
    switch (kind_) {
    case Kind::rectilinear: largest_angle_ = kPiD / 2; return;
    case Kind::orthographic: largest_angle_ = kPiD / 2, largest_radius_ = 1; return;
    case Kind::equidistant: largest_radius_ = kPiD; return;
    case Kind::equisolid: largest_radius_ = 2; return;
    case Kind::fov: largest_angle_ = kPiD / 2, largest_radius_ = kPiD / 2 / k_[0]; return;
    case Kind::eucm: {
        const double w = widest(k_[0]);
        largest_angle_ = atan2(std::sqrt(1 - w * w), -w * std::sqrt(k_[1]));
        return;
    }
    case Kind::double_sphere: {
        // Tangent from the centre of the second sphere to its limit, continued to the first sphere.
        const double xi = k_[0], w = widest(k_[1]), inside = 1 - xi * xi * (1 - w * w);
        double z = inside >= 0 ? w * (w * xi - std::sqrt(inside)) - xi : -1;
        if (xi > 1) z = std::max(z, -1 / xi);
        largest_angle_ = acos(std::clamp(z, -1.0, 1.0));
        return;
    }
    case Kind::kannala_brandt: {
        for (int i = 1; i <= kFoldSteps; ++i) {
            const double t = kPiD * i / kFoldSteps, t2 = t * t;
            const double slope =
                1 + t2 * (3 * k_[0] + t2 * (5 * k_[1] + t2 * (7 * k_[2] + t2 * 9 * k_[3])));
            if (slope > 0) continue;
            largest_angle_ = kPiD * (i - 1) / kFoldSteps;
            break;
        }
        largest_radius_ = radius_of(largest_angle_);
        return;
    }
    case Kind::ftheta: {
        // Up to 180 degrees, as long as the angle increases.
        const auto seen = [&](double r) { return ftheta_slope(r) > 0 && ftheta_angle(r) <= kPiD ? 1.0 : -1.0; };
        double before = 0, r = 0;
        for (int i = 0; i <= 4 * kFoldSteps && seen(r) > 0; ++i) {
            before = r;
            r = std::exp(-6 + 12.0 * i / (4 * kFoldSteps));   // 0.0025 to 400 focal lengths
        }
        largest_radius_ = seen(r) > 0 ? r : last_rising(seen, before, r);
        largest_angle_ = ftheta_angle(largest_radius_);
        return;
    }
    case Kind::opencv:
    case Kind::opencv_inverse:
    case Kind::omni: {
        // Ideal radius at which the distorted radius stops increasing; an omni model also has its
        // domain limit.
        double last = kInfinity;
        double before = 0;
        for (int i = 0; i <= 4 * kFoldSteps && last == kInfinity; ++i) {
            const double r = std::exp(-6 + 12.0 * i / (4 * kFoldSteps));   // 0.0025 to 400 focal lengths
            if (!(radial_slope(r) > 0)) last = last_rising([&](double x) { return radial_slope(x); }, before, r);
            before = r;
        }
        if (last < kInfinity && !(radial_factor(last) > 0))   // e.g. a pole before the first step
            throw input_error("projection", "parameters", "a radius that increases from the centre", "a radius that decreases");
        ideal_end_ = last;
        largest_angle_ = kind_ == Kind::opencv ? atan(last) : kPiD;
        largest_radius_ = last < kInfinity ? last * radial_factor(last) : kInfinity;
        if (kind_ == Kind::omni) {
            const double xi = k_[0], inside = 1 + (1 - xi * xi) * last * last;   // on the sphere at this radius
            largest_angle_ = acos(xi <= 1 ? -xi : -1 / xi);
            if (last < kInfinity && inside >= 0)
                largest_angle_ = acos((xi + std::sqrt(inside)) / (1 + last * last) - xi);
        }
        if (kind_ != Kind::opencv_inverse) return;
        largest_angle_ = atan(largest_radius_);
        largest_radius_ = last;
        return;
    }
    default: return;
    }
}

/// Ratio of distorted to ideal radius by the radial terms.
double ProjectionModel::radial_factor(double r) const {
    const double r2 = r * r;
    const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = radial_;
    return (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) * (1 / (1 + r2 * (k4 + r2 * (k5 + r2 * k6))));
}

/// Derivative of the distorted radius by the ideal radius, radial terms only.
double ProjectionModel::radial_slope(double r) const {
    const double r2 = r * r, r4 = r2 * r2, r6 = r4 * r2;
    const double a = 1 + radial_[0] * r2 + radial_[1] * r4 + radial_[4] * r6;
    const double b = 1 + radial_[5] * r2 + radial_[6] * r4 + radial_[7] * r6;
    const double da = 2 * radial_[0] * r2 + 4 * radial_[1] * r4 + 6 * radial_[4] * r6;   // r times a'
    const double db = 2 * radial_[5] * r2 + 4 * radial_[6] * r4 + 6 * radial_[7] * r6;
    if (!(b > 0)) return -1;
    return (a + da) / b - a * db / (b * b);
}

double ProjectionModel::radius_of(double angle) const {
    switch (kind_) {
    case Kind::rectilinear: return std::tan(angle);
    case Kind::equidistant: return angle;
    case Kind::equisolid: return 2 * std::sin(0.5 * angle);
    case Kind::stereographic: return 2 * std::tan(0.5 * angle);
    case Kind::orthographic: return std::sin(angle);
    case Kind::fov: return atan(2 * std::tan(angle) * std::tan(0.5 * k_[0])) / k_[0];
    case Kind::ftheta:
        return solved([&](double r) { return ftheta_angle(r); }, [&](double r) { return ftheta_slope(r); }, angle,
                      largest_radius_);
    default: {
        const double t2 = angle * angle;
        return angle * (1 + t2 * (k_[0] + t2 * (k_[1] + t2 * (k_[2] + t2 * k_[3]))));
    }
    }
}

std::optional<double> ProjectionModel::angle_of(double r) const {
    switch (kind_) {
    case Kind::rectilinear: return atan(r);
    case Kind::equidistant: return r <= kPiD ? std::optional(r) : std::nullopt;
    case Kind::equisolid: return r <= 2 ? std::optional(2 * asin(0.5 * r)) : std::nullopt;
    case Kind::stereographic: return 2 * atan(0.5 * r);
    case Kind::orthographic: return r <= 1 ? std::optional(asin(r)) : std::nullopt;
    case Kind::fov:
        if (!(r * k_[0] < kPiD / 2)) return std::nullopt;
        return atan(std::tan(r * k_[0]) / (2 * std::tan(0.5 * k_[0])));
    default: break;
    }
    if (r > largest_radius_) return std::nullopt;
    if (kind_ == Kind::ftheta) return ftheta_angle(r);
    // The radius increases with the angle up to the fold.
    const auto slope = [&](double t) {
        const double t2 = t * t;
        return 1 + t2 * (3 * k_[0] + t2 * (5 * k_[1] + t2 * (7 * k_[2] + t2 * 9 * k_[3])));
    };
    return solved([&](double t) { return radius_of(t); }, slope, r, largest_angle_);
}

double ProjectionModel::ftheta_angle(double r) const {
    return r * (1 + r * (k_[0] + r * (k_[1] + r * (k_[2] + r * k_[3]))));
}

double ProjectionModel::ftheta_slope(double r) const {
    return 1 + r * (2 * k_[0] + r * (3 * k_[1] + r * (4 * k_[2] + r * 5 * k_[3])));
}

/// Radial, tangential and thin prism terms, without domain checks, and their derivatives by x and
/// y.
ProjectionModel::Bent ProjectionModel::bent(Vec2d u) const {
    const double r2 = u.x * u.x + u.y * u.y, xy = 2 * u.x * u.y;
    const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = radial_;
    const double a = 1 + r2 * (k1 + r2 * (k2 + r2 * k3)), b = 1 / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
    const double da = k1 + r2 * (2 * k2 + r2 * 3 * k3), db = k4 + r2 * (2 * k5 + r2 * 3 * k6);
    const double radial = a * b, slope = 2 * (da - radial * db) * b;   // derivative by r^2, times 2
    const double across = 0.5 * xy * slope;
    Bent out{{u.x * radial + p1 * xy + p2 * (r2 + 2 * u.x * u.x), u.y * radial + p1 * (r2 + 2 * u.y * u.y) + p2 * xy},
             {radial + u.x * u.x * slope + 2 * p1 * u.y + 6 * p2 * u.x, across + 2 * (p1 * u.x + p2 * u.y)},
             {across + 2 * (p1 * u.x + p2 * u.y), radial + u.y * u.y * slope + 6 * p1 * u.y + 2 * p2 * u.x}};
    if (kind_ != Kind::opencv) return out;
    const Vec2d once{k_[8], k_[10]}, twice{k_[9], k_[11]};   // s1 s3, s2 s4
    out.point = out.point + r2 * (once + r2 * twice);
    const Vec2d prism = 2 * (once + 2 * r2 * twice);
    out.by_x = out.by_x + u.x * prism;
    out.by_y = out.by_y + u.y * prism;
    return out;
}

std::optional<Vec2d> ProjectionModel::distorted(Vec2d u) const {
    if (!(length(u) <= ideal_end_)) return std::nullopt;
    const Vec2d d = bent(u).point;
    const auto p = tilts_ ? through(tilt_, d) : d;
    if (!p || !leans_) return p;
    // Tangential and prism terms fold on one side first: beyond the fold the point belongs to
    // another direction.
    const auto back = undistorted(*p);
    return back && length(*back - u) <= kSame * std::max(length(u), 1e-3) ? p : std::nullopt;
}

/// Newton's method in both coordinates; the solution must be before the fold.
std::optional<Vec2d> ProjectionModel::undistorted(Vec2d p) const {
    const auto flat = tilts_ ? through(untilt_, p) : p;
    if (!flat) return std::nullopt;
    const Vec2d goal = *flat;
    Vec2d u = goal;
    if (length(u) > ideal_end_) u = u * (0.9 * ideal_end_ / length(u));
    const double size = std::max(length(goal), 1e-3);
    for (int i = 0; i < kNewton; ++i) {
        const Bent here = bent(u);
        const Vec2d miss = here.point - goal;
        const double det = here.area();
        if (length(miss) <= kExact * size) return det > 0 ? std::optional(u) : std::nullopt;
        if (det == 0) return std::nullopt;
        Vec2d step{(here.by_y.y * miss.x - here.by_y.x * miss.y) / det,
                   (here.by_x.x * miss.y - here.by_x.y * miss.x) / det};
        const double long_step = length(step), longest = 0.5 * std::max(length(u), 0.1);
        if (long_step > longest) step = step * (longest / long_step);
        u = u - step;
        if (length(u) > ideal_end_) u = u * (0.999999 * ideal_end_ / length(u));
    }
    const Bent here = bent(u);   // converged up to rounding, or not at all
    return here.area() > 0 && length(here.point - goal) <= 1e-10 * size ? std::optional(u) : std::nullopt;
}

std::optional<Vec2d> ProjectionModel::project(Vec3d d) const {
    const double norm = length(d);
    if (!(norm > 0)) return std::nullopt;
    switch (kind_) {
    case Kind::equirectangular:
        return Vec2d{atan2(d.x, d.z), asin(std::clamp(d.y / norm, -1.0, 1.0))};
    case Kind::cube: return on_cube(d);
    case Kind::opencv: return d.z > 0 ? distorted(seen(d)) : std::nullopt;
    case Kind::opencv_inverse: return d.z > 0 ? undistorted(seen(d)) : std::nullopt;
    case Kind::omni: {
        const double z = d.z + k_[0] * norm;
        // Beyond this angle two directions share a point (Mei and Rives 2007: xi > 1), or the
        // direction has no point.
        const double back = k_[0] <= 1 ? -k_[0] : -1 / k_[0];
        if (!(z > 0 && d.z > back * norm)) return std::nullopt;
        return distorted({d.x / z, d.y / z});
    }
    case Kind::double_sphere: {
        const double xi = k_[0], alpha = k_[1];
        const double z = xi * norm + d.z, d2 = hypot(hypot(d.x, d.y), z);
        // The second sphere has the domain of a unified model. (Equation 43 bounds the angle of the
        // first sphere instead, some degrees too early.) Beyond a second angle two directions share
        // a point, as in omni.
        if (!(z > -widest(alpha) * d2 && (xi <= 1 || d.z * xi > -norm))) return std::nullopt;
        const double scale = alpha * d2 + (1 - alpha) * z;
        return scale > 0 ? std::optional(Vec2d{d.x / scale, d.y / scale}) : std::nullopt;
    }
    case Kind::eucm: {
        const double alpha = k_[0], beta = k_[1];
        const double rho = std::sqrt(beta * (d.x * d.x + d.y * d.y) + d.z * d.z);
        if (!(d.z > -widest(alpha) * rho)) return std::nullopt;
        const double scale = alpha * rho + (1 - alpha) * d.z;
        return scale > 0 ? std::optional(Vec2d{d.x / scale, d.y / scale}) : std::nullopt;
    }
    default: break;
    }
    const double across = hypot(d.x, d.y), angle = atan2(across, d.z);
    if (!(angle <= largest_angle_) || (kind_ == Kind::rectilinear && !(d.z > 0))) return std::nullopt;
    if (across == 0) return Vec2d{0, 0};
    const double scale = radius_of(angle) / across;
    return Vec2d{d.x * scale, d.y * scale};
}

std::optional<Vec3d> ProjectionModel::unproject(Vec2d p) const {
    switch (kind_) {
    case Kind::equirectangular: {
        if (!(std::abs(p.x) <= kPiD && std::abs(p.y) <= kPiD / 2)) return std::nullopt;
        const double c = std::cos(p.y);
        return Vec3d{c * std::sin(p.x), std::sin(p.y), c * std::cos(p.x)};
    }
    case Kind::cube: return from_cube(p);
    case Kind::opencv:
    case Kind::opencv_inverse: {
        const auto u = kind_ == Kind::opencv ? undistorted(p) : distorted(p);
        return u ? std::optional(normalize(Vec3d{u->x, u->y, 1})) : std::nullopt;
    }
    case Kind::omni: {
        const auto u = undistorted(p);
        if (!u) return std::nullopt;
        const double xi = k_[0], r2 = u->x * u->x + u->y * u->y, inside = 1 + (1 - xi * xi) * r2;
        if (!(inside >= 0)) return std::nullopt;
        const double scale = (xi + std::sqrt(inside)) / (r2 + 1);
        return normalize(Vec3d{scale * u->x, scale * u->y, scale - xi});
    }
    case Kind::double_sphere: {
        const double xi = k_[0], alpha = k_[1], r2 = p.x * p.x + p.y * p.y;
        const double inside = 1 - (2 * alpha - 1) * r2;
        if (!(inside >= 0)) return std::nullopt;
        const double z = (1 - alpha * alpha * r2) / (alpha * std::sqrt(inside) + 1 - alpha);
        const double other = z * z + (1 - xi * xi) * r2;
        if (!(other >= 0)) return std::nullopt;
        const double scale = (z * xi + std::sqrt(other)) / (z * z + r2);
        if (!(scale > 0)) return std::nullopt;   // for xi >= 1: no direction has this point
        return normalize(Vec3d{scale * p.x, scale * p.y, scale * z - xi});
    }
    case Kind::eucm: {
        const double alpha = k_[0], beta = k_[1], r2 = p.x * p.x + p.y * p.y;
        const double inside = 1 - (2 * alpha - 1) * beta * r2;
        if (!(inside >= 0)) return std::nullopt;
        const double over = alpha * std::sqrt(inside) + 1 - alpha;
        if (!(over > 0)) return std::nullopt;   // rim at alpha = 1
        return normalize(Vec3d{p.x, p.y, (1 - beta * alpha * alpha * r2) / over});
    }
    default: break;
    }
    const double r = length(p);
    const auto angle = angle_of(r);
    if (!angle) return std::nullopt;
    if (r == 0) return Vec3d{0, 0, 1};
    const double across = std::sin(*angle) / r;
    return Vec3d{p.x * across, p.y * across, std::cos(*angle)};
}

Vec2d ProjectionModel::continued(Vec2d p) const {
    if (kind_ != Kind::equirectangular || (std::abs(p.x) <= kPiD && std::abs(p.y) <= kPiD / 2)) return p;
    p.y = std::remainder(p.y, 2 * kPiD);
    if (std::abs(p.y) > kPiD / 2) {   // across a pole, continuing on the other side
        p.y = std::copysign(kPiD, p.y) - p.y;
        p.x += kPiD;
    }
    return {std::remainder(p.x, 2 * kPiD), p.y};
}

double ProjectionModel::solid_angle(Vec2d p) const {
    const double h = 1e-5;
    const auto a = unproject({p.x - h, p.y}), b = unproject({p.x + h, p.y}), c = unproject({p.x, p.y - h}),
               d = unproject({p.x, p.y + h});
    if (!(a && b && c && d)) return 0;
    return length(cross(*b - *a, *d - *c)) / square(2 * h);
}

}  // namespace dg
