#include "transport/path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "math/below_one.h"
#include "medium/segment.h"
#include "transport/light_pick.h"
#include "transport/path_mis.h"

namespace dg {
namespace {

constexpr float kRouletteThreshold = 0.3f;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Scenes that a path goes through: the full one, that of the set alone (of catchers), or both as long as they do not
/// differ on its way. Without catchers there is the full one alone.
enum class World : std::uint8_t { both, full, set };

/// State of the path from vertex to vertex.
struct Walk {
    Ray ray;
    Spectrum throughput{1.f};
    Vec3f previous;              // where the ray left from, for the density of light sampling
    float bsdf_pdf = 0;
    int tries = 1;               // light samples that the last vertex picked one of
    bool from_delta = true;      // camera, or a mirror: light sampling cannot have found this
    bool in_view = true;         // straight from the camera, or by way of mirrors and smooth glass alone
    float straight = 0;          // m from there to the ray's origin, through clear sheets
    float eta_squared = 1;       // undoes the radiance scaling of refraction for Russian roulette
    Interior medium;
    float brightest = 0;         // lux that lamps bring to the brightest point on its ways through media
    Spectrum lanes{1.f};         // by which wavelengths the path may have been drawn (medium/segment.h)
    const FirstRay* first = nullptr;   // while the path is one, and light paths may find the same
    PathMis* bounces = nullptr;        // while light paths may find what comes next
    bool bent_alone = false;           // it goes the hero's way, behind a dispersive interface
    int splits = 0;                    // interfaces at which both ways were taken
    bool seen = false;                 // a surface that is not smooth was met: what the lens sees
    bool open = true;                  // straight from the lens: what is met here covers the background
    World world = World::full;
    bool bent = false;                 // it is, by way of smooth glass
    bool of_catcher = false;           // light is the set's, and not an object's
    bool hides = false;                // behind an object: what the set sends without it is found by another path
    bool hidden = false;               // that path, which the lens looks past an object
    const CatcherEffects* effects = nullptr;   // of the first catcher on the way
    bool past_catcher = false, left_catcher = false;   // it lies behind; straight from it
    float kept = 1;                    // share of differences between both worlds that counts: the effects that are on
    bool change = false;               // the plate has shown the set here: differences between both worlds alone count
    float share = 1;                   // of what is found on the way to a plate, which was a difference itself
};

constexpr int kBranchDraws = 1 << 15;   // dimensions of the sampler from way to way: more than the longest path has

/// Both ways on from a smooth clear interface, each with the share of light that takes it for a weight; nothing if it
/// has one alone, as where light is reflected totally or the glass is black, or more than these two.
template <typename BsdfKind>
std::optional<std::array<BsdfSample, 2>> both_ways(const BsdfKind& bsdf, Vec3f wo) {
    auto one = bsdf.sample(wo, 0, {}), other = bsdf.sample(wo, kBelowOne, {});
    if (!one || !other || one->transmitted == other->transmitted) return std::nullopt;
    if (std::abs(one->pdf + other->pdf - 1) > 1e-5f) return std::nullopt;
    if (one->weight.is_black() || other->weight.is_black()) return std::nullopt;
    one->weight *= one->pdf, other->weight *= other->pdf;
    return std::array{*one, *other};
}

/// The cone that leaves a hit. Curvature is asked for only where it matters.
RayCone next_cone(const Scene& scene, const RayCone& cone, const SurfaceHit& hit, const BsdfSample& sample) {
    if (cone.empty()) return cone;
    const RayCone here = cone.after(hit.t);
    if (!sample.specular) return here.scattered(sample.pdf);
    if (!sample.transmitted) return here.reflected(scene.curvature(hit));
    return sample.eta == 1 ? here : here.refracted(scene.curvature(hit), sample.eta);
}

/// The numbers of one vertex.
struct VertexRandom {
    float select = 0;      // which light
    Vec2f light;           // where on it
    float lobe = 0;        // which lobe of the BSDF, and which of several light samples
    Vec2f direction;
};

/// Every vertex takes the same four dimensions, so that stratification stays; those that this BSDF has
/// no use for are left out.
template <typename BsdfKind>
VertexRandom draw_vertex(const BsdfKind& bsdf, int tries, PathSampler& sampler) {
    VertexRandom u;
    const bool specular = bsdf.is_specular();
    if (tries > 0 && !specular) {
        u.select = sampler.next_1d();
        u.light = sampler.next_2d();
    } else {
        sampler.skip(2);
    }
    if (BsdfKind::kOneLobe && tries < 2)
        sampler.skip(1);
    else
        u.lobe = sampler.next_1d();
    if (specular)
        sampler.skip(1);
    else
        u.direction = sampler.next_2d();
    return u;
}

/// The medium of a ray that leaves along `wi`.
template <typename BsdfKind>
Interior medium_after(const Scene& scene, const Walk& walk, const SurfaceHit& hit, const BsdfKind& bsdf,
                      Vec3f wi) {
    if constexpr (requires { BsdfKind::kInMedium; }) return walk.medium;
    const float side = dot(wi, hit.ng);
    const bool transmitted = (side > 0) != hit.front;
    if (!transmitted) return walk.medium;
    return scene.beyond(walk.medium, hit.instance, bsdf.interior(), bsdf.bounds_volume(), side < 0);
}

/// Carries on from a vertex. What goes straight on through a clear sheet comes from where
/// it came from: light sampling there sees through the sheet too.
template <typename BsdfKind>
void advance(const Scene& scene, Walk& walk, const SurfaceHit& hit, const BsdfKind& bsdf,
             const BsdfSample& sample, PathMis::Vertex* both) {
    walk.throughput *= sample.weight;
    if (sample.transmitted) {
        walk.eta_squared *= sample.eta * sample.eta;
        walk.medium = medium_after(scene, walk, hit, bsdf, sample.wi);
        if (sample.specular && !bsdf.bounds_volume()) {
            walk.straight += hit.t;
            return;
        }
    }
    walk.first = nullptr;
    if (both) {
        walk.bounces->leave(*both, sample);
        if (!walk.bounces->open()) walk.bounces = nullptr;
    }
    walk.bsdf_pdf = sample.pdf;
    walk.from_delta = sample.specular;
    walk.in_view = walk.in_view && sample.specular;
    walk.previous = hit.position;
    walk.straight = 0;
}

/// False: the path ends. Only paths that carry less than kRouletteThreshold are at stake (without the
/// 1/eta^2 of radiance inside glass): ending stronger ones saves little and was measured to cost more
/// noise than time. What survives is raised by what was ended, so that the mean does not change.
bool survives_roulette(Walk& walk, float u) {
    const float strength = walk.throughput.max() * walk.eta_squared;
    if (strength >= kRouletteThreshold) return true;
    const float survival = strength / kRouletteThreshold;
    if (u >= survival) return false;
    walk.throughput *= 1.f / survival;
    return true;
}

/// One path: its state, what it has found, and the steps from vertex to vertex.
class Path {
  public:
    Path(const Scene& scene, const PathSettings& settings, const Wavelengths& wavelengths, PathSampler& sampler,
         FirstHit* first_hit)
        : scene_(scene), settings_(settings), wavelengths_(wavelengths), secondary_ended_(wavelengths.secondary_ended),
          sampler_(sampler), first_hit_(first_hit) {}
    Path(const Path&) = delete;
    Path& operator=(const Path&) = delete;

    void start(const Ray& ray, const FirstRay* first);
    bool follow() { return follow(0); }
    const Sight& sight() const { return sight_; }
    std::uint64_t rays() const { return rays_; }

  private:
    bool follow(int vertex);
    void gather(Spectrum light, bool hero, float kept);
    void gather(Spectrum light) { gather(light, walk_.bent_alone, walk_.kept); }
    void gather_emission(Spectrum light);
    bool step(int vertex);
    bool leave_scene(bool counts);
    bool arrive(Scene::Hit& found, int vertex, bool counts);
    bool pass_boundary(const SurfaceHit& hit);
    bool fork(Scene::Hit& found, int vertex, bool counts);
    void see_catcher(std::uint32_t instance);
    bool see_through();
    void cover(std::uint32_t id, float sign);
    bool asks_plate() const;
    bool show_plate_sky();
    void show_plate(const Material& material, const SurfaceHit& hit);
    bool counts(int vertex) const;
    bool scatter(const Material& material, SurfaceHit& hit, int vertex);
    bool scatter_shared(const Material& material, SurfaceHit& hit, int vertex);
    bool leave_by_kind(const Bsdf& bsdf, const Material& material, const SurfaceHit& hit, int vertex,
                       PathMis::Vertex* both);
    template <typename BsdfKind>
    bool leave(const BsdfKind& bsdf, const SurfaceHit& hit, int vertex, PathMis::Vertex* both);
    template <typename BsdfKind>
    bool split(const BsdfKind& bsdf, const SurfaceHit& hit, int vertex);
    template <typename BsdfKind>
    void go(const BsdfKind& bsdf, const SurfaceHit& hit, const BsdfSample& sample, PathMis::Vertex* both);
    template <typename BsdfKind, typename Seen>
    void direct_light(const BsdfKind& bsdf, const Seen& seen, int tries, const SurfaceHit& hit, const VertexRandom& u,
                      PathMis::Vertex* both);
    template <typename BsdfKind>
    void arriving(const BsdfKind& bsdf, const SurfaceHit& hit, const LightSample& light, float weight,
                  const Evaluation& f, PathMis::Vertex* both);
    bool at_first_catcher() const { return walk_.effects && !walk_.past_catcher; }
    template <typename BsdfKind>
    float kept_by(const BsdfKind& bsdf, Vec3f wo, Vec3f wi) const;
    template <typename BsdfKind>
    void leave_catcher(const BsdfKind& bsdf, const SurfaceHit& hit, const BsdfSample& sample);

    // In media (path_media-inl.h).
    enum class Way { passed, scattered, ended };
    struct Place {
        float t, density;
    };
    struct LampOnWay {
        LightSample light;
        Evaluation seen;
        Spectrum scattered;   // share of light that is scattered there, per m and sr, and reaches the start
        float t, weight;
    };
    struct WayRandom {
        float select, where;         // which lamp; where it is sampled from
        Vec2f place;                 // on the lamp
    };
    Way cross_medium(float t, int vertex);
    Way cross_even(const Medium& medium, const MediumAt& here, float t, int vertex);
    Way cross_grid(const Medium& medium, const MediumAt& here, float t, int vertex);
    bool take(const Segment::Onward& onward);
    float scattering_drawn(const Segment& way) const;
    bool survives_dark(Vec3f from, Vec3f at);
    void note_medium();
    float light_way(const Phase& phase, const Segment& way, float drawn);
    float share_of_light(float light_pdf, float phase_pdf) const;
    LampOnWay find_lamp(const Phase& phase, const Segment& way, float odds, const WayRandom& u) const;
    Place aim(const Segment& way, const std::optional<LightSet::Place>& lamp, const Phase& phase, float u) const;

    Spectrum environment_emission() const;
    Spectrum surface_emission(const Material& material, const SurfaceHit& hit) const;
    Spectrum sphere_light(std::uint32_t sphere, const SurfaceHit& hit) const;
    float emission_weight(float light_pdf) const;
    float bounced_share(std::int64_t light, float distance, float light_pdf) const;
    void record_first_hit(const Material& material, const SurfaceHit& hit, bool smooth);

    const Scene& scene_;
    const PathSettings& settings_;
    Wavelengths wavelengths_;   // those of the way that is followed: a copy, as it may end the secondary ones
    const bool secondary_ended_;
    PathSampler& sampler_;
    FirstHit* first_hit_;
    Walk walk_;
    std::optional<PathMis> bounces_;
    Sight sight_;
    float seen_through_ = 0;   // share of the camera's ray that objects let pass, glass included
    bool traced_ = true;
    std::uint64_t rays_ = 0;
};

void Path::start(const Ray& ray, const FirstRay* first) {
    walk_.ray = ray;
    walk_.previous = ray.origin;
    walk_.first = first;
    if (scene_.has_media()) walk_.medium = scene_.medium_around(ray);
    if (scene_.has_catchers()) walk_.world = World::both, walk_.of_catcher = true;
    if (first) bounces_.emplace(*first);
    if (bounces_ && bounces_->open()) walk_.bounces = &*bounces_;
}

/// From a vertex on. False: a ray that cannot be traced. The film counts the sample as bad; the ray tracer never
/// sees it.
bool Path::follow(int vertex) {
    for (;; vertex += walk_.straight == 0) {  // a window is no vertex
        if (!is_traceable(walk_.ray)) return traced_ = false;
        if (!step(vertex)) return traced_;
        if (vertex + 1 >= settings_.roulette_depth && !survives_roulette(walk_, sampler_.next_1d())) return traced_;
    }
}

/// Adds light that the path found, to what it belongs to. `kept`: the share of it that only this world is to have.
void Path::gather(Spectrum light, bool hero, float kept) {
    const auto add = [&](Radiance& to, float share) {
        if (share != 0) (hero ? to.hero : to.shared) += light * (share * walk_.share);
    };
    if (walk_.change) {
        const float sign = walk_.world == World::both ? 0 : walk_.world == World::full ? kept : -kept;
        return add(walk_.of_catcher ? sight_.with : sight_.light, sign);
    }
    if (!walk_.of_catcher) return add(sight_.light, 1);
    if (walk_.hidden) kept = 1 - seen_through_;
    if (walk_.world != World::full && !walk_.hides) add(sight_.without, 1);
    const float share = walk_.world == World::both ? 1 : walk_.world == World::full ? kept : 1 - kept;
    add(sight_.with, share);
}

/// The same for what the path met itself. Light of an emitter straight on a catcher is the shadow's affair.
void Path::gather_emission(Spectrum light) {
    const bool shadow = walk_.left_catcher && walk_.world == World::set;
    gather(light, walk_.bent_alone, shadow ? float(walk_.effects->shadow) : walk_.kept);
}

/// Whether emission met here counts: that of some ways is other passes'.
bool Path::counts(int vertex) const {
    const bool caustic = walk_.from_delta && !walk_.in_view;
    return (settings_.straight || vertex > 0) && (settings_.caustics || !caustic);
}

/// To what the ray meets, and on from it. False: the path ends.
bool Path::step(int vertex) {
    ++rays_;
    const bool counted = counts(vertex);
    auto found = scene_.intersect(walk_.ray);
    if (walk_.medium.medium) {
        const Way way = cross_medium(found ? found->surface.t : kInfinity, vertex);
        if (way != Way::passed) return way == Way::scattered;
    }
    if (!found) return leave_scene(counted);
    const bool object = found->sphere_light < 0 && walk_.world == World::both &&
                        !scene_.catcher(found->surface.instance);
    return object ? fork(*found, vertex, counted) : arrive(*found, vertex, counted);
}

/// To the background. False: the path ends.
bool Path::leave_scene(bool counts) {
    if (walk_.open && walk_.bent && scene_.has_catchers()) return see_through();
    if (walk_.open && scene_.has_catchers()) walk_.of_catcher = true;
    else if (walk_.open && settings_.background == Background::transparent) return false;
    if (counts && !show_plate_sky()) gather_emission(walk_.throughput * environment_emission());
    return false;
}

/// Whether an object sees the set here, and a plate may say what that is like.
bool Path::asks_plate() const { return settings_.plate && walk_.world == World::full && !walk_.open; }

/// Adds what the plate shows of the background, where mirrors and smooth glass look there: light sampling knows the
/// environment alone.
bool Path::show_plate_sky() {
    if (!asks_plate() || !walk_.from_delta) return false;
    const Vec3f direction = walk_.ray.direction;
    const auto shown = settings_.plate->at(direction, 0, walk_.ray.time);
    if (!shown) return false;
    Ray from_eye{.origin = settings_.plate->eye(walk_.ray.time), .direction = direction, .time = walk_.ray.time};
    from_eye.of_set = true;
    ++rays_;
    if (scene_.visibility(from_eye, false, {}, wavelengths_).max() < 1) return false;
    gather(walk_.throughput * wavelengths_.emission(*shown), walk_.bent_alone, walk_.kept);
    return true;
}

/// Adds what the plate shows of a catcher that an object sees. From here on the path looks for what objects change of
/// that. Lamps of the set are their own light, which light sampling finds.
void Path::show_plate(const Material& material, const SurfaceHit& hit) {
    if (!asks_plate() || emits(material)) return;
    const auto shown = settings_.plate->at(hit.position, 1, hit.time);
    if (!shown) return;
    const Vec3f to_eye = settings_.plate->eye(hit.time) - hit.position;
    const float distance = length(to_eye);
    Ray ray = ray_to(hit, to_eye * (1 / distance), distance, hit.time);
    ray.of_set = true;
    ++rays_;
    if (scene_.visibility(ray, false, {}, wavelengths_).max() < 1) return;   // it lies behind something else
    walk_.share *= walk_.kept;
    walk_.change = false;
    gather(walk_.throughput * wavelengths_.emission(*shown), walk_.bent_alone, 1);
    walk_.change = true, walk_.world = World::both;
    walk_.effects = scene_.catcher(hit.instance), walk_.past_catcher = walk_.left_catcher = false, walk_.kept = 1;
}

/// Goes on at what was met. False: the path ends.
bool Path::arrive(Scene::Hit& found, int vertex, bool counts) {
    SurfaceHit& hit = found.surface;
    if (walk_.medium.present) walk_.throughput *= walk_.medium.transmittance(hit.t);
    if (found.sphere_light < 0 && scene_.is_invisible(hit.instance)) return pass_boundary(hit);
    if (found.sphere_light >= 0) {
        if (walk_.open && scene_.has_catchers()) walk_.of_catcher = true;
        else cover(Cover::kSpheres + std::uint32_t(found.sphere_light), 1);
        if (counts) gather_emission(sphere_light(std::uint32_t(found.sphere_light), hit));
        return false;
    }
    if (!scene_.has_catchers() || !scene_.catcher(hit.instance)) cover(hit.instance, 1);
    else if (walk_.open && walk_.bent) return see_through();
    else see_catcher(hit.instance);
    const MaterialAt material = scene_.material(hit);
    if (scene_.has_catchers() && scene_.catcher(hit.instance)) show_plate(material, hit);
    if (counts) gather_emission(walk_.throughput * surface_emission(material, hit));
    if (vertex == settings_.max_depth && !scene_.has_clear()) return false;   // behind it only windows count
    return scatter(material, hit, vertex);
}

/// Straight on through a surface where nothing but the medium changes. It is a window, and no vertex.
bool Path::pass_boundary(const SurfaceHit& hit) {
    walk_.medium = scene_.beyond(walk_.medium, hit.instance, {}, false, hit.front);
    walk_.straight += hit.t;
    const Ray before = walk_.ray;
    walk_.ray = spawn_ray(hit, before.direction, before.time);
    if (!before.cone.empty()) walk_.ray.cone = before.cone.after(hit.t);
    return true;
}

/// At a catcher. One that is seen past an object (through a sheet) is in both worlds again, as effects may be off.
void Path::see_catcher(std::uint32_t instance) {
    if (walk_.open && walk_.world == World::full) walk_.world = World::both, walk_.hides = true;
    if (walk_.open) walk_.of_catcher = true;
    if (walk_.of_catcher && !walk_.effects) walk_.effects = scene_.catcher(instance);
}

/// At the end of a way through smooth glass that is to show what lies straight behind it: the path that looks there
/// brings it (fork()).
bool Path::see_through() {
    seen_through_ += walk_.throughput.average() * walk_.eta_squared;
    return false;
}

/// Adds to what the camera's ray is covered by, or takes off what passes.
void Path::cover(std::uint32_t id, float sign) {
    if (!walk_.open || walk_.world == World::set) return;
    const float share = walk_.throughput.average() * walk_.eta_squared;
    sight_.covers.add(id, sign * share);
}

/// At an object, where the two worlds part: the full one goes on there, the set's behind it. Both draw the same random
/// numbers: each by itself is right on average, and so is their difference.
bool Path::fork(Scene::Hit& found, int vertex, bool counts) {
    const Walk before = walk_;
    const PathSampler sampler = sampler_;
    const bool camera = walk_.open;
    walk_.world = World::full;
    if (camera) walk_.of_catcher = false;
    if (walk_.kept > 0 && arrive(found, vertex, counts)) {
        const int next = vertex + (walk_.straight == 0);
        if (next < settings_.roulette_depth || survives_roulette(walk_, sampler_.next_1d())) follow(next);
    }
    walk_ = before;
    if (camera && walk_.hides) return false;
    wavelengths_.secondary_ended = secondary_ended_ || walk_.bent_alone;
    sampler_ = sampler;
    walk_.world = World::set;
    walk_.ray.of_set = true;
    walk_.hidden = camera;
    return step(vertex);
}

/// At a surface: its BSDF, and the way on. False: the path ends.
bool Path::scatter(const Material& material, SurfaceHit& hit, int vertex) {
    if (walk_.bounces) return scatter_shared(material, hit, vertex);
    const Bsdf bsdf = shade(material, scene_.textures(), hit, wavelengths_);
    return leave_by_kind(bsdf, material, hit, vertex, nullptr);
}

/// The same, where light paths may find what comes next. By itself, as gcc clears room for a vertex that may be
/// absent (bug 86173): 1.7 kB at each surface that has none.
bool Path::scatter_shared(const Material& material, SurfaceHit& hit, int vertex) {
    const SurfaceHit bare = hit;
    const Bsdf bsdf = shade(material, scene_.textures(), hit, wavelengths_);
    PathMis::Vertex both(scene_, material, bare, wavelengths_, bsdf);
    return leave_by_kind(bsdf, material, hit, vertex, &both);
}

bool Path::leave_by_kind(const Bsdf& bsdf, const Material& material, const SurfaceHit& hit, int vertex,
                         PathMis::Vertex* both) {
    if (first_hit_ && !walk_.seen && walk_.world != World::set) record_first_hit(material, hit, is_specular(bsdf));
    return std::visit([&](const auto& kind) { return leave(kind, hit, vertex, both); }, bsdf);
}

/// Direct light, and a direction to go on in. False: the path ends.
template <typename BsdfKind>
bool Path::leave(const BsdfKind& bsdf, const SurfaceHit& hit, int vertex, PathMis::Vertex* both) {
    const bool last = vertex == settings_.max_depth;
    const int tries = light_tries(scene_.lights(), walk_.in_view);
    const VertexRandom u = draw_vertex(bsdf, tries, sampler_);
    const auto seen = seen_from(bsdf, hit.wo);
    if (!last && !bsdf.is_specular()) {
        direct_light(bsdf, seen, tries, hit, u, both);
    }
    if constexpr (!BsdfKind::kOneLobe)
        if (!last && walk_.in_view && walk_.splits < settings_.splits && split(bsdf, hit, vertex)) return true;
    const auto sample = bsdf.sample(seen, u.lobe, u.direction);
    if (!sample || sample->weight.is_black()) return false;
    go(bsdf, hit, *sample, both);
    if (walk_.straight == 0) walk_.tries = tries;   // else a window: light was sampled where the ray came from
    return !last || walk_.straight > 0;
}

/// Follows one way to its end and goes on by the other, if there are two. Drawing one of them is the noise of glass: a
/// bright reflection that few paths take, among many that pass (measured: rays x error -11 % with two splits, more buy
/// nothing).
template <typename BsdfKind>
bool Path::split(const BsdfKind& bsdf, const SurfaceHit& hit, int vertex) {
    if (!bsdf.is_specular() || !bsdf.bounds_volume()) return false;
    const auto ways = both_ways(bsdf, hit.wo);
    if (!ways) return false;
    walk_.bounces = nullptr;   // no light path ends at a delta lobe that the lens sees
    const int draws = kBranchDraws << walk_.splits++;
    const Walk before = walk_;
    const PathSampler sampler = sampler_;
    sampler_.skip(draws);
    go(bsdf, hit, (*ways)[0], nullptr);
    if (vertex + 1 < settings_.roulette_depth || survives_roulette(walk_, sampler_.next_1d())) follow(vertex + 1);
    walk_ = before;
    wavelengths_.secondary_ended = secondary_ended_ || walk_.bent_alone;
    sampler_ = sampler;
    go(bsdf, hit, (*ways)[1], nullptr);
    return true;
}

/// On from a vertex, with the ray of what comes next.
template <typename BsdfKind>
void Path::go(const BsdfKind& bsdf, const SurfaceHit& hit, const BsdfSample& sample, PathMis::Vertex* both) {
    const RayCone cone = next_cone(scene_, walk_.ray.cone, hit, sample);
    const bool of_set = walk_.ray.of_set;
    if (scene_.has_catchers()) leave_catcher(bsdf, hit, sample);
    const bool through = sample.transmitted && sample.specular && (settings_.see_through || !bsdf.bounds_volume());
    walk_.open = walk_.open && through;
    walk_.bent = walk_.bent || bsdf.bounds_volume();
    advance(scene_, walk_, hit, bsdf, sample, both);
    if (!scene_.has_catchers() || !scene_.catcher(hit.instance)) cover(hit.instance, -1);
    if (sample.hero_only) {
        // The throughput carries the hero's share from here on, so the weights of what was
        // gathered before stay. A BSDF disperses no path whose wavelengths have ended.
        wavelengths_.secondary_ended = walk_.bent_alone = true;
    }
    walk_.ray = spawn_ray(hit, sample.wi, walk_.ray.time);
    walk_.ray.cone = cone;
    walk_.ray.of_set = of_set;
}

/// From the first catcher on, differences count as far as its effects are on.
template <typename BsdfKind>
void Path::leave_catcher(const BsdfKind& bsdf, const SurfaceHit& hit, const BsdfSample& sample) {
    if (sample.transmitted && sample.specular && !bsdf.bounds_volume()) return;   // a window
    walk_.left_catcher = walk_.world == World::both && at_first_catcher();
    if (!walk_.left_catcher) return;
    walk_.kept = sample.specular ? float(walk_.effects->reflection) : kept_by(bsdf, hit.wo, sample.wi);
    walk_.past_catcher = true;
}

/// Next-event estimation at one vertex.
template <typename BsdfKind, typename Seen>
void Path::direct_light(const BsdfKind& bsdf, const Seen& seen, int tries, const SurfaceHit& hit, const VertexRandom& u,
                        PathMis::Vertex* both) {
    using Strategy = PathSettings::Strategy;
    const bool shared = settings_.strategy != Strategy::light, by_bsdf = settings_.strategy == Strategy::bsdf;
    if (tries > 1 && !by_bsdf) {
        const auto picked =
            LightPick::pick(scene_, hit, wavelengths_, tries, shared, {u.select, u.light, u.lobe}, walk_.throughput,
                            [&](Vec3f wi) { return bsdf.evaluate_with_pdf(seen, wi); });
        if (picked) arriving(bsdf, hit, picked->light, picked->weight, picked->seen, both);
        return;
    }
    const auto light = scene_.sample_light(u.select, u.light, hit.position, hit.time, wavelengths_);
    if (!light || light->pdf <= 0) return;
    if (by_bsdf && !light->delta) return;
    const Evaluation f = bsdf.evaluate_with_pdf(seen, light->wi);
    if (f.f_cos.is_black()) return;
    const float share = light->delta || !shared ? 1.f : power_heuristic(light->pdf, f.pdf);
    arriving(bsdf, hit, *light, share / light->pdf, f, both);
}

/// Adds a light's radiance with its weight, where nothing is in its way.
template <typename BsdfKind>
void Path::arriving(const BsdfKind& bsdf, const SurfaceHit& hit, const LightSample& light, float weight,
                    const Evaluation& f, PathMis::Vertex* both) {
    const bool of_object = walk_.world != World::full && scene_.is_of_object(light.light);
    if (of_object && walk_.world == World::set) return;
    const Interior medium = medium_after(scene_, walk_, hit, bsdf, light.wi);
    Ray ray = ray_to_light(hit, light, walk_.ray.time);
    const auto visible = [&](bool of_set) {
        ++rays_;
        ray.of_set = of_set;
        return scene_.visibility(ray, light.delta, medium, wavelengths_);
    };
    if (both) weight *= walk_.bounces->of_sample(scene_, *both, light, wavelengths_);
    const auto bring = [&](Spectrum left, World world, float kept) {
        if (left.is_black()) return;
        const Spectrum direct = walk_.throughput * (f.f_cos * (light.radiance * left * weight));
        const World here = std::exchange(walk_.world, world);
        gather(direct, f.hero_only || walk_.bent_alone, kept);
        walk_.world = here;
    };
    const Spectrum now = visible(walk_.world == World::set);
    if (walk_.world != World::both) return bring(now, walk_.world, walk_.kept);
    if (of_object) return bring(now, World::full, kept_by(bsdf, hit.wo, light.wi));
    if (now.min() == 1 && now.max() == 1) return bring(now, World::both, 1);
    const float kept = at_first_catcher() ? float(walk_.effects->shadow) : walk_.kept;
    bring(now, World::full, kept);
    bring(visible(true), World::set, kept);
}

/// Share of what the full scene sends to a catcher from there that counts.
template <typename BsdfKind>
float Path::kept_by(const BsdfKind& bsdf, Vec3f wo, Vec3f wi) const {
    if (!at_first_catcher() || walk_.effects->all()) return walk_.kept;
    const float diffuse = bsdf.diffuse_share(wo, wi);
    return diffuse * float(walk_.effects->gi) + (1 - diffuse) * float(walk_.effects->reflection);
}

/// Share of emission met by following the BSDF, where light sampling would have had `light_pdf`.
float Path::emission_weight(float light_pdf) const {
    using Strategy = PathSettings::Strategy;
    if (walk_.from_delta || light_pdf <= 0 || settings_.strategy == Strategy::bsdf) return 1;
    if (settings_.strategy == Strategy::light) return 0;
    return power_heuristic(walk_.bsdf_pdf, float(walk_.tries) * light_pdf);
}

/// Share of an emitter that the path has met, which light paths leave.
float Path::bounced_share(std::int64_t light, float distance, float light_pdf) const {
    if (!walk_.bounces) return 1;
    const float ratio = walk_.from_delta ? 0 : light_pdf / walk_.bsdf_pdf;
    return walk_.bounces->of_emitter(light, walk_.previous, walk_.ray.direction, distance, walk_.ray.time, ratio);
}

Spectrum Path::environment_emission() const {
    const LightSet& lights = scene_.lights();
    if (!lights.has_environment()) return 0.f;
    const Vec3f direction = walk_.ray.direction;
    const float pdf =
        walk_.from_delta ? 0 : lights.pdf_environment(direction, walk_.previous, walk_.ray.time);
    const float left = walk_.first ? walk_.first->share_of_sky(direction).value_or(1.f)
                                   : bounced_share(LightSet::kEnvironment, kInfinity, pdf);
    return lights.environment_radiance(direction, walk_.ray.time, wavelengths_) * (left * emission_weight(pdf));
}

/// With the path's throughput.
Spectrum Path::sphere_light(std::uint32_t sphere, const SurfaceHit& hit) const {
    const LightSet& lights = scene_.lights();
    const float pdf = walk_.from_delta ? 0 : lights.pdf_sphere(sphere, walk_.previous, hit.time);
    const float left =
        walk_.first ? walk_.first->share_of_sphere(lights, sphere, hit).value_or(1.f)
                    : bounced_share(lights.sphere_index(sphere), walk_.straight + hit.t, pdf);
    return walk_.throughput * lights.sphere_radiance(sphere, hit.wo, hit.time, wavelengths_) *
           (left * emission_weight(pdf));
}

Spectrum Path::surface_emission(const Material& material, const SurfaceHit& hit) const {
    if (!emits(material)) return 0.f;
    SurfaceHit seen = hit;
    // Light that light sampling and light paths could find too must be the same light: that of a point. Light paths
    // straight to the lens know the cone of the camera's sample, and see what it covers.
    if (!walk_.in_view) seen.footprint[0] = seen.footprint[1] = {};
    const Rgb luminance = emitted(material, scene_.textures(), seen) * scene_.shaping(material, hit);
    if (max_component(luminance) <= 0) return 0.f;
    const LightSet& lights = scene_.lights();
    const float distance = walk_.straight + hit.t;
    const float pdf =
        walk_.from_delta ? 0
                         : lights.pdf_triangle(hit.instance, hit.primitive, distance,
                                               std::abs(dot(hit.ng, hit.wo)), walk_.previous, hit.time);
    float share = walk_.first ? walk_.first->share_of_triangle(hit).value_or(1.f) : 1.f;
    if (walk_.bounces) {
        const std::int64_t light = lights.triangle_index(hit.instance, hit.primitive);
        if (light >= 0) share *= bounced_share(light, distance, pdf);
    }
    return wavelengths_.emission(luminance) * (share * emission_weight(pdf));
}

/// The first surface; and on the way on by mirrors and glass alone, the first that is not smooth.
void Path::record_first_hit(const Material& material, const SurfaceHit& hit, bool smooth) {
    FirstHit& first = *first_hit_;
    if (first.found && smooth) return;
    const Rgb color = albedo(material, scene_.textures(), hit);
    if (!first.found) first = {true, hit.position, hit.ns, color, hit.instance, {}, {}};
    if (smooth) return;
    const float share = walk_.throughput.average();
    first.seen_albedo = first.seen_albedo + color * share;
    first.seen_normal = first.seen_normal + hit.ns * share;
    walk_.seen = true;
}

}  // namespace
}  // namespace dg

#include "transport/path_media-inl.h"

namespace dg {

Radiance radiance(const Scene& scene, Ray ray, const Wavelengths& wavelengths, PathSampler& sampler,
                  const PathSettings& settings, FirstHit* hit, std::uint64_t* ray_count,
                  const FirstRay* first) {
    return look(scene, ray, wavelengths, sampler, settings, hit, ray_count, first).light;
}

Sight look(const Scene& scene, Ray ray, const Wavelengths& wavelengths, PathSampler& sampler,
           const PathSettings& settings, FirstHit* hit, std::uint64_t* ray_count, const FirstRay* first) {
    Path path(scene, settings, wavelengths, sampler, hit);
    path.start(ray, first);
    if (!path.follow()) {
        Sight untraceable;
        untraceable.light.shared = Spectrum(std::numeric_limits<float>::quiet_NaN());
        return untraceable;
    }
    if (ray_count) *ray_count += path.rays();
    return path.sight();
}

}  // namespace dg
