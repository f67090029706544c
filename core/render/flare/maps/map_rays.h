// map_rays.h -- exact rays from a small source through a ghost, as functions of front point and source point. Maps of
// ghosts interpolate them.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/sensor.h"
#include "light/emitter_points.h"
#include "optics/stray/open_ghost.h"

namespace dg {

/// A source of small angular size; camera frame, m.
struct MapSource {
    Vec3d middle{0, 0, -1};   // position, or direction toward a source at infinity
    bool at_infinity = true;
    double radius = 0;        // m, or the tangent of half its angular diameter
    double turn = 0;          // rad: rotation of the square's axes about the direction to the source

    /// Position or direction of the source point at `shift` in the unit disc.
    Vec3d point(Vec2f shift) const;
    /// Inverse of point(), also outside the source.
    Vec2f shift_of(Vec3d point) const;
};

/// A ray: a point of the square [-1, 1)^2 that bounds the front; a point of the source; nm.
struct MapRay {
    Vec2f at, shift;
    float nm;
};

/// Landing of a ray on the film; see OpenLandings.
struct MapLanding {
    Vec2f px;
    float beyond, pass;
    bool sound;
    std::int16_t lost_after;
    std::array<Vec2f, kMostCrossings> iris;   // mm
};

class MapRays {
  public:
    /// The camera is static and has an exact lens; it and the ghost's steps must outlive this.
    MapRays(const Camera& camera, const Sensor& sensor, const GhostLens& ghosts,
            const std::vector<GhostStep>& steps, const MapSource& source);

    int crossings() const { return crossings_; }
    const GhostLens& ghosts() const { return ghosts_; }
    const MapSource& source() const { return source_; }
    std::vector<MapLanding> trace(std::span<const MapRay> rays) const;
    /// Transmittance of edges and iris. `iris_opening`: fraction of the iris radius.
    float passed(const MapLanding& landing, float iris_opening) const;
    /// Clip value: positive where an edge or the iris blocks light; the maximum of smooth functions.
    float stopped(const MapLanding& landing) const;
    /// Ray from the front lens to a point of the source, in the world; empty if it misses the lens.
    std::optional<Ray> shadow(const MapRay& ray, const EmitterPoint& from, float time) const;

  private:
    struct Line {
        Vec3d place, direction;   // camera frame, m; direction toward the source
    };
    struct Front {
        Vec3d point, toward, x, y;   // source point; unit direction; half sides of the square
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
    double turn_x_, turn_y_;   // m: components of the front's radius along the rotated axes
};

}  // namespace dg
