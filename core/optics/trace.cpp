#include "optics/trace.h"

#include <cmath>

namespace dg {

Tracer::Tracer(const Prescription& lens) : lens_(lens) {
    validate(lens);
    vertices_ = lens.vertices();
    stop_ = lens.stop_index();
}

LensIndices Tracer::at(double wavelength_nm) const {
    LensIndices n{wavelength_nm, {refractive_index(lens_.object_medium, wavelength_nm)}};
    for (const Surface& s : lens_.surfaces)
        n.index.push_back(refractive_index(s.glass, wavelength_nm));
    return n;
}

// Intersection and refraction in curvature form (planes and spheres alike), from the
// point M of the ray nearest to the vertex; `sign` is +1 toward the film. Source: Feder
// 1951, Optical Calculations with Automatic Computing Machinery, JOSA 41(9), eqs. 1-9;
// also valid for rays at and beyond 90 degrees.
bool Tracer::cross(int i, int sign, const LensIndices& n, const Clip& clip,
                   TracedRay& traced) const {
    const Surface& surface = lens_.surfaces[i];
    const double c = surface.curvature;
    Vec3d p = traced.ray.origin, d = traced.ray.direction;
    p.z -= vertices_[i];
    const double e = -dot(p, d);
    const Vec3d m = p + e * d;
    const double q = c * dot(m, m) - 2 * m.z;
    const double cos1_squared = d.z * d.z - c * q;
    if (!(cos1_squared >= 0)) return false;  // missed
    const double cos1 = std::sqrt(cos1_squared);
    p = m + d * (q / (d.z + sign * cos1));
    const double r2 = p.x * p.x + p.y * p.y, toward_axis = 1 - c * p.z;
    if (!(toward_axis > 0)) return false;  // the far half of the sphere
    const double n1 = n.index[sign > 0 ? i : i + 1], n2 = n.index[sign > 0 ? i + 1 : i];
    const Vec3d met{p.x, p.y, p.z + vertices_[i]};
    traced.optical_path += n1 * dot(met - traced.ray.origin, d);
    traced.ray.origin = met;
    if (i == stop_) {
        traced.iris = {p.x, p.y};
        if (clip.iris) {
            const double open =
                clip.iris->transmission(traced.iris * (1 / clip.iris_radius));
            if (!(open > 0)) return false;
            traced.transmittance *= open;
        }
    }
    const bool iris_here = i == stop_ && clip.iris;
    const double edge = clear_radius(surface) * clip.widened;
    const double hole = surface.inner_semi_diameter / clip.widened;
    if (clip.clear_apertures && !iris_here && !(r2 <= edge * edge)) return false;
    if (clip.clear_apertures && !(r2 >= hole * hole)) return false;
    const double mu = n1 / n2, cos2_squared = 1 - mu * mu * (1 - cos1_squared);
    if (!(cos2_squared >= 0)) return false;  // total reflection
    const double cos2 = std::sqrt(cos2_squared);
    const Vec3d normal{-c * p.x, -c * p.y, toward_axis};
    traced.ray.direction = mu * d + (sign * (cos2 - mu * cos1)) * normal;
    traced.transmittance *=
        surface_transmittance(lens_.coating, n1, cos1, n2, cos2, n.wavelength_nm);
    return true;
}

int Tracer::follow(TracedRay& ray, bool toward_film, const LensIndices& n,
                   const Clip& clip) const {
    const int count = int(lens_.surfaces.size());
    for (int k = 0; k < count; ++k) {
        const int i = toward_film ? k : count - 1 - k;
        if (!cross(i, toward_film ? 1 : -1, n, clip, ray)) return i;
    }
    return -1;
}

std::optional<TracedRay> Tracer::to_film(LensRay ray, const LensIndices& n,
                                         const Clip& clip) const {
    TracedRay traced{ray};
    if (follow(traced, true, n, clip) >= 0) return std::nullopt;
    return traced;
}

std::optional<TracedRay> Tracer::to_scene(LensRay ray, const LensIndices& n,
                                          const Clip& clip) const {
    TracedRay traced{ray};
    if (follow(traced, false, n, clip) >= 0) return std::nullopt;
    return traced;
}

std::optional<Vec2d> Tracer::to_iris(LensRay ray, const LensIndices& n,
                                     double widened) const {
    const Clip clip{true, nullptr, 0, widened};
    TracedRay traced{ray};
    for (int i = int(lens_.surfaces.size()) - 1; i >= stop_; --i)
        if (!cross(i, -1, n, clip, traced)) return std::nullopt;
    return traced.iris;
}

std::vector<Vec3d> Tracer::path_to_film(LensRay ray, const LensIndices& n,
                                        const Clip& clip) const {
    TracedRay traced{ray};
    std::vector<Vec3d> points;
    for (int i = 0; i < int(lens_.surfaces.size()); ++i) {
        if (!cross(i, 1, n, clip, traced)) return {};
        points.push_back(traced.ray.origin);
    }
    return points;
}

}  // namespace dg
