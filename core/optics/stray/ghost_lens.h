// ghost_lens.h -- a lens prepared for tracing its ghosts: reflecting surfaces, ghost paths, and
// tables for the kernels.
//
// Cover glass and sensor belong to the camera body. They reflect if the body declares them, but the
// image itself is rendered without them, since lenses are designed for their cover glass. The film
// of ghosts is therefore displaced by the focus shift of the cover glass, d (1 - 1/n).
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "optics/trace/lens_tables.h"
#include "optics/trace/trace.h"
#include "optics/trace/trace_simd.h"

namespace dg {

/// Reflecting parts of the body at the film. Default: none.
struct SensorStack {
    double cover_thickness = 0;  // mm; 0: no cover glass
    double cover_index = 1.5168;
    double cover_gap = 1;        // mm of air between cover glass and sensor
    Coating cover_coating = Coating::broadband;
    double reflectance = 0;      // of the sensor, at all angles and wavelengths; 0: black

    bool empty() const { return !(cover_thickness > 0 || reflectance > 0); }
    friend bool operator==(const SensorStack&, const SensorStack&) = default;
};

/// Throws an Error with the name of the faulty value.
void check_stack(const SensorStack& stack);

/// Mirrors of a ghost in the order in which light hits them: far, near, or far, near, far, near.
using Mirrors = std::vector<int>;

/// Step of a ghost path for the kernels; gap: mm from the previous vertex.
struct GhostStep {
    int surface;
    int sign;
    bool reflects;
    float gap;
};

/// Reflectance of a surface: bare, with films (coating.h), or constant. Index of a film: n = a + b
/// / um^2.
struct MirrorTables {
    enum class Kind { none, bare, films, constant };
    struct Layer {
        float a, b, um;
    };
    Kind kind = Kind::none;
    bool rarer_in_front = true;
    float reflectance = 0;  // constant
    std::vector<Layer> layers{};
};

class GhostLens {
  public:
    /// `lens` must have its gaps set for focus; film and iris match the image rays. Throws Error
    /// for an invalid stack, or for a stack with a tilted film.
    GhostLens(const Prescription& lens, const FilmPlane& film, const Iris& iris, double iris_radius,
              const SensorStack& stack, double half_diagonal);

    /// Tracer of the surfaces of the lens, followed by the surfaces of the body.
    const Tracer& tracer() const { return tracer_; }
    const LensTables& tables() const { return tables_; }
    const std::vector<MirrorTables>& mirrors() const { return mirrors_; }
    const FilmPlane& film() const { return film_; }
    const Iris& iris() const { return iris_; }
    double iris_radius() const { return iris_radius_; }
    /// Surfaces with a reflectance above zero, in order.
    const std::vector<int>& reflecting() const { return reflecting_; }
    /// Number of surfaces that transmitted light passes to the film: all but the sensor.
    int passed() const { return passed_; }

    /// Pairs of reflecting surfaces, n (n - 1) / 2.
    std::vector<Mirrors> two_bounces() const;
    /// Ghosts of four reflections. Their number grows with the fourth power of the number of
    /// surfaces; returns at most the `most` brightest by reflectance at normal incidence.
    std::vector<Mirrors> four_bounces(std::size_t most) const;
    /// Reflectance at normal incidence, mean over blue, green and red; positive if the surface
    /// reflects at any of them.
    double reflectance(int surface) const;
    LensPath path(const Mirrors& mirrors) const {
        return ghost_path(passed_, mirrors, true);
    }
    std::vector<GhostStep> steps(const Mirrors& mirrors) const;

    /// Clips at the iris and all clear apertures.
    Clip clip() const { return {true, &iris_, iris_radius_}; }

  private:
    Prescription lens_;
    int passed_;
    FilmPlane film_;
    Tracer tracer_;
    Iris iris_;
    double iris_radius_;
    LensTables tables_;
    std::vector<MirrorTables> mirrors_;
    std::vector<int> reflecting_;
};

/// Traces a ghost exactly in SIMD lanes from the scene to the film, like trace_to_film
/// (trace_simd.h). iris_opening: fraction of the iris radius per ray; null: fully open.
void trace_ghost(const GhostLens& lens, const std::vector<GhostStep>& steps, SceneRays& in, FilmRays& out,
                 const float* iris_opening, int count);

}  // namespace dg
