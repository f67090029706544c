#include "optics/expansion/fit_error.h"

#include <algorithm>
#include <cmath>

#include "optics/expansion/fit_rays.h"
#include "optics/expansion/lens_fit_make.h"

namespace dg {
namespace {

constexpr int kZones = 6;  // of equal width in film radius

class Deviations {
  public:
    void add(double e) { sum_ += e * e, ++count_, max_ = std::max(max_, e); }
    FitDeviation total() const { return {count_ ? std::sqrt(sum_ / count_) : 0, max_}; }

  private:
    double sum_ = 0, max_ = 0;
    int count_ = 0;
};

/// Errors of a ray.
struct Compared {
    double radius = 0, direction = 0, film = -1, iris = 0, mount = 0, transmittance = 0;
    bool exact = false, fitted = false;
};

/// Traces the fitted scene ray exactly back to the film: distance in mm from the start of the film
/// ray; negative if it does not reach the film.
double film_error(const Tracer& tracer, const LensFit& fit, const FitValue& v,
                  const FitSample& s) {
    LensRay ray = fit.scene_ray(v.direction, v.offset);
    // Start well in front of the first surface: the vertex sphere differs from its sag.
    ray.direction = -ray.direction,
    ray.origin = ray.origin - ray.direction * (2 * length(ray.origin) + 10);
    const auto out = tracer.to_film(ray, tracer.at(s.nm), {false, nullptr, 0});
    if (!out) return -1;
    const Vec3d n = fit.film.normal();
    const Vec3d o = out->ray.origin - fit.film.center, d = out->ray.direction;
    const Vec3d p = o - d * (dot(o, n) / dot(d, n));
    return length(Vec2d{dot(p, fit.film.x), dot(p, fit.film.y)} - s.film);
}

Compared compare(const Tracer& tracer, const LensFit& fit, const FitSample& s) {
    const FitValue v = fit.evaluate({s.film, s.slope, s.nm});
    Compared c;
    c.radius = length(s.film), c.exact = s.passes;
    c.fitted = v.within && length(v.iris) <= fit.iris_outer;
    if (!s.passes) return c;
    c.direction = length(v.direction - s.direction), c.iris = length(v.iris - s.iris);
    c.transmittance = std::abs(v.transmittance - s.transmittance);
    for (std::size_t i = 0; i < fit.mounts.size(); ++i)
        c.mount = std::max(c.mount, length(v.mounts[i] - s.met[fit.mounts[i].surface]));
    c.film = film_error(tracer, fit, v, s);
    return c;
}

FitErrorZone summary(const std::vector<Compared>& rays, double low, double high) {
    FitErrorZone zone;
    zone.low = low, zone.high = high;
    Deviations direction, film, iris, mount, transmittance;
    int lost = 0, leaked = 0;
    for (const Compared& c : rays) {
        if (c.radius < low || c.radius >= high) continue;
        leaked += c.fitted && !c.exact;
        if (!c.exact) continue;
        ++zone.rays;
        lost += !c.fitted;
        direction.add(c.direction), iris.add(c.iris), mount.add(c.mount);
        transmittance.add(c.transmittance);
        if (c.film >= 0) film.add(1e3 * c.film);
    }
    zone.direction = direction.total(), zone.film = film.total(),
    zone.iris = iris.total();
    zone.mount = mount.total(), zone.transmittance = transmittance.total();
    if (zone.rays)
        zone.lost = double(lost) / zone.rays, zone.leaked = double(leaked) / zone.rays;
    return zone;
}

}  // namespace

FitError measure_fit(const FitRays& rays, const LensFit& fit, int count) {
    std::vector<Compared> compared;
    for (const FitSample& s : rays.draw({.count = count,
                              .first = kFreshRays,
                              .widened = kErrorWidened,
                              .met = true}))
        compared.push_back(compare(rays.tracer(), fit, s));
    const double radius = fit.symmetry.axial
                              ? fit.film_half.x
                              : length(fit.film_half) + length(fit.film_center);
    FitError error;
    error.all = summary(compared, 0, 2 * radius);
    for (int k = 0; k < kZones; ++k)
        error.zones.push_back(
            summary(compared, radius * k / kZones,
                    radius * (k + 1) / kZones * (k + 1 == kZones ? 1.0001 : 1)));
    return error;
}

}  // namespace dg
