// shown.h -- visibility over time.
#pragma once
#include <algorithm>
#include <vector>

namespace dg {

/// Interval of time: in seconds, the exposure of a frame; or a period of visibility.
struct TimeInterval {
    double open = 0, close = 0;
};

/// Visible from each `open` up to but excluding `close`.
struct Shown {
    std::vector<TimeInterval> times;

    bool at(double time) const {
        return std::ranges::any_of(
            times, [&](const TimeInterval& i) { return i.open <= time && time < i.close; });
    }
    /// Intervals with time remapped so that `open` is 0 and `close` is 1, both included in the
    /// picture.
    Shown over(const TimeInterval& picture) const {
        const double span = picture.close - picture.open;
        Shown part;
        for (const TimeInterval& i : times) {
            const bool moment = i.open == i.close && i.open == picture.open;
            if (i.open > picture.close || (i.close <= picture.open && !moment)) continue;
            const bool first = i.open <= picture.open, last = i.close >= picture.close;
            part.times.push_back({first ? 0 : (i.open - picture.open) / span,
                                  last ? 2 : (i.close - picture.open) / span});
        }
        return part;
    }
    bool always() const {  // in fractions
        return std::ranges::any_of(times, [](const TimeInterval& i) { return i.open <= 0 && i.close > 1; });
    }
    bool never() const { return times.empty(); }
};

}  // namespace dg
