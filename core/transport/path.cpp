#include "transport/path.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "math/below_one.h"
#include "math/error.h"
#include "transport/catcher/one_world.h"
#include "transport/catcher/two_worlds.h"
#include "transport/emission.h"
#include "transport/light_pick.h"
#include "transport/media/interior.h"
#include "transport/media/medium_crossing.h"
#include "transport/media/phase_bsdf.h"
#include "transport/vertex_random.h"
#include "transport/walk/guides.h"

namespace dg {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kBranchDraws = 1 << 15;   // sampler dimensions between branches: more than the longest path uses

/// Reflection and refraction at a smooth clear interface, each weighted by its probability. Empty if there are
/// not exactly two lobes, as for total internal reflection, black glass and coats.
template <Scatters B>
std::optional<std::array<BsdfSample, 2>> both_lobes(const B& bsdf, Vec3f wo) {
    auto one = bsdf.sample(wo, 0, {}), other = bsdf.sample(wo, kBelowOne, {});
    if (!one || !other || one->transmitted == other->transmitted) return std::nullopt;
    if (std::abs(one->pdf + other->pdf - 1) > 1e-5f) return std::nullopt;
    if (one->weight.is_black() || other->weight.is_black()) return std::nullopt;
    one->weight *= one->pdf, other->weight *= other->pdf;
    return std::array{*one, *other};
}

/// The ray cone after a hit. Curvature is computed only if the sample needs it.
RayCone next_cone(const Scene& scene, const RayCone& cone, const SurfaceHit& hit, const BsdfSample& sample) {
    if (cone.empty()) return cone;
    const RayCone here = cone.after(hit.t);
    if (!sample.specular) return here.scattered(sample.pdf);
    if (!sample.transmitted) return here.reflected(scene.curvature(hit));
    return sample.eta == 1 ? here : here.refracted(scene.curvature(hit), sample.eta);
}

/// A path tracer's loop over vertices, with light sampling and BSDF sampling at each. `Worlds` is OneWorld, or
/// TwoWorlds for scenes with catchers and plates. Functions that return false end the path. `vertex`: number of
/// vertices before the hit of the ray; windows (walk.h) do not count.
template <class Worlds>
class Path : public PathState {
  public:
    Path(const Scene& scene, const PathSettings& settings, PathSampler& sampler, FirstHit* first_hit,
         const Wavelengths& wavelengths, const Ray& ray, const FirstRay* first)
        : PathState{scene, settings, sampler, first_hit, wavelengths}, worlds_(scene) {
        walk.ray = ray;
        walk.last.position = ray.origin;
        walk.media.around = surroundings_at_camera(scene, settings, walk.ray, wavelengths);
        walk.light_mis.first_ray = first;
        if (first) path_mis_.emplace(*first);
        if (path_mis_ && path_mis_->open()) walk.light_mis.path_mis = &*path_mis_;
    }
    Path(const Path&) = delete;
    Path& operator=(const Path&) = delete;

    /// False: a ray is not traceable (not finite). It is not passed to the ray tracer, and the film counts a bad
    /// sample.
    bool follow() { return follow(0); }

    /// Branches the path: runs `branch` and restores the state; the radiance that the branch gathered stays. The branch
    /// draws random numbers beyond the `skipped` dimensions. A path must not branch while it has the MIS of light paths
    /// with bounces: path_mis_, which accumulates over vertices, is not saved.
    template <typename Branch>
    void branch_off(int skipped, const Branch& branch) {
        DG_CHECK(walk.light_mis.path_mis, ==, nullptr);
        const WalkState walk_before = walk;
        const typename Worlds::State worlds_before = worlds_.state;
        const PathSampler sampler_before = sampler;
        const bool secondary_ended = wavelengths.secondary_ended;
        sampler.skip(skipped);
        branch();
        walk = walk_before;
        worlds_.state = worlds_before;
        sampler = sampler_before;
        wavelengths.secondary_ended = secondary_ended;
    }

    /// Follows a branch, which has just left `vertex`, until it ends; roulette may end it at once.
    void follow_to_end(int vertex) {
        const int next = vertex + walk.last.starts_ray();   // a window is no vertex
        if (next < settings.roulette_depth || survives_roulette(walk, sampler.next_1d())) follow(next);
    }

    /// Traces the ray through media to the next hit and processes the hit.
    bool step(int vertex) {
        ++rays;
        const bool gathers = gathers_emission(vertex);
        auto found = scene.intersect(walk.ray);
        if (walk.media.around.interior.medium) {
            const bool at_end = vertex == settings.max_depth;
            const MediumEvent event = MediumCrossing(*this).cross(found ? found->surface.t : kInfinity, at_end);
            if (!after_crossing(event, vertex)) return false;
            if (event.kind != MediumEvent::Kind::passed) return true;
        }
        return found ? worlds_.arrive(*this, *found, vertex, gathers) : leave_scene(gathers);
    }

    /// Processes a hit on a surface or a sphere light. `gathers`: from gathers_emission().
    bool arrive(Scene::Hit& found, int vertex, bool gathers) {
        SurfaceHit& hit = found.surface;
        if (walk.media.around.interior.present) walk.throughput *= walk.media.around.interior.transmittance(hit.t);
        if (found.sphere_light < 0 && scene.is_invisible(hit.instance)) return pass_boundary(hit);
        if (found.sphere_light >= 0) {
            const auto sphere = std::uint32_t(found.sphere_light);
            worlds_.meet_sphere(*this, sphere);
            if (gathers) worlds_.gather_emission(*this, sphere_emission(*this, sphere, hit));
            return false;
        }
        if (!worlds_.meet_surface(*this, hit)) return false;
        if (scene.rank(hit.instance) > 0 && !resolve_boundary(*this, hit)) return pass_boundary(hit);
        const MaterialAt material = scene.material(hit);
        worlds_.show_plate(*this, material, hit);
        if (gathers) worlds_.gather_emission(*this, surface_emission(*this, material, hit));
        if (vertex == settings.max_depth && !scene.has_clear()) return false;   // only clear surfaces may follow
        return scatter(material, hit, vertex);
    }

  private:
    using MisVertex = PathMis::Vertex;   // passed by pointer; null: no MIS with light paths that have bounces

    bool follow(int vertex) {
        for (;; vertex += walk.last.starts_ray()) {   // a window is no vertex
            if (!is_traceable(walk.ray)) return traced_ = false;
            if (!step(vertex)) return traced_;
            // Roulette counts a window as a vertex, and may begin at the window before vertex `roulette_depth`.
            if (vertex + 1 >= settings.roulette_depth && !survives_roulette(walk, sampler.next_1d())) return traced_;
        }
    }

    /// Whether the path gathers the emission of an emitter that it hits. Only the flare pass (flare_aim.cpp) leaves out
    /// emission: of visible emitters, which it samples directly, and of caustics, which paths hit too rarely.
    bool gathers_emission(int vertex) const {
        const bool caustic = walk.last.delta && !walk.in_view;
        return (settings.visible_emitters || vertex > 0) && (settings.caustics || !caustic);
    }

    bool leave_scene(bool gathers) {
        if (worlds_.sees_background(*this) && gathers && !worlds_.show_plate_sky(*this))
            worlds_.gather_emission(*this, sky_emission(*this));
        return false;
    }

    /// Passes a boundary without a BSDF: of a medium, or of a solid that a solid of a higher rank hides.
    bool pass_boundary(const SurfaceHit& hit) {
        cross_unscattered(scene, walk.media.around, hit);
        walk.last.window_distance += hit.t;
        const RayCone cone = walk.ray.cone;
        spawn(hit, walk.ray.direction, cone.empty() ? cone : cone.after(hit.t));
        return true;
    }

    /// Adds the light gathered in a medium, and continues from the point where the medium scatters the path.
    bool after_crossing(const MediumEvent& event, int vertex) {
        using Kind = MediumEvent::Kind;
        const PhaseBsdf phase{walk.media.around.interior.medium->phase};
        if (!event.emitted.is_black()) worlds_.gather(*this, event.emitted, walk.hero_only);
        if (event.lamp.direct.weight > 0)
            gather_direct(phase, in_medium(walk.ray, event.lamp.t), event.lamp.direct, event.lamp_throughput, nullptr);
        if (event.kind == Kind::passed || event.kind == Kind::ended) return event.kind == Kind::passed;
        walk.light_mis.path_mis = nullptr;   // light paths are not scattered by media
        const SurfaceHit at = in_medium(walk.ray, event.t);
        if (event.kind == Kind::collision) return sample_vertex(phase, at, vertex, nullptr);
        leave(phase, at, {.wi = event.wi, .weight = 1.f, .pdf = event.phase_pdf}, nullptr);
        // The ratio of light samples to collisions for MIS, as in lamp_sampler.h.
        walk.last.bsdf_pdf /= event.light_samples_per_collision, walk.last.candidates = 1;
        return true;
    }

    /// Evaluates the BSDF at a surface and continues from there.
    bool scatter(const Material& material, SurfaceHit& hit, int vertex) {
        if (walk.light_mis.path_mis) return scatter_with_light_mis(material, hit, vertex);
        const Bsdf bsdf = scene.shade_smooth(material, hit, wavelengths);
        return sample_vertex_by_kind(bsdf, material, hit, vertex, nullptr);
    }

    /// scatter() for a path with MIS against light paths with bounces. Separate, because gcc zeroes the storage of an
    /// optional vertex (bug 86173): 1.7 kB at each surface.
    bool scatter_with_light_mis(const Material& material, SurfaceHit& hit, int vertex) {
        const SurfaceHit unshaded = hit;   // before shading moves it and bends its normal
        const Bsdf bsdf = scene.shade_smooth(material, hit, wavelengths);
        MisVertex mis_vertex(scene, material, unshaded, wavelengths, bsdf);
        return sample_vertex_by_kind(bsdf, material, hit, vertex, &mis_vertex);
    }

    bool sample_vertex_by_kind(const Bsdf& bsdf, const Material& material, const SurfaceHit& hit, int vertex,
                               MisVertex* mis_vertex) {
        if (first_hit && !walk.guides_recorded && worlds_.finds_first_hit())
            note_surface(*this, material, hit, is_specular(bsdf));
        return std::visit([&](const auto& kind) { return sample_vertex(kind, hit, vertex, mis_vertex); }, bsdf);
    }

    /// Adds direct light and samples the next direction.
    template <Scatters B>
    bool sample_vertex(const B& bsdf, const SurfaceHit& hit, int vertex, MisVertex* mis_vertex) {
        const bool at_end = vertex == settings.max_depth;
        const int candidates = light_candidates(scene.lights(), walk.in_view);
        const VertexRandom u = draw_vertex(bsdf, candidates, sampler);
        const auto view = seen_from(bsdf, hit.wo);
        if (!at_end && !bsdf.is_specular()) sample_light(bsdf, view, candidates, hit, u, mis_vertex);
        if constexpr (!B::kOneLobe)
            if (!at_end && walk.in_view && walk.splits < settings.splits && split(bsdf, hit, vertex)) return true;
        const auto sample = bsdf.sample(view, u.lobe, u.direction);
        if (!sample || sample->weight.is_black()) return false;
        leave(bsdf, hit, *sample, mis_vertex);
        if (walk.last.starts_ray()) walk.last.candidates = candidates;
        return !at_end || !walk.last.starts_ray();
    }

    /// Follows one of two lobes to its end, then continues with the other. Choosing one at random makes glass noisy,
    /// since few paths sample a bright reflection. Measured: two splits lower rays x error by 11 %; more do not help.
    template <Scatters B>
    bool split(const B& bsdf, const SurfaceHit& hit, int vertex) {
        if (!bsdf.is_specular() || !bsdf.bounds_volume()) return false;
        const auto lobes = both_lobes(bsdf, hit.wo);
        if (!lobes) return false;
        walk.light_mis.path_mis = nullptr;   // light paths cannot connect to the lens at a delta lobe
        const int skipped = kBranchDraws << walk.splits;
        ++walk.splits;
        branch_off(skipped, [&] {
            leave(bsdf, hit, (*lobes)[0], nullptr);
            follow_to_end(vertex);
        });
        leave(bsdf, hit, (*lobes)[1], nullptr);
        return true;
    }

    /// Leaves a vertex along a BSDF sample and spawns the next ray.
    template <Scatters B>
    void leave(const B& bsdf, const SurfaceHit& hit, const BsdfSample& sample, MisVertex* mis_vertex) {
        const RayCone cone = next_cone(scene, walk.ray.cone, hit, sample);
        worlds_.leave(*this, bsdf, hit, sample);
        const bool through = sample.transmitted && sample.specular && (settings.see_through || !bsdf.bounds_volume());
        walk.unscattered = walk.unscattered && through;
        advance(bsdf, hit, sample, mis_vertex);
        worlds_.uncover(*this, hit);
        // The weight of such a sample has the hero's factor, so only later contributions are scaled. A path without
        // secondary wavelengths is not dispersed again.
        if (sample.hero_only) wavelengths.secondary_ended = walk.hero_only = true;
        spawn(hit, sample.wi, cone);
    }

    /// Updates the state. A clear sheet is no vertex, since shadow rays pass it.
    template <Scatters B>
    void advance(const B& bsdf, const SurfaceHit& hit, const BsdfSample& sample, MisVertex* mis_vertex) {
        walk.throughput *= sample.weight;
        if (sample.transmitted) {
            walk.eta_squared *= sample.eta * sample.eta;
            leave_along(scene, walk.media.around, hit, bsdf, sample.wi, wavelengths);
            if (sample.specular && !bsdf.bounds_volume()) {
                walk.last.window_distance += hit.t;
                return;
            }
        }
        walk.light_mis.leave(mis_vertex, sample);
        walk.in_view = walk.in_view && sample.specular;
        walk.last = {hit.position, sample.pdf, walk.last.candidates, sample.specular, 0};
    }

    /// Spawns the next ray from a hit. It ignores objects if the last ray did.
    void spawn(const SurfaceHit& hit, Vec3f direction, RayCone cone) {
        const bool without_objects = walk.ray.without_objects;
        walk.ray = spawn_ray(hit, direction, walk.ray.time);
        walk.ray.cone = cone;
        walk.ray.without_objects = without_objects;
    }

    /// Next-event estimation.
    template <Scatters B, typename View>
    void sample_light(const B& bsdf, const View& view, int candidates, const SurfaceHit& hit,
                      const VertexRandom& u, MisVertex* mis_vertex) {
        using Strategy = PathSettings::Strategy;
        const bool mis = settings.strategy != Strategy::light, by_bsdf = settings.strategy == Strategy::bsdf;
        if (candidates > 1 && !by_bsdf) {
            const auto picked =
                LightPick::pick(scene, hit, wavelengths, candidates, mis, {u.select, u.light, u.lobe}, walk.throughput,
                                [&](Vec3f wi) { return bsdf.evaluate_with_pdf(view, wi); });
            if (picked) gather_direct(bsdf, hit, *picked, walk.throughput, mis_vertex);
            return;
        }
        const auto light = scene.lights().sample(u.select, u.light, hit.position, hit.time, wavelengths);
        if (!light || light->pdf <= 0) return;
        if (by_bsdf && !light->delta) return;
        const Evaluation f = bsdf.evaluate_with_pdf(view, light->wi);
        if (f.f_cos.is_black()) return;
        const float share = light->delta || !mis ? 1.f : power_heuristic(light->pdf, f.pdf);
        gather_direct(bsdf, hit, {*light, f, share / light->pdf}, walk.throughput, mis_vertex);
    }

    /// Adds a light sample times its visibility. Only visible lights read their textures.
    template <Scatters B>
    void gather_direct(const B& bsdf, const SurfaceHit& hit, const DirectLight& direct,
                       Spectrum throughput, MisVertex* mis_vertex) {
        const LightSample& light = direct.light;
        Ray ray = ray_to_light(hit, light, walk.ray.time);
        const auto visibility = [&](bool without_objects) {
            ++rays;
            ray.without_objects = without_objects;
            return visibility_of(*this, hit, bsdf, light, ray);
        };
        const float camera_weight =
            mis_vertex ? walk.light_mis.path_mis->weight_of_sample(scene, *mis_vertex, light, wavelengths) : 1;
        const float weight = direct.weight * camera_weight;
        const auto reflected = [&](Spectrum visible) {
            const Spectrum radiance = scene.radiance(light, walk.ray.time, wavelengths);
            return throughput * (direct.f.f_cos * (radiance * visible * weight));
        };
        worlds_.gather_direct(*this, bsdf, hit.wo, direct, visibility, reflected);
    }

    Worlds worlds_;
    std::optional<PathMis> path_mis_;   // walk.light_mis.path_mis points at it
    bool traced_ = true;                // false: a ray was not traceable
};

template <class Worlds>
Sight sight_of(Path<Worlds>&& path, std::uint64_t* ray_count) {
    if (!path.follow()) {
        Sight untraceable;
        untraceable.light.any_hero = Spectrum(std::numeric_limits<float>::quiet_NaN());
        return untraceable;
    }
    if (ray_count) *ray_count += path.rays;
    return path.sight;
}

}  // namespace

Radiance radiance(const Scene& scene, Ray ray, const Wavelengths& wavelengths, PathSampler& sampler,
                  const PathSettings& settings, FirstHit* hit, std::uint64_t* ray_count, const FirstRay* first) {
    return trace_camera_ray(scene, ray, wavelengths, sampler, settings, hit, ray_count, first).light;
}

Sight trace_camera_ray(const Scene& scene, Ray ray, const Wavelengths& wavelengths, PathSampler& sampler,
                       const PathSettings& settings, FirstHit* hit, std::uint64_t* ray_count, const FirstRay* first) {
    if (scene.has_catchers() || settings.plate)
        return sight_of(Path<TwoWorlds>(scene, settings, sampler, hit, wavelengths, ray, first), ray_count);
    return sight_of(Path<OneWorld>(scene, settings, sampler, hit, wavelengths, ray, first), ray_count);
}

}  // namespace dg
