#include "optics/pupil_region.h"

#include <algorithm>
#include <cmath>

namespace dg {
namespace {

/// Where a column that begins at `x` ends if it has this area; it may go beyond the outline's `end`.
double column_end(const Outline& o, double x, double end, double area) {
    const double rest = o.largest(x, std::max(x, end));
    if (x >= end || rest * 2 * (end - x) < area) return x + 0.5 * area / std::max(rest, 1e-9);
    double low = x, high = end;
    for (int i = 0; i < 24; ++i) {
        const double middle = 0.5 * (low + high);
        (o.largest(x, middle) * 2 * (middle - x) < area ? low : high) = middle;
    }
    return high;
}

}  // namespace

double Outline::largest(double a, double b) const {
    const double per_step = (kPoints - 1) / (2 * reach);
    const auto place = [&](double at) {
        return std::clamp((at + reach) * per_step, 0.0, double(kPoints - 1));
    };
    const auto value = [&](double p) {
        const int i = std::min(int(p), kPoints - 2);
        return half[i] + (half[i + 1] - half[i]) * (p - i);
    };
    const double from = place(a), to = place(b);
    double found = std::max(value(from), value(to));
    for (int i = int(from) + 1; i <= int(to); ++i) found = std::max(found, half[i]);
    return found;
}

Outline Outline::joined(const Outline& other, double margin) const {
    Outline both{reach, {}}, o{reach, {}};
    for (int i = 0; i < kPoints; ++i) both.half[i] = std::max(half[i], other.half[i]);
    int first = 0, last = kPoints - 1;
    while (first < kPoints && !(both.half[first] > 0)) ++first;
    while (last > first && !(both.half[last] > 0)) --last;
    if (first == kPoints) return o;
    // A round outline bulges over its chords by an eighth of the second difference.
    for (int i = first; i <= last; ++i) {
        const double left = both.half[std::max(i - 1, first)], here = both.half[i],
                     right = both.half[std::min(i + 1, last)];
        o.half[i] = here + std::max(0.0, 2 * here - left - right) / 4 + margin;
    }
    // At its ends it is too steep for that, and ends somewhere before the next point.
    const auto close = [&](int end, int inward) {
        const int inner = std::clamp(end + inward, first, last),
                  beyond = std::clamp(end - inward, 0, kPoints - 1);
        o.half[end] = std::max(o.half[end], o.half[inner]);
        o.half[beyond] = std::max(o.half[beyond], o.half[end]);
    };
    close(first, 1);
    close(last, -1);
    return o;
}

bool Columns::contain(double at_x, double at_y) const {
    if (!(area > 0) || at_x < x.front() || at_x > x.back()) return false;
    const auto after = std::upper_bound(x.begin(), x.end(), at_x);
    const std::ptrdiff_t k = std::clamp<std::ptrdiff_t>(after - x.begin() - 1, 0, kColumns - 1);
    return std::abs(at_y) <= half[k];
}

Columns cover(const Outline& outline) {
    Columns c;
    if (outline.empty()) return c;
    int first = 0, last = Outline::kPoints - 1;
    while (!(outline.half[first] > 0)) ++first;
    while (!(outline.half[last] > 0)) --last;
    const double begin = outline.x(std::max(first - 1, 0));
    const double end = outline.x(std::min(last + 1, Outline::kPoints - 1));
    // Each column is as wide as its area allows; the area for which the last one reaches the end is found
    // by bisection.
    const auto fill = [&](double area) {
        c.x[0] = begin;
        for (int k = 0; k < kColumns; ++k) {
            c.x[k + 1] = column_end(outline, c.x[k], end, area);
            c.half[k] = 0.5 * area / (c.x[k + 1] - c.x[k]);
        }
        return c.x[kColumns] >= end;
    };
    double low = 0, high = outline.largest(begin, end) * 2.02 * (end - begin) / kColumns;
    for (int i = 0; i < 14; ++i) {
        const double middle = 0.5 * (low + high);
        (fill(middle) ? high : low) = middle;
    }
    fill(high);
    c.area = high * kColumns;
    return c;
}

Columns rectangle(double x0, double x1, double half) {
    Columns c;
    for (int k = 0; k <= kColumns; ++k) c.x[k] = x0 + (x1 - x0) * k / kColumns;
    c.half.fill(half);
    c.area = 2 * half * (x1 - x0);
    return c;
}

}  // namespace dg
