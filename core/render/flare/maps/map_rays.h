// map_rays.h -- exact rays from a small source by one ghost, by where they enter and which point of the source they come
// from: what maps of ghosts are made of.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/sensor.h"
#include "light/emitter_points.h"
#include "optics/stray/open_ghost.h"

namespace dg {

/// A source that the lens sees within a small angle; camera frame, m.
struct MapSource {
    Vec3d middle{0, 0, -1};   // a place, or the direction toward it
    bool at_infinity = true;
    double radius = 0;        // m, or the tangent of half its angle
    double turn = 0;          // rad, of the square's sides about the way to it

    /// Place or direction of one of its points; within the unit disc.
    Vec3d point(Vec2f shift) const;
    /// The shift of a point of the source, or of one beside it.
    Vec2f shift_of(Vec3d point) const;
};

/// A ray: a place of the square that holds the front, [-1, 1)^2; a point of the source; nm.
struct MapRay {
    Vec2f at, shift;
    float nm;
};

/// Where it comes to the film; see OpenLandings.
struct MapLanding {
    Vec2f px;
    float beyond, pass;
    bool sound;
    std::int16_t lost_after;
    std::array<Vec2f, kMostCrossings> iris;   // mm
};

class MapRays {
  public:
    /// A camera with an exact lens that stands still; it and the steps outlive this.
    MapRays(const Camera& camera, const Sensor& sensor, const GhostLens& ghosts,
            const std::vector<GhostStep>& steps, const MapSource& source);

    int crossings() const { return crossings_; }
    const GhostLens& ghosts() const { return ghosts_; }
    const MapSource& source() const { return source_; }
    std::vector<MapLanding> trace(std::span<const MapRay> rays) const;
    /// Share of light that gets through the edges and an iris that is open so far, a share of its radius.
    float passed(const MapLanding& landing, float iris_opening) const;
    /// Above 0 where an edge or the iris stops light; smooth, but for where one takes over from the other.
    float stopped(const MapLanding& landing) const;
    /// The ray as it runs from the front lens to a point of the source, in the world; nothing if it misses the lens.
    std::optional<Ray> shadow(const MapRay& ray, const EmitterPoint& from, float time) const;

  private:
    struct Line {
        Vec3d place, direction;   // camera frame, m; toward the source
    };
    struct Front {
        Vec3d point, toward, x, y;   // of the source; unit; sides of half the square
    };
    Front front(Vec2f shift) const;
    Line line(const Front& front, Vec2f at) const;

    const ExactLens& lens_;
    const Camera& camera_;
    Sensor sensor_;
    const GhostLens& ghosts_;
    const std::vector<GhostStep>& steps_;
    MapSource source_;
    int crossings_;
    float per_iris2_;   // 1 / mm2
    ExactLens::Ball front_;
    double turn_x_, turn_y_;   // m: the radius of the front, along and across the turn
};

}  // namespace dg
