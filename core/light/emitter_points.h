// emitter_points.h -- light sources of ghosts: all emitters, grouped into sources that the lens sees in about one
// direction each. Includes point, spot and directional lights, which are invisible but have ghosts, and reflected light
// that a survey found.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "light/direction_tile.h"
#include "light/emission.h"
#include "light/emitter_point.h"
#include "light/highlights.h"

namespace dg {

class EmitterPoints {
  public:
    EmitterPoints() = default;
    /// `views`: cones of all directions from the lens, at several times. `lights` must outlive this.
    EmitterPoints(const LightSet& lights, std::span<const ViewCone> views);
    /// Adds reflected light. Call it at most once.
    void add(Highlights highlights);

    int count() const { return int(sources_.size()); }
    /// Estimated unoccluded illuminance by a source at the lens, lux.
    double strength(int source) const { return sources_[source].strength; }
    /// Whether mirrors may show the source: lamps with an area, and bright spots of the sky.
    bool has_size(int source) const;
    /// Whether the source is reflected light, which paths have to estimate.
    bool reflected(int source) const { return sources_[source].highlight >= 0; }
    /// Whether this source accounts for the ray that it sampled; otherwise another source does.
    bool owns(int source, const Ray& ray) const {
        return !reflected(source) || highlights_.owns(sources_[source].highlight, ray);
    }
    /// Samples a point of a source. `u_select` chooses among its lights.
    std::optional<EmitterPoint> sample(int source, float u_select, Vec2f u, float time,
                                     const Viewpoint& view) const;
    /// Light of a delta light toward a point (m): cd, or lux for a directional light.
    Rgb delta_value(const EmitterPoint& from, Vec3f to, float time) const;

  private:
    struct Part {
        Vec2f from{0, 0};
        float side = 1;
        Vec2f at(Vec2f u) const { return from + u * side; }
    };
    struct Source {
        double strength = 0;
        std::vector<std::int32_t> lights{};   // lights of the source, or
        DiscreteDistribution choice{};
        Part part{};                          // part of these lights
        int hot = -1;                         // index of a part of the bright sky, or
        std::optional<DirectionTile> tile{};  // tile of the remaining sky, or
        int highlight = -1;
    };
    void add_lights(std::span<const ViewCone> views);
    /// Adds lamps of many triangles as single sources; returns a flag for each light that is part of them.
    std::vector<bool> add_lamps(std::span<const ViewCone> views, const std::vector<double>& strength, double all);
    void add_source(std::vector<std::int32_t> lights, const std::vector<double>& strength);
    std::vector<Part> parts_of(std::int32_t light, double share, std::span<const ViewCone> views) const;
    void add_parts(std::int32_t light, const std::vector<double>& strength, double all,
                   std::span<const ViewCone> views);
    void add_sky(std::span<const ViewCone> views);
    std::optional<EmitterPoint> sample_light(std::int32_t light, Vec2f u, float time, const Viewpoint& view) const;
    std::optional<EmitterPoint> sample_tile(const DirectionTile& tile, Vec2f u, float time) const;

    const LightSet* lights_ = nullptr;
    std::vector<Source> sources_;
    HotSky hot_;
    std::vector<HotSky> hot_parts_;
    Highlights highlights_;
};

}  // namespace dg
