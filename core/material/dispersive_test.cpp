// dispersive_test.cpp -- dispersive glass, compared with Cauchy's, Snell's and Fresnel's formulas in double.
#include "material/dispersive.h"

#include <doctest/doctest.h>

#include <cmath>

#include "material/bsdf_check.h"
#include "material/material.h"

namespace dg {
namespace {

constexpr float kDispersion = 0.625f;  // polycarbonate, V = 32

/// KHR_materials_dispersion: A + B / nm^2 through the three lines that define V.
double cauchy(double nm, double n_d, double abbe) {
    const double f = 1 / (486.1 * 486.1), c = 1 / (656.3 * 656.3);
    const double b = (n_d - 1) / (abbe * (f - c));
    return n_d - b / (587.6 * 587.6) + b / (nm * nm);
}

double fresnel(double cos_i, double eta) {
    const double sin2 = (1 - cos_i * cos_i) / (eta * eta);
    if (sin2 >= 1) return 1;
    const double cos_t = std::sqrt(1 - sin2);
    const double s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    const double p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return (s * s + p * p) / 2;
}

Material glass(float n_d, float alpha = 0) {
    return {"glass", DielectricMaterial{n_d, alpha, {1, 1, 1}, kDispersion}, {}, false};
}
Material gltf_glass(float n_d, float roughness = 0) {
    GltfMaterial m;
    m.metallic = 0;
    m.roughness = roughness;
    m.ior = n_d;
    m.transmission = m.thickness = 1;
    m.dispersion = kDispersion;
    return {"gltf glass", m, {}, false};
}

SurfaceHit hit(Vec3f ng, Vec3f wo) {
    SurfaceHit h;
    h.ng = h.ns = ng;
    h.wo = wo;
    h.front = dot(ng, wo) > 0;
    return h;
}

/// Samples transmission at a smooth interface.
BsdfSample bent(const Material& m, Vec3f ng, Vec3f wo, const Wavelengths& wl) {
    SurfaceHit h = hit(ng, wo);
    const auto s = sample(shade(m, {}, h, wl), wo, 0.99999f, {0.5f, 0.5f});
    REQUIRE(s.has_value());
    REQUIRE(s->transmitted);
    return *s;
}

}  // namespace

TEST_CASE("the index follows the Abbe number, and is never below 1") {
    const Spectrum nm{486.1f, 587.6f, 656.3f, 405};
    const Spectrum n = dispersed_ior(1.585f, kDispersion, nm);
    for (int k = 0; k < kWavelengths; ++k)
        CHECK(n[k] == doctest::Approx(cauchy(nm[k], 1.585, 32)).epsilon(1e-5));
    CHECK((n[1] - 1) / (n[0] - n[2]) == doctest::Approx(32).epsilon(1e-3));
    CHECK(dispersed_ior(1.5f, 60, {700, 780, 400, 587.6f})[1] == 1);
    CHECK(dispersed_ior(1, 1, nm)[3] == 1);
}

TEST_CASE("a prism deviates each hero as Snell's law does for its own index") {
    // At the minimum of deviation: D = 2 asin(n sin(A / 2)) - A.
    const double half = 30 * kPiD / 180;
    const Vec3f in{-std::cos(float(half)), std::sin(float(half)), 0};
    const Vec3f out{-in.x, in.y, 0};
    for (const Material& m : {glass(1.585f), gltf_glass(1.585f)}) {
        double red = 0, violet = 0;
        for (float u : {0.01f, 0.2f, 0.45f, 0.7f, 0.99f}) {
            Wavelengths wl = Wavelengths::sample(u);
            const double n = cauchy(wl.nm[0], 1.585, 32), i = std::asin(n * std::sin(half));
            // The incident ray lies i above the normal of the first face, toward the base.
            const double angle = i - half;
            const Vec3f travels{std::cos(float(angle)), std::sin(float(angle)), 0};
            const BsdfSample first = bent(m, in, -travels, wl);
            CHECK(first.hero_only);
            CHECK(first.wi.y == doctest::Approx(0).epsilon(1e-5));  // parallel to the base
            CHECK(first.weight[0] > 0);
            for (int k = 1; k < kWavelengths; ++k) CHECK(first.weight[k] == 0);
            wl.secondary_ended = true;
            const BsdfSample second = bent(m, out, -first.wi, wl);
            CHECK_FALSE(second.hero_only);
            const double deviation = std::acos(double(dot(travels, second.wi)));
            CHECK(deviation == doctest::Approx(2 * i - 2 * half).epsilon(1e-4));
            (wl.nm[0] > 600 ? red : violet) = deviation;
        }
        CHECK(violet > red + 0.01);
    }
}

TEST_CASE("each wavelength keeps its own reflectance, up to total reflection") {
    const Wavelengths wl = Wavelengths::sample(0.1f);
    for (const Material& m : {glass(1.585f), gltf_glass(1.585f)}) {
        // From the front, and from inside where only some wavelengths are totally reflected.
        for (const double angle : {20.0, 75.0, -10.0, -38.6, -39.0, -39.4}) {
            const float c = float(std::cos(angle * kPiD / 180));
            const float s = float(std::sin(angle * kPiD / 180));
            const Vec3f wo{s, 0, std::copysign(c, float(angle))};
            SurfaceHit h = hit({0, 0, 1}, wo);
            const auto up = sample(shade(m, {}, h, wl), wo, 0, {0.5f, 0.5f});
            REQUIRE(up.has_value());
            CHECK_FALSE(up->hero_only);
            for (int k = 0; k < kWavelengths; ++k) {
                const double n = cauchy(wl.nm[k], 1.585, 32);
                const double wanted = fresnel(c, angle > 0 ? n : 1 / n);
                CHECK(up->weight[k] * up->pdf == doctest::Approx(wanted).epsilon(3e-3));
            }
        }
    }
}

TEST_CASE("over the four possible heroes no wavelength gains or loses light") {
    for (const float u : {0.07f, 0.61f}) {
        for (const float slant : {0.3f, -0.9f}) {
            const Vec3f wo = normalize(Vec3f{1, 0.2f, slant});
            const auto total = [&](const Material& m) {
                double sum = 0;  // of wavelength k over all heroes
                for (int k = 0; k < kWavelengths; ++k) {
                    Wavelengths wl = Wavelengths::sample(std::fmod(u + k * 0.25f, 1.f));
                    const int lane = (kWavelengths - k) % kWavelengths;
                    SurfaceHit h = hit({0, 0, 1}, wo);
                    const Bsdf b = shade(m, {}, h, wl);
                    const float n = dispersed_ior(1.585f, kDispersion, wl.nm)[0];
                    const check::Setting s{Frame::from_normal({0, 0, 1}), wo,
                                           wo.z > 0 ? n : 1 / n};
                    sum += std::visit(
                        [&](const auto& x) {
                            return check::albedo_by_quadrature(x, s).value[lane];
                        },
                        b);
                }
                return sum / kWavelengths;
            };
            CHECK(total(glass(1.585f)) == doctest::Approx(1).epsilon(1e-4));
            CHECK(total(gltf_glass(1.585f)) == doctest::Approx(1).epsilon(1e-4));
            CHECK(total(glass(1.585f, 0.3f)) < 1.001);
            CHECK(total(gltf_glass(1.585f, 0.5f)) < 1.001);
        }
    }
}

TEST_CASE("a thin wall and a path that has lost its secondary wavelengths disperse nothing") {
    Wavelengths wl = Wavelengths::sample(0.3f);
    Material thin = gltf_glass(1.585f);
    std::get<GltfMaterial>(thin.kind).thickness = 0;
    const Vec3f wo{0.6f, 0, 0.8f};
    CHECK_FALSE(bent(thin, {0, 0, 1}, wo, wl).hero_only);
    wl.secondary_ended = true;
    const BsdfSample s = bent(gltf_glass(1.585f), {0, 0, 1}, wo, wl);
    CHECK_FALSE(s.hero_only);
    CHECK(s.weight[0] == s.weight[3]);
}

}  // namespace dg
