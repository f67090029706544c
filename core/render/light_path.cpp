#include "render/light_path.h"

namespace dg {
namespace {

constexpr int kSequence = -2;   // next to the sequence of paths directly to the lens (light_pass.cpp)

}  // namespace

struct LightPaths::Flight {
    LightWalk walk;
    Moment moment;
    std::uint32_t sample;   // sample index that the light path belongs to
};

LightPaths::LightPaths(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                       const LightWeight& weight)
    : scene_(scene), camera_(camera), settings_(settings), weight_(weight) {
    end_secondary_ = settings.dispersion == Dispersion::end_secondary &&
                     std::holds_alternative<ExactLens>(camera.lens);
}

void LightPaths::follow(std::uint64_t index, std::vector<LightArrival>& arrivals,
                        std::uint64_t& rays) const {
    auto flight = begin(index);
    if (!flight) return;
    LightWalk& walk = flight->walk;
    while (is_traceable(walk.ray())) {
        ++rays;
        const LightWalk::Random u = walk.draw();
        std::optional<LightVertex> vertex;
        if (!walk.meet(vertex)) return;
        if (walk.sends(*vertex))
            if (const auto arrival = connect(*flight, *vertex, u)) arrivals.push_back(*arrival);
        if (!walk.go_on(*vertex, u)) return;
    }
}

/// Stratifies time, wavelengths, the choice of the light and the direction jointly.
std::optional<LightPaths::Flight> LightPaths::begin(std::uint64_t index) const {
    PathSampler sampler(int(std::uint32_t(index >> 32)), kSequence, std::uint32_t(index),
                        settings_.seed);
    const CameraRandom u = sampler.camera();
    const Moment moment = settings_.shutter.draw_any(u.time);
    LightWalk::Start start{u.film.x, sampler.next_2d(), u.lens, moment.time, Wavelengths::sample(u.lambda)};
    if (end_secondary_) start.wavelengths.end_secondary();
    auto walk = LightWalk::begin(scene_, weight_, settings_.path, start, sampler);
    if (!walk) return std::nullopt;
    return Flight{*walk, moment, std::uint32_t(double(index) / settings_.light.m2)};
}

/// Connects a vertex to a point of the lens.
std::optional<LightArrival> LightPaths::connect(const Flight& flight, LightVertex& vertex,
                                                const LightWalk::Random& u) const {
    const float time = flight.walk.ray().time;
    const Affine3d to_camera = inverse(weight_.pose(time));
    const auto lens = weight_.pupil().sample(to_camera.point(to_double(vertex.hit().position)), 1, u.lens, time);
    if (!lens || !(lens->pdf > 0)) return std::nullopt;
    LightArrival arrival;
    arrival.lens.ray = Ray{.origin = lens->origin, .direction = lens->direction, .time = time};
    const Ray world = to_world(camera_, arrival.lens.ray);
    const Vec3f w = -world.direction;
    const auto sent = flight.walk.send(vertex, w, lens->pdf);
    if (!sent) return std::nullopt;
    arrival.density = sent->density, arrival.radiance = sent->radiance;
    arrival.shadow = spawn_ray(vertex.hit(), w, time);
    arrival.shadow.t_max = length(world.origin - arrival.shadow.origin) - world.t_min;
    arrival.lens.iris_opening = flight.moment.iris_opening * setting_at(camera_, time).iris_opening;
    arrival.wavelengths = flight.walk.wavelengths();
    arrival.u_pixel = u.pixel;
    arrival.sample = flight.sample;
    return arrival;
}

}  // namespace dg
