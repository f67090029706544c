// bsdf_test.cpp -- applies the checks of bsdf_check.h to every kind of BSDF.
#include "material/bsdf.h"

#include <doctest/doctest.h>

#include <string>
#include <variant>

#include "material/bsdf_check.h"

namespace dg {
namespace {

using namespace check;

struct Case {
    std::string name;
    Bsdf bsdf;
    float ior = 1;           // index of a refracting interface
    bool lossless = false;   // albedo is exactly 1 from either side
    bool two_sided = false;  // also tested from behind
    bool disperses = false;  // the hero's lane has four times its light
    bool reciprocal = true;
};

/// Tolerance for energy gain, since albedo tables are interpolated.
double rounding_of(const Case& c) {
    if (c.name == "Beckmann even pane 0.150000") return 0.035;  // anisotropic, at grazing angles
    if (std::holds_alternative<GlassBsdf>(c.bsdf)) return 0.025;
    return std::holds_alternative<CoatedBsdf>(c.bsdf) ? 0.02 : 0.003;
}

const Vec3f kNg = normalize(Vec3f{0.3f, -0.5f, 0.8f});
const Spectrum kColor{0.2f, 0.5f, 0.8f, 1.f};

/// Indices of a strongly dispersive glass; the first is the hero's.
const Spectrum kIndices{1.5f, 1.62f, 1.55f, 1.45f};

DielectricBsdf prism(Vec3f ns, float alpha) {
    return {ns, kNg, kColor, kIndices[0], alpha, true, kIndices};
}

void add_plain(std::vector<Case>& cases, Vec3f ns, bool straight) {
    cases.push_back({"diffuse", DiffuseBsdf{ns, kNg, kColor}, 1, false, true});
    cases.push_back({"white diffuse", DiffuseBsdf{ns, kNg, 1.f}, 1, straight, false});
    for (float alpha : {0.f, 0.15f, 0.5f, 1.f})
        cases.push_back({"conductor " + std::to_string(alpha),
                         ConductorBsdf{ns, kNg, kColor, alpha}, 1, false, alpha == 0.5f});
    cases.push_back({"mirror", ConductorBsdf{ns, kNg, 1.f, 0}, 1, straight, true});
    cases.push_back(
        {"glass", DielectricBsdf{ns, kNg, 1.f, 1.5f, 0}, 1.5f, straight, true});
    cases.push_back({"window", DielectricBsdf{ns, kNg, 1.f, 1, 0.5f}, 1, straight, true});
    cases.push_back(
        {"tinted glass", DielectricBsdf{ns, kNg, kColor, 1.5f, 0}, 1.5f, false, true});
    for (float alpha : {0.15f, 0.5f})
        cases.push_back({"rough glass " + std::to_string(alpha),
                         DielectricBsdf{ns, kNg, kColor, 1.5f, alpha}, 1.5f, false,
                         true});
    for (float alpha : {0.f, 0.3f})
        cases.push_back({"prism " + std::to_string(alpha), prism(ns, alpha), kIndices[0],
                         false, true, true});
    cases.push_back(
        {"bubble", DielectricBsdf{ns, kNg, 1.f, 0.75f, 0.3f}, 0.75f, false, true});
}

GltfSurface surface(float metallic, float roughness, float transmission = 0,
                    bool volume = false) {
    return {.base = kColor,
            .metallic = metallic,
            .roughness = roughness,
            .transmission = transmission,
            .volume = volume,
            .interior = {}};
}

void add_gltf(std::vector<Case>& cases, Vec3f ns, bool straight) {
    const auto add = [&](const std::string& name, const GltfSurface& s,
                         bool lossless = false) {
        const bool clear = s.transmission + s.diffuse_transmission > 0;
        // Index 0 is a special case of KHR_materials_ior with almost no refraction.
        const float ior = !s.volume ? 1 : s.ior > 0 ? s.ior : 1 + kSmoothAlpha;
        // Diffuse on both sides of a change of index: see bsdf_gltf.h.
        const bool reciprocal = !s.volume || s.diffuse_transmission == 0;
        cases.push_back({name, GltfBsdf(s, ns, kNg), ior, lossless && straight, clear,
                         s.disperses, reciprocal});
    };
    for (float roughness : {0.f, 0.4f, 1.f}) {
        std::string r = std::to_string(roughness);
        r.insert(r.begin(), ' ');
        add("gltf plastic" + r, surface(0, roughness));
        add("gltf metal" + r, surface(1, roughness));
        add("gltf alloy" + r, surface(0.4f, roughness));
        add("gltf thin" + r, surface(0, roughness, 1));
        add("gltf part thin" + r, surface(0.2f, roughness, 0.6f));
        add("gltf volume" + r, surface(0, roughness, 1, true));
        add("gltf part volume" + r, surface(0.2f, roughness, 0.6f, true));
        GltfSurface s = surface(0, roughness);
        s.specular = 0.7f;
        s.specular_color = {3, 1, 0.5f, 0};
        add("gltf tinted specular" + r, s);
        s.specular = 0;
        s.base = 1.f;
        add("gltf Lambert" + r, s, true);
        for (const bool volume : {false, true}) {
            s = surface(0.1f, roughness, volume ? 0.4f : 0, volume);
            s.diffuse_transmission = 0.6f;
            s.diffuse_transmission_color = {0.9f, 0.1f, 0.5f, 0.7f};
            add((volume ? "gltf wax" : "gltf leaf") + r, s);
        }
        s = surface(0.1f, roughness, 0.7f, true);
        s.disperses = true;
        s.iors = kIndices;
        s.ior = kIndices[0];
        add("gltf prism" + r, s);
        s = surface(0, roughness, 0.5f, true);
        s.ior = 0;
        s.specular_color = {0.9f, 0.3f, 0.2f, 0.1f};
        if (roughness == 0) add("gltf ior 0" + r, s);
    }
    GltfSurface clear = surface(0, 0, 1);
    clear.base = 1.f;
    add("gltf clear thin", clear, true);
    clear.volume = true;
    add("gltf clear volume", clear, true);
    clear.metallic = 1;
    add("gltf mirror", clear, true);
}

/// Anisotropic along a direction that is neither x nor y of the tests' frames.
Vec3f brushed_along(Vec3f n) {
    const Vec3f t{0.7f, 0.6f, 0.2f};
    return normalize(t - n * dot(t, n));
}

GltfSurface brushed(GltfSurface s, Vec3f ns, float strength) {
    s.anisotropy = strength;
    s.tangent = brushed_along(ns);
    return s;
}

GltfSurface filmed(GltfSurface s, float factor, float film_ior, float thickness) {
    s.iridescence = factor;
    s.film = {film_ior, thickness, 1, {450, 520, 580, 650}};
    return s;
}

void add_anisotropic(std::vector<Case>& cases, Vec3f ns) {
    const auto add = [&](const std::string& name, const GltfSurface& s, float strength) {
        const float ior = s.volume ? 1.5f : 1;
        cases.push_back({name, GltfBsdf(brushed(s, ns, strength), ns, kNg), ior, false,
                         s.transmission > 0});
    };
    GltfSurface white = surface(0, 0.5f);
    white.base = 1.f;
    for (float strength : {0.5f, 1.f}) {
        const std::string s = " " + std::to_string(strength);
        add("brushed metal" + s, surface(1, 0.5f), strength);
        add("brushed white plastic" + s, white, strength);
        add("brushed thin" + s, surface(0, 0.4f, 0.7f), strength);
        add("brushed volume" + s, surface(0, 0.5f, 0.7f, true), strength);
    }
    add("brushed mirror", surface(1, 0.2f), 0.7f);
}

void add_iridescent(std::vector<Case>& cases, Vec3f ns) {
    const auto add = [&](const std::string& name, const GltfSurface& s, float factor,
                         float film_ior, float thickness) {
        const float ior = s.volume ? s.ior : 1;
        cases.push_back({name, GltfBsdf(filmed(s, factor, film_ior, thickness), ns, kNg),
                         ior, false, s.transmission > 0});
    };
    for (float roughness : {0.f, 0.4f, 1.f}) {
        const std::string r = " " + std::to_string(roughness);
        GltfSurface white = surface(0, roughness);
        white.base = 1.f;
        add("film on white plastic" + r, white, 1, 1.8f, 400);
        add("thick film on white plastic" + r, white, 1, 2.5f, 1200);
        add("film on metal" + r, surface(1, roughness), 1, 1.3f, 300);
        add("film on thin" + r, surface(0, roughness, 1), 1, 1.33f, 500);
        add("film on part volume" + r, surface(0.2f, roughness, 0.6f, true), 0.6f, 2, 350);
    }
}

void add_layered(std::vector<Case>& cases, Vec3f ns, bool straight) {
    const Vec3f coat_ns = straight ? kNg : normalize(kNg + Vec3f{-0.2f, 0.1f, 0});
    const auto add = [&](const std::string& name, const GltfSurface& s, Coat coat,
                         const Sheen& sheen) {
        coat.ns = coat_ns;
        cases.push_back({name, LayeredBsdf(s, ns, kNg, coat, sheen), s.volume ? 1.5f : 1,
                         false, s.transmission > 0, false, coat.factor == 0});
    };
    GltfSurface white = surface(0, 0.6f);
    white.base = 1.f;
    for (float alpha : {0.f, 0.1f, 1.f}) {
        const std::string a = " " + std::to_string(alpha);
        add("coat on white plastic" + a, white, {{}, 1, alpha}, {});
        add("coat on mirror" + a, surface(1, 0), {{}, 0.7f, alpha}, {});
        add("coat on volume" + a, surface(0, 0.3f, 0.8f, true), {{}, 1, alpha}, {});
    }
    for (float roughness : {0.f, 0.2f, 0.5f, 1.f}) {
        const std::string r = " " + std::to_string(roughness);
        add("sheen on white plastic" + r, white, {}, Sheen(kColor, 1, roughness));
        add("sheen on thin" + r, surface(0, 0.3f, 0.8f), {}, Sheen(0.5f, 0.5f, roughness));
    }
    add("sheen on mirror", surface(1, 0), {}, Sheen(kColor, 1, 0.3f));
    add("coat on sheen", white, {{}, 1, 0.15f}, Sheen(kColor, 1, 0.4f));
    add("smooth coat on sheen on mirror", surface(1, 0), {{}, 1, 0}, Sheen(1.f, 1, 0.5f));
}

Facets facets(Vec3f ns, float alpha_u, float alpha_v) { return {ns, brushed_along(ns), alpha_u, alpha_v}; }

/// A metal similar to gold, at four wavelengths.
const MetalReflectance kGold{kColor, true, {0.2f, 0.4f, 1.3f, 1.5f}, {3.5f, 2.4f, 1.9f, 1.8f}};

GlassBsdf glass(Vec3f ns, const Facets& f) {
    GlassBsdf g{ns, kNg, kColor, {0.9f, 0.8f, 0.7f, 1.f}};
    g.facets = f;
    return g;
}

void add_translucent_and_metals(std::vector<Case>& cases, Vec3f ns, bool straight) {
    cases.push_back({"translucent", TranslucentBsdf{ns, kNg, kColor * 0.5f, 0.4f}, 1, false, true});
    cases.push_back({"white translucent", TranslucentBsdf{ns, kNg, 0.25f, 0.75f}, 1, straight, true});
    cases.push_back({"lit from behind alone", TranslucentBsdf{ns, kNg, 0.f, kColor}, 1, false, true});
    for (const auto& [u, v] : {Vec2f{0, 0}, {0.3f, 0.3f}, {0.1f, 0.5f}, {1, 0.2f}})
        cases.push_back({"gold " + std::to_string(u), MetalBsdf{ns, kNg, kGold, facets(ns, u, v)}, 1, false, u == 1});
}

void add_glass(std::vector<Case>& cases, Vec3f ns) {
    for (const auto& [u, v] : {Vec2f{0, 0}, {0.3f, 0.3f}, {0.15f, 0.6f}}) {
        const std::string name = " " + std::to_string(u);
        for (const bool thin : {false, true}) {
            GlassBsdf g = glass(ns, facets(ns, u, v));
            g.thin = thin;
            cases.push_back({(thin ? "pane" : "tinted reflection") + name, g, thin ? 1 : 1.5f, false, true});
            if (u == 0) continue;
            g.compensation.emplace(1.5f, g.facets);
            cases.push_back({(thin ? "even pane" : "even glass") + name, g, thin ? 1 : 1.5f, false, true});
        }
        GlassBsdf prism = glass(ns, facets(ns, u, v));
        prism.disperses = true;
        prism.iors = kIndices;
        if (u > 0) prism.compensation.emplace(1.5f, prism.facets);
        cases.push_back({"brushed prism" + name, prism, kIndices[0], false, true, true});
    }
    GlassBsdf bubble = glass(ns, facets(ns, 0.4f, 0.4f));
    bubble.ior = 0.75f, bubble.iors = 0.75f;
    bubble.compensation.emplace(1 / 0.75f, bubble.facets);
    cases.push_back({"even bubble", bubble, 0.75f, false, true});
}

void add_coated(std::vector<Case>& cases, Vec3f ns) {
    const auto add = [&](const std::string& name, const ClearCoat& coat, const CoatedBase& base) {
        cases.push_back({name, CoatedBsdf(ns, kNg, coat, base), 1, false, false});
    };
    for (const auto& [u, v] : {Vec2f{0, 0}, {0.2f, 0.2f}, {0.1f, 0.6f}}) {
        const std::string name = " " + std::to_string(u);
        ClearCoat coat{1.5f, facets(ns, u, v), {0.9f, 1.f, 0.8f, 0.7f}};
        add("plastic" + name, coat, {.diffuse = kColor});
        add("white plastic" + name, coat, {.diffuse = 1.f});
        add("coated gold" + name, coat, {.metal = true, .reflectance = kGold, .facets = facets(ns, 0.25f, 0.25f)});
        add("coated mirror" + name, coat, {.metal = true, .facets = facets(ns, 0, 0)});
        coat.depth = kColor;
        add("varnish" + name, coat, {.diffuse = kColor});
        add("dark varnish on brushed gold" + name, coat,
            {.metal = true, .reflectance = kGold, .facets = facets(ns, 0.5f, 0.15f)});
    }
}

void add_beckmann(std::vector<Case>& cases, Vec3f ns) {
    for (const auto& [u, v] : {Vec2f{0.3f, 0.3f}, {0.15f, 0.6f}}) {
        const std::string name = " " + std::to_string(u);
        Facets f = facets(ns, u, v), below = facets(ns, 0.25f, 0.25f);
        f.distribution = below.distribution = Distribution::beckmann;
        cases.push_back({"Beckmann gold" + name, MetalBsdf{ns, kNg, kGold, f}});
        for (const bool thin : {false, true}) {
            GlassBsdf g = glass(ns, f);
            g.thin = thin;
            cases.push_back({(thin ? "Beckmann pane" : "Beckmann glass") + name, g, thin ? 1 : 1.5f, false, true});
            g.compensation.emplace(1.5f, g.facets);
            cases.push_back({(thin ? "Beckmann even pane" : "Beckmann even glass") + name, g, thin ? 1 : 1.5f, false, true});
        }
        const auto add_coated = [&](const std::string& kind, const CoatedBase& base) {
            cases.push_back({kind + name, CoatedBsdf(ns, kNg, {1.5f, f}, base)});
        };
        add_coated("Beckmann white plastic", {.diffuse = 1.f});
        add_coated("Beckmann coated gold", {.metal = true, .reflectance = kGold, .facets = below});
        add_coated("Beckmann coat on white metal", {.metal = true, .facets = below});
    }
}

std::vector<Case> all_cases(bool straight) {
    // A shading normal about 20 degrees off the geometric normal.
    const Vec3f ns = straight ? kNg : normalize(kNg + Vec3f{0.2f, 0.3f, 0.1f});
    std::vector<Case> cases;
    add_plain(cases, ns, straight);
    add_gltf(cases, ns, straight);
    add_anisotropic(cases, ns);
    add_iridescent(cases, ns);
    add_layered(cases, ns, straight);
    add_translucent_and_metals(cases, ns, straight);
    add_glass(cases, ns);
    add_coated(cases, ns);
    add_beckmann(cases, ns);
    return cases;
}

/// Directions at three elevations, from both sides for two-sided surfaces.
std::vector<Setting> settings(const Case& c, bool straight) {
    std::vector<Setting> list;
    const Frame frame = Frame::from_normal(kNg);
    for (float z : {0.95f, 0.5f, 0.12f, -0.9f, -0.6f}) {
        if (z < 0 && !c.two_sided) continue;
        if (!straight && z != 0.5f && z != -0.6f) continue;
        const float r = std::sqrt(1 - z * z);
        list.push_back(
            {frame, frame.to_world({r * 0.6f, -r * 0.8f, z}), z > 0 ? c.ior : 1 / c.ior});
    }
    return list;
}

template <typename Check>
void for_all(bool straight, Check check) {
    for (const Case& c : all_cases(straight)) {
        CAPTURE(c.name);
        for (const Setting& s : settings(c, straight)) {
            CAPTURE(dot(s.wo, kNg));
            std::visit([&](const auto& b) { check(c, b, s); }, c.bsdf);
        }
    }
}

/// Planted faults: a density 2 % too large, and a missing cosine in sample() or evaluate().
template <typename B>
struct WrongPdf : B {
    Evaluation evaluate_with_pdf(Vec3f wo, Vec3f wi) const {
        Evaluation e = B::evaluate_with_pdf(wo, wi);
        e.pdf *= 1.02f;
        return e;
    }
    std::optional<BsdfSample> sample(Vec3f wo, float u_lobe, Vec2f u) const {
        auto s = B::sample(wo, u_lobe, u);
        if (s) s->weight = s->weight / 1.02f;
        return s;
    }
};
template <typename B>
struct NoCosine : B {
    Evaluation evaluate_with_pdf(Vec3f wo, Vec3f wi) const {
        Evaluation e = B::evaluate_with_pdf(wo, wi);
        e.f_cos = e.f_cos / std::max(1e-6f, std::abs(dot(kNg, wi)));
        return e;
    }
    Spectrum evaluate(Vec3f wo, Vec3f wi) const {
        return evaluate_with_pdf(wo, wi).f_cos;
    }
};

}  // namespace

TEST_CASE("furnace: sampling and quadrature agree and never exceed 1") {
    for (bool straight : {true, false}) {
        std::uint64_t seed = 1;
        for_all(straight, [&](const Case& c, const auto& b, const Setting& s) {
            const Albedo q = albedo_by_quadrature(b, s);
            CHECK(furnace_deviation(b, s, q, ++seed) < 4.5);
            for (int k = 0; k < kWavelengths; ++k) {
                CHECK(q.value[k] < (c.disperses && k == 0 ? 4 : 1) + rounding_of(c));
                if (c.lossless) CHECK(q.value[k] == doctest::Approx(1).epsilon(3e-4));
            }
        });
    }
}

TEST_CASE("lossless materials: every weight is 1, from either side") {
    for_all(true, [&](const Case& c, const auto& b, const Setting& s) {
        if (!c.lossless || c.name.starts_with("white")) return;
        const Albedo mc = albedo_by_sampling(b, s, 2000, 7);
        for (int k = 0; k < kWavelengths; ++k) {
            CHECK(mc.value[k] == doctest::Approx(1).epsilon(2e-5));
            CHECK(mc.error[k] < 1e-5);
        }
    });
}

TEST_CASE("chi-square: sample() follows pdf()") {
    for (bool straight : {true, false}) {
        std::uint64_t seed = 1000;
        for_all(straight, [&](const Case&, const auto& b, const Setting& s) {
            ++seed;
            if (b.is_specular()) return;
            CHECK(chi_square_p(b, s, seed) > 1e-5);
        });
    }
}

TEST_CASE("a sample's weight is evaluate / pdf") {
    for (bool straight : {true, false})
        for_all(straight, [&](const Case&, const auto& b, const Setting& s) {
            CHECK(weight_deviation(b, s, 5) < 2e-4);
        });
}

TEST_CASE("reciprocity: f for reflection, f n^2 for refraction") {
    for (const Case& c : all_cases(true)) {
        CAPTURE(c.name);
        if (!c.reciprocal) continue;
        std::visit([&](const auto& b) { CHECK(asymmetry(b, kNg, kNg, c.ior, 3) < 2e-4); },
                   c.bsdf);
    }
}

TEST_CASE("nothing passes an opaque surface, whatever the shading normal says") {
    Random random{11};
    const Vec3f ns = normalize(kNg + Vec3f{0.9f, 0.3f, 0.1f});
    const Bsdf opaque[] = {DiffuseBsdf{ns, kNg, 1.f}, ConductorBsdf{ns, kNg, 1.f, 0.6f},
                           GltfBsdf(surface(0.3f, 0.8f), ns, kNg)};
    for (const Bsdf& b : opaque) {
        for (int i = 0; i < 5000; ++i) {
            const Vec3f wo = random.direction(), wi = random.direction();
            if (dot(wo, kNg) * dot(wi, kNg) < 0)
                CHECK(evaluate_with_pdf(b, wo, wi).f_cos.is_black());
            const float u_lobe = random.next();
            const auto s = sample(b, wo, u_lobe, random.next_2d());
            if (s) CHECK(dot(wo, kNg) * dot(s->wi, kNg) > 0);
        }
    }
}

TEST_CASE("the checks find planted faults") {
    const Setting s{Frame::from_normal(kNg), normalize(kNg + Vec3f{0.4f, 0.2f, 0}), 1};
    const ConductorBsdf metal{kNg, kNg, kColor, 0.5f};
    const DiffuseBsdf paint{kNg, kNg, kColor};
    const GltfBsdf plastic(surface(0, 0.5f), kNg, kNg);
    const auto all_found = [&](const auto& good) {
        using B = std::decay_t<decltype(good)>;
        const Albedo q = albedo_by_quadrature(good, s);
        CHECK(furnace_deviation(good, s, q, 1) < 4.5);
        CHECK(chi_square_p(good, s, 1) > 1e-5);
        const WrongPdf<B> wrong{good};
        CHECK(furnace_deviation(wrong, s, q, 1) > 4.5);
        CHECK(chi_square_p(wrong, s, 1) < 1e-5);
        const NoCosine<B> flat{good};
        CHECK(furnace_deviation(flat, s, albedo_by_quadrature(flat, s), 1) > 4.5);
        CHECK(weight_deviation(flat, s, 1) > 2e-4);
        CHECK(asymmetry(flat, kNg, kNg, 1, 1) > 2e-4);
    };
    all_found(metal);
    all_found(paint);
    all_found(plastic);
    all_found(GltfBsdf(brushed(surface(1, 0.5f), kNg, 0.8f), kNg, kNg));
    all_found(MetalBsdf{kNg, kNg, kGold, facets(kNg, 0.5f, 0.3f)});
    all_found(MetalBsdf{kNg, kNg, kGold, {kNg, brushed_along(kNg), 0.5f, 0.3f, Distribution::beckmann}});
    all_found(CoatedBsdf(kNg, kNg, {1.5f, facets(kNg, 0.4f, 0.4f)}, {.diffuse = kColor}));
    all_found(GltfBsdf(filmed(surface(0.5f, 0.5f), 1, 1.8f, 400), kNg, kNg));
    all_found(LayeredBsdf(surface(0, 0.5f), kNg, kNg, {}, Sheen(kColor, 1, 0.5f)));
}

}  // namespace dg
