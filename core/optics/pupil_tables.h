// pupil_tables.h -- flat float tables that the SIMD kernels read: the lens and its iris.
#pragma once
#include <vector>

#include "optics/aim_tables.h"
#include "optics/film_plane.h"
#include "optics/stop.h"
#include "optics/trace.h"

namespace dg {

struct IrisTables {
    Iris::Kind kind = Iris::Kind::round;
    float radius = 0;  // mm, of the circle of equal area; 0: no iris (all passes)
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

/// 1/lambda^2 mapped to [-1, 1] over the visible range: the variable of every fit in the
/// wavelength.
struct WavelengthScale {
    float offset, scale;  // l = offset + scale / um^2
    static WavelengthScale visible();
    double operator()(double nm) const { return offset + scale * (1e6 / (nm * nm)); }
};

/// How a surface treats light in the kernel.
enum class SurfaceLight : int { none, bare, film };

/// By which formula rays meet a surface.
enum class MetAs : int { plane, sphere, other };

/// A form that is no centred plane or sphere (form.h), in float. The asphere is a
/// polynomial in (r / scale)^2, so that its coefficients are lengths.
struct ShapeTables {
    Shape shape = Shape::conic;
    bool quadric = true, has_asphere = false, placed = false;
    float c = 0, wx = 1, wy = 1, wz = 1;  // c (wx x^2 + wy y^2 + wz z^2) = 2 z
    float cx = 0, cy = 0;                 // both sections
    float px = 0, py = 0;                 // (1 + k) c^2 of both
    float inverse_scale2 = 1;             // 1/mm^2
    std::vector<float> even, even_slope, odd, odd_slope;
    float tolerance = 0, stride = 0;  // mm: of the last step of a search, of any
    float shift[3] = {0, 0, 0};
    float axis[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

struct LensTables {
    int surfaces = 0, stop = 0;
    float film_gap = 0;  // last vertex to film, mm; to its centre if it is tilted
    FilmTables film;
    std::vector<float> curvature, semi2, inner2, gap;
    std::vector<MetAs> met;
    std::vector<char> refracts;      // or rays go straight on
    std::vector<ShapeTables> shape;  // of those met as other
    std::vector<SurfaceLight> light;
    int index_degree = 0;
    std::vector<float> index;  // [medium][power of l]
    bool apertures = true;     // test clear apertures
    IrisTables iris;
    WavelengthScale scale = WavelengthScale::visible();
};

LensTables make_lens_tables(const Tracer& tracer, double film_z, bool clear_apertures,
                            const Iris* iris, double iris_radius);
/// The same with the film in any place.
LensTables make_lens_tables(const Tracer& tracer, const FilmPlane& film, bool clear_apertures,
                            const Iris* iris, double iris_radius);

}  // namespace dg
