// coated_test.cpp -- coats over diffuse surfaces and metals: energy, saturation, and closed forms of smooth coats.
#include "material/bsdf_coated.h"

#include <doctest/doctest.h>

#include "material/bsdf_check.h"
#include "material/bsdf_glass.h"

namespace dg {
namespace {

const Vec3f kUp{0, 0, 1};

Vec3f at_cosine(float z) { return {std::sqrt(1 - z * z), 0, z}; }

CoatedBsdf plastic(Spectrum diffuse, float alpha, float ior = 1.5f, bool linear = false, Spectrum depth = 0.f) {
    ClearCoat coat{ior, {kUp, {1, 0, 0}, alpha, alpha}, 1.f, depth, linear};
    return {kUp, kUp, coat, {.diffuse = diffuse}};
}

/// Plastic without compensation of light blocked by the coat's facets.
CoatedBsdf lossy(Spectrum diffuse, float alpha, float ior, bool linear = false) {
    ClearCoat coat{ior, {kUp, {1, 0, 0}, alpha, alpha}, 1.f, 0.f, linear, false};
    return {kUp, kUp, coat, {.diffuse = diffuse}};
}

CoatedBsdf coated_metal(MetalReflectance metal, float alpha, float coat_alpha, Spectrum depth = 0.f) {
    ClearCoat coat{1.5f, {kUp, {1, 0, 0}, coat_alpha, coat_alpha}, 1.f, depth};
    return {kUp, kUp, coat, {.metal = true, .reflectance = metal, .facets = {kUp, {1, 0, 0}, alpha, alpha}}};
}

check::Albedo seen(const CoatedBsdf& b, float z) {
    return check::albedo_by_quadrature(b, {Frame::from_normal(kUp), at_cosine(z), 1});
}

/// Reference for a smooth coat over a Lambertian base: traces rays between both.
double by_following(float diffuse, float z, float n, double depth, std::uint64_t seed) {
    constexpr int kCount = 400000;
    check::Random random{seed};
    double sum = kCount * double(fresnel_dielectric(z, n));
    const double down = std::exp(-depth / std::sqrt(1 - (1 - z * z) / (n * n)));
    for (int i = 0; i < kCount; ++i) {
        double left = (1 - fresnel_dielectric(z, n)) * down;
        while (left > 1e-5) {
            left *= diffuse;
            const float c = std::sqrt(random.next() * (1 - 1e-6f) + 1e-6f);   // cosine distribution
            left *= std::exp(-depth / c);
            const double r = fresnel_dielectric(c, 1 / n);
            sum += left * (1 - r);
            left *= r * std::exp(-depth / c);
        }
    }
    return sum / kCount;
}

/// Reference for a rough coat over a Lambertian base, with facets that reflect, transmit or block, by single-scattering
/// glass.
double by_facets(float diffuse, float alpha, float z, float n, std::uint64_t seed) {
    constexpr int kCount = 300000;
    GlassBsdf interface{kUp, kUp, 1.f, 1.f, n};
    interface.iors = n, interface.facets = {kUp, {1, 0, 0}, alpha, alpha};
    check::Random random{seed};
    double sum = 0;
    for (int i = 0; i < kCount; ++i) {
        double left = 1;
        for (Vec3f wo = at_cosine(z); left > 1e-5;) {
            const float u_lobe = random.next();
            const auto s = interface.sample(wo, u_lobe, random.next_2d());
            if (!s) break;
            const bool through = (s->wi.z > 0) != (wo.z > 0);   // radiance is scaled by 1 / eta^2
            left *= double(s->weight[0]) * (!through ? 1 : wo.z > 0 ? double(n) * n : 1 / (double(n) * n));
            if (s->wi.z > 0) {
                sum += left;
                break;
            }
            left *= diffuse;
            const float c = std::sqrt(random.next() * (1 - 1e-6f) + 1e-6f);   // up from the base, cosine distribution
            wo = {std::sqrt(1 - c * c), 0, -c};
        }
    }
    return sum / kCount;
}

}  // namespace

TEST_CASE("without compensation plastic loses what light does that its facets block") {
    for (const float n : {1.33f, 1.5f, 2.f}) {
        for (const float alpha : {0.15f, 0.4f, 0.9f}) {
            for (const float z : {0.95f, 0.5f, 0.25f}) {
                CAPTURE(n);
                CAPTURE(alpha);
                CAPTURE(z);
                const double followed = by_facets(0.8f, alpha, z, n, 21);
                CHECK(seen(lossy(0.8f, alpha, n), z).value[0] == doctest::Approx(followed).epsilon(0.012));
                CHECK(seen(lossy(0.8f, alpha, n, true), z).value[0] > followed);   // light does not depend on the base
                if (alpha > 0.2f)   // planted fault: no loss
                    CHECK(seen(plastic(0.8f, alpha, n), z).value[0] > 1.03 * followed);
            }
        }
    }
}

TEST_CASE("without compensation a smooth coat is the same, and a rough one is reciprocal") {
    const CoatedBsdf rough = lossy(0.6f, 0.4f, 1.5f);
    const Vec3f a = at_cosine(0.3f), b = at_cosine(0.8f);
    CHECK(rough.evaluate(a, b)[0] / b.z == doctest::Approx(rough.evaluate(b, a)[0] / a.z).epsilon(1e-4));
    CHECK(lossy(0.6f, 0, 1.5f).evaluate(a, b)[0] == plastic(0.6f, 0).evaluate(a, b)[0]);
}

TEST_CASE("white plastic that absorbs nothing returns all light") {
    for (const float ior : {1.f, 1.3f, 1.5f, 2.4f}) {
        for (const float alpha : {0.f, 0.1f, 0.4f, 1.f}) {
            for (const float z : {0.95f, 0.5f, 0.2f}) {
                CAPTURE(ior);
                CAPTURE(alpha);
                CAPTURE(z);
                const double rounding = alpha == 0 ? 1e-3 : 6e-3;
                CHECK(seen(plastic(1.f, alpha, ior), z).value[0] == doctest::Approx(1).epsilon(rounding));
            }
        }
    }
}

TEST_CASE("plastic is what light does that is followed between coat and base") {
    for (const float z : {0.9f, 0.4f}) {
        for (const float p : {0.2f, 0.8f}) {
            CHECK(seen(plastic(p, 0), z).value[0] == doctest::Approx(by_following(p, z, 1.5f, 0, 7)).epsilon(3e-3));
            CHECK(seen(plastic(p, 0, 1.5f, false, 0.3f), z).value[0] ==
                  doctest::Approx(by_following(p, z, 1.5f, 0.3, 9)).epsilon(5e-3));
            // Planted faults: no reflection at the coat's inside; no colour shift by inter-reflections.
            CHECK(seen(plastic(p, 0), z).value[0] != doctest::Approx(by_following(p, z, 1.5f, 0.1, 7)).epsilon(3e-3));
            CHECK(seen(plastic(p, 0, 1.5f, true), z).value[0] !=
                  doctest::Approx(by_following(p, z, 1.5f, 0, 7)).epsilon(3e-3));
        }
    }
}

TEST_CASE("a smooth coat on a mirror has the closed form of two interfaces") {
    const MetalReflectance gold{1.f, true, {0.2f, 0.4f, 1.3f, 1.5f}, {3.5f, 2.4f, 1.9f, 1.8f}};
    const float z = 0.7f, inside = std::sqrt(1 - (1 - z * z) / 2.25f), f = fresnel_dielectric(z, 1.5f);
    const Spectrum r = gold.at(inside);
    const CoatedBsdf b = coated_metal(gold, 0, 0);
    CHECK(b.is_specular());
    const auto s = b.sample(at_cosine(z), 0.4f, {0.5f, 0.5f});
    REQUIRE(s);
    for (int k = 0; k < kWavelengths; ++k)
        CHECK(s->weight[k] == doctest::Approx(f + (1 - f) * (1 - f) * r[k] / (1 - r[k] * f)).epsilon(1e-5));
    for (const float low : {1e-3f, 1e-6f, 1e-20f}) {
        const auto grazing = coated_metal({}, 0, 0).sample(at_cosine(low), 0.4f, {0.5f, 0.5f});
        CHECK((!grazing || (grazing->weight[0] >= 0 && grazing->weight[0] < 1.01f)));
        const Spectrum rough = coated_metal({}, 0.2f, 0).evaluate(at_cosine(low), at_cosine(low));
        CHECK(std::isfinite(rough[0]));
    }
    // A lossless metal under a lossless coat is lossless.
    CHECK(coated_metal({}, 0, 0).sample(at_cosine(z), 0.4f, {0.5f, 0.5f})->weight[0] == doctest::Approx(1));
    const auto dim = coated_metal({}, 0, 0, 0.5f).sample(at_cosine(z), 0.4f, {0.5f, 0.5f});
    const float way = std::exp(-1 / inside);
    CHECK(dim->weight[0] == doctest::Approx(f + (1 - f) * (1 - f) * way / (1 - way * f)).epsilon(1e-5));
}

TEST_CASE("white metals under a coat return what their facets let pass, and no more than they get") {
    for (const float alpha : {0.05f, 0.2f, 0.4f})
        for (const float coat : {0.f, 0.1f, 0.4f})
            for (const float z : {0.95f, 0.5f, 0.15f}) {
                CAPTURE(alpha);
                CAPTURE(coat);
                CAPTURE(z);
                const double a = seen(coated_metal({}, alpha, coat), z).value[0];
                CHECK(a < (coat == 0 ? 1.005 : 1.02));
                CHECK(a > (alpha < 0.1f ? 0.97 : alpha < 0.3f ? 0.84 : 0.6));   // facets block the rest
            }
    CHECK(seen(coated_metal({}, 0.03f, 0), 0.9f).value[0] == doctest::Approx(1).epsilon(0.01));
}

TEST_CASE("a coat of index 1 changes nothing of a metal") {
    const MetalReflectance gold{1.f, true, {0.2f, 0.4f, 1.3f, 1.5f}, {3.5f, 2.4f, 1.9f, 1.8f}};
    const Facets facets{kUp, {1, 0, 0}, 0.3f, 0.3f};
    const CoatedBsdf coated(kUp, kUp, {1, {}}, {.metal = true, .reflectance = gold, .facets = facets});
    const MetalBsdf bare{kUp, kUp, gold, facets};
    for (const float z : {0.9f, 0.5f, 0.2f})
        for (int k = 0; k < kWavelengths; ++k)
            CHECK(coated.evaluate(at_cosine(0.8f), at_cosine(z))[k] ==
                  doctest::Approx(bare.evaluate(at_cosine(0.8f), at_cosine(z))[k]).epsilon(1e-4));
}

TEST_CASE("a coat makes colours deeper: the darker lane loses the more") {
    const Spectrum p{0.8f, 0.2f, 0.5f, 0.5f};
    const auto diffuse = [&](bool linear) {
        return plastic(p, 0, 1.5f, linear).evaluate(kUp, at_cosine(0.8f));
    };
    CHECK(diffuse(true)[0] / diffuse(true)[1] == doctest::Approx(4));
    CHECK(diffuse(false)[0] / diffuse(false)[1] > 5);
    CHECK(diffuse(false)[1] < diffuse(true)[1]);
}

}  // namespace dg
