// material_test.cpp -- materials at a hit: factors, textures, vertex colours, normals,
// opacity, emission.
#include "material/material.h"
#include "material/material_read.h"

#include <doctest/doctest.h>

#include <cmath>

#include "material/bsdf_check.h"
#include "material/test_hits.h"
#include "math/error.h"

namespace dg {
namespace {

using namespace test;

/// Two texels side by side, linear bytes.
Texture pair(std::initializer_list<std::uint8_t> left,
             std::initializer_list<std::uint8_t> right) {
    Texture t;
    t.width = 2;
    t.height = 1;
    t.channels = static_cast<int>(left.size());
    std::vector<std::uint8_t> p(left);
    p.insert(p.end(), right);
    t.pixels = p;
    t.filter = TextureFilter::nearest;
    return t;
}

GltfBsdf shaded(const GltfMaterial& m, const std::vector<Texture>& textures,
                SurfaceHit hit) {
    return std::get<GltfBsdf>(shade({"m", m, {}, false}, textures, hit, wavelengths()));
}

GltfMaterial lambert(Rgb colour) {
    GltfMaterial m;
    m.base_color = colour;
    m.metallic = 0;
    m.specular = 0;
    return m;
}

/// f * pi of a Lambert surface seen from above.
Spectrum reflectance(const GltfBsdf& b) {
    return b.evaluate({0, 0, 1}, {0, 0, 1}) * kPi;
}

void check_spectrum(Spectrum s, Rgb c) {
    const Spectrum wanted = wavelengths().reflectance(c);
    for (int k = 0; k < kWavelengths; ++k) CHECK(s[k] == doctest::Approx(wanted[k]));
}

}  // namespace

TEST_CASE("base colour = factor x texture x vertex colour, by set and transform") {
    const std::vector<Texture> textures{pair({51, 102, 255, 255}, {255, 0, 51, 0})};
    GltfMaterial m = lambert({1, 0.5f, 1});
    SurfaceHit h = hit_from({0, 0, 1});
    check_spectrum(reflectance(shaded(m, textures, h)), {1, 0.5f, 1});
    m.base_color_texture = slot(0);
    check_spectrum(reflectance(shaded(m, textures, h)), {0.2f, 0.2f, 1});
    m.base_color_texture = slot(0, 1);
    check_spectrum(reflectance(shaded(m, textures, h)), {1, 0, 0.2f});
    m.base_color_texture = slot(0);
    m.base_color_texture.m[2] = 0.5f;
    check_spectrum(reflectance(shaded(m, textures, h)), {1, 0, 0.2f});
    h.color[0] = 0.5f;
    h.color[2] = 9;  // clamped, so that it gains no energy
    check_spectrum(reflectance(shaded(m, textures, h)), {0.5f, 0, 1});
}

TEST_CASE("metallic-roughness texture: G is roughness, B is metallic") {
    const std::vector<Texture> textures{pair({255, 51, 102}, {0, 255, 0})};
    GltfMaterial m;
    m.metallic = 0.5f;
    m.metallic_roughness_texture = slot(0);
    const GltfBsdf b = shaded(m, textures, hit_from({0, 0, 1}));
    CHECK(b.alpha == doctest::Approx(0.04));
    CHECK(b.r0[0] == doctest::Approx(0.2 + 0.8 * 0.04));
}

TEST_CASE("F0 of dielectrics: ior, specular factor and colour") {
    GltfMaterial m;
    m.metallic = 0;
    m.roughness = 0;
    m.base_color = {0, 0, 0};
    const auto reflected = [&](float cos_o) {
        const SurfaceHit h = hit_from({std::sqrt(1 - cos_o * cos_o), 0, cos_o});
        const auto s = shaded(m, {}, h).sample(h.wo, 0.5f, {0.5f, 0.5f});
        REQUIRE(s);
        CHECK(s->specular);
        CHECK(s->wi.z == doctest::Approx(cos_o));
        return s->weight;
    };
    CHECK(reflected(1)[0] == doctest::Approx(0.04));
    CHECK(reflected(0.5f)[0] == doctest::Approx(0.04 + 0.96 * 0.03125));
    m.specular = 0.5f;
    CHECK(reflected(1)[0] == doctest::Approx(0.02));
    CHECK(reflected(0.5f)[0] == doctest::Approx(0.02 + 0.48 * 0.03125));
    m.specular_color = {1, 100, 0};  // the clamp comes before the factor
    CHECK(reflected(1)[0] == doctest::Approx(0));
    CHECK(reflected(1)[1] == doctest::Approx(0.5));
    m.specular_color = {1, 1, 1};
    m.specular = 1;
    m.ior = 0;
    CHECK(reflected(1)[0] == doctest::Approx(1));
    m.ior = 2.42f;
    CHECK(reflected(1)[0] == doctest::Approx(std::pow(1.42 / 3.42, 2)));
    m.metallic = 1;
    m.base_color = {1, 0.5f, 0.25f};
    check_spectrum(reflected(1), {1, 0.5f, 0.25f});
    check_spectrum(reflected(0.5f),
                   Rgb{1, 0.5f, 0.25f} * (1 - 0.03125f) + Rgb{1, 1, 1} * 0.03125f);
}

TEST_CASE("specular textures: A scales, RGB colours") {
    const std::vector<Texture> textures{pair({0, 0, 0, 51}, {0, 0, 0, 0}),
                                        pair({255, 102, 0}, {0, 0, 0})};
    GltfMaterial m;
    m.metallic = 0;
    m.specular_texture = slot(0);
    const Spectrum f0 = shaded(m, textures, hit_from({0, 0, 1})).f0;
    CHECK(f0[0] == doctest::Approx(0.04 * 0.2));
    m.specular_color_texture = slot(1);
    const Spectrum tinted = shaded(m, textures, hit_from({0, 0, 1})).f0;
    CHECK(tinted[1] == doctest::Approx(0.04 * 0.2 * 0.4));
    CHECK(tinted[0] == 0);
}

TEST_CASE("a white dielectric loses next to nothing at any roughness") {
    for (float roughness : {0.f, 0.2f, 0.5f, 0.8f, 1.f}) {
        for (float z : {1.f, 0.7f, 0.4f, 0.2f}) {
            GltfMaterial m;
            m.metallic = 0;
            m.roughness = roughness;
            const SurfaceHit h = hit_from({std::sqrt(1 - z * z), 0, z});
            const check::Setting s{Frame::from_normal(h.ng), h.wo, 1};
            const check::Albedo a =
                check::albedo_by_sampling(shaded(m, {}, h), s, 40000, 17);
            CHECK(a.value[0] < 1.003 + 4 * a.error[0]);
            CHECK(a.value[0] > 0.985 - 4 * a.error[0]);
        }
    }
}

TEST_CASE("transmission: thin walls do not bend, volumes follow Snell and absorb") {
    GltfMaterial m;
    m.metallic = 0;
    m.roughness = 0;
    m.transmission = 1;
    m.base_color = {0.5f, 0.5f, 0.5f};
    const SurfaceHit h = hit_from({0.6f, 0, 0.8f});
    const float u_transmit = 0.99f;
    const auto thin = shaded(m, {}, h).sample(h.wo, u_transmit, {0.5f, 0.5f});
    REQUIRE(thin);
    CHECK(thin->transmitted);
    CHECK(thin->specular);
    CHECK(thin->eta == 1);
    CHECK(length(thin->wi + h.wo) < 1e-6f);
    CHECK_FALSE(shaded(m, {}, h).interior().present);

    m.thickness = 0.1f;
    m.attenuation_distance = 2;
    m.attenuation_color = {0.25f, 0.25f, 0.25f};
    const GltfBsdf volume = shaded(m, {}, h);
    const auto bent = volume.sample(h.wo, u_transmit, {0.5f, 0.5f});
    REQUIRE(bent);
    CHECK(bent->transmitted);
    CHECK(bent->eta == doctest::Approx(1.5));
    CHECK(bent->wi.x == doctest::Approx(-0.4));
    const double f = fresnel_dielectric(0.8f, 1.5f);
    CHECK(bent->weight[0] * bent->pdf == doctest::Approx(0.5 * (1 - f) / 2.25));
    // Transmittance is 0.25 after 2 m, its square root after 1 m, its square after 4 m.
    CHECK(volume.interior().present);
    CHECK(volume.interior().transmittance(2)[0] == doctest::Approx(0.25));
    CHECK(volume.interior().transmittance(1)[1] == doctest::Approx(0.5));
    CHECK(volume.interior().transmittance(4)[2] == doctest::Approx(0.0625));
    CHECK(volume.interior().transmittance(0)[3] == 1);
    m.attenuation_distance = std::numeric_limits<float>::infinity();
    CHECK_FALSE(shaded(m, {}, h).interior().present);

    // Total internal reflection beyond the critical angle.
    const SurfaceHit inside = hit_from({0.8f, 0, -0.6f});
    const auto total = shaded(m, {}, inside).sample(inside.wo, u_transmit, {0.5f, 0.5f});
    REQUIRE(total);
    CHECK_FALSE(total->transmitted);
    CHECK(total->weight[0] == doctest::Approx(1));

    const std::vector<Texture> textures{pair({0}, {255})};
    m.transmission_texture = slot(0);
    CHECK(shaded(m, textures, h).clear == GltfBsdf::Clear::none);
    m.transmission_texture = slot(0, 1);
    CHECK(shaded(m, textures, h).clear == GltfBsdf::Clear::volume);
}

TEST_CASE("normal map: tangent frame, scale, handedness") {
    const std::vector<Texture> textures{pair({204, 153, 230}, {128, 128, 255})};
    GltfMaterial m;
    m.normal_texture = slot(0);
    const Material material{"m", m, {}, false};
    SurfaceHit h = hit_from({0, 0, 1});
    h.tangent = {0, 1, 0};
    shade(material, textures, h, wavelengths());
    // Tangent space (0.6, 0.2, 0.804); the bitangent is cross(z, y) = -x.
    const Vec3f wanted = normalize(Vec3f{-0.2f, 0.6f, 2 * 230 / 255.f - 1});
    CHECK(length(h.ns - wanted) < 1e-5f);
    h = hit_from({0, 0, 1});
    h.tangent = {0, 1, 0};
    h.tangent_sign = -1;
    shade(material, textures, h, wavelengths());
    CHECK(h.ns.x == doctest::Approx(-wanted.x));
    m.normal_scale = 0;
    h = hit_from({0, 0, 1});
    shade({"m", m, {}, false}, textures, h, wavelengths());
    CHECK(length(h.ns - h.ng) < 1e-6f);
}

TEST_CASE("bumps under the footprint become roughness, and do not shorten the normal") {
    // Normals tilted by 0.6 to either side: the length of their mean is 0.8.
    std::vector<Texture> textures{pair({204, 128, 230}, {51, 128, 230})};
    textures[0].pyramid = build_pyramid(textures[0], false);
    GltfMaterial m;
    m.roughness = 0.5f;
    m.normal_texture = slot(0);
    SurfaceHit near = hit_from({0, 0, 1});
    CHECK(shaded(m, textures, near).alpha == doctest::Approx(0.25));
    SurfaceHit far = hit_from({0, 0, 1});
    far.footprint[0] = {{9, 0}, {0, 9}};
    const GltfBsdf b = shaded(m, textures, far);
    const double variance = 0.2 / 0.8 - 0.01;
    CHECK(b.alpha == doctest::Approx(std::sqrt(0.0625 + 2 * variance)).epsilon(0.02));
    CHECK(length(b.ns - Vec3f{0, 0, 1}) < 0.01f);
    m.normal_scale = 0;
    CHECK(shaded(m, textures, far).alpha == doctest::Approx(0.25));
    m.normal_scale = 1;  // the same with roughness from a texture
    textures.push_back(pair({255, 255, 255}, {255, 255, 255}));
    m.metallic_roughness_texture = slot(1);
    CHECK(shaded(m, textures, far).alpha == b.alpha);
    m.metallic_roughness_texture = {};
    m.specular_glossiness = true;
    m.glossiness = 0.5f;
    CHECK(shaded(m, textures, far).alpha == b.alpha);
}

TEST_CASE("glass is as clear to paths, which have a footprint, as to shadow rays") {
    std::vector<Texture> textures{pair({204, 128, 230}, {51, 128, 230}),
                                  pair({0, 0, 0}, {0, 255, 0}),
                                  pair({255, 128, 0}, {255, 128, 255})};
    for (Texture& t : textures) t.pyramid = build_pyramid(t, false);
    GltfMaterial bumps, frost, brushed;
    bumps.normal_texture = slot(0);
    frost.metallic_roughness_texture = slot(1);
    bumps.roughness = brushed.roughness = 0;
    brushed.anisotropy.strength = 1;
    brushed.anisotropy.texture = slot(2);
    for (GltfMaterial m : {bumps, frost, brushed}) {
        m.metallic = 0;
        m.transmission = 1;
        for (const float u : {0.25f, 0.75f}) {
            SurfaceHit shadow = hit_from({0, 0, 1});
            shadow.uv[0].x = u;
            SurfaceHit path = shadow;
            path.footprint[0] = {{9, 0}, {0, 9}};
            CHECK(shaded(m, textures, path).smooth == shaded(m, textures, shadow).smooth);
        }
    }
}

TEST_CASE("no normal turns a surface black: wo and its mirror image stay above") {
    check::Random random{5};
    const Wavelengths w = wavelengths();
    for (int i = 0; i < 20000; ++i) {
        SurfaceHit h = hit_from(random.direction());
        h.ns = random.direction();  // including normals that no mesh has
        const float height = std::abs(h.wo.z);
        if (height < 1e-3f) continue;
        const Bsdf b = shade({"m", ConductorMaterial{{1, 1, 1}, 0}, {}, false}, {}, h, w);
        const float side = h.wo.z > 0 ? 1.f : -1.f;
        CHECK(side * dot(h.ns, h.wo) > 0.09f * height);
        CHECK(length(h.ns) == doctest::Approx(1));
        const auto s = sample(b, h.wo, 0.5f, {0.5f, 0.5f});
        REQUIRE(s);
        CHECK(side * s->wi.z > 0.09f * height);
    }
    SurfaceHit h = hit_from({0, 0.6f, 0.8f});  // a valid normal is not changed
    const Vec3f ns = h.ns = normalize(Vec3f{0.1f, 0.1f, 1});
    shade({"m", DiffuseMaterial{}, {}, false}, {}, h, w);
    CHECK(h.ns == ns);
}

TEST_CASE("a matte surface with a steep normal shows (1 + cos) / 2 of an even sky, from wherever it is seen") {
    const Wavelengths w = wavelengths();
    const auto byte = [](float v) { return static_cast<std::uint8_t>(std::lround(127.5f * (1 + v))); };
    for (const float degrees : {0.f, 30.f, 60.f, 80.f}) {
        const float angle = degrees * kPi / 180, up = std::cos(angle);
        const auto texel = {byte(std::sin(angle)), byte(0), byte(up)};
        const std::vector<Texture> textures{pair(texel, texel)};
        Material m{"m", DiffuseMaterial{}, {}, false};
        m.normal_texture = slot(0);
        for (const Vec3f wo : {Vec3f{0, 0, 1}, Vec3f{0.8f, 0, 0.6f}, Vec3f{-0.8f, 0, 0.6f}}) {
            SurfaceHit h = hit_from(wo);
            h.tangent = {1, 0, 0};
            const Bsdf b = shade(m, textures, h, w);
            CHECK(dot(h.ns, wo) > 0);
            CHECK(h.ns.z == doctest::Approx(up).epsilon(0.02));
            check::Random random{7};
            double sum = 0;
            constexpr int kCount = 40000;
            for (int i = 0; i < kCount; ++i)
                if (const auto s = sample(b, wo, 0.5f, random.next_2d())) sum += s->weight[0];
            CHECK(sum / kCount == doctest::Approx(0.5 * (1 + up) / 2).epsilon(0.015));
        }
    }
}

TEST_CASE("no normal map turns a matte surface black") {
    check::Random random{5};
    for (int i = 0; i < 20000; ++i) {
        const Vec3f wo = random.direction(), ng = random.direction(), ns = random.direction();
        if (std::abs(dot(ng, wo)) < 1e-3f) continue;
        const Vec3f n = facing_normal(ns, ng, wo);
        CHECK(dot(n, wo) * dot(ng, wo) > 0);
        CHECK(length(n) == doctest::Approx(1));
    }
}

TEST_CASE("opacity: opaque, mask and blend") {
    const std::vector<Texture> textures{pair({0, 0, 0, 102}, {0, 0, 0, 255})};
    GltfMaterial m;
    m.base_alpha = 0.5f;
    m.base_color_texture = slot(0);
    const Vec2f uv[2] = {{0.25f, 0.5f}, {0.75f, 0.5f}};
    const auto at = [&](float vertex_alpha) {
        return opacity({"m", m, {}, false}, textures, uv, vertex_alpha);
    };
    CHECK(at(0.1f) == 1);
    CHECK_FALSE(has_cutout({"m", m, {}, false}, textures));
    m.alpha_mode = GltfMaterial::AlphaMode::blend;
    CHECK(has_cutout({"m", m, {}, false}, textures));
    CHECK(at(1) == doctest::Approx(0.2));
    CHECK(at(0.5f) == doctest::Approx(0.1));
    m.base_color_texture.uv_set = 1;
    CHECK(at(1) == doctest::Approx(0.5));
    m.alpha_mode = GltfMaterial::AlphaMode::mask;
    CHECK(at(1) == 1);  // 0.5 >= 0.5
    CHECK(at(0.99f) == 0);
    m.alpha_cutoff = 0.2f;
    CHECK(at(0.5f) == 1);
    CHECK(opacity({"m", DiffuseMaterial{}, {}, false}, textures, uv, 0) == 1);
}

TEST_CASE("emission: texture, strength, sides") {
    const std::vector<Texture> textures{pair({51, 255, 0}, {0, 0, 0})};
    GltfMaterial m;
    m.emissive = {100, 10, 1};
    m.emissive_texture = slot(0);
    Material material{"m", m, {1, 2, 3}, false};
    CHECK(emits(material));
    const Rgb front = emitted(material, textures, hit_from({0, 0, 1}));
    CHECK(front.x == doctest::Approx(21));
    CHECK(front.y == doctest::Approx(12));
    CHECK(front.z == doctest::Approx(3));
    CHECK(emitted(material, textures, hit_from({0, 0, -1})) == Rgb{0, 0, 0});
    material.two_sided_emission = true;
    CHECK(emitted(material, textures, hit_from({0, 0, -1})) == Rgb{1, 2, 3});
    std::get<GltfMaterial>(material.kind).double_sided = true;
    CHECK(emitted(material, textures, hit_from({0, 0, -1})).x == doctest::Approx(21));
    CHECK_FALSE(emits({"m", GltfMaterial{}, {}, false}));
    CHECK(emits({"m", DiffuseMaterial{}, {0, 0, 1}, false}));
}

TEST_CASE("a single-sided surface is shaded from behind too") {
    const GltfMaterial m = lambert({0.5f, 0.5f, 0.5f});
    const SurfaceHit h = hit_from({0.3f, 0, -0.9f});
    const GltfBsdf b = shaded(m, {}, h);
    CHECK(b.evaluate(h.wo, {0, 0, -1})[0] == doctest::Approx(0.5 / kPiD));
    CHECK(b.evaluate(h.wo, {0, 0, 1})[0] == 0);
}

TEST_CASE("albedo of the first hit") {
    const SurfaceHit h = hit_from({0, 0, 1});
    const auto of = [&](auto kind) { return albedo({"m", kind, {}, false}, {}, h); };
    CHECK(of(DiffuseMaterial{{0.1f, 0.2f, 0.3f}}) == Rgb{0.1f, 0.2f, 0.3f});
    GltfMaterial m;
    m.base_color = {0.5f, 0.5f, 0.5f};
    CHECK(of(m).x == doctest::Approx(0.5));
    m.metallic = 0;
    CHECK(of(m).x == doctest::Approx(0.5 * 0.96 + 0.04));
    m.base_color = {1, 1, 1};
    CHECK(of(m).x == doctest::Approx(1));
}

TEST_CASE("validate names material, field, wanted and got") {
    const std::vector<Texture> textures(2);
    GltfMaterial m;
    CHECK_NOTHROW(validate({"ok", m, {}, false}, textures));
    m.roughness = 1.5f;
    CHECK_THROWS_WITH_AS(
        validate({"bad", m, {}, false}, textures),
        "material 'bad': roughness: wanted a number from 0 to 1, got 1.5", Error);
    m.roughness = std::nanf("");
    CHECK_THROWS_AS(validate({"bad", m, {}, false}, textures), Error);
    m = {};
    m.normal_texture = slot(2);
    CHECK_THROWS_WITH_AS(
        validate({"bad", m, {}, false}, textures),
        "material 'bad': normal_texture: wanted one of 2 textures, got index 2", Error);
    m = {};
    m.ior = 0.5f;
    CHECK_THROWS_AS(validate({"bad", m, {}, false}, textures), Error);
    m.ior = 0;
    CHECK_NOTHROW(validate({"ok", m, {}, false}, textures));
    CHECK_THROWS_AS(
        validate({"bad", DielectricMaterial{0, 0, {1, 1, 1}}, {}, false}, textures),
        Error);
    CHECK_THROWS_AS(validate({"bad", DiffuseMaterial{{1.1f, 0, 0}}, {}, false}, textures),
                    Error);
    CHECK_THROWS_AS(validate({"bad", DiffuseMaterial{}, {-1, 0, 0}, false}, textures),
                    Error);
}

}  // namespace dg
