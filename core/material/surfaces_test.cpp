// surfaces_test.cpp -- the kinds of surfaces.h at a hit: textures, spectra, roughness, sides, mixtures, opacity.
#include "material/surfaces.h"

#include <doctest/doctest.h>

#include <cmath>

#include "material/material_needs.h"
#include "material/test_hits.h"
#include "math/error.h"

namespace dg {
namespace {

using namespace test;

const Vec3f kUp{0, 0, 1};

Material made(decltype(Material::kind) kind) {
    Material m;
    m.name = "m";
    m.kind = std::move(kind);
    return m;
}

Bsdf shaded(const Material& m, const std::vector<Texture>& textures, SurfaceHit hit) {
    return shade(m, textures, hit, wavelengths());
}

std::shared_ptr<const SampledSpectrum> spectrum(std::vector<double> nm, std::vector<double> values) {
    return std::make_shared<const SampledSpectrum>(nm, values);
}

void check_spectrum(Spectrum s, Spectrum wanted) {
    for (int k = 0; k < kWavelengths; ++k) CHECK(s[k] == doctest::Approx(wanted[k]).epsilon(1e-4));
}

}  // namespace

TEST_CASE("diffuse: factor x texture x vertex colour on this side, factor x texture on the other") {
    const std::vector<Texture> textures{texel({255, 128, 51}), texel({51, 255, 102})};
    DiffuseMaterial m{{0.5f, 0.5f, 1}, slot(0)};
    SurfaceHit h = hit_from(kUp);
    h.color[0] = 0.5f;
    const auto pi_f = [&](Vec3f wi) { return evaluate_with_pdf(shaded(made(m), textures, h), kUp, wi).f_cos * kPi; };
    const Rgb r{0.25f, 0.5f * 128 / 255, 0.2f}, t{0.5f * 0.2f, 0.5f, 0.5f * 0.4f};
    check_spectrum(pi_f(kUp), wavelengths().reflectance(r));
    CHECK(std::holds_alternative<DiffuseBsdf>(shaded(made(m), textures, h)));
    m.transmittance = {0.5f, 0.5f, 0.5f};
    m.transmittance_texture = slot(1);
    check_spectrum(pi_f(kUp), wavelengths().reflectance(r));
    check_spectrum(pi_f(-kUp), wavelengths().reflectance(t));
    m = {{1, 1, 1}, {}, {1, 1, 1}};   // would gain energy
    check_spectrum(pi_f(kUp) + pi_f(-kUp), Spectrum(0.75f) + 0.25f * Spectrum(1.f));
}

TEST_CASE("a spectrum in place of a colour is read at the wavelengths, and multiplied by a texture") {
    const std::vector<Texture> textures{texel({128, 128, 128})};
    DiffuseMaterial m;
    m.reflectance = spectrum({400, 700}, {0.2, 0.8});
    const Spectrum nm = wavelengths().nm;
    Spectrum wanted;
    for (int k = 0; k < kWavelengths; ++k) wanted.set(k, 0.2f + 0.6f * std::clamp((nm[k] - 400) / 300, 0.f, 1.f));
    const SurfaceHit h = hit_from(kUp);
    const auto pi_f = [&] { return evaluate_with_pdf(shaded(made(m), textures, h), kUp, kUp).f_cos * kPi; };
    check_spectrum(pi_f(), wanted);
    m.reflectance_texture = slot(0);
    check_spectrum(pi_f(), wanted * wavelengths().reflectance({128 / 255.f, 128 / 255.f, 128 / 255.f}));
}

TEST_CASE("roughness textures: R on alpha along u, G along v; the kind of BSDF is the simplest that does") {
    const std::vector<Texture> textures{texel({102, 204, 0}), texel({51})};
    ConductorMaterial m{{1, 1, 1}, {0.5f, 1, slot(0)}};
    const auto metal = std::get<MetalBsdf>(shaded(made(m), textures, hit_from(kUp)));
    CHECK(metal.facets.ggx.alpha_t == doctest::Approx(0.2));
    CHECK(metal.facets.ggx.alpha_b == doctest::Approx(0.8));
    CHECK(metal.facets.ggx.tangent == Vec3f{1, 0, 0});
    m.alpha = {0.5f, 0.5f, slot(1)};   // grey: equal factors on both axes
    CHECK(std::get<ConductorBsdf>(shaded(made(m), textures, hit_from(kUp))).alpha == doctest::Approx(0.1));
    DielectricMaterial glass{1.5f, {0.5f, 0.5f, slot(1)}};
    CHECK(std::get<DielectricBsdf>(shaded(made(glass), textures, hit_from(kUp))).alpha == doctest::Approx(0.1));
    CHECK(clearness(made(glass)) == Clear::volume);   // may be smooth at some points
    glass.thin = true;
    CHECK(clearness(made(glass)) == Clear::sheet);
    CHECK(std::get<GlassBsdf>(shaded(made(glass), textures, hit_from(kUp))).thin);
    glass.alpha = 0.5f;
    CHECK(clearness(made(glass)) == Clear::no);
}

TEST_CASE("Beckmann's facets go to the kinds of BSDF that have them; smooth ones are as smooth as those of GGX") {
    const Roughness rough{0.3f, 0.3f, {}, Distribution::beckmann};
    ConductorMaterial metal{{1, 1, 1}, rough};
    const auto facets_of = [](const auto& b) { return b.facets.distribution; };
    CHECK(facets_of(std::get<MetalBsdf>(shaded(made(metal), {}, hit_from(kUp)))) == Distribution::beckmann);
    CHECK(facets_of(std::get<GlassBsdf>(shaded(made(DielectricMaterial{1.5f, rough}), {}, hit_from(kUp)))) ==
          Distribution::beckmann);
    CoatedMaterial coated;
    coated.alpha = rough;
    const Vec3f wo = normalize(Vec3f{0.3f, 0, 1}), tail = normalize(Vec3f{0.7f, 0, 0.6f});
    const float beckmann = evaluate_with_pdf(shaded(made(coated), {}, hit_from(wo)), wo, tail).f_cos[0];
    coated.alpha = {0.3f, 0.3f};
    const float ggx = evaluate_with_pdf(shaded(made(coated), {}, hit_from(wo)), wo, tail).f_cos[0];
    CHECK(std::abs(ggx - beckmann) > 1e-3f * ggx);
    metal.alpha = {0, 0, {}, Distribution::beckmann};
    CHECK(is_specular(shaded(made(metal), {}, hit_from(kUp))));
}

TEST_CASE("glass by a table of indices goes the hero's way, and reflects each wavelength by its own") {
    DielectricMaterial m;
    m.ior_by_wavelength = spectrum({400, 700}, {1.6, 1.5});
    const auto glass = std::get<DielectricBsdf>(shaded(made(m), {}, hit_from(kUp)));
    CHECK(glass.disperses);
    for (int k = 0; k < kWavelengths; ++k)
        CHECK(glass.iors[k] == doctest::Approx(m.ior_by_wavelength->at(wavelengths().nm[k])));
    CHECK(glass.ior == glass.iors[0]);
}

TEST_CASE("metals under a coat have the index relative to it") {
    CoatedMaterial m;
    m.metal = true;
    m.conductor.fresnel = true;
    m.conductor.alpha = 0;
    m.conductor.eta = {1.5f, 1.5f, 1.5f};   // equal to the coat's index: no reflection
    const auto s = sample(shaded(made(m), {}, hit_from(kUp)), kUp, 0.5f, {0.5f, 0.5f});
    REQUIRE(s);
    CHECK(s->weight[0] == doctest::Approx(0.04));
}

TEST_CASE("a one-sided surface is black from behind, and shines there if it does") {
    for (const bool two_sided : {true, false}) {
        Material m = made(DiffuseMaterial{{1, 1, 1}});
        m.two_sided = two_sided;
        m.emission = {3, 3, 3};
        m.two_sided_emission = true;
        const SurfaceHit behind = hit_from(-kUp);
        CHECK(evaluate_with_pdf(shaded(m, {}, behind), -kUp, -kUp).f_cos.is_black() != two_sided);
        CHECK(emitted(m, {}, behind) == Rgb{3, 3, 3});
        CHECK_FALSE(evaluate_with_pdf(shaded(m, {}, hit_from(kUp)), kUp, kUp).f_cos.is_black());
        CHECK(is_one_sided(m) != two_sided);
    }
}

TEST_CASE("normal map, opacity and emission texture of any kind") {
    const std::vector<Texture> textures{texel({204, 128, 230}), texel({128}), texel({255, 51, 0})};
    Material m = made(ConductorMaterial{});
    m.normal_texture = slot(0);
    SurfaceHit h = hit_from(kUp);
    shade(m, textures, h, wavelengths());
    CHECK(h.ns.x == doctest::Approx(0.6).epsilon(0.01));
    CHECK(has_normal_map(m));
    CHECK(tangent_set(m) == 0);
    CHECK_FALSE(has_cutout(m, textures));
    m.opacity = 0.5f;
    m.opacity_texture = slot(1);
    CHECK(has_cutout(m, textures));
    CHECK(opacity(m, textures, h.uv, 1) == doctest::Approx(0.5 * 128 / 255));
    m.emission = {10, 10, 10};
    m.emission_texture = slot(2);
    const Rgb l = emitted(m, textures, hit_from(kUp));
    CHECK(l.x == doctest::Approx(10));
    CHECK(l.y == doctest::Approx(2));
    CHECK(l.z == doctest::Approx(0));
    CHECK(uses_textures(m));
    CHECK_FALSE(uses_textures(made(ConductorMaterial{})));
}

TEST_CASE("a mixture is one of its parts, by the hit's choice and what is there of either") {
    const std::vector<Texture> textures{texel({128})};
    std::vector<Material> all{made(DiffuseMaterial{{1, 1, 1}}), made(DielectricMaterial{}), made(BoundaryMaterial{}),
                              made(MixMaterial{0, 1, 0.25f}), made(MixMaterial{3, 2, 0.5f})};
    link_mixtures(all, {});
    const auto kind = [&](std::size_t material, float choice) {
        SurfaceHit h = hit_from(kUp);
        h.choice = choice;
        const Bsdf b = shaded(all[material], textures, h);
        CHECK(h.choice == choice);
        if (std::holds_alternative<DiffuseBsdf>(b)) return 0;
        return std::get<DielectricBsdf>(b).ior == 1 ? 2 : 1;
    };
    const auto shares = [&](std::size_t material) {
        std::array<double, 3> count{};
        for (int i = 0; i < 1000; ++i) count[std::size_t(kind(material, (i + 0.5f) / 1000))] += 1e-3;
        return count;
    };
    CHECK(shares(3)[1] == doctest::Approx(0.25).epsilon(0.01));
    CHECK(shares(4)[2] == doctest::Approx(0.5).epsilon(0.01));
    CHECK(shares(4)[1] == doctest::Approx(0.125).epsilon(0.02));
    std::get<MixMaterial>(all[3].kind).amount_texture = slot(0);
    CHECK(shares(3)[1] == doctest::Approx(0.25 * 128 / 255).epsilon(0.02));
    std::get<MixMaterial>(all[3].kind).amount_texture = {};
    // Half of the glass is cut out: glass stops 0.125 of the rays, paint 0.75.
    all[1].opacity = 0.5f;
    CHECK(has_cutout(all[4], textures));
    CHECK(opacity(all[3], textures, hit_from(kUp).uv, 1) == doctest::Approx(0.875));
    CHECK(shares(3)[1] == doctest::Approx(0.125 / 0.875).epsilon(0.02));
    CHECK(clearness(all[3]) == Clear::volume);
    CHECK(clearness(all[4]) == Clear::sheet);
    all[0].two_sided = false;
    CHECK(is_one_sided(all[4]));
    CHECK(makes_caustics(all[4]));
}

TEST_CASE("validate names the fields of surfaces") {
    const std::vector<Texture> textures;
    const auto refused = [&](decltype(Material::kind) kind, const char* field) {
        CHECK_THROWS_WITH_AS(validate(made(kind), textures), doctest::Contains(field), Error);
    };
    CHECK_NOTHROW(validate(made(CoatedMaterial{}), textures));
    refused(DiffuseMaterial{{0.5f, 0.5f, 0.5f}, slot(0)}, "reflectance_texture");
    DiffuseMaterial bright;
    bright.reflectance = spectrum({500}, {1.5});
    refused(bright, "reflectance: wanted a number from 0 to 1, got 1.5");
    refused(ConductorMaterial{{1, 1, 1}, {0.1f, 2}}, "alpha_v");
    DielectricMaterial heavy;
    heavy.ior_by_wavelength = spectrum({500}, {12});
    refused(heavy, "ior");
    CoatedMaterial coat;
    coat.ior = 0.9f;
    refused(coat, "ior");
    coat.ior = 1.5f;
    coat.diffuse.transmittance = {0.5f, 0, 0};
    refused(coat, "base: transmittance");
    refused(MixMaterial{0, 0, 1.5f}, "amount");
    Material faint = made(BoundaryMaterial{});
    faint.opacity = -0.5f;
    CHECK_THROWS_WITH_AS(validate(faint, textures), doctest::Contains("opacity"), Error);
}

}  // namespace dg
