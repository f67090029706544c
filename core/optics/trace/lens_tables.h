// lens_tables.h -- flat float tables that the SIMD kernels read: the lens and its iris.
#pragma once
#include <cmath>
#include <vector>

#include "optics/lens/film_plane.h"
#include "optics/lens/stop.h"
#include "optics/trace/coating_table.h"
#include "optics/trace/trace.h"

namespace dg {

struct IrisTables {
    Iris::Kind kind = Iris::Kind::round;
    float radius = 0;  // mm, radius of the circle of equal area; 0: no iris
    // Blades, mm.
    std::vector<float> edge_x, edge_y;
    float apothem = 0, center = 0, arc_radius2 = 0;
    int bend = 0;
    std::vector<float> fan_x, fan_y;
    // Image, mm.
    int width = 0, height = 0;
    float pixel = 0;
    std::vector<float> values, support_x, support_y;
};

/// Wavelength variable of all polynomial fits: 1/lambda^2 mapped to [-1, 1] over the visible range.
struct WavelengthScale {
    float offset, scale;  // l = offset + scale / um^2
    static WavelengthScale visible();
    double operator()(double nm) const { return offset + scale * (1e6 / (nm * nm)); }
    double wavelength(double l) const { return 1e3 / std::sqrt((l - offset) / scale); }
};

/// Transmittance model of a surface: 1, Fresnel's formulas, or the table of its coating.
enum class FresnelModel : int { none, bare, coated };

/// Intersection routine of a surface.
enum class Intersection : int { plane, sphere, other };

/// Form of a surface other than a centred plane or sphere (form.h), in float. The asphere is a
/// polynomial in (r / scale)^2, so its coefficients are lengths.
struct ShapeTables {
    Shape shape = Shape::conic;
    bool quadric = true, has_asphere = false, placed = false;
    float c = 0, wx = 1, wy = 1, wz = 1;  // c (wx x^2 + wy y^2 + wz z^2) = 2 z
    float cx = 0, cy = 0;                 // curvatures of the sections
    float px = 0, py = 0;                 // (1 + k) c^2 of the sections
    float inverse_scale2 = 1;             // 1/mm^2
    std::vector<float> even, even_slope, odd, odd_slope;
    float tolerance = 0, stride = 0;  // mm, of a search: step at convergence, and longest step
    float shift[3] = {0, 0, 0};
    float axis[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<float> ripple;  // RippleSlope
    float ripple_steps_per_mm = 0;
};

/// Absorption coefficients of the media (1/mm, base e) at equal steps of l from -1 to 1,
/// [medium][node]; empty if all media are clear.
struct AbsorptionTables {
    static constexpr int kNodes = 257;  // 0.6 nm apart at 380 nm, 5 nm at 780 nm
    std::vector<float> per_mm;
    std::vector<char> absorbs;  // by medium
};

struct LensTables {
    int surfaces = 0, stop = 0;
    float film_gap = 0;  // mm, last vertex to film (to the centre of a tilted film)
    FilmPlaneTables film;
    std::vector<float> curvature, semi2, inner2, gap;   // semi2, inner2: mm2, squared clear and inner radius
    std::vector<Intersection> intersection;
    std::vector<char> refracts;      // false: no change of index
    std::vector<ShapeTables> shape;  // for surfaces with Intersection::other
    std::vector<FresnelModel> fresnel;
    std::vector<CoatingTable> coatings;     // for coated surfaces
    std::vector<char> rarer_in_front;  // for coated surfaces: the table takes the cosine in the rarer medium
    int index_degree = 0;
    std::vector<float> index;  // [medium][power of l]
    AbsorptionTables absorption;
    bool apertures = true;     // test clear apertures
    IrisTables iris;
    WavelengthScale scale = WavelengthScale::visible();
};

/// Transmittance table of a coated surface; empty if it has no films.
CoatingTable coating_table(const SurfaceCoating& coating, const Glass& before,
                     const Glass& after, const WavelengthScale& scale);

LensTables make_lens_tables(const Tracer& tracer, double film_z, bool clear_apertures,
                            const Iris* iris, double iris_radius);
/// Tables with a shifted or tilted film.
LensTables make_lens_tables(const Tracer& tracer, const FilmPlane& film, bool clear_apertures,
                            const Iris* iris, double iris_radius);

}  // namespace dg
