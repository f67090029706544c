#include "optics/expansion/fit_rays.h"

#include <algorithm>
#include <cmath>

#include "math/quasi_random.h"
#include "optics/first_order/paraxial.h"
#include "optics/lens/lens_error.h"

namespace dg {
namespace {

constexpr int kSearchRays = 1024;
constexpr double kSearch = 1.8;  // range of the search, in radii of the paraxial exit pupil
constexpr double kIrisWidened =
    1.02;  // a margin suffices, as the iris is flat
constexpr double kMaxPupilDistance = 1e4;  // mm: farther pupils count as telecentric

/// Density of Chebyshev nodes, for which the maximal error of a polynomial is close to its mean
/// error.
double toward_edges(double u) {
    return (1 - std::cos(kPiD * u)) / 2;
}

bool mirrored_x(const Prescription& lens) {
    return std::all_of(lens.surfaces.begin(), lens.surfaces.end(), [](const Surface& s) {
        return s.decenter.x == 0 && s.tilt.y == 0 && s.tilt.z == 0;
    });
}
bool mirrored_y(const Prescription& lens) {
    return std::all_of(lens.surfaces.begin(), lens.surfaces.end(), [](const Surface& s) {
        return s.decenter.y == 0 && s.tilt.x == 0 && s.tilt.z == 0;
    });
}

/// Half the range of slopes from the film's centre to the exit pupil, which may be at infinity.
double exit_slope(const FirstOrder& order, double iris_radius, double film_z) {
    const double distance = film_z - order.exit_pupil_z;
    if (std::isfinite(distance))
        return std::abs(order.exit_magnification * iris_radius / distance);
    return iris_radius / std::abs(2 * order.f_number * order.stop_semi_diameter);
}

/// Offset c and slope k of the least-squares line c + k f through points (f, q).
Vec2d line_through(const std::vector<Vec2d>& points) {
    double n = 0, f = 0, q = 0, ff = 0, fq = 0;
    for (const Vec2d p : points)
        n += 1, f += p.x, q += p.y, ff += p.x * p.x, fq += p.x * p.y;
    const double det = n * ff - f * f;
    if (!(det > 0)) return {n > 0 ? q / n : 0, 0};
    return {(ff * q - f * fq) / det, (n * fq - f * q) / det};
}

/// Centres q over the film and equalizes its extents in x and y. Mirror symmetry is preserved:
/// symmetric coordinates are already centred.
void center_pupil(const std::vector<FitSample>& found, const FitSymmetry& symmetry,
                  FitPupil& p) {
    std::vector<Vec2d> x, y;
    for (const FitSample& s : found)
        x.push_back({s.f.x, s.q.x}), y.push_back({s.f.y, s.q.y});
    Vec2d line_x = line_through(x), line_y = line_through(y);
    if (symmetry.mirror_x) line_x.x = 0;
    if (symmetry.mirror_y) line_y.x = 0;
    p.shift = p.shift - Vec2d{line_x.x, line_y.x},
    p.by_film = p.by_film - Vec2d{line_x.y, line_y.y};
    double xx = 0, yy = 0;
    for (const FitSample& s : found) {
        const Vec2d q = p.q(s.f, s.slope);
        xx += q.x * q.x, yy += q.y * q.y;
    }
    const double wider = std::sqrt(yy / xx);
    p.by_film.x *= wider, p.by_slope.x *= wider, p.shift.x *= wider;
}

constexpr double kWide = 1;  // rad

}  // namespace

bool is_wide(const std::vector<FitSample>& clear) {
    return std::any_of(clear.begin(), clear.end(),
                       [](const FitSample& s) { return length(s.direction) > kWide; });
}

FitRays::FitRays(const Tracer& tracer, const LensFitRequest& request, LensFit& fit)
    : tracer_(tracer), request_(request), fit_(fit) {
    const Prescription& lens = tracer.prescription();
    outer_ = request.iris_radius * request.iris.outer_radius();
    fit.film = request.tilted ? *request.tilted : FilmPlane{{0, 0, request.film_z}};
    const bool axial = !request.tilted && is_axially_symmetric(lens);
    const Vec3d n = fit.film.normal();
    fit.symmetry = {axial,
                    axial || (mirrored_x(lens) && n.x == 0 && fit.film.center.x == 0),
                    axial || (mirrored_y(lens) && n.y == 0 && fit.film.center.y == 0)};
    const Vec2d half = request.film.half;
    fit.film_half = Vec2d{request.film_radius, request.film_radius};
    if (!axial && half.x > 0 && half.y > 0) {
        fit.film_center = request.film.center, fit.film_half = half;
        fit.symmetry.mirror_x = fit.symmetry.mirror_x && fit.film_center.x == 0;
        fit.symmetry.mirror_y = fit.symmetry.mirror_y && fit.film_center.y == 0;
    }
    fit.iris_radius = request.iris_radius, fit.iris_outer = outer_;
    find_domain(fit);
}

/// Refines the domain from the paraxial exit pupil to the disc that exact rays fill.
void FitRays::find_domain(LensFit& fit) {
    const FirstOrder order = first_order(tracer_.prescription());
    fit.entrance_pupil_z = order.entrance_pupil_z;
    const double film_z = fit.film.center.z;
    double away = film_z - order.exit_pupil_z;
    if (!(std::abs(away) < kMaxPupilDistance))
        away = std::copysign(kMaxPupilDistance, away);
    const double wide = kSearch * std::abs(away) * exit_slope(order, outer_, film_z);
    FitPupil& p = fit.pupil;
    const auto look = [&] {
        p.by_film = fit.film_half * (1 / wide),
        p.by_slope = Vec2d{-away, -away} * (1 / wide);
        p.shift = fit.film_center * (1 / wide);
        return draw({.count = kSearchRays, .widened = kIrisWidened});
    };
    auto found = look();
    double lit = 0;
    for (const FitSample& s : found) lit = std::max(lit, length(s.f));
    if (found.size() >= 16 && fit.symmetry.axial &&
        lit < 0.95) {  // a film larger than the image circle
        fit.film_half = fit.film_half * (1.02 * lit);
        found = look();
    }
    if (found.size() < 16)
        throw LensError(tracer_.prescription().name + ": no light reaches the film",
                        "lens-no-light");
    if (!fit.symmetry.axial) center_pupil(found, fit.symmetry, p);
    double reach = 0;
    for (const FitSample& s : found) reach = std::max(reach, length(p.q(s.f, s.slope)));
    const double grow = 1 / (1.03 * reach);
    p.by_film = p.by_film * grow, p.by_slope = p.by_slope * grow,
    p.shift = p.shift * grow;
}

std::optional<FitSample> FitRays::trace(Vec2d f, Vec2d q, double nm,
                                        const FitDraw& what) const {
    FitSample s;
    s.f = f, s.q = q, s.nm = nm, s.l = fit_.scale(nm);
    s.film = {fit_.film_center.x + fit_.film_half.x * f.x,
              fit_.film_center.y + fit_.film_half.y * f.y};
    s.slope = fit_.pupil.slope(f, q);
    const LensIndices index = tracer_.at(nm);
    const Clip clip{true, &round_, outer_ * std::min(what.widened, kIrisWidened),
                    what.widened};
    const auto ray = tracer_.to_scene(fit_.film_ray({s.film, s.slope, nm}), index, clip);
    if (!ray) return std::nullopt;
    s.iris = ray->iris, s.transmittance = ray->transmittance;
    const FitDirection d = describe_ray(ray->ray, fit_.entrance_pupil_z);
    s.direction = d.direction, s.offset = d.offset;
    if (what.met && !add_met(ray->ray, index, s)) return std::nullopt;
    return s;
}

/// Adds the intersections with all surfaces by tracing the scene ray back.
bool FitRays::add_met(const LensRay& scene, const LensIndices& index,
                      FitSample& s) const {
    const LensRay back{scene.origin + scene.direction, -scene.direction};
    const auto path = tracer_.path_to_film(back, index, {false, nullptr, 0});
    s.passes = length(s.iris) <= outer_;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const Vec3d p = tracer_.form(int(i)).place.into(path[i]);
        s.met.push_back({p.x, p.y});
        const Surface& surface = tracer_.prescription().surfaces[i];
        const double r = length(s.met.back());
        if (int(i) != tracer_.stop())
            s.passes = s.passes && r <= clear_radius(surface) &&
                       r >= surface.inner_semi_diameter;
    }
    return !path.empty();
}

std::vector<FitSample> FitRays::draw(const FitDraw& what) const {
    constexpr int kTries = 12;  // per requested ray
    const double blue = 1 / (380. * 380.), red = 1 / (780. * 780.);
    std::vector<FitSample> samples;
    for (int n = 0; n < kTries * what.count && int(samples.size()) < what.count; ++n) {
        const auto u = quasi_random<5>(what.first + n);
        const auto spread_out = [&](int k) {
            return what.toward_edges ? toward_edges(u[k]) : u[k];
        };
        const double nm = 1 / std::sqrt(red + spread_out(0) * (blue - red));
        // Over the pupil, the mean of this density and a uniform density: mounts clip the edge
        // anyway.
        const double w = std::sqrt((u[1] + spread_out(1)) / 2), phi = 2 * kPiD * u[2];
        Vec2d f, q{w * std::cos(phi), w * std::sin(phi)};
        if (fit_.symmetry.axial) {
            f = {std::sqrt(what.u_low + spread_out(3) * (what.u_high - what.u_low)), 0};
            q.y = std::abs(q.y);
        } else {
            f = {2 * spread_out(3) - 1, 2 * spread_out(4) - 1};
        }
        if (auto s = trace(f, q, nm, what)) samples.push_back(std::move(*s));
    }
    return samples;
}

}  // namespace dg
