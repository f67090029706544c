// A vertex sampled from the camera and from the light: both integrals must agree.
#include "transport/sharing/path_vertex.h"

#include <doctest/doctest.h>

#include "material/material_needs.h"
#include "material/test_hits.h"
#include "math/hash.h"
#include "math/statistics.h"
#include "math/warp.h"

using namespace dg;

namespace {

Vec2f pair(int seed, int i) {
    return {float(hash_uniform(seed, 2 * i)), float(hash_uniform(seed, 2 * i + 1))};
}

/// Radiance and importance of a direction. Asymmetric, so that no error cancels by symmetry. Grazing light is weak,
/// else the variance of |ng . wo| / |ng . wi| would be infinite.
double shine(Vec3f w) {
    return std::abs(w.z) * (1 + w.x + 0.5 * w.y * w.y + (w.z > 0 ? 0.4 : 0) + 0.5 * w.z * w.x);
}
double look(Vec3f w) { return 1 - 0.7 * w.x + 0.6 * w.y + (w.z > 0 ? 0 : 0.5); }

/// Samples the sphere with the density |cos| / 2 pi about z.
Vec3f around(Vec2f u) {
    const bool below = u.x < 0.5f;
    u.x = below ? 2 * u.x : 2 * u.x - 1;
    const Vec3f w = warp_cosine_hemisphere({std::min(u.x, 0x1.fffffep-1f), u.y});
    return below ? Vec3f{w.x, w.y, -w.z} : w;
}

struct Case {
    const char* name = "";
    Material material{};
    Vec3f ns = {0, 0, 1};
    std::vector<Texture> textures = {};
};

GltfMaterial gltf(float metallic, float roughness) {
    GltfMaterial m;
    m.base_color = {0.7f, 0.5f, 0.3f};
    m.metallic = metallic;
    m.roughness = roughness;
    return m;
}

GltfMaterial glass(float roughness, float thickness) {
    GltfMaterial m = gltf(0, roughness);
    m.transmission = 0.8f;
    m.thickness = thickness;
    return m;
}

std::vector<Case> cases() {
    const Vec3f tilted = normalize(Vec3f{0.3f, -0.2f, 1});
    std::vector<Case> all;
    const auto add = [&](const char* name, auto kind) {
        for (const Vec3f ns : {Vec3f{0, 0, 1}, tilted}) {
            Case& c = all.emplace_back();
            c.name = name, c.ns = ns;
            c.material.kind = kind;
        }
    };
    add("diffuse", DiffuseMaterial{});
    add("metal", ConductorMaterial{{0.9f, 0.6f, 0.3f}, 0.2f});
    add("mirror", ConductorMaterial{{0.9f, 0.6f, 0.3f}, 0});
    add("rough glass", DielectricMaterial{1.5f, 0.3f});
    add("clear glass", DielectricMaterial{1.5f, 0, {0.8f, 0.9f, 1}});
    add("glossy", gltf(0.3f, 0.5f));
    add("window", glass(0, 0));
    add("frosted window", glass(0.5f, 0));
    add("solid", glass(0, 0.01f));
    add("frosted solid", glass(0.5f, 0.01f));
    GltfMaterial leaf = gltf(0, 0.6f);
    leaf.diffuse_transmission = 0.5f;
    add("leaf", leaf);
    GltfMaterial wax = glass(0.4f, 0.01f);
    wax.diffuse_transmission = 0.5f;
    add("wax", wax);
    for (const float rough : {0.f, 0.5f}) {
        GltfMaterial coated = glass(rough, 0.01f);
        coated.clearcoat.factor = 0.9f;
        coated.clearcoat.roughness = rough;
        coated.sheen.color = {0.5f, 0.3f, 0.2f};
        coated.sheen.roughness = 0.4f;
        add("coated solid", coated);
    }
    GltfMaterial film = glass(0.3f, 0.01f);
    film.iridescence.factor = 1;
    film.iridescence.thickness_max = 400;
    add("film", film);
    DiffuseMaterial translucent{{0.3f, 0.5f, 0.2f}, {}, {0.5f, 0.4f, 0.6f}};
    add("translucent", translucent);
    ConductorMaterial gold{{1, 1, 1}, {0.15f, 0.5f}};
    gold.fresnel = true;
    gold.eta = {0.2f, 0.4f, 1.3f}, gold.k = {3.5f, 2.4f, 1.9f};
    add("brushed gold", gold);
    gold.alpha = 0;
    add("gold mirror", gold);
    DielectricMaterial even{1.5f, {0.2f, 0.6f}, {0.8f, 0.9f, 1}};
    even.reflection_tint = {0.9f, 0.5f, 0.7f};
    even.energy_compensation = true;
    add("brushed glass that keeps its energy", even);
    for (const float rough : {0.f, 0.4f}) {
        DielectricMaterial pane{1.5f, rough, {0.8f, 0.9f, 1}};
        pane.thin = true;
        add("pane", pane);
        CoatedMaterial plastic;
        plastic.alpha = rough;
        plastic.diffuse.reflectance = {0.8f, 0.4f, 0.6f};
        add("plastic", plastic);
        CoatedMaterial coated_gold;
        coated_gold.metal = true;
        coated_gold.conductor = gold;
        coated_gold.conductor.alpha = rough;
        add("coated gold", coated_gold);
        coated_gold.alpha = 0.3f;
        add("gold under a rough coat", coated_gold);
    }
    add("boundary", BoundaryMaterial{});
    GltfMaterial bumpy = gltf(0.2f, 0.4f);
    bumpy.normal_texture = test::slot(0);
    add("bumpy", bumpy);
    all.pop_back();
    all.back().textures = {test::texel({190, 90, 230})};
    return all;
}

SurfaceHit hit_of(const Case& c, Vec3f wo) {
    SurfaceHit hit = test::hit_from(wo);
    hit.ns = c.ns;
    hit.tangent = normalize(Vec3f{1, 0, 0} - c.ns * c.ns.x);
    return hit;
}

/// Integral of look(wo) f shine(wi) |ns . wi| |ng . wo| over both directions, from the camera.
SampleMoments from_camera(const Case& c, int n) {
    const Wavelengths wavelengths = Wavelengths::sample(0.4f);
    std::vector<double> values;
    for (int i = 0; i < n; ++i) {
        const Vec3f wo = around(pair(1, i));
        SurfaceHit hit = hit_of(c, wo);
        const SurfaceHit bare = hit;
        const Bsdf bsdf = shade(c.material, c.textures, hit, wavelengths);
        const auto s = sample(bsdf, wo, float(hash_uniform(2, i)), pair(3, i));
        double value = 0;
        if (s) {
            PathVertex both(c.material, c.textures, bare, wavelengths);
            // With an adjusted shading normal, only the camera can sample some directions.
            const bool found = s->specular ? both.reversible(wo, s->wi)
                                           : both.scattering(wo, s->wi).light_pdf > 0;
            if (found)
                value = look(wo) * double(s->weight[1]) * shine(s->wi);
        }
        values.push_back(value);
    }
    return moments(values);
}

/// The integral of from_camera(), sampled from the light.
SampleMoments from_light(const Case& c, int n) {
    const Wavelengths wavelengths = Wavelengths::sample(0.4f);
    std::vector<double> values;
    for (int i = 0; i < n; ++i) {
        const Vec3f wi = around(pair(4, i));
        PathVertex both(c.material, c.textures, hit_of(c, wi), wavelengths);
        const auto s = both.step(wi, float(hash_uniform(5, i)), pair(6, i));
        values.push_back(s ? shine(wi) * double(s->weight[1]) * look(s->to_camera) : 0.0);
    }
    return moments(values);
}

}  // namespace

TEST_CASE("a vertex followed from the camera and from the light finds the same light") {
    for (const Case& c : cases()) {
        CAPTURE(std::string(c.name));
        CAPTURE(c.ns.x);
        const SampleMoments camera = from_camera(c, 40000), light = from_light(c, 40000);
        CHECK(camera.mean > 0.05);
        const double p = welch_p_value(camera, light);
        CHECK(p > 1e-4);
        SampleMoments wrong = light;
        wrong.mean *= 1.03;
        CHECK(welch_p_value(camera, wrong) < 0.05);
    }
}

TEST_CASE("the densities of a step are those that scattering() tells") {
    const Wavelengths wavelengths = Wavelengths::sample(0.4f);
    for (const Case& c : cases()) {
        CAPTURE(std::string(c.name));
        for (int i = 0; i < 200; ++i) {
            const Vec3f wi = around(pair(4, i));
            PathVertex both(c.material, c.textures, hit_of(c, wi), wavelengths);
            const auto s = both.step(wi, float(hash_uniform(5, i)), pair(6, i));
            if (!s || s->specular) continue;
            const Scattering e = both.scattering(s->to_camera, wi);
            CHECK(e.light_pdf == doctest::Approx(s->pdf).epsilon(1e-4));
            CHECK(e.camera_pdf == doctest::Approx(s->camera_pdf).epsilon(1e-4));
            const float turned = std::abs(s->to_camera.z / wi.z);
            CHECK(s->weight[1] ==
                  doctest::Approx(e.f_cos[1] * turned / s->pdf).epsilon(1e-3));
        }
    }
}

TEST_CASE("what a delta lobe has from the other side is what reversed() says") {
    const Wavelengths wavelengths = Wavelengths::sample(0.4f);
    int compared = 0, uneven = 0;
    for (const Case& c : cases()) {
        if (!(c.ns == Vec3f{0, 0, 1}) || !c.textures.empty()) continue;
        CAPTURE(std::string(c.name));
        for (int i = 0; i < 300; ++i) {
            const Vec3f wo = around(pair(1, i));
            SurfaceHit hit = hit_of(c, wo);
            const Bsdf bsdf = shade(c.material, c.textures, hit, wavelengths);
            const auto s = sample(bsdf, wo, float(hash_uniform(2, i)), pair(3, i));
            if (!s || !s->specular) continue;
            // Coat and base may have delta lobes in the same direction: both count.
            const auto all = [&](Vec3f from, Vec3f to) {
                double sum = 0, last = -1;
                for (int k = 0; k < 400; ++k) {
                    const auto back = sample(bsdf, from, (k + 0.5f) / 400, {0.3f, 0.6f});
                    if (!back || !back->specular || length(back->wi - to) > 1e-3f) continue;
                    const double lobe = double(back->weight[1]) * back->pdf * back->eta * back->eta;
                    if (lobe != last) sum += lobe;
                    last = lobe;
                }
                return sum;
            };
            const float ratio = std::visit([&](const auto& b) { return b.reversed(wo, s->wi); }, bsdf);
            CHECK(all(s->wi, wo) == doctest::Approx(ratio * all(wo, s->wi)).epsilon(5e-3));
            ++compared;
            uneven += std::abs(ratio - 1) > 0.02f;
        }
    }
    CHECK(compared > 500);
    CHECK(uneven > 20);
}

TEST_CASE("on a smooth mesh the vertex has the BSDF of camera paths, and none through its triangle") {
    const Wavelengths wavelengths = Wavelengths::sample(0.4f);
    int lit = 0, grazing = 0, behind = 0;
    for (const Case& c : cases()) {
        if (c.ns == Vec3f{0, 0, 1} || !only_reflects(c.material)) continue;
        CAPTURE(std::string(c.name));
        for (int i = 0; i < 2000; ++i) {
            Vec3f wo = around(pair(1, i)), wi = around(pair(4, i));
            if (i % 2) wo = normalize(Vec3f{wo.x, wo.y, 0.1f * wo.z});
            SurfaceHit hit = hit_of(c, wo);
            hit.smooth = true;
            PathVertex vertex(c.material, c.textures, hit, wavelengths);
            const Spectrum f = vertex.scattering(wo, wi).f_cos;
            use_smooth_normal(hit);
            const Bsdf bsdf = shade(c.material, c.textures, hit, wavelengths);
            const Spectrum camera = evaluate_with_pdf(bsdf, wo, wi).f_cos;
            const bool through = wo.z * wi.z <= 0;
            behind += through && !camera.is_black();
            if (through) CHECK(f.is_black());
            else CHECK(f[1] == doctest::Approx(camera[1]).epsilon(1e-4));
            lit += !f.is_black();
            grazing += !f.is_black() && dot(c.ns, wo) * wo.z < 0.1f * wo.z * wo.z;
        }
    }
    CHECK(lit > 1000);
    CHECK(grazing > 100);
    CHECK(behind > 100);
}
