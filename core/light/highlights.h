// highlights.h -- light that other things send to the lens, by reflection or through glass: from where, and about
// how much. It says where rays are worth it, not what they find.
//
// A mirror shows a lamp at the place of its image, as if there were a lamp; so does glass. Seen from all over the
// front of a lens that image stays where it is, while its direction changes. So bright spots are parts of planes
// as far away as their images are, which go along with what moves; only the rest is drawn by direction.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "geometry/ray.h"
#include "light/direction_tile.h"
#include "light/emitter_point.h"
#include "math/distribution.h"

namespace dg {

/// A bright part of what is seen from an anchor: a rectangle of a plane across the way there, in tangents.
struct HighlightSpot {
    Vec3f anchor;            // m
    Frame frame;             // z: the way
    float nearness = 0;      // 1 / distance of the plane, 1/m; 0: at infinity
    Vec2f velocity{};        // of tangents, per exposure: of what moves, or is seen from what moves
    Vec2f low{}, size{};     // at mid-exposure
    Distribution2D weights{};   // of the luminance
    double luminance = 0;    // cd/m2: mean

    /// Where a ray meets the plane, moved to mid-exposure; nothing behind the anchor.
    std::optional<Vec2f> meet(const Ray& ray) const;
    bool holds(const Ray& ray) const;
    double solid_angle() const { return double(size.x) * size.y; }   // nearly
    EmitterPoint sample(Vec2f u, float time) const;
};

/// Directions that are not bright spots.
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

    /// Spots, then tiles.
    int count() const { return int(spots_.size() + tiles_.size()); }
    int spots() const { return int(spots_.size()); }
    /// lux, on a surface that faces it.
    double illuminance(int part) const;
    EmitterPoint sample(int part, Vec2f u, float time) const;
    /// A ray to the world is drawn by the first spot that holds it alone, and by a tile if none does.
    bool owns(int part, const Ray& ray) const;

  private:
    std::vector<HighlightSpot> spots_;
    std::vector<HighlightTile> tiles_;
};

/// Whether one of the first so many holds the ray.
bool held(std::span<const HighlightSpot> spots, const Ray& ray);

}  // namespace dg
