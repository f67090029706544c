// flare_sources.h -- where ghosts get their light: all emitters that there are, in sources that a lens sees in
// about one direction each. What no picture shows, point, spot and directional lights, has ghosts, too.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "light/emission.h"

namespace dg {

/// A point that shines, or a direction from which light comes.
struct FlarePoint {
    EmissionPoint point;     // pdf: as of EmissionPoint; of a delta light the choice alone
    bool at_infinity = false;
    bool delta = false;      // a light without size
};

class FlareSources {
  public:
    FlareSources() = default;
    /// `views`: the whole world as seen from the lens, at some moments. `lights` outlives this.
    FlareSources(const LightSet& lights, std::span<const ViewCone> views);

    int count() const { return int(sources_.size()); }
    /// What it brings to the lens, as far as can be known without asking what is in its way, lux.
    double strength(int source) const { return sources_[source].strength; }
    /// `u_select`: which of its lights.
    std::optional<FlarePoint> sample(int source, float u_select, Vec2f u, float time,
                                     const Viewpoint& view) const;
    /// Light of a delta light toward a point (m): cd; of a directional one lux.
    Rgb delta_value(const FlarePoint& from, Vec3f to, float time) const;

  private:
    /// A tile of the even part of the sky: cos(theta) and azimuth.
    struct Tile {
        std::array<float, 2> z, phi;
        float solid_angle() const { return (z[1] - z[0]) * (phi[1] - phi[0]); }
    };
    struct Source {
        double strength = 0;
        std::vector<std::int32_t> lights{};   // or
        DiscreteDistribution choice{};
        int hot = -1;                         // part of the bright sky, or
        std::optional<Tile> tile{};
    };
    void add_lights(std::span<const ViewCone> views);
    void add_source(std::vector<std::int32_t> lights, const std::vector<double>& strength);
    void add_sky(std::span<const ViewCone> views);
    std::optional<FlarePoint> sample_light(std::int32_t light, Vec2f u, float time, const Viewpoint& view) const;
    std::optional<FlarePoint> sample_tile(const Tile& tile, Vec2f u, float time) const;

    const LightSet* lights_ = nullptr;
    std::vector<Source> sources_;
    HotSky hot_;
    std::vector<HotSky> hot_parts_;
};

}  // namespace dg
