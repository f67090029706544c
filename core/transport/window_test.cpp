// Light through glass: smooth sheets transmit the same light with every strategy; volumes transmit the light of delta
// lights unrefracted.
#include <doctest/doctest.h>

#include "material/fresnel.h"
#include "math/hash.h"
#include "math/statistics.h"
#include "scene/test_scenes.h"
#include "transport/path.h"

namespace dg {
namespace {

using Strategy = PathSettings::Strategy;
const Rgb kGreen{0.3f, 0.8f, 0.5f};

/// [-size,size]^2 at height y, facing up or down.
Mesh plate(float size, float y, bool up = true) {
    Mesh mesh;
    mesh.name = "plate";
    mesh.positions = {
        {-size, y, -size}, {-size, y, size}, {size, y, size}, {size, y, -size}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (!up) mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
    return mesh;
}

/// A white floor at y = 0.
SceneDescription white_floor() {
    SceneDescription d;
    add(d, plate(50, 0), {"floor", DiffuseMaterial{{1, 1, 1}}});
    return d;
}

GltfMaterial glass(Rgb colour, float thickness = 0) {
    GltfMaterial m;
    m.base_color = colour;
    m.metallic = m.roughness = 0;
    m.transmission = 1;
    m.thickness = thickness;
    return m;
}

/// Radiance of the hero along a ray, relative to emission(1, 1, 1) at its wavelength: mean and variance.
SampleMoments radiance_along(const Ray& ray, const SceneDescription& d, Strategy strategy,
                             int n, int max_depth) {
    const auto scene = Scene::build(d);
    PathSettings settings;
    settings.strategy = strategy;
    settings.max_depth = max_depth;
    std::vector<double> values;
    for (int i = 0; i < n; ++i) {
        PathSampler sampler(i % 64, i / 64, 0, 7);
        Wavelengths wl = Wavelengths::sample(0.4f);
        const Spectrum l = radiance(*scene, ray, wl, sampler, settings, nullptr, nullptr).sum();
        values.push_back(l[0] / wl.emission({1, 1, 1})[0]);
    }
    return moments(values);
}

/// Radiance of the floor at the origin, seen from below the lowest glass (y = 0.1).
SampleMoments floor_radiance(const SceneDescription& d, Strategy strategy, int n,
                             int max_depth = 16) {
    Ray ray;
    ray.origin = {0.05f, 0.08f, 0.02f};
    ray.direction = normalize(Vec3f{} - ray.origin);
    return radiance_along(ray, d, strategy, n, max_depth);
}

float green() {
    return Wavelengths::sample(0.4f).reflectance(kGreen)[0];
}

/// Schlick's transmittance of a sheet of index 1.5, as in glTF's dielectric.
double sheet(double cosine) {
    return green() * (1 - (0.04 + 0.96 * std::pow(1 - cosine, 5)));
}

void check(const SampleMoments& m, double expected, double tolerance = 1e-3) {
    const double spread = 4 * std::sqrt(m.variance / m.count);
    CHECK(spread < 0.03 * expected);
    CHECK(m.mean == doctest::Approx(expected).epsilon(tolerance + spread / expected));
}

/// Depth that excludes light which the glass reflects back to the floor.
constexpr int kDirectOnly = 1;

}  // namespace

TEST_CASE(
    "a lamp at a point, through one and two panes: the product of what they let "
    "through") {
    for (int panes : {0, 1, 2, 5}) {
        SceneDescription d = white_floor();
        for (int i = 0; i < panes; ++i)
            add(d, plate(20, 0.2f + 0.1f * i, i % 2 == 0), {"pane", glass(kGreen)});
        d.lights.push_back(PointLight{{2, 1, 0}, {30, 30, 30}});
        const double cosine = 1 / std::sqrt(5.0);
        const double through = std::pow(sheet(cosine), panes);
        check(floor_radiance(d, Strategy::mis, 4, kDirectOnly),
              30 * cosine / 5 * through / kPiD);
    }
}

TEST_CASE("a pane lets light through as a picture hangs: texture, vertex colour, alpha") {
    SceneDescription d = white_floor();
    GltfMaterial m = glass({1, 1, 1});
    m.alpha_mode = GltfMaterial::AlphaMode::blend;
    m.base_alpha = 0.5f;  // half of the light passes the pane unaffected
    Mesh pane = plate(20, 0.3f);
    const std::array<float, 4> colour{kGreen.x, kGreen.y, kGreen.z, 1};
    pane.colors = {colour, colour, colour, colour};
    add(d, pane, {"pane", m});
    d.lights.push_back(DirectionalLight{{0, -1, 0}, {3, 3, 3}});
    std::vector<double> values;
    const auto scene = Scene::build(d);
    for (int i = 0; i < 20000; ++i) {
        const Wavelengths wl = Wavelengths::sample(0.4f);
        Ray ray;
        ray.origin = {float(hash_uniform(1, i)), 0.01f, float(hash_uniform(2, i))};
        ray.direction = {0, 1, 0};
        values.push_back(scene->visibility(ray, true, {}, wl)[0]);
    }
    check(moments(values), 0.5 + 0.5 * sheet(1));
}

TEST_CASE(
    "lamps with an extent and skies through panes: every strategy has the same mean") {
    // A lamp that covers the hemisphere above the floor, and a sky of the same luminance, give the same light: the
    // integral of the panes' transmittance over the hemisphere.
    for (int panes : {1, 2}) {
        double expected = 0;
        const int n = 1000;
        for (int i = 0; i < n; ++i) {
            const double cosine = (i + 0.5) / n;
            expected += 2 * cosine * std::pow(sheet(cosine), panes) / n;
        }
        for (int kind : {0, 1, 2}) {
            SceneDescription d = white_floor();
            for (int i = 0; i < panes; ++i)
                add(d, plate(500, 0.2f + 0.1f * i), {"pane", glass(kGreen)});
            if (kind == 0) {
                add(d, plate(400, 1, false),
                    {"lamp", DiffuseMaterial{{0, 0, 0}}, {1, 1, 1}});
            } else if (kind == 1) {
                EnvironmentImage sky{4, 2, std::vector<Rgb>(8, Rgb{1, 1, 1})};
                d.environment = Environment::image(sky, 1, {});
            } else {
                d.environment = Environment::constant({1, 1, 1});
            }
            CAPTURE(panes);
            CAPTURE(kind);
            check(floor_radiance(d, Strategy::mis, 20000, kDirectOnly), expected, 4e-3);
            check(floor_radiance(d, Strategy::bsdf, 20000, kDirectOnly), expected, 4e-3);
            if (kind == 1)
                check(floor_radiance(d, Strategy::light, 40000, kDirectOnly), expected,
                      4e-3);
        }
    }
}

TEST_CASE(
    "a small lamp behind panes: light sampling and chance agree, and so do both "
    "together") {
    for (int lamp : {0, 1}) {
        SceneDescription d = white_floor();
        for (int i = 0; i < 2; ++i)
            add(d, plate(20, 0.2f + 0.1f * i), {"pane", glass(kGreen)});
        if (lamp == 0)
            add(d, plate(1, 1, false), {"lamp", DiffuseMaterial{{0, 0, 0}}, {9, 9, 9}});
        else
            d.lights.push_back(SphereLight{{{0, 1, 0}, 0.3f}, {9, 9, 9}});
        // Quadrature over the lamp, as the panes' transmittance varies with the angle.
        double expected = 0;
        const int n = 200;
        for (int i = 0; i < n && lamp == 0; ++i) {
            for (int j = 0; j < n; ++j) {
                const double x = 2 * (i + 0.5) / n - 1, z = 2 * (j + 0.5) / n - 1;
                const double d2 = x * x + z * z + 1, cosine = 1 / std::sqrt(d2);
                expected +=
                    9 * cosine * cosine / d2 * std::pow(sheet(cosine), 2) * 4 / (n * n);
            }
        }
        for (int i = 0; i < n && lamp == 1; ++i) {  // rings of the cone, sin = 0.3
            const double least = std::sqrt(1 - 0.09),
                         cosine = least + (1 - least) * (i + 0.5) / n;
            expected +=
                9 * 2 * kPiD * cosine * std::pow(sheet(cosine), 2) * (1 - least) / n;
        }
        CAPTURE(lamp);
        check(floor_radiance(d, Strategy::mis, 8000, kDirectOnly), expected / kPiD, 2e-3);
        check(floor_radiance(d, Strategy::light, 8000, kDirectOnly), expected / kPiD,
              2e-3);
        check(floor_radiance(d, Strategy::bsdf, 400000, kDirectOnly), expected / kPiD,
              2e-3);
    }
}

TEST_CASE(
    "a delta light through a slab: Fresnel twice, and absorption along the straight "
    "way") {
    GltfMaterial m = glass({1, 1, 1}, 0.1f);
    m.attenuation_color = kGreen;
    m.attenuation_distance = 0.25f;
    SceneDescription d = white_floor();
    Mesh slab = plate(20, 0.5f);   // top and bottom, wound outward
    slab.positions = {{-20, 0.5f, -20}, {-20, 0.5f, 20}, {20, 0.5f, 20}, {20, 0.5f, -20},
                      {-20, 0.2f, -20}, {-20, 0.2f, 20}, {20, 0.2f, 20}, {20, 0.2f, -20}};
    slab.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
    add(d, slab, {"slab", m});
    d.lights.push_back(PointLight{{2, 1, 0}, {30, 30, 30}});
    const double cosine = 1 / std::sqrt(5.0);
    const double fresnel = 1 - fresnel_dielectric(float(cosine), 1.5f);
    const double through = fresnel * fresnel * std::pow(green(), 0.3 / cosine / 0.25);
    check(floor_radiance(d, Strategy::mis, 4, kDirectOnly),
          30 * cosine / 5 * through / kPiD,
          5e-3);  // glTF's curve is rescaled between F0 and F90

    // A ray from inside the slab passes a boundary and the distance to it.
    const auto scene = Scene::build(d);
    const Wavelengths wl = Wavelengths::sample(0.4f);
    Ray ray;
    ray.origin = {0, 0.4f, 0};
    ray.direction = {0, 1, 0};
    const Interior inside{true, wl.reflectance(kGreen), 0.25f};
    const double normal = 1 - normal_reflectance(1.5f);
    ray.t_max = 5;
    CHECK(scene->visibility(ray, true, inside, wl)[0] ==
          doctest::Approx(normal * std::pow(green(), 0.1 / 0.25)).epsilon(1e-3));
    // Emitters that a path can hit are not approximated by unrefracted shadow rays; inside the volume they are
    // attenuated.
    CHECK(scene->visibility(ray, false, inside, wl).is_black());
    ray.t_max = 0.05f;
    CHECK(scene->visibility(ray, false, inside, wl)[0] ==
          doctest::Approx(std::pow(green(), 0.05 / 0.25)).epsilon(1e-3));
}

TEST_CASE("a lamp inside coloured glass: light sampling knows the absorption") {
    GltfMaterial m = glass({1, 1, 1}, 1);
    m.attenuation_color = kGreen;
    m.attenuation_distance = 0.5f;
    SceneDescription d = white_floor();
    add(d, plate(40, 3), {"water", m});  // the floor and the lamp are below its surface
    d.lights.push_back(SphereLight{{{0, 1, 0}, 0.6f}, {9, 9, 9}});
    // The camera stands above, so that its path knows that it is inside.
    auto look = [&](Strategy strategy, int n) {
        Ray ray;
        ray.origin = {0.8f, 5, 0};
        ray.direction = {0, -1, 0};
        return radiance_along(ray, d, strategy, n, 2);
    };
    // Directions over the lamp's cone, seen from below the camera, and the way to the
    // lamp.
    double irradiance = 0;
    const int n = 300;
    const double d2 = 0.8 * 0.8 + 1, least = std::sqrt(1 - 0.36 / d2);
    const Frame frame = Frame::from_normal(normalize(Vec3f{-0.8f, 1, 0}));
    for (int i = 0; i < n * n; ++i) {
        const double z = least + (1 - least) * (i / n + 0.5) / n,
                     r = std::sqrt(1 - z * z);
        const double phi = 2 * kPiD * (i % n + 0.5) / n;
        const Vec3f w = frame.to_world(
            {float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)});
        const double way = std::sqrt(d2) * z - std::sqrt(0.36 - d2 * r * r);
        irradiance +=
            9 * 2 * kPiD * (1 - least) / (n * n) * w.y * std::pow(green(), way / 0.5);
    }
    const double surface = (1 - normal_reflectance(1.5f)) / (1.5 * 1.5);
    const double expected = irradiance / kPiD * surface * std::pow(green(), 3 / 0.5);
    check(look(Strategy::light, 20000), expected, 0.01);
    check(look(Strategy::bsdf, 160000), expected, 0.01);
    check(look(Strategy::mis, 20000), expected, 0.01);
}

TEST_CASE("rough glass and opaque things keep their shadows") {
    for (float roughness : {0.f, 0.5f}) {
        SceneDescription d = white_floor();
        GltfMaterial m = glass(kGreen, roughness == 0 ? 0.f : 0.1f);
        m.roughness = roughness;
        if (roughness == 0) m.metallic = 1;
        add(d, plate(20, 0.3f), {"plate", m});
        d.lights.push_back(PointLight{{0, 1, 0}, {30, 30, 30}});
        CHECK(floor_radiance(d, Strategy::mis, 4, kDirectOnly).mean == 0);
    }
}

TEST_CASE("many panes: dark in the end, never wrong in order") {
    SceneDescription d = white_floor();
    for (int i = 0; i < 40; ++i)
        add(d, plate(20, 0.2f + 0.01f * i), {"pane", glass({1, 1, 1})});
    d.lights.push_back(PointLight{{0.1f, 1, 0}, {30, 30, 30}});
    CHECK(floor_radiance(d, Strategy::mis, 4, kDirectOnly).mean == 0);
    d.instances.resize(1 + Crossings::kMost);
    CHECK(floor_radiance(d, Strategy::mis, 4, kDirectOnly).mean ==
          doctest::Approx(30 / kPiD * std::pow(0.96, 32)).epsilon(0.03));
    // Along the diagonal, where the ray hits both triangles of each pane.
    d.instances.resize(1 + 3);
    d.lights = {PointLight{{0, 1, 0}, {30, 30, 30}}};
    CHECK(floor_radiance(d, Strategy::mis, 4, kDirectOnly).mean ==
          doctest::Approx(30 / kPiD * std::pow(0.96, 3)).epsilon(1e-3));
}

}  // namespace dg
