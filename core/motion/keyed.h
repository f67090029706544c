// keyed.h -- a value over time: linear between keys, held before the first and after the last.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace dg {

/// Where a time lies among keys: `share` of the way from key `left` to key `right`.
struct KeyPlace {
    std::size_t left = 0, right = 0;
    double share = 0;
};

/// `times` do not fall and are not empty. Of two keys of one time (a jump) the second counts there.
template <typename Time>
KeyPlace place_among(const std::vector<Time>& times, Time t) {
    const auto after = std::upper_bound(times.begin(), times.end(), t);
    if (after == times.begin()) return {};
    const std::size_t right = std::size_t(after - times.begin()), left = right - 1;
    if (right == times.size()) return {left, left, 0};
    return {left, right, double(t - times[left]) / double(times[right] - times[left])};
}

/// Time is the fraction of the scene's interval. `blend(a, b, share)` must exist for T.
template <typename T>
struct Keyed {
    std::vector<float> times;
    std::vector<T> values;

    bool moves() const { return values.size() > 1; }
    T at(float t) const {
        if (!moves()) return values.front();
        const KeyPlace p = place_among(times, t);
        return p.share > 0 ? blend(values[p.left], values[p.right], float(p.share))
                           : values[p.left];
    }
};

}  // namespace dg
