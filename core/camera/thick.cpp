#include "camera/thick.h"

#include <cmath>

#include "camera/tilt.h"
#include "math/error.h"
#include "math/warp.h"
#include "optics/trace/trace.h"
#include "spectrum/wavelengths.h"

namespace dg {
namespace {

constexpr double kMetre = 1e-3;  // m per mm

Vec2d xy(Vec3d v) { return {v.x, v.y}; }

/// E / L at the centre of the film: integral of cos^4 / Z^2 over the exit pupil (Kolb 1995, eq. 4).
double axial_exposure(const RadialOpening& opening, double radius, double distance) {
    constexpr int kSteps = 1024;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double q = opening.outer() * (i + 0.5) / kSteps, rho = q * radius / distance;
        const double cos2 = 1 / (1 + rho * rho);
        sum += opening.at(q) * 2 * kPiD * rho * cos2 * cos2;
    }
    return sum * opening.outer() / kSteps * radius / distance;
}

/// Transmittance along the axis, luminance-weighted over a D65 spectrum; 1 if no ray along the axis
/// passes.
double axial_transmittance(const Prescription& lens) {
    const Tracer tracer(lens);
    const LensRay axis{{0, 0, lens.last_vertex() + 1}, {0, 0, -1}};
    double sum = 0, weights = 0;
    for (double nm = 390; nm <= 770; nm += 20) {
        const auto ray = tracer.to_scene(axis, tracer.at(nm), {false, nullptr, 0});
        if (!ray) return 1;
        const double w = cie_y(nm) * d65(nm);
        sum += w * ray->transmittance, weights += w;
    }
    return sum / weights;
}

void check_pupils(const Prescription& lens, const FirstOrder& order) {
    if (!std::isfinite(order.entrance_pupil_z) || !std::isfinite(order.exit_pupil_z))
        throw Error(lens.name + ": a pupil is at infinity: use the exact model of this lens");
}

}  // namespace

ThickLens::ThickLens(const Prescription& lens, const ThickLensSettings& s)
    : order_(dg::first_order(lens)),
      iris_(s.iris),
      f_stop_(s.f_stop == 0 ? order_.f_number : s.f_stop),
      iris_radius_(dg::iris_radius(lens, order_, f_stop_)),
      film_z_(s.film_z ? *s.film_z
                       : film_position(lens, order_, s.focus_distance_m, s.focus_from)),
      turn_(lens_turn(s.tilt_deg)),
      back_(inverse(turn_)),
      film_normal_(back_.vector({0, 0, -1})),
      transmittance_(axial_transmittance(lens)) {
    check_pupils(lens, order_);
    const double distance = std::abs(film_z_ - order_.exit_pupil_z);
    axial_ = axial_exposure(RadialOpening(iris_), std::abs(order_.exit_magnification) * iris_radius_,
                            distance);
    unit_ = axial_;
    if (!(axial_ > 0) || !std::isfinite(axial_))
        throw Error(lens.name + ": the film would be in the exit pupil");
    const auto ahead = film_hit({0, 0, -1});
    if (!ahead) throw Error(lens.name + ": tilt: the film would not see straight ahead");
    film_origin_ = *ahead;
}

ThickLens ThickLens::in_the_body_of(const ThickLens& middle) const {
    ThickLens lens = *this;
    // The film is fixed; focusing moves the lens and its pupil.
    const auto film = [](const ThickLens& l) {
        return (l.film_z_ - l.order_.entrance_pupil_z) * l.turn_.z.z;
    };
    lens.offset_m_ = middle.offset_m_ + kMetre * (film(middle) - film(*this));
    lens.film_origin_ = middle.film_origin_;
    lens.unit_ = middle.unit_;
    return lens;
}

/// Film point in the lens frame. The image on the film is rotated by 180 degrees.
Vec3d ThickLens::film_in_lens(Vec2d film_mm) const {
    const double depth = (film_z_ - order_.entrance_pupil_z) * turn_.z.z;
    const Vec3d p = back_.vector({film_origin_.x - film_mm.x, film_origin_.y - film_mm.y, depth});
    return {p.x, p.y, p.z + order_.entrance_pupil_z};
}

ThickLens::Line ThickLens::to_scene(Vec3d from, Vec2d pupil) const {
    const Vec2d slope = (pupil - xy(from)) * (1 / (order_.exit_pupil_z - from.z));
    const Vec2d height = xy(from) + slope * (order_.back_principal_z - from.z);
    // n u = n' u' + height x power, power = n / front focal length = n' / rear focal length.
    const double front_focal = order_.front_principal_z - order_.front_focal_z;
    return {height, (slope * order_.efl + height) * (1 / front_focal)};
}

ThickLens::Line ThickLens::to_film(const Line& scene) const {
    const double front_focal = order_.front_principal_z - order_.front_focal_z;
    return {scene.height, (scene.slope * front_focal - scene.height) * (1 / order_.efl)};
}

/// Intersection of a ray behind the lens with the film, in the lens frame.
std::optional<Vec3d> ThickLens::meets_film(const Line& rear) const {
    // Film plane: n . (p - pupil) = depth, with normal n.
    const Vec3d n = -film_normal_;
    const double from_pupil = order_.back_principal_z - order_.entrance_pupil_z;
    const double depth = (film_z_ - order_.entrance_pupil_z) * turn_.z.z;
    const double run = dot(xy(n), rear.slope) + n.z;
    if (!(run > 0)) return std::nullopt;
    const double z = (depth - dot(xy(n), rear.height) - n.z * from_pupil) / run;   // distance past H'
    const Vec2d at = rear.height + rear.slope * z;
    return Vec3d{at.x, at.y, order_.back_principal_z + z};
}

/// Intersection of the chief ray of a direction (camera frame) with the film; camera frame, mm.
std::optional<Vec2d> ThickLens::film_hit(Vec3d direction) const {
    const Vec3d d = back_.vector(direction);
    if (!(d.z < 0)) return std::nullopt;
    const Vec2d in = xy(d) * (1 / d.z);
    const auto at = meets_film(to_film({in * (order_.front_principal_z - order_.entrance_pupil_z), in}));
    if (!at) return std::nullopt;
    return xy(turn_.vector({at->x, at->y, at->z - order_.entrance_pupil_z}));
}

Opening ThickLens::opening() const {
    Affine3d frame = turn_;
    frame.origin = {0, 0, offset_m_};
    return FlatIris{frame, 1e-3 * order_.entrance_magnification * iris_radius_, -1e-3 * order_.entrance_pupil_z};
}

std::optional<Vec2d> ThickLens::film_point(Vec3d p, double w) const {
    const auto hit = film_hit({p.x, p.y, p.z - w * offset_m_});
    if (!hit) return std::nullopt;
    return film_origin_ - *hit;
}

Vec3d ThickLens::chief_direction(Vec2d film_mm) const {
    const Line ray = to_scene(film_in_lens(film_mm), {0, 0});
    return normalize(turn_.vector({-ray.slope.x, -ray.slope.y, -1}));
}

/// Solid angle per area of the exit pupil times the cosine on the film, 1/mm2.
double ThickLens::solid_angle(Vec3d film, Vec2d pupil) const {
    const Vec3d to_pupil{pupil.x - film.x, pupil.y - film.y, order_.exit_pupil_z - film.z};
    const double d2 = length_squared(to_pupil);
    return std::abs(to_pupil.z * dot(to_pupil, film_normal_)) / (d2 * d2);
}

void ThickLens::generate(std::span<const CameraSample> samples, std::span<CameraRay> rays) const {
    const double pupil_radius = order_.exit_magnification * iris_radius_;
    const double area = iris_.sampling_area() * pupil_radius * pupil_radius / unit_;
    const bool round = iris_.kind() == Iris::Kind::round;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const CameraSample& s = samples[i];
        const Vec2d u{s.u_lens.x, s.u_lens.y};
        const Vec2d q = round ? concentric_disc(u) : iris_.sample(u);
        const Vec3d film = film_in_lens({s.film_mm.x, s.film_mm.y});
        const Vec2d pupil = q * (pupil_radius * s.iris_opening);
        const Line ray = to_scene(film, pupil);
        // Start at the first vertex.
        const Vec2d start = ray.height - ray.slope * order_.front_principal_z;
        const Vec3d origin = turn_.vector({start.x, start.y, -order_.entrance_pupil_z}) * kMetre;
        const Vec3d out = turn_.vector(normalize(Vec3d{-ray.slope.x, -ray.slope.y, -1}));
        double weight = area * s.iris_opening * s.iris_opening * solid_angle(film, pupil);
        if (!round) weight *= iris_.transmission(q);
        rays[i].ray = Ray{.origin = to_float(Vec3d{origin.x, origin.y, origin.z + offset_m_}),
                          .direction = to_float(out),
                          .time = s.time};
        rays[i].weight = std::isfinite(weight) && out.z < 0 ? float(weight) : 0.f;
        rays[i].iris_opening = s.iris_opening;
    }
}

void ThickLens::reproject(std::span<const CameraRay> rays, std::span<Reprojection> out) const {
    const double pupil_radius = order_.exit_magnification * iris_radius_;
    const double area = iris_.sampling_area() * pupil_radius * pupil_radius;
    const double focal = order_.efl / (order_.front_principal_z - order_.front_focal_z);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const CameraRay& r = rays[i];
        out[i] = {};
        const Vec3d p = back_.vector((to_double(r.ray.origin) - Vec3d{0, 0, offset_m_}) * (1 / kMetre));
        const Vec3d d = back_.vector(to_double(r.ray.direction));
        if (!(d.z < 0 && r.ray.direction.z < 0 && r.iris_opening > 0)) continue;
        const Vec2d slope = xy(d) * (1 / d.z);
        const double to_plane = order_.front_principal_z - order_.entrance_pupil_z - p.z;
        const Line rear = to_film({xy(p) + slope * to_plane, slope});
        const auto film = meets_film(rear);
        if (!film) continue;
        const Vec2d pupil =
            rear.height + rear.slope * (order_.exit_pupil_z - order_.back_principal_z);
        const double pass = iris_.transmission(pupil * (1 / (pupil_radius * r.iris_opening)));
        const double exposed = area * r.iris_opening * r.iris_opening * solid_angle(*film, pupil);
        if (!(pass > 0 && exposed > 0) || !std::isfinite(exposed)) continue;
        // The lens preserves the measure of slopes, cos^-4 dw; the cosines differ between film and
        // scene.
        const double cos2 = d.z * d.z * (1 + dot(rear.slope, rear.slope));
        const double etendue = kMetre * kMetre * exposed * cos2 * cos2 * focal * focal;
        const Vec2d at = film_origin_ - xy(turn_.vector({film->x, film->y,
                                                         film->z - order_.entrance_pupil_z}));
        out[i] = {{float(at.x), float(at.y)},
                  float(pass),
                  float(exposed / unit_),
                  float(etendue),
                  float(exposed * pass / (unit_ * etendue))};
    }
}

}  // namespace dg
