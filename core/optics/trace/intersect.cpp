#include "optics/trace/intersect.h"

#include <algorithm>

namespace dg {
namespace {

constexpr double kResidual = 1e-9;  // mm
constexpr int kPieces = 32;         // intervals of a span in the scan for a sign change

/// Signed distance (in z) past the surface, negative before it, and its derivative by t.
struct Side {
    double past, speed;
    bool defined;
};

/// Ray and surface of a root search.
struct Search {
    const SurfaceForm& form;
    Vec3d origin, direction;
    double sign;

    Side at(double t) const {
        const Vec3d p = origin + t * direction;
        const Sag<double> s = sag(form, p.x, p.y);
        return {sign * (p.z - s.z),
                sign * (direction.z - s.slope_x * direction.x - s.slope_y * direction.y),
                s.defined};
    }
    bool crosses(double t) const {
        const Side s = at(t);
        return s.defined && s.speed > 0 && std::abs(s.past) < kResidual;
    }
};

struct Span {
    double low, high;
};

/// Interval of the ray within a cylinder about the axis and a slab about the vertex plane.
std::optional<Span> inside(const Search& s, double radius, double height) {
    const Vec3d o = s.origin, d = s.direction;
    Span span{-1e9, 1e9};
    const auto cut = [&](double low, double high) {
        span = {std::max(span.low, low), std::min(span.high, high)};
    };
    const double a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y;
    const double c = o.x * o.x + o.y * o.y - radius * radius;
    if (a > 1e-24) {
        const double discriminant = b * b - a * c;
        if (!(discriminant >= 0)) return std::nullopt;
        const double root = std::sqrt(discriminant);
        cut((-b - root) / a, (-b + root) / a);
    } else if (!(c <= 0)) {
        return std::nullopt;
    }
    if (std::abs(d.z) > 1e-12) {
        const double t1 = (-height - o.z) / d.z, t2 = (height - o.z) / d.z;
        cut(std::min(t1, t2), std::max(t1, t2));
    }
    if (!(span.low <= span.high)) return std::nullopt;
    return span;
}

/// Newton's method within a bracket with opposite signs at its ends. Bisects when a step would
/// leave the bracket or is more than half as long as the step before (Dekker 1969, Finding a zero
/// by means of successive linear interpolation).
std::optional<double> bracketed(const Search& s, Span span, double start) {
    double t = std::clamp(start, span.low, span.high), previous = span.high - span.low;
    for (int i = 0; i < 120; ++i) {
        const Side side = s.at(t);
        if (std::abs(side.past) < 1e-14) break;
        (side.past < 0 ? span.low : span.high) = t;
        double next = t - side.past / side.speed;
        const bool keep =
            next > span.low && next < span.high && std::abs(next - t) < 0.5 * previous;
        if (!keep) next = 0.5 * (span.low + span.high);
        previous = std::abs(next - t);
        if (next == t || next == span.low || next == span.high) break;
        t = next;
    }
    if (s.crosses(t)) return t;
    return std::nullopt;
}

/// Newton's method without a bracket.
std::optional<double> newton(const Search& s, double t) {
    for (int i = 0; i < 16; ++i) {
        const Side side = s.at(t);
        const double next = t - side.past / side.speed;
        if (!std::isfinite(next)) return std::nullopt;
        if (std::abs(next - t) < 1e-14 * (1 + std::abs(t))) break;
        t = next;
    }
    if (s.crosses(t)) return t;
    return std::nullopt;
}

/// Bisects for the largest `past` between two points before the surface; returns early at a point
/// behind it.
double turning_point(const Search& s, Span span) {
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (span.low + span.high);
        const Side side = s.at(middle);
        if (side.past >= 0) return middle;
        (side.speed > 0 ? span.low : span.high) = middle;
    }
    return span.low;
}

/// Root in the first interval of the span with a sign change or a touching point.
std::optional<double> scanned(const Search& s, Span span) {
    double t0 = span.low;
    Side before = s.at(t0);
    for (int i = 1; i <= kPieces; ++i) {
        const double t1 = span.low + (span.high - span.low) * i / kPieces;
        const Side after = s.at(t1);
        if (before.past < 0) {
            double end = t1;
            if (after.past < 0 && before.speed > 0 && after.speed < 0)
                end = turning_point(s, {t0, t1});
            if (s.at(end).past >= 0)
                if (const auto t = bracketed(s, {t0, end}, 0.5 * (t0 + end))) return t;
        }
        t0 = t1, before = after;
    }
    return std::nullopt;
}

/// Start of the search: distance to the form without its asphere, or to the vertex plane.
double first_guess(const Search& s) {
    const Vec3d &m = s.origin, &d = s.direction;
    const double c = s.form.shape == Shape::conic ? s.form.cy : 0, wz = 1 + s.form.ky;
    const double q = c * (m.x * m.x + m.y * m.y + wz * m.z * m.z) - 2 * m.z;
    const double a = c * (d.x * d.x + d.y * d.y + wz * d.z * d.z);
    const double b = d.z - c * (m.x * d.x + m.y * d.y + wz * m.z * d.z);
    const double t = q / (b + s.sign * std::sqrt(std::max(0.0, b * b - a * q)));
    return std::isfinite(t) ? t : 0;
}

/// Search beyond the clear radius; without a clear radius, as far as the base form reaches.
std::optional<double> outside(const Search& s, double guess) {
    if (const auto t = newton(s, guess)) return t;
    const double reach = std::isfinite(s.form.clear) ? 2 * s.form.clear : 1e3;
    const auto span = inside(s, reach, 4 * reach);
    return span ? scanned(s, *span) : std::nullopt;
}

}  // namespace

std::optional<double> first_crossing(const SurfaceForm& form, const Vec3d& origin,
                                     const Vec3d& direction, int sign) {
    const Search s{form, origin, direction, double(sign)};
    const double guess = first_guess(s);
    if (!std::isfinite(form.height)) return outside(s, guess);
    const auto span = inside(s, form.clear, form.height);
    if (span && s.at(span->low).past < 0 && s.at(span->high).past >= 0) {
        const double across = hypot(direction.x, direction.y);
        if (form.slope * across < sign * direction.z)  // monotonic: the ray crosses the surface once
            return bracketed(s, *span, guess);
    }
    if (span)
        if (const auto t = scanned(s, *span)) return t;
    return outside(s, guess);
}

}  // namespace dg
