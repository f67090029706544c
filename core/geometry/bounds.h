// bounds.h -- boxes along the axes, and pairs of boxes that meet.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "math/vec.h"

namespace dg {

struct Bounds {
    Vec3f min, max;

    /// Holds nothing yet.
    static Bounds none() {
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    }
    void hold(Vec3f p) { hold(p, p); }
    void hold(const Bounds& other) { hold(other.min, other.max); }
    bool holds(const Bounds& other) const {
        for (int k = 0; k < 3; ++k)
            if (other.min[k] < min[k] || other.max[k] > max[k]) return false;
        return true;
    }
    bool is_empty() const { return !(min.x <= max.x); }
    bool meets(Vec3f low, Vec3f high) const {
        return low.x <= max.x && low.y <= max.y && low.z <= max.z && high.x >= min.x && high.y >= min.y &&
               high.z >= min.z;
    }
    bool meets(const Bounds& other) const { return meets(other.min, other.max); }

  private:
    void hold(Vec3f low, Vec3f high) {
        for (int k = 0; k < 3; ++k) min[k] = std::min(min[k], low[k]), max[k] = std::max(max[k], high[k]);
    }
};

/// Box of items with `bounds`.
template <typename Item>
Bounds bounds_of(std::span<Item> items) {
    Bounds all = Bounds::none();
    for (const Item& i : items) all.hold(i.bounds);
    return all;
}

/// Keeps the items with boxes that meet a box, at the front.
template <typename Item>
void keep_meeting(std::span<Item>& items, const Bounds& box) {
    const auto apart = std::ranges::partition(items, [&](const Item& i) { return box.meets(i.bounds); });
    items = items.first(items.size() - apart.size());
}

/// Splits items in two halves along the longest axis of their box.
template <typename Item>
std::array<std::span<Item>, 2> halves(std::span<Item> items) {
    const Bounds all = bounds_of(items);
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (all.max[k] - all.min[k] > all.max[axis] - all.min[axis]) axis = k;
    const auto middle = items.begin() + std::ptrdiff_t(items.size() / 2);
    std::ranges::nth_element(items, middle, {}, [axis](const Item& i) { return i.bounds.min[axis] + i.bounds.max[axis]; });
    return {std::span(items.begin(), middle), std::span(middle, items.end())};
}

inline constexpr std::size_t kFewBounds = 8;

/// Calls use(a, b) for each pair of two sets with boxes that meet, until it returns false. Reorders both sets. Returns
/// false if use() did.
template <typename Item, typename Use>
bool each_meeting(std::span<Item> as, std::span<Item> bs, const Use& use) {
    keep_meeting(bs, bounds_of(as));
    keep_meeting(as, bounds_of(bs));
    if (as.size() <= kFewBounds && bs.size() <= kFewBounds) {
        for (Item& a : as)
            for (Item& b : bs)
                if (a.bounds.meets(b.bounds) && !use(a, b)) return false;
        return true;
    }
    if (as.size() >= bs.size()) {
        for (const std::span<Item> half : halves(as))
            if (!each_meeting(half, bs, use)) return false;
    } else {
        for (const std::span<Item> half : halves(bs))
            if (!each_meeting(as, half, use)) return false;
    }
    return true;
}

/// The same for the pairs of one set.
template <typename Item, typename Use>
bool each_meeting(std::span<Item> items, const Use& use) {
    if (items.size() <= kFewBounds) {
        for (std::size_t i = 0; i < items.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                if (items[k].bounds.meets(items[i].bounds) && !use(items[k], items[i])) return false;
        return true;
    }
    const auto [first, second] = halves(items);
    return each_meeting(first, use) && each_meeting(second, use) && each_meeting(first, second, use);
}

}  // namespace dg
