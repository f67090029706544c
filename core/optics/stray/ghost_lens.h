// ghost_lens.h -- a lens with all of its ghosts, ready to be traced: which surfaces reflect, the ways by two
// of them, and the tables that the kernels read.
//
// The sensor and the glass before it belong to the body. They reflect, too, where it declares them; the
// picture itself is drawn as if they were not there, since every lens is made for them. So the film of ghosts
// lies behind by what the glass shifts the focus, d (1 - 1/n).
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "optics/trace/lens_tables.h"
#include "optics/trace/trace.h"
#include "optics/trace/trace_simd.h"

namespace dg {

/// Parts before the film, and how much light the film sends back. Nothing by default.
struct SensorStack {
    double cover_thickness = 0;  // mm; 0: no cover glass
    double cover_index = 1.5168;
    double cover_gap = 1;        // mm of air between the cover glass and the sensor
    Coating cover_coating = Coating::broadband;
    double reflectance = 0;      // of the sensor, at all angles and wavelengths; 0: it swallows all

    bool empty() const { return !(cover_thickness > 0 || reflectance > 0); }
    friend bool operator==(const SensorStack&, const SensorStack&) = default;
};

/// Throws Error that names the value.
void check_stack(const SensorStack& stack);

/// A way by mirrors, in the order in which light meets them: far, near, or far, near, far, near.
using Mirrors = std::vector<int>;

/// One step of a path for the kernels; gap: mm from the vertex before.
struct GhostStep {
    int surface;
    int sign;
    bool reflects;
    float gap;
};

/// A surface as a mirror: the films on it (coating.h), or none; n = a + b / um^2.
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
    /// `lens` with the gaps of its focus; film and iris as of its rays. Error for a stack that cannot be, or
    /// before a film that is tilted against the lens.
    GhostLens(const Prescription& lens, const FilmPlane& film, const Iris& iris, double iris_radius,
              const SensorStack& stack, double half_diagonal);

    /// Surfaces of the lens, then of the body.
    const Tracer& tracer() const { return tracer_; }
    const LensTables& tables() const { return tables_; }
    const std::vector<MirrorTables>& mirrors() const { return mirrors_; }
    const FilmPlane& film() const { return film_; }
    const Iris& iris() const { return iris_; }
    double iris_radius() const { return iris_radius_; }
    /// Those that reflect anything, in order.
    const std::vector<int>& reflecting() const { return reflecting_; }
    /// How many surfaces light passes on its straight way to the film: all but a sensor.
    int passed() const { return passed_; }

    /// All pairs of reflecting surfaces, n (n - 1) / 2.
    std::vector<Mirrors> two_bounces() const;
    /// Those by four reflections; of all of them the brightest, by what their surfaces reflect straight on: so
    /// many at most, as their number grows with the fourth power of the surfaces'.
    std::vector<Mirrors> four_bounces(std::size_t most) const;
    /// Reflectance of a surface straight on, mean over blue, green and red; above 0 where it reflects at all.
    double reflectance(int surface) const;
    LensPath path(const Mirrors& mirrors) const {
        return ghost_path(passed_, mirrors, true);
    }
    std::vector<GhostStep> steps(const Mirrors& mirrors) const;

    /// The iris and all clear apertures.
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

/// The exact trace of one ghost in lanes, scene -> film, as trace_to_film (trace_simd.h). iris_opening: of its
/// radius, by ray; null: fully open at all times.
void trace_ghost(const GhostLens& lens, const std::vector<GhostStep>& steps, SceneRays& in, FilmRays& out,
                 const float* iris_opening, int count);

}  // namespace dg
