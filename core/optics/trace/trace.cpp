#include "optics/trace/trace.h"

#include <cmath>

#include "optics/trace/intersect.h"

namespace dg {

Tracer::Tracer(const Prescription& lens) : lens_(lens) {
    validate(lens);
    vertices_ = lens.vertices();
    stop_ = lens.stop_index();
    for (std::size_t i = 0; i < vertices_.size(); ++i)
        forms_.emplace_back(lens_.surfaces[i], vertices_[i]);
    for (std::size_t i = 0; i < vertices_.size(); ++i)
        coatings_.push_back(coating_at(lens_, int(i)));
}

LensIndices Tracer::at(double wavelength_nm) const {
    LensIndices n{wavelength_nm, {refractive_index(lens_.object_medium, wavelength_nm)}};
    for (const Surface& s : lens_.surfaces)
        n.index.push_back(refractive_index(s.glass, wavelength_nm));
    if (!absorbs(lens_)) return n;
    n.absorption = {absorption_per_mm(lens_.object_medium, wavelength_nm)};
    for (const Surface& s : lens_.surfaces)
        n.absorption.push_back(absorption_per_mm(s.glass, wavelength_nm));
    return n;
}

namespace {

bool within_apertures(const Surface& s, const Vec3d& p, const Clip& clip, bool iris_here) {
    const double r2 = p.x * p.x + p.y * p.y;
    const double edge = clear_radius(s) * clip.widened;
    const double hole = s.inner_semi_diameter / clip.widened;
    return (iris_here || r2 <= edge * edge) && r2 >= hole * hole;
}

constexpr double kOverlap = 0.01;  // mm, tolerated overlap of neighbouring surfaces at their rims in real
                                   // prescriptions

/// Tilts the normal by the slope of the ripple.
void lean(const RippleSlope& ripple, const Vec3d& direction, int sign, LensHit<double>& hit) {
    const double r = hypot(hit.point.x, hit.point.y);
    if (!(r > 0)) return;
    const double slope = ripple.at(r) / r;
    hit.normal = normalize(hit.normal - Vec3d{slope * hit.point.x, slope * hit.point.y, 0});
    hit.cosine = sign * dot(direction, hit.normal);
}

}  // namespace

bool Tracer::cross(const PathStep& step, const LensIndices& n, const Clip& clip,
                   TracedRay& traced) const {
    const int i = step.surface, sign = step.sign;
    const SurfaceFrame& place = forms_[i].place;
    const Vec3d start = place.into(traced.ray.origin);
    const Vec3d d = place.turn_in(traced.ray.direction);
    auto hit = meet(forms_[i], start, d, sign);
    if (!hit) return false;
    if (!forms_[i].ripple.slope.empty()) lean(forms_[i].ripple, d, sign, *hit);
    const double n1 = n.index[step.before()], n2 = n.index[step.behind()];
    const double path = dot(hit->point - start, d);
    traced.optical_path += n1 * path;
    if (!n.absorption.empty())
        traced.transmittance *= std::exp(-n.absorption[step.before()] * path);
    traced.ray.origin = place.out_of(hit->point);
    if (i == stop_) {
        traced.iris = {hit->point.x, hit->point.y};
        if (clip.iris) {
            const double open =
                clip.iris->transmission(traced.iris * (1 / clip.iris_radius));
            if (!(open > 0)) return false;
            traced.transmittance *= open;
        }
    }
    if (clip.clear_apertures &&
        !within_apertures(lens_.surfaces[i], hit->point, clip, i == stop_ && clip.iris))
        return false;
    double cos2 = 0;
    const auto bent = refract(d, *hit, sign, n1 / n2, cos2);
    if (!bent && !step.reflects) return false;  // total reflection
    const double through =
        bent ? surface_transmittance(coatings_[i], n1, hit->cosine, n2, cos2, n.wavelength_nm)
             : 0;
    traced.transmittance *= step.reflects ? 1 - through : through;
    traced.ray.direction = place.turn_out(step.reflects ? reflect(d, *hit, sign) : *bent);
    return true;
}

int Tracer::follow(TracedRay& ray, bool toward_film, const LensIndices& n,
                   const Clip& clip) const {
    const int count = int(lens_.surfaces.size());
    for (int k = 0; k < count; ++k) {
        const int i = toward_film ? k : count - 1 - k;
        if (!cross({i, toward_film ? 1 : -1}, n, clip, ray)) return i;
    }
    return -1;
}

int Tracer::follow(TracedRay& ray, const LensPath& path, const LensIndices& n,
                   const Clip& clip) const {
    for (std::size_t k = 0; k < path.size(); ++k) {
        const LensRay from = ray.ray;
        if (!cross(path[k], n, clip, ray)) return int(k);
        // A steep mirror may send light away from the next surface. The test is limited to mirrors:
        // at refracting surfaces, the iris of a real prescription may be within the bulge of its
        // neighbour.
        if (k > 0 && path[k - 1].reflects &&
            dot(ray.ray.origin - from.origin, from.direction) < -kOverlap)
            return int(k);
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
        if (!cross({i, -1}, n, clip, traced)) return std::nullopt;
    return traced.iris;
}

std::vector<Vec3d> Tracer::path_to_film(LensRay ray, const LensIndices& n,
                                        const Clip& clip) const {
    TracedRay traced{ray};
    std::vector<Vec3d> points;
    for (int i = 0; i < int(lens_.surfaces.size()); ++i) {
        if (!cross({i}, n, clip, traced)) return {};
        points.push_back(traced.ray.origin);
    }
    return points;
}

}  // namespace dg
