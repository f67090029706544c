// highlights.h -- approximate distribution of reflected and refracted light that reaches the lens, for importance
// sampling. Paths estimate the light itself.
//
// A mirror or glass shows a lamp at the position of its image. Seen from different points of the lens's front, the
// image has a fixed position, and its direction changes. So bright spots are rectangles on planes at the distance of
// their images, which move with them; the remaining light is sampled by direction.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "geometry/ray.h"
#include "light/direction_tile.h"
#include "light/emitter_point.h"
#include "math/distribution.h"

namespace dg {

/// A bright spot as seen from an anchor: a rectangle on a plane perpendicular to its direction, in tangents.
struct HighlightSpot {
    Vec3f anchor;            // m
    Frame frame;             // z: direction to the spot
    float nearness = 0;      // 1 / distance of the plane, 1/m; 0: at infinity
    Vec2f velocity{};        // change of tangents per exposure, by motion of spot or anchor
    Vec2f low{}, size{};     // at mid-exposure
    Distribution2D weights{};   // by luminance
    double luminance = 0;    // cd/m2: mean

    /// Intersection of a ray with the plane, moved to mid-exposure; empty behind the anchor.
    std::optional<Vec2f> meet(const Ray& ray) const;
    bool holds(const Ray& ray) const;
    double solid_angle() const { return double(size.x) * size.y; }   // approximate
    EmitterPoint sample(Vec2f u, float time) const;
};

/// A tile of directions without bright spots.
struct HighlightTile {
    DirectionTile tile;
    Distribution2D weights;
    double luminance = 0;    // cd/m2: mean

    EmitterPoint sample(Vec2f u) const;
};

class Highlights {
  public:
    Highlights() = default;
    Highlights(std::vector<HighlightSpot> spots, std::vector<HighlightTile> tiles)
        : spots_(std::move(spots)), tiles_(std::move(tiles)) {}

    /// Number of spots and tiles; spots come first.
    int count() const { return int(spots_.size() + tiles_.size()); }
    int spots() const { return int(spots_.size()); }
    /// Illuminance by a spot or tile on a facing surface, lux.
    double illuminance(int part) const;
    EmitterPoint sample(int part, Vec2f u, float time) const;
    /// Whether a spot or tile accounts for a ray: the first spot that contains it, or a tile if no spot does.
    bool owns(int part, const Ray& ray) const;

  private:
    std::vector<HighlightSpot> spots_;
    std::vector<HighlightTile> tiles_;
};

/// Whether a spot contains the ray.
bool held(std::span<const HighlightSpot> spots, const Ray& ray);

}  // namespace dg
