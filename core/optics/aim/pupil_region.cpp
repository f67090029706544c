#include "optics/aim/pupil_region.h"

#include <algorithm>
#include <cmath>

namespace dg {
namespace {

struct Range {
    double low = 1e30, high = -1e30;
    void add(double a, double b) { low = std::min(low, a), high = std::max(high, b); }
    double length() const { return std::max(0.0, high - low); }
};

/// Range of y of the outline between a start x and the current position of a sweep to the right.
/// Positions are in units of the outline's points.
class Sweep {
  public:
    Sweep(const Outline& o, double x) : o_(o), from_(place(x)), next_(int(from_) + 1) {
        add(swept_, from_);
    }

    double place(double x) const {
        const double last = o_.points() - 1;
        return std::clamp((x + o_.reach) * last / (2 * o_.reach), 0.0, last);
    }
    int next() const { return next_; }   // next point that the sweep has not passed
    void pass_next() {
        if (o_.lit(next_)) swept_.add(o_.low[next_], o_.high[next_]);
        ++next_;
    }
    /// Range up to the position `to`, which must not exceed the next point.
    Range up_to(double to) const {
        Range r = swept_;
        add(r, to);
        return r;
    }

  private:
    void add(Range& r, double p) const {
        const int i = std::min(int(p), o_.points() - 2);
        const double t = p - i;
        if (o_.lit(i) && o_.lit(i + 1))
            r.add(o_.low[i] + (o_.low[i + 1] - o_.low[i]) * t,
                  o_.high[i] + (o_.high[i + 1] - o_.high[i]) * t);
        else if (o_.lit(i) || o_.lit(i + 1))   // the outline ends between the two points
            r.add(o_.low[o_.lit(i) ? i : i + 1], o_.high[o_.lit(i) ? i : i + 1]);
    }

    const Outline& o_;
    double from_;
    int next_;
    Range swept_;
};

/// Range of y of the outline over [a, b].
Range range(const Outline& o, double a, double b) {
    Sweep sweep(o, a);
    const double to = sweep.place(b);
    while (sweep.next() <= int(to)) sweep.pass_next();
    return sweep.up_to(to);
}

/// End of the column that starts at `x` and has the given area; it may exceed the outline's `end`.
double column_end(const Outline& o, double x, double end, double area) {
    Sweep sweep(o, x);
    const double last = sweep.place(end);
    const auto enough = [&](double to, double at) {
        return sweep.up_to(to).length() * (at - x) >= area;
    };
    double low = x;
    if (x < end)
        for (;; sweep.pass_next()) {
            const bool final = sweep.next() >= last;
            double high = final ? end : o.x(sweep.next());
            if (enough(final ? last : sweep.next(), high)) {
                for (int i = 0; i < 16; ++i) {
                    const double middle = 0.5 * (low + high);
                    (enough(sweep.place(middle), middle) ? high : low) = middle;
                }
                return high;
            }
            if (final) break;
            low = high;
        }
    return x + area / std::max(range(o, x, std::max(x, end)).length(), 1e-9);
}

}  // namespace

Outline Outline::dark(double reach, int points) {
    return {reach, std::vector<double>(points, 1e30), std::vector<double>(points, -1e30)};
}

bool Outline::empty() const {
    for (int i = 0; i < points(); ++i)
        if (lit(i)) return false;
    return true;
}

Outline Outline::joined(const Outline& other, double margin) const {
    Outline both = *this;
    for (int i = 0; i < points(); ++i) {
        both.low[i] = std::min(low[i], other.low[i]);
        both.high[i] = std::max(high[i], other.high[i]);
    }
    return margin > 0 ? both.grown(margin) : both;
}

Outline Outline::grown(double margin) const {
    Outline o = dark(reach, points());
    int first = 0, last = points() - 1;
    while (first < points() && !lit(first)) ++first;
    while (last > first && !lit(last)) --last;
    if (first == points()) return o;
    // A round rim exceeds its chords by an eighth of the second difference.
    const auto bulge = [](double left, double here, double right) {
        return std::max(0.0, 2 * here - left - right) / 4;
    };
    for (int i = first; i <= last; ++i) {
        if (!lit(i)) continue;
        const int l = i > first && lit(i - 1) ? i - 1 : i, r = i < last && lit(i + 1) ? i + 1 : i;
        o.high[i] = high[i] + bulge(high[l], high[i], high[r]) + margin;
        o.low[i] = low[i] - bulge(-low[l], -low[i], -low[r]) - margin;
    }
    // The ends of the outline are too steep for the second difference; they extend toward the next
    // point.
    const auto close = [&](int end, int inward) {
        const int inner = std::clamp(end + inward, first, last),
                  beyond = std::clamp(end - inward, 0, points() - 1);
        for (const auto& [to, from] : {std::pair{end, inner}, std::pair{beyond, end}}) {
            o.high[to] = std::max(o.high[to], o.high[from]);
            o.low[to] = std::min(o.low[to], o.low[from]);
        }
    };
    close(first, 1);
    close(last, -1);
    return o;
}

bool Columns::contain(double at_x, double at_y) const {
    if (!(area > 0) || at_x < x.front() || at_x > x.back()) return false;
    const auto after = std::upper_bound(x.begin(), x.end(), at_x);
    const std::ptrdiff_t k = std::clamp<std::ptrdiff_t>(after - x.begin() - 1, 0, kColumns - 1);
    return at_y >= low[k] && at_y <= high[k];
}

Columns cover(const Outline& outline) {
    Columns c;
    if (outline.empty()) return c;
    const int points = outline.points();
    int first = 0, last = points - 1;
    while (!outline.lit(first)) ++first;
    while (!outline.lit(last)) --last;
    const double begin = outline.x(std::max(first - 1, 0));
    const double end = outline.x(std::min(last + 1, points - 1));
    // Each column is as wide as its area allows. Bisection finds the area for which the last column
    // ends at the outline's end.
    const auto fill = [&](double area) {
        c.x[0] = begin;
        for (int k = 0; k < kColumns; ++k) {
            c.x[k + 1] = column_end(outline, c.x[k], end, area);
            const Range y = range(outline, c.x[k], c.x[k + 1]);
            const double middle = y.length() > 0 ? 0.5 * (y.low + y.high) : 0,
                         half = 0.5 * area / (c.x[k + 1] - c.x[k]);
            c.low[k] = middle - half, c.high[k] = middle + half;
        }
        return c.x[kColumns] >= end;
    };
    // The total area of the columns is at least the outline's area, and hardly more at the optimum.
    double low = 1e-9 * (end - begin), high = 0;
    const double step = outline.x(1) - outline.x(0);
    for (int i = first + 1; i < last; ++i)
        if (outline.lit(i)) low += 0.99 * step * (outline.high[i] - outline.low[i]);
    low /= kColumns, high = 1.05 * low;
    while (!fill(high)) low = high, high *= 1.3;
    for (int i = 0; i < 9; ++i) {
        const double middle = 0.5 * (low + high);
        (fill(middle) ? high : low) = middle;
    }
    fill(high);
    c.area = high * kColumns;
    return c;
}

Columns rectangle(double x0, double x1, double y0, double y1) {
    Columns c;
    for (int k = 0; k <= kColumns; ++k) c.x[k] = x0 + (x1 - x0) * k / kColumns;
    c.low.fill(y0), c.high.fill(y1);
    c.area = (y1 - y0) * (x1 - x0);
    return c;
}

}  // namespace dg
