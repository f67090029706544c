// models_test.cpp -- KHR_materials_{unlit, diffuse_transmission, pbrSpecularGlossiness} at a hit, compared with the
// formulas of the extensions.
#include <doctest/doctest.h>

#include <cmath>

#include "material/bsdf_check.h"
#include "material/material.h"
#include "material/test_hits.h"

namespace dg {
namespace {

using test::hit_from;
using test::slot;
using test::texel;

const Vec3f kUp{0, 0, 1};

/// Wavelengths with the lanes red, green, blue and grey, so that spectra show their colour.
Wavelengths wavelengths() {
    Wavelengths w;
    w.red = {1, 0, 0, 1 / 3.f};
    w.green = {0, 1, 0, 1 / 3.f};
    w.blue = {0, 0, 1, 1 / 3.f};
    return w;
}

Bsdf shaded(const GltfMaterial& m, const std::vector<Texture>& textures, Vec3f wo) {
    SurfaceHit h = hit_from(wo);
    return shade({"m", m, {}, false}, textures, h, wavelengths());
}
Spectrum f_cos(const Bsdf& b, Vec3f wo, Vec3f wi) {
    return evaluate_with_pdf(b, normalize(wo), normalize(wi)).f_cos;
}
void expect(Spectrum s, Rgb wanted) {
    for (int k = 0; k < 3; ++k)
        CHECK(s[k] == doctest::Approx(wanted[k]).epsilon(2e-3));
}

}  // namespace

TEST_CASE("diffuse transmission: mix(diffuse_brdf, diffuse_btdf, factor x A)") {
    const std::vector<Texture> textures{texel({0, 0, 0, 102}), texel({255, 51, 0, 255})};
    GltfMaterial m;
    m.metallic = 0;
    m.specular = 0;  // no interface above
    m.base_color = {0.8f, 0.6f, 0.4f};
    m.diffuse_transmission = 0.5f;
    m.diffuse_transmission_color = {0.5f, 1, 1};
    m.diffuse_transmission_texture = slot(0);  // 0.4
    m.diffuse_transmission_color_texture = slot(1);
    const Vec3f wo{0.3f, 0.1f, 0.8f}, up{0, 0.6f, 0.8f}, down{0.6f, 0, -0.8f};
    for (const float side : {1.f, -1.f}) {
        const Bsdf b = shaded(m, textures, wo * side);
        const float c = 0.8f / kPi;
        expect(f_cos(b, wo * side, up * side),
              Rgb{0.8f, 0.6f, 0.4f} * (0.8f * c));
        expect(f_cos(b, wo * side, down * side), Rgb{0.5f, 0.2f, 0} * (0.2f * c));
    }
}

TEST_CASE("diffuse transmission: metals and KHR_materials_transmission come first") {
    GltfMaterial m;
    m.metallic = 0.25f;
    m.specular = 0;
    m.transmission = 0.4f;
    m.roughness = 0;  // the clear lobe is a delta and not part of evaluate()
    m.diffuse_transmission = 0.3f;
    const Bsdf b = shaded(m, {}, {0, 0, 1});
    const float c = 0.8f / kPi, diffuse = 0.75f * 0.6f;
    expect(f_cos(b, kUp, {0, 0.6f, 0.8f}), Rgb{1, 1, 1} * (diffuse * 0.7f * c));
    expect(f_cos(b, kUp, {0, 0.6f, -0.8f}), Rgb{1, 1, 1} * (diffuse * 0.3f * c));
}

TEST_CASE("diffuse transmission leads into a volume, and bounds nothing without one") {
    GltfMaterial m;
    m.metallic = 0;
    m.diffuse_transmission = 1;
    m.attenuation_distance = 2;
    m.attenuation_color = {0.5f, 0.25f, 1};
    CHECK_FALSE(interior(shaded(m, {}, kUp)).present);
    m.thickness = 1;
    const Bsdf b = shaded(m, {}, kUp);
    REQUIRE(interior(b).present);
    CHECK(interior(b).transmittance(4)[1] == doctest::Approx(0.0625));
    CHECK(std::get<GltfBsdf>(b).bounds_volume());
    // The factors 1 / eta^2 of entering and leaving cancel.
    const float in = f_cos(b, kUp, -kUp)[0], out = f_cos(b, -kUp, kUp)[0];
    CHECK(in * 1.5f * 1.5f == doctest::Approx(out / (1.5f * 1.5f)));
}

TEST_CASE("specular-glossiness: c_diff, F0 and alpha of the extension") {
    const std::vector<Texture> textures{texel({255, 128, 51, 204})};
    GltfMaterial m;
    m.specular_glossiness = true;
    m.base_color = {0.8f, 0.6f, 0.4f};
    m.specular_color = {0.2f, 0.5f, 1};
    m.glossiness = 0.5f;
    m.specular_glossiness_texture = slot(0);
    m.metallic = 1;  // belongs to the other workflow, ignored
    m.transmission = 1;
    const Rgb f0{0.2f, 0.5f * 128 / 255, 0.2f};
    const auto b = std::get<GltfBsdf>(shaded(m, textures, kUp));
    CHECK(b.alpha == doctest::Approx((1 - 0.5 * 0.8) * (1 - 0.5 * 0.8)));
    expect(b.r0, f0);
    CHECK(b.r0[0] + b.r90_r0[0] == doctest::Approx(1));  // F90
    CHECK(b.transmitted.is_black());
    const float c = 1 - f0.y;  // the largest
    const Rgb diffuse{0.8f * c, 0.6f * c, 0.4f * c};
    CHECK(b.diffuse_albedo == doctest::Approx((diffuse.x + diffuse.y + diffuse.z) / 3));
    const Rgb seen = albedo({"m", m, {}, false}, textures, hit_from(kUp));
    expect({seen.x, seen.y, seen.z, 0}, diffuse + f0);
    // Without gloss and F0: Lambertian under a Fresnel curve that starts at 0.
    GltfMaterial paint = m;
    paint.specular_glossiness_texture = {};
    paint.specular_color = {0, 0, 0};
    CHECK(std::get<GltfBsdf>(shaded(paint, {}, kUp)).diffuse_albedo ==
          doctest::Approx(0.6));
}

TEST_CASE("specular-glossiness: a furnace gives back no more than it gets") {
    for (const float gloss : {0.f, 0.5f, 1.f}) {
        for (const Rgb f0 : {Rgb{0, 0, 0}, Rgb{0.04f, 0.04f, 0.04f}, Rgb{1, 0.7f, 0.3f}}) {
            GltfMaterial m;
            m.specular_glossiness = true;
            m.specular_color = f0;
            m.glossiness = gloss;
            for (const float z : {0.1f, 0.6f, 1.f}) {
                const Vec3f wo{std::sqrt(1 - z * z), 0, z};
                const auto b = std::get<GltfBsdf>(shaded(m, {}, wo));
                const check::Setting s{Frame::from_normal(kUp), wo, 1};
                const check::Albedo a = check::albedo_by_quadrature(b, s);
                for (int k = 0; k < kWavelengths; ++k) CHECK(a.value[k] < 1.003);
                CHECK(check::furnace_deviation(b, s, a, 3) < 4.5);
            }
        }
    }
}

TEST_CASE("unlit: shines with factor x texture x vertex colour, and reflects nothing") {
    const std::vector<Texture> textures{texel({255, 51, 102, 128})};
    GltfMaterial m;
    m.unlit = true;
    m.base_color = {0.5f, 1, 1};
    m.base_color_texture = slot(0);
    m.emissive = {9, 9, 9};  // belongs to the lit model, ignored
    m.alpha_mode = GltfMaterial::AlphaMode::blend;
    const Material material{"m", m, {}, false};
    CHECK(emits(material));
    for (const float z : {1.f, -1.f}) {  // from both sides
        SurfaceHit h = hit_from({0, 0.2f, z});
        h.color[1] = 0.5f;
        const Rgb l = emitted(material, textures, h);
        expect({l.x, l.y, l.z, 0}, {0.5f, 0.1f, 0.4f});
        const Bsdf b = shade(material, textures, h, wavelengths());
        CHECK(f_cos(b, h.wo, h.wo).is_black());
        const auto s = sample(b, h.wo, 0.5f, {0.5f, 0.5f});
        CHECK((!s || s->weight.is_black()));
        CHECK(opacity(material, textures, h.uv, 1) == doctest::Approx(128 / 255.0));
    }
    m.base_color = {0, 0, 0};
    CHECK_FALSE(emits({"black", m, {}, false}));
}

}  // namespace dg
