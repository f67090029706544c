#include "transport/sharing/path_mis.h"

namespace dg {
namespace {

SurfaceHit at_point(SurfaceHit hit) {
    hit.footprint[0] = hit.footprint[1] = {};
    return hit;
}

bool is_point(const SurfaceHit& hit) {
    const auto none = [](const UvFootprint& f) {
        return f.across == Vec2f{} && f.along == Vec2f{};
    };
    return none(hit.footprint[0]) && none(hit.footprint[1]);
}

}  // namespace

PathMis::Vertex::Vertex(const Scene& scene, const Material& material, const SurfaceHit& hit,
                            const Wavelengths& wavelengths, const Bsdf& shaded)
    : scene_(scene),
      material_(material),
      wavelengths_(wavelengths),
      shaded_(shaded),
      point_(is_point(hit)),
      hit_(at_point(hit)) {}

PathVertex& PathMis::Vertex::bidirectional() {
    if (!bidirectional_)
        bidirectional_.emplace(material_, scene_.textures(), hit_, wavelengths_, point_ ? &shaded_ : nullptr);
    return *bidirectional_;
}

/// p'_back of the vertex; p'_lens / D at the first vertex.
double PathMis::back(Vertex& vertex, const Scattering& s) const {
    const SurfaceHit& hit = vertex.hit_;
    const double pdf = vertices_ > 0 ? s.light_pdf : first_.lens_over_camera(hit.position);
    return light_camera_ratio_ * pdf / std::abs(double(dot(hit.ng, hit.wo)));
}

bool PathMis::cross(VolumeState& volume, Vertex& vertex, Vec3f wi) {
    const SurfaceHit& hit = vertex.hit_;
    const bool entering = dot(wi, hit.ng) < 0;
    if (entering != hit.front) return true;   // reflected
    if (hit.smooth) return false;             // light paths cannot find light from behind the triangle
    return std::visit(
        [&](const auto& b) {
            return !b.bounds_volume() || volume.cross(b.interior(), entering);
        },
        vertex.shaded_);
}

float PathMis::weight_of_sample(const Scene& scene, Vertex& vertex, const LightSample& light,
                             const Wavelengths& wavelengths) const {
    if (vertices_ < 1) return 1;
    const SurfaceHit& hit = vertex.hit_;
    const Scattering s = vertex.bidirectional().scattering(hit.wo, light.wi);
    if (s.hero_only || s.f_cos.is_black()) return 1;
    VolumeState volume = volume_;
    if (!cross(volume, vertex, light.wi)) return 1;
    const bool infinite = !(light.distance < std::numeric_limits<float>::infinity());
    if (infinite && volume.where != VolumeState::Where::air) return 1;
    // Shadow rays to delta lights pass volumes unrefracted. Light paths cannot find that light.
    if (light.delta && scene.has_clear() &&
        scene.visibility(ray_to_light(hit, light, hit.time), false, {}, wavelengths).is_black())
        return 1;
    const float emission = first_.sharing().emission_rays().pdf(light.light, hit.position, light.wi,
                                                               light.distance, hit.time);
    const double found = double(light.pdf) + (light.delta ? 0 : s.camera_pdf);
    const double ratio = first_.sharing().bounced_density(emission) * back(vertex, s) *
                         std::abs(double(dot(hit.ng, light.wi))) / found;
    return ratio > 0 ? first_.sharing().camera_weight(ratio, 1) : 1;
}

float PathMis::weight_of_emitter(std::int64_t light, Vec3f from, Vec3f direction, float distance,
                              float time, float light_over_bsdf) const {
    if (!open_ || vertices_ < 2) return 1;
    const bool infinite = light == LightSet::kEnvironment;
    if (infinite && volume_.where != VolumeState::Where::air) return 1;
    const float emission = first_.sharing().emission_rays().pdf(std::int32_t(light), from, direction,
                                                               distance, time);
    const double ratio =
        first_.sharing().bounced_density(emission) * light_camera_ratio_ / (1 + double(light_over_bsdf));
    return ratio > 0 ? first_.sharing().camera_weight(ratio, 1) : 1;
}

void PathMis::leave(Vertex& vertex, const BsdfSample& sample) {
    const SurfaceHit& hit = vertex.hit_;
    open_ = !sample.hero_only && cross(volume_, vertex, sample.wi);
    if (!open_) return;
    if (sample.specular) {
        open_ = vertices_++ > 0 && vertex.bidirectional().reversible(hit.wo, sample.wi);
        return;
    }
    Scattering s;
    if (vertices_ == 0 && vertex.point_)
        s.camera_pdf = sample.pdf;   // light_pdf is not needed
    else
        s = vertex.bidirectional().scattering(hit.wo, sample.wi);
    light_camera_ratio_ = back(vertex, s) * std::abs(double(dot(hit.ng, sample.wi))) / s.camera_pdf;
    ++vertices_;
    open_ = light_camera_ratio_ > 0 && std::isfinite(light_camera_ratio_);
}

}  // namespace dg
