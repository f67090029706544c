#include "optics/pupil_tables.h"

#include <cfloat>
#include <cmath>

#include "optics/lens_error.h"

namespace dg {
namespace {

constexpr double kShortest = 380, kLongest = 780;  // nm

/// Coefficients (powers of l) of the polynomial through n at Chebyshev points of [-1, 1].
std::vector<double> interpolate_index(const Glass& glass, const WavelengthScale& scale,
                                      int degree) {
    const int count = degree + 1;
    std::vector<double> node(count), divided(count);
    for (int i = 0; i < count; ++i) {
        node[i] = std::cos(kPiD * (i + 0.5) / count);
        divided[i] = refractive_index(
            glass, 1e3 / std::sqrt((node[i] - scale.offset) / scale.scale));
    }
    for (int order = 1; order < count; ++order)  // Newton's divided differences
        for (int i = count - 1; i >= order; --i)
            divided[i] = (divided[i] - divided[i - 1]) / (node[i] - node[i - order]);
    std::vector<double> power(count, 0.0);
    for (int i = count - 1; i >= 0; --i) {  // Horner, expanded into powers
        for (int j = count - 1; j > 0; --j) power[j] = power[j - 1] - node[i] * power[j];
        power[0] = divided[i] - node[i] * power[0];
    }
    return power;
}

/// The lowest degree that follows all glasses within 1e-7: 2 for Cauchy, more for tables.
int index_degree(const Prescription& lens, const WavelengthScale& scale) {
    for (int degree = 0; degree < 8; ++degree) {
        double worst = 0;
        const auto visit = [&](const Glass& glass) {
            const auto power = interpolate_index(glass, scale, degree);
            for (double nm = kShortest; nm <= kLongest; nm += 10) {
                double n = 0;
                for (int j = degree; j >= 0; --j) n = n * scale(nm) + power[j];
                worst = std::max(worst, std::abs(n - refractive_index(glass, nm)));
            }
        };
        visit(lens.object_medium);
        for (const Surface& s : lens.surfaces) visit(s.glass);
        if (worst < 1e-7) return degree;
    }
    return 8;
}

void fill_iris(IrisTables& t, const Iris& iris, double radius) {
    const auto mm = [&](double unit) { return float(unit * radius); };
    t.kind = iris.kind();
    t.radius = float(radius);
    const Iris::Blades& b = iris.blades();
    for (const Vec2d e : b.edge)
        t.edge_x.push_back(float(e.x)), t.edge_y.push_back(float(e.y));
    t.apothem = mm(b.apothem), t.center = mm(b.center), t.bend = b.bend;
    t.arc_radius2 = mm(b.arc_radius) * mm(b.arc_radius);
    for (const Vec2d p : b.fan) t.fan_x.push_back(mm(p.x)), t.fan_y.push_back(mm(p.y));
    const Iris::Image& m = iris.picture();
    t.width = m.width, t.height = m.height, t.pixel = mm(m.pixel), t.values = m.values;
    for (const Vec2d p : m.support)
        t.support_x.push_back(mm(p.x)), t.support_y.push_back(mm(p.y));
}

}  // namespace

WavelengthScale WavelengthScale::visible() {
    const double a = 1e6 / (kShortest * kShortest), b = 1e6 / (kLongest * kLongest);
    return {float(-(a + b) / (a - b)), float(2 / (a - b))};
}

LensTables make_lens_tables(const Tracer& tracer, double film_z, bool clear_apertures,
                            const Iris* iris, double iris_radius) {
    const Prescription& lens = tracer.prescription();
    LensTables t;
    t.surfaces = int(lens.surfaces.size());
    t.stop = tracer.stop();
    t.film_gap = float(film_z - tracer.vertices().back());
    t.apertures = clear_apertures;
    t.index_degree = index_degree(lens, t.scale);
    const auto add_index = [&](const Glass& glass) {
        for (const double c : interpolate_index(glass, t.scale, t.index_degree))
            t.index.push_back(float(c));
    };
    add_index(lens.object_medium);
    for (int i = 0; i < t.surfaces; ++i) {
        const Surface& s = lens.surfaces[i];
        if (!tracer.form(i).sphere || is_placed(s))
            throw LensError(surface_name(lens, i) + ": a form that the kernels trace not yet",
                            "lens-surface", i);
        const Glass& before = i ? lens.surfaces[i - 1].glass : lens.object_medium;
        t.curvature.push_back(float(s.curvature));
        t.gap.push_back(float(s.thickness));
        const bool bounded =
            clear_apertures && std::isfinite(clear_radius(s)) && !(iris && i == t.stop);
        t.semi2.push_back(bounded ? float(clear_radius(s) * clear_radius(s)) : FLT_MAX);
        add_index(s.glass);
        const bool same = refractive_index(before, 550) == refractive_index(s.glass, 550);
        const bool coated =
            lens.coating == Coating::mgf2 && (is_air(before) || is_air(s.glass));
        t.light.push_back(same || lens.coating == Coating::perfect ? SurfaceLight::none
                          : coated                                 ? SurfaceLight::film
                                                                   : SurfaceLight::bare);
    }
    if (iris) fill_iris(t.iris, *iris, iris_radius);
    return t;
}

}  // namespace dg
