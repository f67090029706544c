#include "transport/light_walk.h"

#include <cmath>

namespace dg {
namespace {

constexpr float kRouletteThreshold = 0.3f;   // fraction of the emitted flux

}  // namespace

/// Samples the light, a point on it and a direction.
std::optional<LightWalk> LightWalk::begin(const Scene& scene, const LightSharing& sharing,
                                          const PathSettings& settings, const Start& start,
                                          const PathSampler& sampler) {
    const auto emitted =
        sharing.emission_rays().sample(start.u_light, start.u_place, start.u_direction, start.time);
    if (!emitted) return std::nullopt;
    const auto leaving = scene.leave(*emitted, start.time);
    if (!(max_component(leaving.value) > 0)) return std::nullopt;
    LightWalk walk(scene, sharing, settings, *emitted, sampler);
    walk.ray_ = leaving.ray;
    if (emitted->light != LightSet::kEnvironment) {
        walk.light_ = scene.lights().light_at(emitted->light, start.time);
        walk.delta_ = !std::holds_alternative<TriangleLight>(walk.light_) &&
                      !std::holds_alternative<SphereLight>(walk.light_);
    }
    walk.wavelengths_ = start.wavelengths;
    walk.flux_ = walk.wavelengths_.emission(leaving.value) * (1 / emitted->pdf);
    if (scene.has_media()) {
        walk.medium_ = scene.medium_around(walk.ray_);
        const Medium* const fog = walk.medium_.medium;   // attenuates light from infinity along an endless ray
        if (walk.infinite() && fog && !fog->density)
            walk.flux_ *= scene.transmittance_through(walk.medium_, walk.ray_, 0,
                                                      std::numeric_limits<float>::infinity(), walk.wavelengths_);
        if (walk.flux_.is_black()) return std::nullopt;
    }
    walk.volume_.may_nest = scene.has_nested();
    if (scene.has_nested() && (walk.infinite() || !scene.begins_in_solid(walk.ray_)))
        walk.volume_.where = VolumeState::Where::air;
    walk.start_ = walk.flux_;
    walk.light_camera_ratio_ = sharing.bounced_density(emitted->pdf);
    return walk;
}

/// Absorbs light over a length (m) inside a material. A participating medium replaces the material's absorption.
void LightWalk::absorb(float length) {
    if (medium_.medium) return;
    if (volume_.where == VolumeState::Where::unknown) unknown_ += length;
    if (volume_.where == VolumeState::Where::inside) flux_ *= volume_.interior.transmittance(length);
}

/// Traces through the invisible boundaries of media, which attenuate the light, to the next visible surface.
std::optional<Scene::Hit> LightWalk::meet_visible() {
    for (;;) {
        const auto found = scene_->intersect(ray_);
        if (!found) return found;
        const SurfaceHit& hit = found->surface;
        if (medium_.medium) flux_ *= scene_->transmittance_through(medium_, ray_, ray_.t_min, hit.t, wavelengths_);
        if (found->sphere_light >= 0 || !scene_->is_invisible(hit.instance)) return found;
        absorb(hit.t);
        medium_ = scene_->beyond(medium_, hit.instance, {}, false, hit.front);
        distance_ += hit.t;
        ray_ = spawn_ray(hit, ray_.direction, ray_.time);
    }
}

/// Whether a boundary is within another solid or touches one. Camera paths have the full weight there.
bool LightWalk::meets_solids(SurfaceHit hit) const {
    if (hit.front && volume_.where != VolumeState::Where::air) return true;
    return !scene_->resolve_boundary({}, hit, wavelengths_) || hit.outside_ior != 1;
}

bool LightWalk::meet(std::optional<LightVertex>& vertex) {
    const auto found = scene_->has_media() ? meet_visible() : scene_->intersect(ray_);
    if (!found || found->sphere_light >= 0) return false;
    const SurfaceHit& hit = found->surface;
    if (is_last() && !scene_->has_clear()) return false;
    if (scene_->rank(hit.instance) > 0 && meets_solids(hit)) return false;
    absorb(hit.t);
    distance_ += hit.t;
    vertex.emplace(*scene_, hit, wavelengths_);
    return true;
}

bool LightWalk::sends(LightVertex& vertex) const {
    return !is_last() && vertices_ > 0 && !is_specular(vertex.bidirectional().seen_from(vertex.hit().wo));
}

/// Crosses a surface along `w`. Returns the transmittance of the volume around the emitter if the walk leaves it here,
/// as its absorption is known only at its boundary. Empty: a combination of volumes that volume_state.h excludes.
std::optional<Spectrum> LightWalk::enter(VolumeState& volume, const Bsdf& bsdf, const SurfaceHit& hit,
                                         Vec3f w) const {
    const bool entering = dot(w, hit.ng) < 0;
    if (entering != hit.front) return 1.f;   // reflected
    return std::visit(
        [&](const auto& b) -> std::optional<Spectrum> {
            if (!b.bounds_volume()) return 1.f;
            Spectrum transmittance{1.f};
            if (volume.where == VolumeState::Where::unknown && !entering) {
                if (infinite()) return std::nullopt;
                transmittance = b.interior().transmittance(unknown_);
            }
            if (!volume.cross(b.interior(), entering)) return std::nullopt;
            return transmittance;
        },
        bsdf);
}

/// Density with which camera paths sample the direction toward the light, per projected solid angle. Light sampling
/// finds a point light by choosing it: its rays have a density per sr, and EmissionRays::pdf() is per m2 at the first
/// vertex.
double LightWalk::camera_density(const SurfaceHit& hit, float bsdf_pdf) const {
    double pdf = bsdf_pdf;
    if (vertices_ == 0) {
        const float by_choice =
            scene_->lights().pdf(emission_.light, hit.position, hit.wo, distance(), hit.time);
        pdf = !delta_       ? pdf + by_choice
              : infinite()  ? by_choice
                            : double(by_choice) * distance_ * distance_;
    }
    return pdf / std::abs(double(dot(hit.ng, hit.wo)));
}

std::optional<LightWalk::Sent> LightWalk::send(LightVertex& vertex, Vec3f w, float lens_pdf) const {
    const SurfaceHit& hit = vertex.hit();
    const Scattering s = vertex.bidirectional().scattering(w, hit.wo);
    if (s.f_cos.is_black() || s.hero_only) return std::nullopt;
    VolumeState volume = volume_;
    const auto transmittance = enter(volume, vertex.bidirectional().seen_from(w), hit, w);
    if (!transmittance || volume.where == VolumeState::Where::inside) return std::nullopt;
    const double cosine = std::abs(double(dot(hit.ng, w)));
    Sent sent;
    sent.density = light_camera_ratio_ * lens_pdf / (cosine * camera_density(hit, s.camera_pdf));
    if (!(sent.density > 0) || !std::isfinite(sent.density)) return std::nullopt;
    const double turned = cosine / std::abs(double(dot(hit.ng, hit.wo)));
    sent.radiance = flux_ * s.f_cos * *transmittance *
                    float(reach() * turned / lens_pdf * sent.density / sharing_->bounced_density(1));
    return sent;
}

bool LightWalk::go_on(LightVertex& vertex, const Random& u) {
    const bool last = is_last();
    const auto step = vertex.bidirectional().step(vertex.hit().wo, u.lobe, u.direction);
    if (!step || !pass(vertex, *step)) return false;
    if (last && distance_ == 0) return false;
    return survives();
}

/// Continues beyond a vertex or a window. False: the walk ends.
bool LightWalk::pass(LightVertex& vertex, const LightStep& step) {
    const SurfaceHit& hit = vertex.hit();
    const Bsdf& bsdf = vertex.bidirectional().seen_from(step.to_camera);
    const bool bounds = std::visit([](const auto& b) { return b.bounds_volume(); }, bsdf);
    const Vec3f w = step.to_camera;
    if (!(step.specular && step.transmitted && !bounds)) {
        // Camera paths cannot connect a delta lobe to a delta light.
        if (step.specular && delta_ && vertices_ == 0) return false;
        const auto transmittance = enter(volume_, bsdf, hit, w);
        if (!transmittance) return false;
        flux_ *= *transmittance * reach();
        if (!step.specular)
            light_camera_ratio_ *=
                step.pdf / (std::abs(double(dot(hit.ng, w))) * camera_density(hit, step.camera_pdf));
        if (!(light_camera_ratio_ > 0) || !std::isfinite(light_camera_ratio_)) return false;
        ++vertices_;
        distance_ = 0;
    }
    flux_ *= step.weight;
    const bool entering = dot(w, hit.ng) < 0;
    if (scene_->has_media() && entering == hit.front)
        medium_ = scene_->beyond(medium_, hit.instance, {}, bounds, entering);
    ray_ = spawn_ray(hit, w, ray_.time);
    return true;
}

/// Russian roulette. Surviving walks are divided by their survival probability.
bool LightWalk::survives() {
    const float survival = (flux_ / start_).max() / kRouletteThreshold, u = sampler_.next_1d();
    if (survival >= 1) return true;
    if (!(u < survival)) return false;
    flux_ *= 1 / survival;
    return true;
}

}  // namespace dg
