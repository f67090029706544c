// shown.h -- when something is there.
#pragma once
#include <algorithm>
#include <vector>

namespace dg {

/// A stretch of time: with seconds what a picture exposes, or when something is there.
struct TimeInterval {
    double open = 0, close = 0;
};

/// There from each `open` on, until `close`, which does not belong to it.
struct Shown {
    std::vector<TimeInterval> times;

    bool at(double time) const {
        return std::ranges::any_of(
            times, [&](const TimeInterval& i) { return i.open <= time && time < i.close; });
    }
    /// With `open` as time 0 and `close` as time 1. Both ends are moments of the picture.
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
    bool always() const {  // of fractions
        return std::ranges::any_of(times, [](const TimeInterval& i) { return i.open <= 0 && i.close > 1; });
    }
    bool never() const { return times.empty(); }
};

}  // namespace dg
