// emission.h -- samples points on the emitters that a lens sees, for light paths directly to the lens. Excludes delta
// lights, which are invisible to cameras.
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

/// A point on an emitter, or a direction toward an emitter at infinity.
struct EmissionPoint {
    static constexpr std::int32_t kSky = LightSet::kEnvironment;
    std::int32_t light = kSky;   // index in LightSet::lights()
    Vec3f position{};            // m; for the sky, the unit direction toward it
    Vec3f normal{};              // unit, of the front side; not set for the sky
    float pdf = 0;               // includes the choice of the emitter; 1/m2, for the sky 1/sr
    Vec2f barycentric{};         // for triangles
};

/// Uniform point on a triangle; empty if it has no area.
std::optional<EmissionPoint> point_on(const TriangleSampler& triangle, Vec2f u);
/// Point on the side of a sphere that the viewpoint may see; empty from inside.
std::optional<EmissionPoint> point_on(const Sphere& sphere, Vec2f u, const Viewpoint& view);

/// Estimated illuminance by a light at a viewpoint (lux), from its bounds; 0 outside the view.
double illuminance_estimate(const LightBounds& bounds, bool moves, const ViewCone& view);

/// Chooses an emitter by its estimated illuminance at the lens from inside the field of view. Samples points uniformly
/// on triangles, on the side of a sphere that the lens may see, and by luminance in the bright spots of a sky. The
/// probabilities of emitters do not depend on time; the point is on the emitter at that time.
class EmissionSampler {
  public:
    EmissionSampler() = default;
    /// `views`: at least one, at times between which the camera moves little. `lights` must outlive this.
    EmissionSampler(const LightSet& lights, std::span<const ViewCone> views, bool with_sky = true);

    /// No emitter to sample.
    bool empty() const { return choice_.empty(); }
    std::optional<EmissionPoint> sample(float u_select, Vec2f u, float time,
                                        const Viewpoint& view) const;
    /// EmissionPoint::pdf with which sample() returns this point.
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
    std::vector<std::int32_t> chosen_;          // light of each entry, or kSky
    std::vector<TriangleSampler> triangles_;    // per entry; area 0: no triangle, or it moves
    std::vector<std::int32_t> entry_of_;        // per light; -1: never chosen
    HotSky sky_;
    float sky_pmf_ = 0;
};

}  // namespace dg
