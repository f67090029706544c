// ray_random.h -- an unlimited sequence of random numbers for tracking along a ray, determined by the ray and a salt.
// Frames do not depend on the order in which rays are traced, and paths need not reserve sampler dimensions for an
// unknown number of collisions.
#pragma once
#include <bit>
#include <cstdint>

#include "math/hash.h"
#include "math/vec.h"

namespace dg {

class RayRandom {
  public:
    RayRandom(Vec3f origin, Vec3f direction, float salt)
        : seed_(hash64(pair(origin.x, origin.y), pair(origin.z, direction.x), pair(direction.y, direction.z),
                       pair(salt, 0))) {}
    /// Uniform in [0, 1).
    double next() { return hash_uniform(seed_, count_++); }

  private:
    static std::uint64_t pair(float a, float b) {
        return std::uint64_t(std::bit_cast<std::uint32_t>(a)) << 32 | std::bit_cast<std::uint32_t>(b);
    }
    std::uint64_t seed_, count_ = 0;
};

}  // namespace dg
