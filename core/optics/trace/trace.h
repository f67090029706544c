// trace.h -- exact sequential ray tracing in double, in both directions: the reference.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "optics/lens/form.h"
#include "optics/lens/prescription.h"
#include "optics/lens/stop.h"
#include "optics/trace/lens_path.h"

namespace dg {

/// Lens frame, mm; the direction is a unit vector.
struct LensRay {
    Vec3d origin, direction;
};

struct TracedRay {
    LensRay ray;               // refracted ray at the last surface
    Vec2d iris{};              // mm, intersection with the plane of the stop
    double transmittance = 1;  // product over surfaces, glasses and the iris
    double optical_path = 0;   // mm, sum of n x distance from the origin to the last surface
};

/// Apertures that clip rays. An iris replaces the clear diameter of the stop.
struct Clip {
    bool clear_apertures = true;
    const Iris* iris = nullptr;
    double iris_radius = 0;  // mm, radius of the circle of equal area
    double widened = 1;      // factor on the clear diameters
};

/// Jacobian d(x, y, n L, n M) out / in, where L and M are the x and y components of the direction;
/// rows are outputs.
using RayJacobian = std::array<std::array<double, 4>, 4>;

/// Media at one wavelength: index[i] before surface i, and absorption coefficients in 1/mm (empty:
/// all media are clear).
struct LensIndices {
    double wavelength_nm;
    std::vector<double> index;
    std::vector<double> absorption = {};
};

class Tracer {
  public:
    explicit Tracer(const Prescription& lens);  // validates

    LensIndices at(double wavelength_nm) const;
    /// Traces from the object side through the last surface. direction.z must be > -1, and the
    /// first hit must be surface 0.
    std::optional<TracedRay> to_film(LensRay ray, const LensIndices& n,
                                     const Clip& clip) const;
    /// Traces from the film side through the first surface.
    std::optional<TracedRay> to_scene(LensRay ray, const LensIndices& n,
                                      const Clip& clip) const;
    /// Traces in either direction. Returns the index of the surface that clips the ray, or -1;
    /// `ray` is left at the last surface that it hit.
    int follow(TracedRay& ray, bool toward_film, const LensIndices& n,
               const Clip& clip) const;
    /// Traces along any path, including ghosts. Returns the index of the step that stops the ray,
    /// or -1. The iris clips at each crossing; the iris point is from the last crossing.
    int follow(TracedRay& ray, const LensPath& path, const LensIndices& n,
               const Clip& clip) const;
    /// Traces from the film side to the stop; returns the iris point in mm. `widened` scales the
    /// clear apertures.
    std::optional<Vec2d> to_iris(LensRay ray, const LensIndices& n, double widened) const;

    /// Intersections with all surfaces, object side first, for drawings; empty if the ray is
    /// clipped.
    std::vector<Vec3d> path_to_film(LensRay ray, const LensIndices& n,
                                    const Clip& clip) const;

    /// Analytic Jacobian from the plane of the ray's origin to the plane image_z, toward the film
    /// through the whole lens, ignoring clear apertures.
    std::optional<RayJacobian> jacobian(const LensRay& ray, const LensIndices& n,
                                        double image_z) const;

    const Prescription& prescription() const { return lens_; }
    const std::vector<double>& vertices() const { return vertices_; }
    const SurfaceForm& form(int surface) const { return forms_[surface]; }
    int stop() const { return stop_; }

  private:
    bool cross(const PathStep& step, const LensIndices& n, const Clip& clip,
               TracedRay& ray) const;

    Prescription lens_;
    std::vector<double> vertices_;
    std::vector<SurfaceForm> forms_;
    std::vector<SurfaceCoating> coatings_;
    int stop_;
};

/// Intersection of a ray with the plane z, mm.
inline Vec3d at_plane(const LensRay& ray, double z) {
    return ray.origin + ray.direction * ((z - ray.origin.z) / ray.direction.z);
}

}  // namespace dg
