// emitter_points.h -- where ghosts get their light: all emitters that there are, in sources that a lens sees in
// about one direction each. What no picture shows, point, spot and directional lights, has ghosts, too; and so
// has what other things reflect, where a survey found it.
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
    /// `views`: the whole world as seen from the lens, at some moments. `lights` outlives this.
    EmitterPoints(const LightSet& lights, std::span<const ViewCone> views);
    /// Once.
    void add(Highlights highlights);

    int count() const { return int(sources_.size()); }
    /// Illuminance that it brings to the lens, as far as can be known without asking what is in its way, lux.
    double strength(int source) const { return sources_[source].strength; }
    /// Mirrors may show it: lamps and bright spots of the sky.
    bool has_size(int source) const;
    /// Light of other things, which takes a path to know.
    bool reflected(int source) const { return sources_[source].highlight >= 0; }
    /// Whether this source draws the ray to the world that it was sampled for; else another one does.
    bool owns(int source, const Ray& ray) const {
        return !reflected(source) || highlights_.owns(sources_[source].highlight, ray);
    }
    /// `u_select`: which of its lights.
    std::optional<EmitterPoint> sample(int source, float u_select, Vec2f u, float time,
                                     const Viewpoint& view) const;
    /// Light of a delta light toward a point (m): cd; of a directional one lux.
    Rgb delta_value(const EmitterPoint& from, Vec3f to, float time) const;

  private:
    struct Part {
        Vec2f from{0, 0};
        float side = 1;
        Vec2f at(Vec2f u) const { return from + u * side; }
    };
    struct Source {
        double strength = 0;
        std::vector<std::int32_t> lights{};   // or
        DiscreteDistribution choice{};
        Part part{};                          // of all of them
        int hot = -1;                         // part of the bright sky, or
        std::optional<DirectionTile> tile{};  // of the even part of it, or
        int highlight = -1;
    };
    void add_lights(std::span<const ViewCone> views);
    /// Which lights it took.
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
