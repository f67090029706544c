// trace.h -- exact tracing through every surface, in double: the reference. Both
// directions.
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
    LensRay ray;               // from the last surface that was met, refracted
    Vec2d iris{};              // mm, where the ray crossed the stop
    double transmittance = 1;  // product over surfaces and glasses, and the iris's
    double optical_path = 0;   // mm: sum of n x distance, from the origin to there
};

/// Stops of rays besides a miss or total reflection. The iris replaces the stop's clear
/// diameter.
struct Clip {
    bool clear_apertures = true;
    const Iris* iris = nullptr;
    double iris_radius = 0;  // mm, of the circle of equal area
    double widened = 1;      // factor on the clear diameters
};

/// d(x, y, n L, n M) out / in: rows are outputs. L and M are the direction's x and y.
using RayJacobian = std::array<std::array<double, 4>, 4>;

/// The indices of all media at one wavelength: index[i] before surface i; and what they
/// swallow, 1/mm (empty: all are clear).
struct LensIndices {
    double wavelength_nm;
    std::vector<double> index;
    std::vector<double> absorption = {};
};

class Tracer {
  public:
    explicit Tracer(const Prescription& lens);  // validates

    LensIndices at(double wavelength_nm) const;
    /// From the object side through the last surface; direction.z > -1 and the ray meets
    /// surface 0 first.
    std::optional<TracedRay> to_film(LensRay ray, const LensIndices& n,
                                     const Clip& clip) const;
    /// From the film side through the first surface.
    std::optional<TracedRay> to_scene(LensRay ray, const LensIndices& n,
                                      const Clip& clip) const;
    /// The same, either way, with what is known of a ray that is stopped: the surface
    /// that stopped it, or -1; `ray` is left at the last surface that it met.
    int follow(TracedRay& ray, bool toward_film, const LensIndices& n,
               const Clip& clip) const;
    /// Along any path, ghosts too: the step that stopped the ray, or -1. The iris point is that
    /// of the last crossing; the iris clips at each.
    int follow(TracedRay& ray, const LensPath& path, const LensIndices& n,
               const Clip& clip) const;
    /// From the film side to the stop: the iris point, mm. Clear apertures are widened by
    /// the factor.
    std::optional<Vec2d> to_iris(LensRay ray, const LensIndices& n, double widened) const;

    /// Points where the ray met the surfaces, object side first, for drawings; empty if
    /// stopped.
    std::vector<Vec3d> path_to_film(LensRay ray, const LensIndices& n,
                                    const Clip& clip) const;

    /// Between the plane of the ray's origin and the plane image_z, through the whole
    /// lens toward the film, whatever the clear apertures. Analytic.
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

/// Where a ray meets the plane z, mm.
inline Vec3d at_plane(const LensRay& ray, double z) {
    return ray.origin + ray.direction * ((z - ray.origin.z) / ray.direction.z);
}

}  // namespace dg
