// emission.h -- points on the emitters that a lens sees, for light paths that begin there. Delta lights are
// not among them: no camera sees one.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/hot_sky.h"
#include "light/light.h"
#include "light/triangle_sampler.h"
#include "light/view_cone.h"
#include "math/distribution.h"

namespace dg {

/// A point that shines, or a direction from which light comes from infinity.
struct EmissionPoint {
    static constexpr std::int32_t kSky = LightSet::kEnvironment;
    std::int32_t light = kSky;   // index in LightSet::lights()
    Vec3f position{};            // m; of the sky the unit direction toward it
    Vec3f normal{};              // unit, of the front side; none of the sky
    float pdf = 0;               // with the choice of the emitter: per m2; of the sky per sr
    Vec2f barycentric{};         // of a triangle
};

/// Evenly on it; nothing where it has no area.
std::optional<EmissionPoint> point_on(const TriangleSampler& triangle, Vec2f u);
/// On that side which some point of the viewpoint may see; nothing from inside.
std::optional<EmissionPoint> point_on(const Sphere& sphere, Vec2f u, const Viewpoint& view);

/// Illuminance by a light at a viewpoint (lux) if the view has it in reach, as far as its bounds tell.
double illuminance_estimate(const LightBounds& bounds, bool moves, const ViewCone& view);

/// Which emitter: by an estimate of the illuminance that it brings to the lens from within the frame's
/// reach. Where on it: evenly on triangles, on that side of a sphere which some point of the lens may see,
/// and by luminance in the bright spots of a sky. The choice is the same at all times; the point is that of
/// the emitter at the time.
class EmissionSampler {
  public:
    EmissionSampler() = default;
    /// `views`: at some moments, one at least, between which the camera hardly moves. `lights` outlives this.
    EmissionSampler(const LightSet& lights, std::span<const ViewCone> views, bool with_sky = true);

    /// Nothing to be sampled.
    bool empty() const { return choice_.empty(); }
    std::optional<EmissionPoint> sample(float u_select, Vec2f u, float time,
                                        const Viewpoint& view) const;
    /// EmissionPoint::pdf, had sample() given this point.
    float pdf_triangle(std::uint32_t instance, std::uint32_t primitive, float time) const;
    float pdf_sphere(std::uint32_t sphere, Vec3f position, float time, const Viewpoint& view) const;
    float pdf_sky(Vec3f direction, float time) const;

  private:
    void add(std::int32_t light, double weight, std::vector<double>& weights);
    double sky_weight(std::span<const ViewCone> views);
    std::optional<EmissionPoint> sample_triangle(std::size_t entry, Vec2f u, float time) const;
    std::optional<EmissionPoint> sample_sphere(std::size_t entry, Vec2f u, float time,
                                               const Viewpoint& view) const;
    float pmf(std::int64_t light) const {
        return light < 0 || entry_of_[light] < 0 ? 0 : choice_.pmf(entry_of_[light]);
    }

    const LightSet* lights_ = nullptr;
    DiscreteDistribution choice_;
    std::vector<std::int32_t> chosen_;          // light by entry, or kSky
    std::vector<TriangleSampler> triangles_;    // by entry; area 0: none, or it moves
    std::vector<std::int32_t> entry_of_;        // by light; -1: never chosen
    HotSky sky_;
    float sky_pmf_ = 0;
};

}  // namespace dg
