// pixel_cone.h -- cones of camera rays: the angle of a pixel as seen from the lens. Rays from one
// point of the lens to neighbouring film points diverge from that point, in focus or not. So the
// apex of the cone is on the entrance pupil (the plane z = 0 of the camera frame), and defocus does
// not widen it.
#pragma once
#include <array>

#include "camera/camera.h"
#include "camera/sensor.h"

namespace dg {

class PixelCone {
  public:
    /// No cones: textures are point-sampled.
    PixelCone() = default;
    PixelCone(const Camera& camera, const Sensor& sensor);
    template <HasChief Lens>
    static PixelCone of(const Lens& lens, const Sensor& sensor);

    /// Angle (rad) of a pixel at a film point: geometric mean of width and height.
    float angle(Vec2f film_mm) const;
    /// Cone of a ray (camera frame) from that film point, kConeShare of a pixel wide.
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
