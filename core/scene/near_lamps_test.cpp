// near_lamps_test.cpp -- lamps close to the surfaces that they light: unoccluded lamps are visible to all shadow rays,
// and occluders very close to the lamp block them.
#include <doctest/doctest.h>

#include "scene/scene.h"
#include "scene/test_scenes.h"

using namespace dg;

namespace {

/// Scale and position of a scene, which determine rounding errors.
struct Place {
    float scale;
    Vec3f origin;
    Affine3f local(float size, Vec3f at) const {
        const float s = scale * size;
        return {{s, 0, 0}, {0, s, 0}, {0, 0, s}, origin + at * scale};
    }
};

Material glowing() {
    GltfMaterial m;
    m.emissive = {1, 1, 1};
    return {"glowing", m};
}

/// A floor under lamps.
SceneDescription floor_of(const Place& place, float half_width) {
    SceneDescription d = describe(quad_mesh(), GltfMaterial{});
    d.instances[0].world_from_local = place.local(half_width, {});
    return d;
}

void put(SceneDescription& d, Mesh mesh, Material material, const Affine3f& where) {
    add(d, std::move(mesh), std::move(material));
    d.instances.back().world_from_local = where;
}

/// A quad that faces down.
Mesh facing_down() {
    Mesh mesh = quad_mesh();
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
    return mesh;
}

struct Count {
    int asked = 0, hidden = 0;
};

/// Shadow rays from points of the floor within `reach` of its center. `aimed`: rays of ray_to_light(); otherwise along
/// the sampled direction.
Count count_hidden(const SceneDescription& d, const Place& place, float reach, bool aimed = true) {
    const auto scene = Scene::build(d);
    const Wavelengths wavelengths = Wavelengths::sample(0.5f);
    Count count;
    for (int i = 0; i < 4000; ++i) {
        const auto at = [&](int k) { return float(2 * hash_uniform(k, i) - 1) * reach; };
        const Vec3f down_from = place.origin + Vec3f{at(1), at(2), 5e-4f} * place.scale;
        const auto found = scene->intersect(test_ray(down_from, {0, 0, -1}));
        if (!found || found->surface.instance != 0) continue;
        const SurfaceHit& hit = found->surface;
        const Vec2f u{float(hash_uniform(3, i)), float(hash_uniform(4, i))};
        const auto light = scene->lights().sample(float(hash_uniform(5, i)), u, hit.position, 0, wavelengths);
        if (!light || !(dot(hit.ng, light->wi) > 0)) continue;
        Ray ray = ray_to_light(hit, *light, 0);
        if (!aimed) {
            ray = spawn_ray(hit, light->wi, 0);
            ray.t_max = light->distance;
        }
        ++count.asked;
        count.hidden += scene->visibility(ray, false, {}, wavelengths).is_black();
    }
    return count;
}

constexpr Place kPlaces[] = {{1, {0, 0, 0}}, {1, {30, -20, 5}}, {1e-3f, {0, 0, 0}}, {1e3f, {0, 0, 0}}};

/// Lamps of each kind at a height over the floor.
std::vector<SceneDescription> lit_floors(const Place& place, float height) {
    const Affine3f over = place.local(0.1f, {0, 0, height});
    std::vector<SceneDescription> all(4, floor_of(place, 20));
    put(all[0], facing_down(), glowing(), over);
    put(all[1], ball_mesh(3), glowing(), place.local(0.25f, {0, 0, 0.25f + height}));
    put(all[2], facing_down(), glowing(), place.local(20, {0, 0, height}));
    SphereLight ball;
    ball.shape = {place.origin + Vec3f{0, 0, 0.25f + height} * place.scale, 0.25f * place.scale};
    ball.luminance = {1, 1, 1};
    all[3].lights.push_back(ball);
    return all;
}

}  // namespace

TEST_CASE("all light of a lamp reaches a floor, however near and wide they are") {
    for (const Place& place : kPlaces) {
        for (const float height : {0.3f, 0.05f, 0.01f, 1e-3f}) {
            const auto floors = lit_floors(place, height);
            for (std::size_t kind = 0; kind < floors.size(); ++kind) {
                const Count count = count_hidden(floors[kind], place, 1);
                CAPTURE(place.scale);
                CAPTURE(place.origin.x);
                CAPTURE(height);
                CAPTURE(kind);
                CHECK(count.asked > 1000);
                CHECK(count.hidden == 0);
            }
        }
    }
}

TEST_CASE("the test sees shadow rays that are not aimed from where they start") {
    const Place place = kPlaces[0];
    for (const SceneDescription& d : lit_floors(place, 0.01f)) CHECK(count_hidden(d, place, 1, false).hidden > 20);
}

TEST_CASE("a plate just below a lamp hides it") {
    for (const Place& place : kPlaces) {
        for (SceneDescription& d : lit_floors(place, 0.05f)) {
            put(d, quad_mesh(), {"dark", GltfMaterial{}}, place.local(30, {0, 0, 0.0498f}));
            const Count count = count_hidden(d, place, 1);
            CAPTURE(place.scale);
            CAPTURE(place.origin.x);
            CHECK(count.asked > 1000);
            CHECK(count.hidden == count.asked);
        }
    }
}
