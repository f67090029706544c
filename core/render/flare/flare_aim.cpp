#include "render/flare/flare_aim.h"

#include <algorithm>
#include <cmath>

#include "math/across.h"
#include "render/flare/highlight_survey.h"
#include "render/light_arrival.h"
#include "transport/media/interior.h"

namespace dg {
namespace {

constexpr std::size_t kMostFour = 1024;   // limit of ghosts with four reflections
constexpr double kFurthestBack = 0.45;    // cosine of the largest angle behind a lens that it can see

}  // namespace

Ray flare_shadow(const EmitterPoint& from, const Ray& from_lens) {
    if (from.at_infinity) return from_lens;
    const float cosine = from.delta ? 1 : std::abs(dot(from.point.normal, from_lens.direction));
    return shadow_ray(from.point.position, cosine, from_lens);
}

Spectrum flare_transmittance(const Scene& scene, const PathSettings& settings, const EmitterPoint& from,
                             const Ray& shadow, const Wavelengths& wavelengths) {
    const Surroundings around = surroundings_at_camera(scene, settings, shadow, wavelengths);
    return scene.visibility_from(around, shadow, from.delta, wavelengths);
}

Spectrum flare_light(const Scene& scene, const Camera& camera, const PathSettings& settings,
                     const FlareArrival& path, PathSampler sampler, std::uint64_t& rays) {
    const Ray ray = to_world(camera, path.lens.ray);
    if (path.from.reflected) {
        PathSettings onward = settings;
        onward.visible_emitters = onward.caustics = false;
        Wavelengths wavelengths = path.wavelengths;
        return radiance(scene, ray, wavelengths, sampler, onward, nullptr, &rays).sum();
    }
    ++rays;
    const Ray shadow = flare_shadow(path.from, ray);
    if (!is_traceable(shadow)) return 0.f;
    return path.radiance * flare_transmittance(scene, settings, path.from, shadow, path.wavelengths);
}

FlareAim::FlareAim(const Scene& scene, const Camera& camera, const RenderSettings& settings)
    : scene_(scene),
      camera_(camera),
      sensor_(settings.sensor),
      shutter_(settings.shutter),
      reach_(settings.filter.radius()),
      times_(camera.lens_motion.times) {
    if (times_.empty()) add_state(camera, std::get<ExactLens>(camera.lens));
    for (const LensKind& lens : camera.lens_motion.lenses) add_state(camera, std::get<ExactLens>(lens));
    mirrors_ = states_.front().ghosts.two_bounces(), pairs_ = int(mirrors_.size());
    if (settings.flare.order >= 4) {
        const auto more = states_.front().ghosts.four_bounces(kMostFour);
        mirrors_.insert(mirrors_.end(), more.begin(), more.end());
    }
    for (State& state : states_)
        for (const Mirrors& mirrors : mirrors_) state.steps.push_back(state.ghosts.steps(mirrors));
    const ExactLens::Ball first = states_.front().lens.front_ball();
    center_ = first.center;
    for (const State& state : states_) {
        const ExactLens::Ball ball = state.lens.front_ball();
        radius_ = std::max(radius_, ball.radius + length(ball.center - center_));
    }
    sources_ = EmitterPoints(scene.lights(), views());
    if (settings.flare.highlights && (!mirrors_.empty() || camera.scatter.scatters())) look_for_highlights(settings);
}

void FlareAim::add_state(const Camera& camera, const ExactLens& lens) {
    states_.push_back({lens, lens.ghosts(camera.sensor_stack), {}});
}

/// Cones of all directions, at several times.
std::vector<ViewCone> FlareAim::views() const {
    std::vector<ViewCone> views;
    const bool still = !camera_.world_from_camera.moves();
    for (int i = 0; i < (still ? 1 : 5); ++i) {
        const float time = still ? 0.5f : 0.25f * float(i);
        const Vec3d eye = camera_.world_from_camera.at(time).origin;
        views.push_back({{to_float(eye), float(length(center_) + radius_)}, time});
    }
    return views;
}

void FlareAim::look_for_highlights(const RenderSettings& settings) {
    const auto ray = [&](const EmitterPoint& to, Vec2f at, float time) -> std::optional<Ray> {
        const auto way = this->way(to, at, time);
        if (!way || way->direction.z > kFurthestBack) return std::nullopt;
        Ray ray = way->ray();
        ray.t_min = float(camera_.near_clip.end(way->start, way->direction));
        return ray;
    };
    const Vec3f middle = to_float(camera_.world_from_camera.at(0.5f).point(center_));
    Survey survey = survey_highlights(
        scene_, sources_, {middle, float(radius_), ray, shutter_, settings.path, settings.threads});
    spots_ = survey.highlights.spots();
    survey_rays_ = survey.rays;
    sources_.add(std::move(survey.highlights));
}

std::size_t FlareAim::state_at(float time) const {
    if (times_.empty()) return 0;
    const KeyPlace p = place_among(times_, time);
    return p.share < 0.5 ? p.left : p.right;
}

void FlareAim::trace(std::size_t state, int ghost, std::span<const CameraRay> rays,
                       std::span<const float> nm, std::span<Reprojection> out) const {
    const State& s = states_[state];
    s.lens.reproject(rays, nm, s.ghosts, s.steps[ghost], out);
    undo_film_shift(camera_, rays, out);
}

std::optional<Vec2f> FlareAim::on_frame(const Reprojection& landing, float time) const {
    if (!(landing.transmittance > 0)) return std::nullopt;
    const Vec2f px = sensor_.px_from_mm(landing.film_mm);
    if (!(px.x > -reach_ && px.x < float(sensor_.width) + reach_ && px.y > -reach_ &&
          px.y < float(sensor_.height) + reach_))
        return std::nullopt;
    if (!shutter_.rolls()) return px;
    const int line = int(std::floor(shutter_.scans_columns() ? px.x : px.y));
    const int lines = shutter_.scans_columns() ? sensor_.width : sensor_.height;
    for (int i = -1; i <= 1; ++i)   // the filter covers neighbouring lines
        if (shutter_.opening(std::clamp(line + i, 0, lines - 1), time) > 0) return px;
    return std::nullopt;
}

int FlareAim::mark_arrived(std::span<Reprojection> landings, float time) const {
    int arrived = 0;
    for (Reprojection& landing : landings) {
        const bool on_film = on_frame(landing, time).has_value();
        landing.etendue = on_film ? 1.f : 0.f;   // RayOnFilm skips landings with 0
        arrived += on_film;
    }
    return arrived;
}

double FlareAim::reflectance(int ghost) const {
    double r = 1;
    for (const int i : mirrors_[ghost]) r *= states_.front().ghosts.reflectance(i);
    return r;
}

std::optional<FlareAim::Way> FlareAim::way(const EmitterPoint& from, Vec2f at, float time) const {
    const Affine3d pose = camera_.world_from_camera.at(time), to_camera = inverse(pose);
    const Vec3d position = to_double(from.point.position);
    const Vec3d p = from.at_infinity ? to_camera.vector(position) : to_camera.point(position);
    const Vec3d toward = from.at_infinity ? p : p - center_;
    const double distance = from.at_infinity ? 1 : length(toward);
    if (!(distance > radius_ * (from.at_infinity ? 0 : 1))) return std::nullopt;   // inside the glass
    const Vec3d e = toward / distance;
    const Across across(e);
    const Vec3d q = center_ + radius_ * (double(at.x) * across.x + double(at.y) * across.y);
    const Vec3d way = from.at_infinity ? e : p - q;
    const double d2 = from.at_infinity ? 1 : length_squared(way);
    const Vec3d direction = way / std::sqrt(d2);
    const auto start = states_[state_at(time)].lens.start(q, direction);
    if (!start) return std::nullopt;
    const bool area = !from.at_infinity && !from.delta;
    const Vec3f world = to_float(pose.vector(direction));
    const double cosine = area ? std::abs(dot(from.point.normal, world)) : 1;
    return Way{pose, *start, direction, world, time, d2 / dot(direction, e) / cosine};
}

std::optional<FlareArrival> FlareAim::aim(int source, int ghost, Vec2f at, double pdf,
                                          const Random& u) const {
    const float time = u.moment.time;
    const Viewpoint view{to_float(camera_.world_from_camera.at(time).origin),
                         float(length(center_) + radius_)};
    const auto from = sources_.sample(source, u.select, u.point, time, view);
    if (!from) return std::nullopt;
    const auto way = this->way(*from, at, time);
    if (!way || !sources_.owns(source, way->ray())) return std::nullopt;
    FlareArrival path;
    path.lens.ray = {.origin = to_float(way->start), .direction = to_float(way->direction), .time = time};
    path.lens.iris_opening = u.moment.iris_opening * setting_at(camera_, time).iris_opening;
    // Converts the density from m2 of the square to sr at the point (or m2 across the ray) to m2 sr.
    path.density = double(from->point.pdf) * pdf / (radius_ * radius_) * way->spread;
    if (!(path.density > 0) || !std::isfinite(path.density)) return std::nullopt;
    const Rgb value = value_of(*from, *way);
    if (!(max_component(value) > 0)) return std::nullopt;
    path.ghost = ghost, path.at = at, path.from = *from;
    path.wavelengths = Wavelengths::at(u.lambda.u, u.lambda.density);
    path.radiance = path.wavelengths.emission(value);
    return path;
}

std::optional<FlareAim::SourcePoint> FlareAim::point(int source, float select, Vec2f u, float time) const {
    const Affine3d pose = camera_.world_from_camera.at(time), to_camera = inverse(pose);
    const Viewpoint view{to_float(pose.origin), float(length(center_) + radius_)};
    const auto from = sources_.sample(source, select, u, time, view);
    if (!from) return std::nullopt;
    const auto way = this->way(*from, {0, 0}, time);
    if (!way) return std::nullopt;
    const double density = double(from->point.pdf) / (radius_ * radius_) * way->spread;
    if (!(density > 0) || !std::isfinite(density)) return std::nullopt;
    const Vec3d position = to_double(from->point.position);
    return SourcePoint{from->at_infinity ? to_camera.vector(position) : to_camera.point(position), from->at_infinity,
                       value_of(*from, *way) * float(1 / density), *from};
}

Rgb FlareAim::value_of(const EmitterPoint& from, const Way& way) const {
    if (from.reflected) return Rgb{1, 1, 1} * *from.reflected;
    if (from.delta) return sources_.delta_value(from, to_float(way.pose.point(way.start)), way.time);
    return scene_.emission(from.point, -way.world, way.time);
}

double FlareAim::visible_share(int source) const {
    if (sources_.reflected(source)) return 1;   // found by rays from the lens, so unoccluded
    int seen = 0, all = 0;
    for (int i = 0; i < 64; ++i) {
        PathSampler sampler(source, -5, std::uint32_t(i), 0);
        const CameraRandom c = sampler.camera();
        const Vec2f at{2 * c.lens.x - 1, 2 * c.lens.y - 1};
        const Random u{c.film.x, c.lambda, sampler.next_2d(), shutter_.draw_any(c.time)};
        const auto path = aim(source, 0, at, 0.25, u);
        if (!path) continue;
        ++all;
        const Ray ray = flare_shadow(path->from, to_world(camera_, path->lens.ray));
        seen += is_traceable(ray) && !scene_.visibility_along(ray, path->wavelengths).is_black();
    }
    return all ? std::max(0.02, double(seen) / all) : 0.02;
}

}  // namespace dg
