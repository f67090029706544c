// pixel_cone.h -- the cones with which camera rays start: how wide a pixel is as seen from
// the lens. For one point of the lens the rays of neighbouring film points spread from that
// point, in focus or not; so the cone's apex lies on the entrance pupil (the plane z = 0 of
// the camera), and defocus does not widen it.
#pragma once
#include <array>

#include "camera/camera.h"
#include "camera/sensor.h"

namespace dg {

class PixelCone {
  public:
    /// No cones at all: every texture is read at a point.
    PixelCone() = default;
    PixelCone(const Camera& camera, const Sensor& sensor);
    template <HasChief Lens>
    static PixelCone of(const Lens& lens, const Sensor& sensor);

    /// Angle (rad) that a pixel covers there: geometric mean of its width and height.
    float angle(Vec2f film_mm) const;
    /// The cone of a ray (camera frame) of that film point, kConeShare of a pixel wide.
    RayCone at(Vec2f film_mm, const Ray& ray) const {
        return steps_per_mm_ > 0 ? cone(film_mm, ray) : RayCone{};
    }

  private:
    template <HasChief Lens>
    void measure_around(const Lens& lens, const Sensor& sensor);
    template <HasChief Lens>
    void measure_along(const Lens& lens, const Sensor& sensor);
    RayCone cone(Vec2f film_mm, const Ray& ray) const;

    static constexpr int kSteps = 32;
    float steps_per_mm_ = 0;
    std::array<float, kSteps + 1> angles_{};  // by distance from the axis
};

}  // namespace dg
