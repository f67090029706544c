// direction_tile.h -- divides the sphere of directions into tiles of equal solid angle.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "math/vec.h"

namespace dg {

/// A range of heights (+y up) and azimuths.
struct DirectionTile {
    std::array<float, 2> height{}, azimuth{};

    float solid_angle() const { return (height[1] - height[0]) * (azimuth[1] - azimuth[0]); }
    /// Uniform unit direction for u in [0, 1)^2.
    Vec3f at(Vec2f u) const {
        const float y = height[0] + (height[1] - height[0]) * u.x;
        const float phi = azimuth[0] + (azimuth[1] - azimuth[0]) * u.y;
        const float r = std::sqrt(std::max(0.f, 1 - y * y));
        return {r * std::cos(phi), y, r * std::sin(phi)};
    }
};

/// Tiles that are nearly square at the horizon.
inline std::vector<DirectionTile> direction_tiles(int across, int down) {
    std::vector<DirectionTile> tiles;
    const auto height = [&](int row) { return -std::cos(kPi * float(row) / float(down)); };
    const auto azimuth = [&](int column) { return 2 * kPi * float(column) / float(across); };
    for (int r = 0; r < down; ++r)
        for (int c = 0; c < across; ++c)
            tiles.push_back({{height(r), height(r + 1)}, {azimuth(c), azimuth(c + 1)}});
    return tiles;
}

}  // namespace dg
