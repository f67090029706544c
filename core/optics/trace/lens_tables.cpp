#include "optics/trace/lens_tables.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace dg {
namespace {

constexpr double kShortest = 380, kLongest = 780;  // nm
constexpr double kFilmTolerance = 1.5e-4;  // bound for film tables; the actual error is about half

/// Coefficients (powers of l) of the polynomial through n at Chebyshev points of [-1, 1].
std::vector<double> interpolate_index(const Glass& glass, const WavelengthScale& scale,
                                      int degree) {
    const int count = degree + 1;
    std::vector<double> node(count), divided(count);
    for (int i = 0; i < count; ++i) {
        node[i] = std::cos(kPiD * (i + 0.5) / count);
        divided[i] = refractive_index(
            glass, scale.wavelength(node[i]));
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

/// Lowest degree that interpolates the indices of all glasses within 1e-7: 2 for Cauchy glass, more
/// for tables.
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

Intersection intersection_of(const Surface& s) {
    const bool sphere =
        s.shape == Shape::conic && s.conic == 0 && s.asphere.empty() && !is_placed(s) &&
        s.ripple.rms_nm == 0;
    if (!sphere) return Intersection::other;
    return s.curvature == 0 ? Intersection::plane : Intersection::sphere;
}

void fill_asphere(ShapeTables& t, const SurfaceForm& f, double scale) {
    t.has_asphere = !f.even.empty() || !f.odd.empty();
    t.inverse_scale2 = float(1 / (scale * scale));
    for (std::size_t j = 0; j < f.even.size(); ++j) {
        const double a = f.even[j] * std::pow(scale, 2.0 * double(j) + 2);
        t.even.push_back(float(a)), t.even_slope.push_back(float(2 * double(j + 1) * a));
    }
    for (std::size_t j = 0; j < f.odd.size(); ++j) {
        const double a = f.odd[j] * std::pow(scale, 2.0 * double(j) + 1);
        t.odd.push_back(float(a)), t.odd_slope.push_back(float((2 * double(j) + 1) * a));
    }
}

ShapeTables shape_tables(const Surface& s, const SurfaceForm& f) {
    ShapeTables t;
    t.shape = f.shape, t.quadric = f.quadric, t.placed = is_placed(s);
    const bool start = f.quadric || f.shape == Shape::conic;  // else the search starts from the plane
    t.c = start ? float(f.c) : 0, t.wz = float(1 + f.k);
    t.wx = float(f.wx), t.wy = float(f.wy);
    t.cx = float(f.cx), t.cy = float(f.cy);
    t.px = float((1 + f.kx) * f.cx * f.cx), t.py = float((1 + f.ky) * f.cy * f.cy);
    const double scale = std::isfinite(f.clear) ? f.clear : 10;
    fill_asphere(t, f, scale);
    double terms = scale;  // magnitude of the terms subject to rounding
    for (const float a : t.even) terms += std::abs(double(a));
    for (const float a : t.odd) terms += std::abs(double(a));
    t.tolerance = float(5e-7 * terms), t.stride = float(scale);
    t.ripple = f.ripple.slope, t.ripple_steps_per_mm = float(f.ripple.steps_per_mm);
    const SurfaceFrame& place = f.place;
    const Vec3d axes[3] = {place.x, place.y, place.z};
    const Vec3d shift = s.decenter;
    for (int i = 0; i < 3; ++i) {
        t.shift[i] = float(shift[i]);
        for (int j = 0; j < 3; ++j) t.axis[i][j] = float(axes[i][j]);
    }
    return t;
}

}  // namespace

namespace {

void add_absorption(AbsorptionTables& t, const Glass& glass, const WavelengthScale& scale) {
    t.absorbs.push_back(!glass.absorption.nm.empty());
    for (int i = 0; i < t.kNodes; ++i) {
        const double nm = scale.wavelength(2.0 * i / (t.kNodes - 1) - 1);
        t.per_mm.push_back(float(absorption_per_mm(glass, nm)));
    }
}

}  // namespace

CoatingTable coating_table(const SurfaceCoating& coating, const Glass& before,
                     const Glass& after, const WavelengthScale& scale) {
    if (coating.films.empty()) return {};
    const double n = refractive_index(before, kFilmWavelength) /
                     refractive_index(after, kFilmWavelength);
    const Glass &rarer = n < 1 ? before : after, &denser = n < 1 ? after : before;
    double thickness = 0;
    for (const CoatingLayer& f : coating.films)
        thickness += f.index(kFilmWavelength) * f.thickness_nm;
    const auto at = [&](double l) -> std::function<double(double)> {
        const double nm = scale.wavelength(l);
        const double n1 = refractive_index(rarer, nm), n2 = refractive_index(denser, nm);
        return [&coating, nm, n1, n2](double cos1) {
            const double mu = n1 / n2, cos2 = std::sqrt(1 - mu * mu * (1 - cos1 * cos1));
            return surface_transmittance(coating, n1, cos1, n2, cos2, nm);
        };
    };
    return fit_coating_table(at, std::max(n, 1 / n),
                          2 * kPiD * thickness * (1 / kShortest - 1 / kLongest),
                          kFilmTolerance);
}

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
        const Glass& before = i ? lens.surfaces[i - 1].glass : lens.object_medium;
        t.curvature.push_back(float(s.curvature));
        t.gap.push_back(float(s.thickness));
        t.intersection.push_back(intersection_of(s));
        t.shape.push_back(shape_tables(s, tracer.form(i)));
        const bool bounded =
            clear_apertures && std::isfinite(clear_radius(s)) && !(iris && i == t.stop);
        t.semi2.push_back(bounded ? float(clear_radius(s) * clear_radius(s)) : FLT_MAX);
        const bool holed = clear_apertures && s.inner_semi_diameter > 0;
        t.inner2.push_back(
            holed ? float(s.inner_semi_diameter * s.inner_semi_diameter) : 0);
        add_index(s.glass);
        const auto after = t.index.end() - (t.index_degree + 1);
        const bool same = std::equal(after, t.index.end(), after - (t.index_degree + 1));
        t.refracts.push_back(!same);
        const SurfaceCoating coating = coating_at(lens, i);
        t.fresnel.push_back(same || !coating.reflects ? FresnelModel::none
                            : coating.films.empty()   ? FresnelModel::bare
                                                      : FresnelModel::coated);
        t.rarer_in_front.push_back(refractive_index(before, kFilmWavelength) <
                                   refractive_index(s.glass, kFilmWavelength));
        t.coatings.push_back(coating_table(coating, before, s.glass, t.scale));
    }
    if (absorbs(lens)) {
        add_absorption(t.absorption, lens.object_medium, t.scale);
        for (const Surface& s : lens.surfaces) add_absorption(t.absorption, s.glass, t.scale);
    }
    if (iris) fill_iris(t.iris, *iris, iris_radius);
    return t;
}

LensTables make_lens_tables(const Tracer& tracer, const FilmPlane& film, bool clear_apertures,
                            const Iris* iris, double iris_radius) {
    LensTables t = make_lens_tables(tracer, film.center.z, clear_apertures, iris, iris_radius);
    const bool across = film.x == Vec3d{1, 0, 0} && film.y == Vec3d{0, 1, 0} &&
                        film.center.x == 0 && film.center.y == 0;
    if (!across) t.film = FilmPlaneTables(film);
    return t;
}

}  // namespace dg
