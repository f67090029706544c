// solids.h -- the solids around a path, for solids in solids: a bubble in glass, water in a glass, ice in whisky.
//
// Each solid has a rank. Where solids overlap, the solid with the highest rank fills the space; a boundary inside a
// solid of a higher rank is hidden. Source: Schmidt and Budge 2002, Simple Nested Dielectrics in Ray Traced Images.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "material/bsdf_sample.h"

namespace dg {

/// How the solids of a material meet others.
struct Nesting {
    int priority = 0;       // the higher fills the space
    bool literal = false;   // the surface is an interface between the two sides as given: not nested
};

/// Instances of the solids that hold a point; at most kMost, others are forgotten.
class Solids {
  public:
    static constexpr int kMost = 8;
    static constexpr std::uint32_t kNone = Interior::kWorld;

    bool empty() const { return count_ == 0; }
    void enter(std::uint32_t instance) {
        leave(instance);
        if (count_ < kMost) instances_[std::size_t(count_++)] = instance;
    }
    void leave(std::uint32_t instance) {
        for (int i = count_ - 1; i >= 0; --i)
            if (instances_[std::size_t(i)] == instance) instances_[std::size_t(i)] = instances_[std::size_t(--count_)];
    }
    /// The solid with the highest rank, apart from `without`; kNone: none. `ranks`: per instance.
    std::uint32_t top(std::span<const std::uint32_t> ranks, std::uint32_t without = kNone) const {
        std::uint32_t best = kNone;
        for (int i = 0; i < count_; ++i) {
            const std::uint32_t k = instances_[std::size_t(i)];
            if (k != without && (best == kNone || ranks[k] > ranks[best])) best = k;
        }
        return best;
    }

  private:
    std::array<std::uint32_t, kMost> instances_{};
    int count_ = 0;
};

/// The solids and the medium around a point.
struct Surroundings {
    Interior interior;   // of the solid or medium that is there
    Solids solids;       // only in scenes with overlapping solids (Scene::has_nested)
};

}  // namespace dg
