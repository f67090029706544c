// layers_test.cpp -- coat, sheen, anisotropic and iridescent lobes against the formulas of their extensions, and their
// parameters and textures at a hit.
#include <doctest/doctest.h>

#include "material/bsdf_check.h"
#include "material/material.h"
#include "material/test_hits.h"
#include "math/error.h"

namespace dg {
namespace {

using namespace check;
using namespace test;

const Vec3f kN{0, 0, 1};

template <typename B>
B shaded(const GltfMaterial& m, const std::vector<Texture>& textures, SurfaceHit hit) {
    return std::get<B>(shade({"m", m, {}, false}, textures, hit, wavelengths()));
}

const std::vector<Texture> kTexels{texel({51, 102, 204, 153})};  // 0.2, 0.4, 0.8, 0.6

}  // namespace

TEST_CASE("stretched facets: D and V of KHR_materials_anisotropy") {
    Random random{5};
    const double at = 0.7, ab = 0.2;
    const StretchedGgx ggx{{1, 0, 0}, {0, 1, 0}, 0.7f, 0.2f};
    for (int i = 0; i < 200; ++i) {
        Vec3f wo = random.direction(), wi = random.direction();
        wo.z = std::abs(wo.z);
        wi.z = std::abs(wi.z);
        const Vec3d v = to_double(wo), l = to_double(wi), h = normalize(v + l);
        const double a2 = at * ab;
        const Vec3d f{ab * h.x, at * h.y, a2 * h.z};
        const double w2 = a2 / dot(f, f), d = a2 * w2 * w2 / kPiD;
        const double vis = 0.5 / (l.z * length(Vec3d{at * v.x, ab * v.y, v.z}) +
                                  v.z * length(Vec3d{at * l.x, ab * l.y, l.z}));
        const Facet facet = reflecting_facet(kN, wo, wi, wo.z, wi.z, ggx);
        CHECK(facet.f_cos == doctest::Approx(d * vis * l.z).epsilon(1e-3));
    }
}

TEST_CASE("anisotropy: strength, rotation and texture decide the two roughnesses") {
    GltfMaterial m;
    m.roughness = 0.5f;
    m.anisotropy.strength = 0.6f;
    GltfBsdf b = shaded<GltfBsdf>(m, {}, hit_from({0, 0, 1}));
    REQUIRE(b.stretched);
    CHECK(b.stretched->alpha_t == doctest::Approx(0.25 * (1 - 0.36) + 0.36));
    CHECK(b.stretched->alpha_b == doctest::Approx(0.25));
    CHECK(b.stretched->tangent.x == doctest::Approx(1));
    m.anisotropy.rotation = kPi / 2;
    b = shaded<GltfBsdf>(m, {}, hit_from({0, 0, 1}));
    CHECK(b.stretched->tangent.y == doctest::Approx(1));  // counter-clockwise
    SurfaceHit mirrored = hit_from({0, 0, 1});
    mirrored.tangent_sign = -1;
    CHECK(shaded<GltfBsdf>(m, {}, mirrored).stretched->tangent.y == doctest::Approx(-1));
    // (0.2, 0.4) is the direction (-0.6, -0.2), a quarter turn on (0.2, -0.6); B is 0.8.
    m.anisotropy.texture = slot(0);
    b = shaded<GltfBsdf>(m, kTexels, hit_from({0, 0, 1}));
    CHECK(b.stretched->tangent.x == doctest::Approx(0.2 / std::sqrt(0.4)));
    CHECK(b.stretched->tangent.y == doctest::Approx(-0.6 / std::sqrt(0.4)));
    CHECK(b.stretched->alpha_t == doctest::Approx(0.25 + 0.75 * 0.48 * 0.48));
    m.anisotropy.strength = 0;
    CHECK_FALSE(shaded<GltfBsdf>(m, kTexels, hit_from({0, 0, 1})).stretched);
}

TEST_CASE("the clear coat: mix(base, specular_brdf, factor F(|N.V|))") {
    GltfMaterial m;
    m.metallic = 0;
    m.specular = 0;  // Lambertian base
    m.base_color = {0.5f, 0.5f, 0.5f};
    m.clearcoat.factor = 0.8f;
    m.clearcoat.roughness = 0.6f;
    const Vec3d v = normalize(Vec3d{0.8, 0, 0.5}), l = normalize(Vec3d{-0.5, 0.3, 0.7});
    const auto b = shaded<LayeredBsdf>(m, {}, hit_from(to_float(v)));
    const double alpha = 0.36, a2 = alpha * alpha;
    const Vec3d h = normalize(v + l);
    const double d = a2 / (kPiD * std::pow(h.z * h.z * (a2 - 1) + 1, 2));
    const double vis = 0.5 / (l.z * std::sqrt(v.z * v.z * (1 - a2) + a2) +
                              v.z * std::sqrt(l.z * l.z * (1 - a2) + a2));
    const double share = 0.8 * (0.04 + 0.96 * std::pow(1 - v.z, 5));
    const double wanted = ((1 - share) * 0.5 / kPiD + share * d * vis) * l.z;
    CHECK(b.evaluate(to_float(v), to_float(l))[1] == doctest::Approx(wanted).epsilon(1e-4));
}

TEST_CASE("textures of the coat: R factor, G roughness, and a normal of its own") {
    GltfMaterial m;
    m.clearcoat.factor = m.clearcoat.roughness = 1;
    m.clearcoat.texture = m.clearcoat.roughness_texture = slot(0);
    m.normal_texture = slot(1);
    const std::vector<Texture> textures{kTexels[0], texel({255, 128, 200})};
    const auto plain = shaded<LayeredBsdf>(m, textures, hit_from({0.1f, 0, 1}));
    CHECK(plain.coat.factor == doctest::Approx(0.2));
    CHECK(plain.coat.alpha == doctest::Approx(0.16));
    CHECK(plain.coat.ns == kN);  // the coat ignores the base's normal map
    CHECK(plain.base.ns.x > 0.3f);
    m.clearcoat.normal_texture = slot(1);
    m.clearcoat.normal_scale = 0.5f;
    const auto bumped = shaded<LayeredBsdf>(m, textures, hit_from({0.1f, 0, 1}));
    CHECK(bumped.coat.ns.x / bumped.coat.ns.z ==
          doctest::Approx(0.5 / (2 * 200 / 255. - 1)).epsilon(1e-3));
    // A normal that faces away is adjusted to face the viewer.
    const auto grazing = shaded<LayeredBsdf>(m, textures, hit_from({-1, 0, 0.1f}));
    CHECK(dot(grazing.coat.ns, normalize(Vec3f{-1, 0, 0.1f})) > 0);
}

TEST_CASE("what goes straight through a window is what sample() lets through") {
    GltfMaterial m;
    m.metallic = m.roughness = 0;
    m.transmission = 0.9f;
    m.clearcoat.factor = 0.7f;
    m.sheen.color = {0.2f, 0.4f, 0.3f};
    m.sheen.roughness = 0.5f;
    m.iridescence.factor = 1;
    const SurfaceHit hit = hit_from({0.7f, 0.2f, 0.6f});
    const auto b = shaded<LayeredBsdf>(m, {}, hit);
    Random random{3};
    double sum = 0;
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i) {
        const float u_lobe = random.next();
        const auto s = b.sample(hit.wo, u_lobe, random.next_2d());
        if (s && s->transmitted && s->specular) sum += s->weight[1];
    }
    CHECK(b.straight_transmittance(hit.wo)[1] == doctest::Approx(sum / kCount).epsilon(0.02));
}

TEST_CASE("emission is seen through the coat") {
    GltfMaterial m;
    m.emissive = {10, 5, 1};
    m.clearcoat.factor = 0.5f;
    const Material material{"lamp", m, {2, 0, 0}, false};
    const SurfaceHit hit = hit_from({std::sqrt(0.75f), 0, 0.5f});
    const double kept = 1 - 0.5 * (0.04 + 0.96 / 32);
    CHECK(emitted(material, {}, hit).x == doctest::Approx(12 * kept));
    CHECK(emitted(material, {}, hit).z == doctest::Approx(kept));
    CHECK(emission_is_coated(material));
}

TEST_CASE("textures of sheen: RGB colour, A roughness") {
    GltfMaterial m;
    m.sheen.color = {1, 0.5f, 1};
    m.sheen.roughness = 0.9f;
    m.sheen.color_texture = m.sheen.roughness_texture = slot(0);
    const auto b = shaded<LayeredBsdf>(m, kTexels, hit_from({0, 0, 1}));
    CHECK(b.sheen.color[0] == doctest::Approx(0.8));  // the test's blue lane
    CHECK(b.sheen.color[1] == doctest::Approx(0.2));
    CHECK(b.sheen.color[2] == doctest::Approx(0.2));
    CHECK(b.sheen.largest == doctest::Approx(0.8));
    CHECK(b.sheen.alpha == doctest::Approx(0.54 * 0.54));
    m.sheen.color = {0, 0, 0};
    shaded<GltfBsdf>(m, kTexels, hit_from({0, 0, 1}));  // no layers
}

TEST_CASE("iridescence: factor R, thickness G between its ends, the outside of a coat") {
    GltfMaterial m;
    m.iridescence = {1, {}, 1.4f, 200, 700, {}};
    CHECK(shaded<GltfBsdf>(m, {}, hit_from({0, 0, 1})).film->film.thickness == 700);
    m.iridescence.texture = m.iridescence.thickness_texture = slot(0);
    const auto b = shaded<GltfBsdf>(m, kTexels, hit_from({0, 0, 1}));
    REQUIRE(b.film);
    CHECK(b.film->factor == doctest::Approx(0.2));
    CHECK(b.film->film.thickness == doctest::Approx(400));
    CHECK(b.film->film.ior == 1.4f);
    CHECK(b.film->film.outside == 1);
    CHECK(b.film->film.wavelengths[2] == wavelengths().nm[2]);
    m.clearcoat.factor = 1;
    CHECK(shaded<LayeredBsdf>(m, kTexels, hit_from({0, 0, 1})).base.film->film.outside ==
          doctest::Approx(1.5));
}

TEST_CASE("F = mix(Schlick, film, factor) on metal and dielectric") {
    GltfMaterial m;
    m.base_color = {0.5f, 0.5f, 0.5f};
    m.roughness = 0;
    m.iridescence = {0.4f, {}, 1.6f, 100, 500, {}};
    const float cos_o = 0.6f;
    const SurfaceHit hit = hit_from({0.8f, 0, cos_o});
    const ThinFilm film{1.6f, 500, 1, wavelengths().nm};
    for (float metallic : {0.f, 0.3f, 1.f}) {
        m.metallic = metallic;
        const Spectrum f = shaded<GltfBsdf>(m, {}, hit).film->mixed(0.f, cos_o);
        const Spectrum wanted = film.reflectance(cos_o, index_of_f0(0.5f)) * metallic +
                                film.reflectance(cos_o, 1.5f) * (1 - metallic);
        for (int k = 0; k < kWavelengths; ++k)
            CHECK(f[k] == doctest::Approx(0.4 * wanted[k]).epsilon(1e-3));
    }
    const auto s = shaded<GltfBsdf>(m, {}, hit).sample(hit.wo, 0.5f, {0.5f, 0.5f});
    REQUIRE(s);
    const double schlick = 0.5 + 0.5 * std::pow(0.4, 5);
    const Spectrum full = film.reflectance(cos_o, index_of_f0(0.5f));
    CHECK(s->weight[0] == doctest::Approx(0.6 * schlick + 0.4 * full[0]).epsilon(1e-3));
}

TEST_CASE("no parameters make light") {
    Random random{17};
    const auto u = [&] { return random.next(); };
    for (int i = 0; i < 400; ++i) {
        GltfMaterial m;
        m.metallic = u() < 0.5f ? 0.f : u();
        m.roughness = u();
        m.specular = u() < 0.5f ? 1.f : u();
        m.ior = 1 + u();
        m.transmission = u() < 0.6f ? 0.f : u();
        m.clearcoat = {u() < 0.5f ? 0.f : u(), {}, u(), {}, 1, {}};
        if (u() < 0.5f) m.sheen.color = {u(), u(), u()};
        m.sheen.roughness = u();
        m.anisotropy = {u() < 0.5f ? 0.f : u(), 6 * u(), {}};
        m.iridescence = {u() < 0.5f ? 0.f : u(), {}, 1 + 1.5f * u(), 0, 1000 * u(), {}};
        SurfaceHit hit = hit_from({u() - 0.5f, u() - 0.5f, 0.02f + u()});
        const Bsdf bsdf = shade({"m", m, {}, false}, {}, hit, wavelengths());
        const Setting s{Frame::from_normal(kN), hit.wo, 1};
        const Albedo a = std::visit(
            [&](const auto& b) { return albedo_by_sampling(b, s, 1500, i); }, bsdf);
        CAPTURE(i);
        for (int k = 0; k < kWavelengths; ++k)
            CHECK(a.value[k] < 1.006 + 4 * a.error[k]);
    }
}

TEST_CASE("factors of the layers out of range are refused by name") {
    const auto refused = [](auto change, const char* field) {
        GltfMaterial m;
        change(m);
        std::string message;
        try {
            validate({"m", m, {}, false}, {});
        } catch (const Error& e) {
            message = e.what();
        }
        CAPTURE(message);
        CHECK(message.find(field) != std::string::npos);
    };
    refused([](auto& m) { m.clearcoat.factor = 1.1f; }, "clearcoat");
    refused([](auto& m) { m.clearcoat.roughness = -1; }, "clearcoat_roughness");
    refused([](auto& m) { m.clearcoat.normal_scale = NAN; }, "clearcoat_normal_scale");
    refused([](auto& m) { m.clearcoat.texture = slot(0); }, "clearcoat_texture");
    refused([](auto& m) { m.sheen.color = {0, 2, 0}; }, "sheen_color");
    refused([](auto& m) { m.sheen.roughness = NAN; }, "sheen_roughness");
    refused([](auto& m) { m.anisotropy.strength = 2; }, "anisotropy");
    refused([](auto& m) { m.anisotropy.rotation = INFINITY; }, "anisotropy_rotation");
    refused([](auto& m) { m.iridescence.factor = -0.1f; }, "iridescence");
    refused([](auto& m) { m.iridescence.ior = 0.9f; }, "iridescence_ior");
    refused([](auto& m) { m.iridescence.thickness_max = -1; }, "thickness_max_nm");
}

}  // namespace dg
