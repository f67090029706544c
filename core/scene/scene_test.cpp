// scene_test.cpp -- building, hits in the world frame, shadows, bad input.
#include "scene/memory_need.h"
#include "scene/scene.h"

#include <doctest/doctest.h>

#include "math/error.h"
#include "scene/test_scenes.h"

using namespace dg;

namespace {

std::string build_error(SceneDescription d) {
    try {
        Scene::build(std::move(d));
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

SceneDescription one_quad() {
    return describe(quad_mesh(), GltfMaterial{});
}

}  // namespace

TEST_CASE("an empty scene can be built and is never hit") {
    const auto scene = Scene::build({});
    CHECK_FALSE(scene->intersect(test_ray({0, 0, 0}, {0, 0, 1})).has_value());
    CHECK_FALSE(occluded(*scene, {0, 0, 0}, {0, 0, 1}, 1));
    CHECK(scene->lights().empty());
    CHECK(scene->triangle_count() == 0);
    CHECK(scene->bounds().max == Vec3f{0, 0, 0});
}

TEST_CASE("bad input is named") {
    SceneDescription d = one_quad();
    d.instances[0].mesh = 4;
    CHECK(build_error(d) == "instance 0 'it': mesh index: wanted less than 1, got 4");
    d = one_quad();
    d.instances[0].material = 1;
    CHECK(build_error(d).find("instance 0 'it': material index") == 0);
    d = one_quad();
    d.instances[0].world_from_local.y = {0, std::nanf(""), 0};
    CHECK(build_error(d).find("instance 0 'it': transform: wanted finite numbers") == 0);
    d = one_quad();
    d.instances[0].world_from_local.y = d.instances[0].world_from_local.x;
    CHECK(build_error(d).find(
              "instance 0 'it': transform: wanted an invertible matrix") == 0);
    d = one_quad();
    d.instances[0].world_from_local.z = {0, 0, 0};
    CHECK(build_error(d).find("wanted an invertible matrix") != std::string::npos);
    d = one_quad();
    d.meshes[0].triangles = {{0, 77, 2}, {0, 2, 3}};
    CHECK(build_error(d).find("mesh 'quad'") == 0);
    d = one_quad();
    std::get<GltfMaterial>(d.materials[0].kind).base_color_texture.index = 0;
    CHECK(build_error(d).find("material") == 0);
}

TEST_CASE("a scene that does not fit into memory is refused with what it needs") {
    GltfMaterial glowing;
    glowing.emissive = {1, 1, 1};
    SceneDescription d = describe(quad_mesh(), glowing);
    for (int i = 1; i < 1000; ++i) d.instances.push_back(d.instances[0]);   // all with the same mesh of 2 triangles
    d.materials.push_back({"dark", GltfMaterial{}});
    const std::uint64_t needed = 2 * MemoryNeed::kTriangle + 2000 * MemoryNeed::kLamp;
    CHECK(MemoryNeed(d).bytes() == needed);
    d.free_memory = needed;
    CHECK(build_error(d) == "");
    d.free_memory = needed - 1;
    CHECK(build_error(d) ==
          "memory: 2 triangles of 50 bytes and 2000 emissive ones of 400: wanted at most the 0.0008 GB that are left, "
          "got 0.0008 GB");
    for (Instance& instance : d.instances) instance.material = 1;
    CHECK(build_error(d) == "");
    // A triangle that emits at some time is in the set of lights at all times.
    Keyed<Material, double> keys{{0, 1}, {d.materials[1], d.materials[0]}};
    d.material_keys[1] = keys;
    CHECK(MemoryNeed(d).bytes() == needed);
}

TEST_CASE("a hit: position, normal, distance, side, uv and colour") {
    SceneDescription d = one_quad();
    d.meshes[0].colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}, {0, 1, 0, 1}};
    use_textures(d);
    d.instances[0].world_from_local.origin = {0, 0, 5};
    const auto scene = Scene::build(d);
    const auto hit = scene->intersect(test_ray({0.5f, 0.25f, 7}, {0, 0, -1}));
    REQUIRE(hit.has_value());
    const SurfaceHit& s = hit->surface;
    CHECK(hit->sphere_light == -1);
    CHECK(length(s.position - Vec3f{0.5f, 0.25f, 5}) < 1e-6f);
    CHECK(s.t == doctest::Approx(2));
    CHECK(length(s.ng - Vec3f{0, 0, 1}) < 1e-6f);
    CHECK(s.front);
    CHECK(s.uv[0].x == doctest::Approx(0.75));  // u runs along +x, v downward
    CHECK(s.uv[0].y == doctest::Approx(0.375));
    CHECK(s.color[0] == doctest::Approx(0.75));
    CHECK(s.color[1] == doctest::Approx(0.625));
    CHECK_FALSE(scene->intersect(test_ray({0.5f, 0.25f, 3}, {0, 0, 1}))->surface.front);
    CHECK(scene->triangle_count() == 2);
    CHECK(scene->bounds().min == Vec3f{-1, -1, 5});
    CHECK(scene->bounds().max == Vec3f{1, 1, 5});
}

TEST_CASE(
    "tangent: along +u, bitangent up the picture; glTF tangents win; mirroring flips the "
    "sign") {
    SceneDescription d = one_quad();
    use_textures(d);
    auto hit = [&] {
        return Scene::build(d)->intersect(test_ray({0.3f, 0.1f, 7}, {0, 0, -1}))->surface;
    };
    auto bitangent = [](const SurfaceHit& s) {
        return cross(s.ns, s.tangent) * s.tangent_sign;
    };
    SurfaceHit s = hit();
    CHECK(length(s.tangent - Vec3f{1, 0, 0}) < 1e-6f);
    CHECK(length(bitangent(s) - Vec3f{0, 1, 0}) < 1e-6f);

    // Mirrored along x and seen from its front: both follow the picture.
    d.instances[0].world_from_local.x = {-1, 0, 0};
    s = hit();
    CHECK(s.front);
    CHECK(length(s.tangent - Vec3f{-1, 0, 0}) < 1e-6f);
    CHECK(length(bitangent(s) - Vec3f{0, 1, 0}) < 1e-6f);

    d.meshes[0].tangents = std::vector<std::array<float, 4>>(4, {0, 1, 0, 1});
    s = hit();
    CHECK(length(s.tangent - Vec3f{0, 1, 0}) < 1e-6f);
    CHECK(length(bitangent(s) - Vec3f{1, 0, 0}) < 1e-6f);
}

TEST_CASE("anisotropy and a coat's normal map have a tangent of their own accord") {
    SceneDescription d = one_quad();
    const auto tangent = [&](auto change) {
        GltfMaterial m;
        change(m);
        d.materials[0].kind = m;
        const auto ray = test_ray({0.3f, 0.1f, 7}, {0, 0, -1});
        return Scene::build(d)->intersect(ray)->surface.tangent;
    };
    CHECK(tangent([](GltfMaterial&) {}) == Vec3f{});
    const auto brushed = [](GltfMaterial& m) { m.anisotropy.strength = 1; };
    CHECK(length(tangent(brushed) - Vec3f{1, 0, 0}) < 1e-6f);
    d.textures.push_back({"bump", 1, 1, 1, std::vector<std::uint8_t>{128}});
    const auto bumped_coat = [](GltfMaterial& m) {
        m.clearcoat.factor = 1;
        m.clearcoat.normal_texture.index = 0;
    };
    CHECK(length(tangent(bumped_coat) - Vec3f{1, 0, 0}) < 1e-6f);
    d.meshes[0].tangents = std::vector<std::array<float, 4>>(4, {0, 1, 0, 1});
    CHECK(length(tangent(brushed) - Vec3f{0, 1, 0}) < 1e-6f);
}

TEST_CASE("a texture of any layer brings the texture coordinates along") {
    const auto slots = {+[](GltfMaterial& m) { return &m.clearcoat.texture; },
                        +[](GltfMaterial& m) { return &m.clearcoat.roughness_texture; },
                        +[](GltfMaterial& m) { return &m.clearcoat.normal_texture; },
                        +[](GltfMaterial& m) { return &m.sheen.color_texture; },
                        +[](GltfMaterial& m) { return &m.sheen.roughness_texture; },
                        +[](GltfMaterial& m) { return &m.anisotropy.texture; },
                        +[](GltfMaterial& m) { return &m.iridescence.texture; },
                        +[](GltfMaterial& m) { return &m.iridescence.thickness_texture; }};
    for (const auto& slot_of : slots) {
        SceneDescription d = one_quad();
        d.textures.push_back({"t", 1, 1, 1, std::vector<std::uint8_t>{128}});
        GltfMaterial m;
        slot_of(m)->index = 0;
        d.materials[0].kind = m;
        const auto hit = Scene::build(d)->intersect(test_ray({0.5f, 0.25f, 7}, {0, 0, -1}));
        CHECK(hit->surface.uv[0].x == doctest::Approx(0.75));
    }
}

TEST_CASE(
    "normals point outward under rotation, shear and mirroring; interpolated ones too") {
    const Affine3f transforms[] = {
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 2, 3}},
        {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {}},
        {{2, 0.5f, 0}, {0, 1, 0.7f}, {0.3f, 0, 0.4f}, {5, 0, 0}},
        {{0, 1, 0}, {1, 0, 0}, {0, 0.2f, 3}, {}},
    };
    for (const Affine3f& m : transforms) {
        for (bool smooth : {false, true}) {
            SceneDescription d = describe(ball_mesh(3), GltfMaterial{});
            if (smooth) d.meshes[0].normals = d.meshes[0].positions;  // normals of the unit ball
            d.instances[0].world_from_local = m;
            const auto scene = Scene::build(d);
            for (int i = 0; i < 500; ++i) {
                const Vec3f on_ball = test_direction(i);
                const Vec3f p = m.point(on_ball);
                const auto hit = scene->intersect(
                    test_ray(m.point({0, 0, 0}), p - m.point({0, 0, 0})));
                REQUIRE(hit.has_value());
                const SurfaceHit& s = hit->surface;
                CHECK_FALSE(s.front);
                const Vec3f expected = normalize(m.normal(on_ball));
                CHECK(dot(s.ng, expected) > 0.9f);
                CHECK(dot(s.ns, expected) > (smooth ? 0.999f : 0.9f));
                CHECK(length(s.ng) == doctest::Approx(1).epsilon(1e-5));
                CHECK(length(s.ns) == doctest::Approx(1).epsilon(1e-5));
                CHECK(std::abs(dot(s.tangent, s.ns)) < 1e-5f);
            }
        }
    }
}

TEST_CASE("shadow rays end before what they aim at") {
    SceneDescription d = one_quad();
    d.lights.push_back(SphereLight{{{0, 0, 3}, 0.5f}, {1, 1, 1}});
    const auto scene = Scene::build(d);
    CHECK_FALSE(occluded(*scene, {0, 0, 2}, {0, 0, -1}, 2));
    CHECK(occluded(*scene, {0, 0, 2}, {0, 0, -1}, 2.01f));
    CHECK_FALSE(occluded(*scene, {0, 0, 2}, {0, 0, 1}, 0.5f));
    CHECK(
        occluded(*scene, {0, 0, 2}, {0, 0, 1}, std::numeric_limits<float>::infinity()));
    const auto hit = scene->intersect(test_ray({0, 0, 5}, {0, 0, -1}));
    REQUIRE(hit.has_value());
    CHECK(hit->sphere_light == 0);
    CHECK(hit->surface.position.z == doctest::Approx(3.5));
}

TEST_CASE("cutout: mask by texture, blend by chance that depends on the ray alone") {
    SceneDescription d = one_quad();
    Texture alpha{"alpha", 2, 1, 4,
                  std::vector<std::uint8_t>{255, 255, 255, 0, 255, 255, 255, 255}};
    alpha.filter = TextureFilter::nearest;
    d.textures = {alpha};
    auto& m = std::get<GltfMaterial>(d.materials[0].kind);
    m.base_color_texture.index = 0;
    CHECK(occluded(*Scene::build(d), {-0.5f, 0, 1}, {0, 0, -1}, 2));  // opaque: alpha unused
    m.alpha_mode = GltfMaterial::AlphaMode::mask;
    auto scene = Scene::build(d);
    CHECK_FALSE(occluded(*scene, {-0.5f, 0, 1}, {0, 0, -1}, 2));
    CHECK_FALSE(scene->intersect(test_ray({-0.5f, 0, 1}, {0, 0, -1})).has_value());
    CHECK(occluded(*scene, {0.5f, 0, 1}, {0, 0, -1}, 2));

    m.alpha_mode = GltfMaterial::AlphaMode::blend;
    m.base_color_texture.index = -1;
    m.base_alpha = 0.3f;
    scene = Scene::build(d);
    int hits = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
        const Vec3f from{float(hash_uniform(1, i)), float(hash_uniform(2, i)), 1};
        const bool hit = scene->intersect(test_ray(from, {0, 0, -1})).has_value();
        hits += hit;
        CHECK(hit == occluded(*scene, from, {0, 0, -1}, 2));
    }
    CHECK(std::abs(hits - 0.3 * n) < 5 * std::sqrt(n * 0.21));
}
