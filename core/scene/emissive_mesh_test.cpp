// emissive_mesh_test.cpp -- emissive meshes as lights: energy, sides, textures, densities.
#include "scene/emissive_mesh.h"

#include <doctest/doctest.h>

#include "scene/test_scenes.h"

using namespace dg;

namespace {

/// An emissive quad that faces down at height 1.
SceneDescription lamp(Rgb emissive) {
    GltfMaterial m;
    m.emissive = emissive;
    SceneDescription d = describe(quad_mesh(), m);
    d.instances[0].world_from_local = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}};
    return d;
}

Wavelengths test_wavelengths() {
    return Wavelengths::sample(0.4f);
}

/// Irradiance at a facet at `position` in units of emission((1,1,1)), by light sampling and by uniform directions,
/// which are independent estimates.
struct Pair {
    double lights, directions;
};
Pair irradiance(const Scene& scene, Vec3f position, Vec3f normal, int n = 40000) {
    const Wavelengths wl = test_wavelengths();
    const double unit = wl.emission({1, 1, 1})[0];
    Pair sum{0, 0};
    for (int i = 0; i < n; ++i) {
        const Vec2f u{float(hash_uniform(1, i)), float(hash_uniform(2, i))};
        const auto s = sample_light(scene, float(hash_uniform(3, i)), u, position, wl);
        if (s && !occluded(scene, position, s->wi, s->distance)) {
            sum.lights +=
                s->radiance[0] * std::max(0.f, dot(normal, s->wi)) / s->pdf / unit / n;
        }
        const Vec3f w = test_direction(i);
        const auto hit = scene.intersect(test_ray(position, w));
        if (!hit) continue;
        const MaterialAt material = scene.material(hit->surface);
        const Rgb e = emitted(material, scene.textures(), hit->surface);
        sum.directions +=
            wl.emission(e)[0] * std::max(0.f, dot(normal, w)) * 4 * kPiD / unit / n;
    }
    return sum;
}

double quad_factor() {  // four corner rectangles of 1 x 1 at distance 1: Howell B-3
    return 4 * 2 / std::sqrt(2.0) * std::atan(1 / std::sqrt(2.0)) / (2 * kPiD);
}

}  // namespace

TEST_CASE("an emissive quad: E = pi L F, from its front only") {
    const auto scene = Scene::build(lamp({3, 3, 3}));
    CHECK(scene->lights().lights().size() == 2);
    const Pair e = irradiance(*scene, {0, 0, 0}, {0, 1, 0});
    CHECK(e.lights == doctest::Approx(3 * kPiD * quad_factor()).epsilon(0.02));
    CHECK(e.directions == doctest::Approx(3 * kPiD * quad_factor()).epsilon(0.03));
    const Pair above = irradiance(*scene, {0, 2, 0}, {0, -1, 0});
    CHECK(above.lights == 0);
    CHECK(above.directions == 0);
}

TEST_CASE("double sided and mirrored emitters shine where rays say they do") {
    for (bool double_sided : {false, true}) {
        SceneDescription d = lamp({3, 3, 3});
        std::get<GltfMaterial>(d.materials[0].kind).double_sided = double_sided;
        d.instances[0].world_from_local.x = {-1, 0, 0};
        const auto scene = Scene::build(d);
        const double full = 3 * kPiD * quad_factor();
        const Pair below = irradiance(*scene, {0, 0, 0}, {0, 1, 0});
        const Pair above = irradiance(*scene, {0, 2, 0}, {0, -1, 0});
        CHECK(below.lights == doctest::Approx(full).epsilon(0.02));
        CHECK(below.directions == doctest::Approx(full).epsilon(0.03));
        CHECK(above.lights == doctest::Approx(double_sided ? full : 0).epsilon(0.02));
        CHECK(above.directions == doctest::Approx(double_sided ? full : 0).epsilon(0.03));
    }
}

TEST_CASE("textured emission: both ways of looking see the same energy") {
    SceneDescription d = lamp({2, 2, 2});
    std::vector<std::uint8_t> pixels(64 * 64 * 3, 0);
    for (int i = 0; i < 64; ++i) {
        for (int j = 0; j < 24;
             ++j) {  // the left 3/8 of the picture emit, with more light at the top
            for (int k = 0; k < 3; ++k)
                pixels[(i * 64 + j) * 3 + k] = std::uint8_t(255 - 3 * i);
        }
    }
    d.textures.push_back({"glow", 64, 64, 3, pixels});
    std::get<GltfMaterial>(d.materials[0].kind).emissive_texture.index = 0;
    const auto scene = Scene::build(d);
    const Pair e = irradiance(*scene, {0.3f, 0.2f, -0.1f}, {0, 1, 0}, 200000);
    CHECK(e.lights > 0.1);
    CHECK(e.lights == doctest::Approx(e.directions).epsilon(0.02));

    // The means for choosing lights add up to the energy of the picture.
    double mean = 0;
    for (const Light& l : scene->lights().lights())
        mean += std::get<TriangleLight>(l).mean_luminance.x / 2;
    double expected = 0;
    for (std::size_t i = 0; i < pixels.size(); i += 3)
        expected += 2 * (pixels[i] / 255.0) / (64 * 64);
    CHECK(mean == doctest::Approx(expected).epsilon(0.05));
}

TEST_CASE("a sign in two colours: each half by its own form factor; vertex colours tint nothing") {
    SceneDescription d = lamp({2, 2, 2});
    d.textures.push_back({"halves", 2, 1, 3, std::vector<std::uint8_t>{255, 0, 0, 0, 0, 255}});
    d.textures[0].filter = TextureFilter::nearest;
    std::get<GltfMaterial>(d.materials[0].kind).emissive_texture.index = 0;
    const std::array<float, 4> dark{0.1f, 0.2f, 0.3f, 1};
    d.meshes[0].colors = {dark, dark, dark, dark};
    // Rectangle a x 1 with a corner above the facet, at distance 1: Howell B-3.
    auto corner = [](double a) {
        const double x = std::sqrt(1 + a * a), y = std::sqrt(2.0);
        return (a / x * std::atan(1 / x) + 1 / y * std::atan(a / y)) / (2 * kPiD);
    };
    const double left = 2 * (corner(1.5) - corner(0.5)), right = 2 * 2 * corner(0.5);
    const Wavelengths wl = test_wavelengths();
    const double unit = wl.emission({1, 1, 1})[0];
    const double expected = kPiD / unit * (left * wl.emission({2, 0, 0})[0] +
                                           right * wl.emission({0, 0, 2})[0]);
    const Pair e = irradiance(*Scene::build(d), {0.5f, 0, 0}, {0, 1, 0}, 200000);
    CHECK(e.lights == doctest::Approx(expected).epsilon(0.01));
    CHECK(e.directions == doctest::Approx(expected).epsilon(0.02));
}

TEST_CASE("dark triangles of a textured emitter are no lights, dots are never missed") {
    for (int size : {16, 512}) {
        SceneDescription d = lamp({1, 1, 1});
        std::vector<std::uint8_t> pixels(size * size * 3, 0);
        pixels[(3 * size / 4 * size + 2 * size / 3 + 1) * 3] =
            255;  // one red dot, lower right
        d.textures.push_back({"dot", size, size, 3, pixels});
        std::get<GltfMaterial>(d.materials[0].kind).emissive_texture.index = 0;
        const auto scene = Scene::build(d);
        int with_dot = 0;
        for (const Light& l : scene->lights().lights())
            with_dot += std::get<TriangleLight>(l).primitive == 0;
        CHECK(with_dot == 1);
        if (size == 16) CHECK(scene->lights().lights().size() == 1);
    }
}

TEST_CASE("opacity dims an emitter for light sampling as it does for rays") {
    SceneDescription d = lamp({3, 3, 3});
    auto& m = std::get<GltfMaterial>(d.materials[0].kind);
    m.alpha_mode = GltfMaterial::AlphaMode::blend;
    m.base_alpha = 0.5f;
    const Pair e = irradiance(*Scene::build(d), {0, 0, 0}, {0, 1, 0});
    CHECK(e.lights == doctest::Approx(1.5 * kPiD * quad_factor()).epsilon(0.02));
    CHECK(e.directions == doctest::Approx(1.5 * kPiD * quad_factor()).epsilon(0.04));
}

TEST_CASE("sample().pdf is what pdf_triangle says of the hit in that direction") {
    SceneDescription d = describe(ball_mesh(1), GltfMaterial{});
    std::get<GltfMaterial>(d.materials[0].kind).emissive = {1, 1, 1};
    d.instances[0].world_from_local = {
        {-0.5f, 0.2f, 0}, {0, 0.7f, 0}, {0, 0.1f, 1}, {1, 2, 3}};
    d.environment = Environment::constant({0.1f, 0.1f, 0.1f});
    const auto scene = Scene::build(d);
    int compared = 0;
    for (int i = 0; i < 5000; ++i) {
        const Vec2f u{float(hash_uniform(1, i)), float(hash_uniform(2, i))};
        const Vec3f p = test_direction(i);
        const auto s =
            sample_light(*scene, float(hash_uniform(3, i)), u, p, test_wavelengths());
        if (!s || s->light < 0 || occluded(*scene, p, s->wi, s->distance))
            continue;
        const auto hit = scene->intersect(test_ray(p, s->wi));
        REQUIRE(hit.has_value());
        const SurfaceHit& h = hit->surface;
        if (h.primitive !=
            std::get<TriangleLight>(scene->lights().lights()[s->light])
                .primitive)
            continue;
        const float cosine = dot(h.ng, h.wo);
        if (cosine < 0.01f) continue;
        ++compared;
        CHECK(h.front);
        CHECK(scene->lights().pdf_triangle(h.instance, h.primitive, h.t, cosine, p, 0) ==
              doctest::Approx(s->pdf).epsilon(2e-3));
    }
    CHECK(compared > 1000);
}

TEST_CASE("an even light needs no second look; a texture or a veil does") {
    auto uneven = [](const GltfMaterial& material, bool colors) {
        SceneDescription d = describe(ball_mesh(1), material);
        if (colors)
            d.meshes[0].colors = std::vector<std::array<float, 4>>(
                d.meshes[0].positions.size(), {1, 1, 1, 0.5f});
        const auto scene = Scene::build(d);
        for (int i = 0; i < 1000; ++i) {
            const Vec2f u{float(hash_uniform(1, i)), float(hash_uniform(2, i))};
            const auto s = sample_light(*scene, float(hash_uniform(3, i)), u, {3, 0, 0}, test_wavelengths());
            if (!s) continue;
            const float alpha = material.alpha_mode == GltfMaterial::AlphaMode::opaque
                                    ? 1.f
                                    : material.base_alpha * (colors ? 0.5f : 1.f);
            const Spectrum expected = test_wavelengths().emission(Rgb{1, 2, 3} * alpha);
            CHECK(s->light >= 0);
            CHECK(s->radiance[0] == doctest::Approx(expected[0]).epsilon(1e-5));
            return s->uneven;
        }
        FAIL("no sample");
        return false;
    };
    GltfMaterial m;
    m.emissive = {1, 2, 3};
    CHECK_FALSE(uneven(m, false));
    CHECK_FALSE(uneven(m, true));  // opaque: alpha is ignored
    m.alpha_mode = GltfMaterial::AlphaMode::blend;
    m.base_alpha = 0.5f;
    CHECK_FALSE(uneven(m, false));
    CHECK(uneven(m, true));
}
