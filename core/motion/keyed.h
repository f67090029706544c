// keyed.h -- value over time: linear between keys, constant before the first and after the last.
#pragma once
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace dg {

/// Position of a time among keys: fraction `share` from key `left` to key `right`.
struct KeyPlace {
    std::size_t left = 0, right = 0;
    double share = 0;
};

/// `times` are ascending and not empty. Of two keys at the same time (a jump), the second applies
/// at that time.
template <typename Time>
KeyPlace place_among(const std::vector<Time>& times, Time t) {
    const auto after = std::upper_bound(times.begin(), times.end(), t);
    if (after == times.begin()) return {};
    const std::size_t right = std::size_t(after - times.begin()), left = right - 1;
    if (right == times.size()) return {left, left, 0};
    return {left, right, double(t - times[left]) / double(times[right] - times[left])};
}

/// Keyframed value. Time is the fraction of the scene's interval, or (double) seconds. T needs
/// `blend(a, b, share)`.
template <typename T, typename Time = float>
struct Keyed {
    std::vector<Time> times;
    std::vector<T> values;

    bool moves() const { return values.size() > 1; }
    T at(Time t) const {
        if (!moves()) return values.front();
        return at(place_among(times, t));
    }
    T at(const KeyPlace& p) const {
        return p.share > 0 ? blend(values[p.left], values[p.right], float(p.share))
                           : values[p.left];
    }
};

/// Keys with times in seconds, mapped so that `open` is 0 and `close` is 1; a single key if the
/// value is constant in between.
template <typename T>
Keyed<T> over(const Keyed<T, double>& keys, double open, double close) {
    Keyed<T> cut{{0}, {keys.at(open)}};
    if (!keys.moves() || !(close > open)) return cut;
    if (close <= keys.times.front() || open >= keys.times.back()) return cut;
    const auto add = [&](double t, T value) {
        cut.times.push_back(float((t - open) / (close - open)));
        cut.values.push_back(std::move(value));
    };
    std::size_t i = std::upper_bound(keys.times.begin(), keys.times.end(), open) - keys.times.begin();
    for (; i < keys.times.size() && keys.times[i] < close; ++i) add(keys.times[i], keys.values[i]);
    if (i == keys.times.size()) return cut;
    // A jump exactly at `close` has no effect.
    const double share = i == 0 ? 1 : (close - keys.times[i - 1]) / (keys.times[i] - keys.times[i - 1]);
    add(close, share < 1 ? keys.at({i - 1, i, share}) : keys.values[i]);
    return cut;
}

}  // namespace dg
