// ggx_test.cpp -- the distribution, its tables and Fresnel's equations against numbers
// and integrals.
#include "material/ggx.h"

#include <doctest/doctest.h>

#include "material/baked.h"
#include "material/bsdf_check.h"
#include "material/fresnel.h"

namespace dg {

TEST_CASE("unit_circle is cos and sin") {
    for (int i = 0; i <= 10000; ++i) {
        const double u = i / 10000.0;
        const Vec2f p = unit_circle(static_cast<float>(u));
        CHECK(std::abs(p.x - std::cos(2 * kPiD * static_cast<float>(u))) < 1e-6);
        CHECK(std::abs(p.y - std::sin(2 * kPiD * static_cast<float>(u))) < 1e-6);
    }
}

TEST_CASE("D is normalised over projected facets, down to the narrowest lobe") {
    const Vec3f n = normalize(Vec3f{0.4f, 0.1f, -0.7f});
    const Frame frame = Frame::from_normal(n);
    for (float alpha : {kSmoothAlpha, 0.01f, 0.1f, 0.5f, 1.f}) {
        // sin^2 = x from 0 to 1, stretched toward 0: x = alpha^2 y / (1 - y (1 -
        // alpha^2)).
        double sum = 0;
        constexpr int kCount = 4000;
        const double a2 = static_cast<double>(alpha) * alpha;
        for (int i = 0; i < kCount; ++i) {
            const double y = (i + 0.5) / kCount, q = 1 - y * (1 - a2), x = a2 * y / q;
            const double dx = a2 / (q * q) / kCount;
            const Vec3d h{std::sqrt(x) * 0.6, std::sqrt(x) * 0.8, std::sqrt(1 - x)};
            sum += kPiD * dx * ggx_d(n, frame.to_world(to_float(h)), 1, alpha * alpha);
        }
        CHECK(sum == doctest::Approx(1).epsilon(2e-3));
    }
}

TEST_CASE("visible normals have the density G1 (h.wo) D / (n.wo): their mean normal") {
    check::Random random{1};
    for (float alpha : {0.05f, 0.4f, 1.f}) {
        const Vec3f n{0, 0, 1}, wo = normalize(Vec3f{0.9f, 0, 0.4f});
        Vec3d drawn;
        constexpr int kCount = 400000, kRings = 1000, kTurns = 200;
        for (int i = 0; i < kCount; ++i)
            drawn +=
                to_double(sample_visible_normal(n, wo, alpha, random.next_2d())) / kCount;
        Vec3d wanted;
        double mass = 0;
        const double a2 = static_cast<double>(alpha) * alpha;
        for (int i = 0; i < kRings; ++i) {
            // Integrate like above, with y = 1 - v^2 so that 1 / cos of the solid angle stays finite.
            const double v = (i + 0.5) / kRings, y = 1 - v * v;
            const double q = 1 - y * (1 - a2), x = a2 * y / q;
            const double dx = a2 / (q * q) * 2 * v / kRings;
            const double cell = dx / 2 / std::sqrt(1 - x) * (2 * kPiD / kTurns);
            for (int j = 0; j < kTurns; ++j) {
                const double phi = 2 * kPiD * (j + 0.5) / kTurns, r = std::sqrt(x);
                const Vec3d h{r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - x)};
                const double g1 = 2 * wo.z / (wo.z + ggx_slope(alpha * alpha, wo.z));
                const double d = ggx_d(n, to_float(h), 1, alpha * alpha);
                const double p = g1 * std::max(0.0, dot(h, to_double(wo))) * d / wo.z;
                wanted += h * (p * cell);
                mass += p * cell;
            }
        }
        CHECK(mass == doctest::Approx(1).epsilon(2e-3));
        CHECK(length(drawn - wanted) < 4e-3);
    }
}

TEST_CASE("Fresnel: numbers of the textbook") {
    CHECK(normal_reflectance(1.5f) == doctest::Approx(0.04));
    CHECK(normal_reflectance(0) == 1);
    CHECK(normal_reflectance(1) == 0);
    CHECK(fresnel_dielectric(1, 1.5f) == doctest::Approx(0.04));
    CHECK(fresnel_dielectric(1, 1 / 1.5f) == doctest::Approx(0.04));
    // Brewster's angle, tan = 1.5: only s is reflected, ((n^2 - 1) / (n^2 + 1))^2 / 2.
    CHECK(fresnel_dielectric(1 / std::sqrt(3.25f), 1.5f) ==
          doctest::Approx(0.5 * std::pow(1.25 / 3.25, 2)));
    CHECK(fresnel_dielectric(0, 1.5f) == 1);
    CHECK(fresnel_dielectric(0.7f, 1 / 1.5f) ==
          1);  // beyond the critical angle (cosine 0.745)
    CHECK(fresnel_dielectric(0.76f, 1 / 1.5f) < 1);
    CHECK(schlick(0) == 1);
    CHECK(schlick(1) == 0);
    CHECK(schlick(0.5f) == doctest::Approx(0.03125));
}

TEST_CASE("albedo tables equal the albedo by sampling, between the nodes too") {
    for (float roughness : {0.05f, 0.2f, 0.37f, 0.71f, 1.f}) {
        const GgxAlbedo::Row row = baked::ggx.row(roughness);
        const float alpha2 = roughness * roughness * roughness * roughness;
        for (float cos_o : {0.03f, 0.13f, 0.43f, 0.77f, 1.f}) {
            const Vec3f n{0, 0, 1}, wo{std::sqrt(1 - cos_o * cos_o), 0, cos_o};
            check::Random random{3};
            double a = 0, b = 0, facets = 0;
            constexpr int kCount = 40000;
            for (int i = 0; i < kCount; ++i) {
                const Vec3f h =
                    sample_visible_normal(n, wo, roughness * roughness, random.next_2d());
                const Vec3f wi = reflect(wo, h);
                const float s = schlick(dot(wo, h));
                facets += s;
                if (wi.z <= 0) continue;
                const Facet f = reflecting_facet(n, wo, wi, cos_o, wi.z, RoundGgx{alpha2});
                a += (1 - s) * f.f_cos / f.pdf;
                b += s * f.f_cos / f.pdf;
            }
            const LobeAlbedo t = row.at(cos_o);
            CHECK(std::abs(t[0] - a / kCount) < 0.006);
            CHECK(std::abs(t[1] - b / kCount) < 0.006);
            CHECK(std::abs(t[2] - facets / kCount) < 0.006);
        }
    }
}

TEST_CASE("the mean of a table row is the integral of its interpolant") {
    for (float roughness : {0.1f, 0.5f, 0.93f}) {
        const GgxAlbedo::Row row = baked::ggx.row(roughness);
        double sum[3] = {};
        constexpr int kCount = 20000;
        for (int i = 0; i < kCount; ++i) {
            const double c = (i + 0.5) / kCount;
            for (int k = 0; k < 3; ++k)
                sum[k] += row.at(static_cast<float>(c))[k] * 2 * c / kCount;
        }
        for (int k = 0; k < 3; ++k)
            CHECK(row.mean[k] == doctest::Approx(sum[k]).epsilon(1e-4));
    }
}

}  // namespace dg
