// embree_test.cpp -- hits against closed forms, flattened and through an instance.
#include <doctest/doctest.h>

#include "math/hash.h"
#include <sys/mman.h>

#include <limits>
#include <random>

#include "geometry/intersector.h"
#include "geometry/layout.h"

using namespace dg;

namespace {

struct Random {
    std::mt19937 generator{7};
    float operator()() { return std::uniform_real_distribution<float>(0, 1)(generator); }
    Vec3f direction() {
        const float z = 2 * (*this)() - 1, phi = 2 * kPi * (*this)(),
                    s = std::sqrt(1 - z * z);
        return {s * std::cos(phi), s * std::sin(phi), z};
    }
};

Mesh triangle_mesh(Vec3f a, Vec3f b, Vec3f c) {
    Mesh mesh;
    mesh.positions = {a, b, c};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

Ray make_ray(Vec3f origin, Vec3f direction) {
    Ray ray;
    ray.origin = origin;
    ray.direction = normalize(direction);
    return ray;
}

/// Enough copies of a mesh to prevent flattening; instance 0 is under test.
std::vector<InstanceGeometry> crowd(const Mesh& mesh, const Affine3f& transform,
                                    bool cutout = false) {
    std::vector<InstanceGeometry> all{{0, transform, cutout}};
    Affine3f far_away;
    far_away.origin = {0, 0, 1e6f};
    all.resize(kFlattenLimit / mesh.triangles.size() + 2, {0, far_away, false});
    return all;
}

}  // namespace

TEST_CASE("positions that end with a page of memory are not read beyond it") {
    constexpr std::size_t kPage = 4096;
    auto* pages = static_cast<char*>(mmap(nullptr, 2 * kPage, PROT_READ | PROT_WRITE,
                                          MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    REQUIRE(pages != MAP_FAILED);
    REQUIRE(mprotect(pages + kPage, kPage, PROT_NONE) == 0);
    for (const std::size_t spare : {0, 4, 8}) {  // bytes before the end of the page
        auto* corners = reinterpret_cast<Vec3f*>(pages + kPage - spare) - 3;
        corners[0] = {0, 0, 0}, corners[1] = {1, 0, 0}, corners[2] = {0, 1, 0};
        Mesh mesh;
        mesh.positions = SharedArray<Vec3f>(corners, 3, nullptr);
        mesh.triangles = {{0, 1, 2}};
        const auto tracer = Intersector::build({mesh}, {{0, {}, false}}, {}, {});
        Ray ray;
        ray.origin = {0.25f, 0.25f, 1};
        ray.direction = {0, 0, -1};
        CHECK(tracer->intersect(ray)->t == 1);
    }
    munmap(pages, 2 * kPage);
}

TEST_CASE(
    "a triangle: distance and barycentrics, on both paths, under shear and mirroring") {
    const Vec3f a{0.1f, 0.2f, 0.3f}, b{1.3f, 0.1f, -0.2f}, c{0.2f, 1.5f, 0.4f};
    std::vector<Mesh> meshes{triangle_mesh(a, b, c)};
    std::vector<std::array<std::uint32_t, 3>> triangles(1000);  // degenerate triangles are never hit
    triangles[0] = {0, 1, 2};
    meshes[0].triangles = triangles;
    const Affine3f transforms[] = {
        {},
        {{-2, 0, 0}, {0, 1, 0}, {0, 0, 1}, {3, 4, 5}},
        {{1, 0.4f, 0}, {0.7f, 2, 0.1f}, {0, -0.3f, 0.5f}, {-1, 0, 2}}};
    Random random;
    for (const Affine3f& m : transforms) {
        for (bool flat : {true, false}) {
            std::vector<InstanceGeometry> instances{{0, m, false}};
            if (!flat) instances = crowd(meshes[0], m);
            const auto tracer = Intersector::build(meshes, instances, {}, {});
            CHECK(tracer->is_flattened(0) == flat);
            for (int i = 0; i < 1000; ++i) {
                float u = random(), v = random();
                if (u + v > 1) u = 1 - u, v = 1 - v;
                if (u < 1e-3f || v < 1e-3f || u + v > 0.999f) continue;
                const Vec3f p = m.point(a * (1 - u - v) + b * u + c * v);
                const float distance = 0.5f + random();
                const Ray ray = make_ray(p, random.direction());
                const Ray back = make_ray(p + ray.direction * distance, -ray.direction);
                // Rays nearly in the plane of the triangle are ill-conditioned.
                const Vec3f n = normalize(m.normal(cross(b - a, c - a)));
                if (std::abs(dot(n, ray.direction)) < 0.05f) continue;
                const auto hit = tracer->intersect(back);
                REQUIRE(hit.has_value());
                CHECK(hit->instance == 0);
                CHECK(hit->primitive == 0);
                CHECK(hit->t == doctest::Approx(distance).epsilon(1e-4));
                CHECK(hit->u == doctest::Approx(u).epsilon(1e-3));
                CHECK(hit->v == doctest::Approx(v).epsilon(1e-3));
            }
        }
    }
}

TEST_CASE("t_min and t_max are honoured") {
    const std::vector<Mesh> meshes{triangle_mesh({-1, -1, 0}, {1, -1, 0}, {0, 1, 0})};
    const auto tracer = Intersector::build(meshes, {{0, {}, false}}, {}, {});
    Ray ray = make_ray({0, 0, 2}, {0, 0, -1});
    auto check = [&](float t_min, float t_max, bool expected) {
        ray.t_min = t_min;
        ray.t_max = t_max;
        CHECK(tracer->intersect(ray).has_value() == expected);
        CHECK(tracer->occluded(ray) == expected);
    };
    check(0, 10, true);
    check(1.999f, 2.001f, true);
    check(0, 1.999f, false);
    check(2.001f, 10, false);
}

TEST_CASE("a shadow ray that cannot be traced is blocked, in an empty scene too") {
    // Found by fuzz_scene: a lamp beyond 10^18 m aborted the process.
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();
    const std::vector<Mesh> meshes{triangle_mesh({-1, -1, 0}, {1, -1, 0}, {0, 1, 0})};
    const auto full = Intersector::build(meshes, {{0, {}, false}}, {}, {});
    const auto empty = Intersector::build({}, {}, {}, {});
    std::vector<Ray> rays(6, make_ray({5, 5, 2}, {0, 0, -1}));  // beside the triangle
    for (const auto& tracer : {full.get(), empty.get()}) CHECK_FALSE(tracer->occluded(rays[0]));
    rays[0].direction.x = nan;
    rays[1].direction.z = -infinity;
    rays[2].origin.y = 1e30f;
    rays[3].origin.x = nan;
    rays[4].t_min = nan;
    rays[5].t_max = nan;
    for (const auto& tracer : {full.get(), empty.get()})
        for (std::size_t i = 0; i < rays.size(); ++i) {
            CAPTURE(i);
            CHECK(tracer->occluded(rays[i]));
        }
}

TEST_CASE("spheres: entry, exit from inside, miss") {
    const std::vector<Keyed<Sphere>> spheres{{{0}, {{{0, 0, 0}, 1}}}, {{0}, {{{10, 2, 3}, 0.25f}}}};
    const auto tracer = Intersector::build({}, {}, spheres, {});
    auto hit = tracer->intersect(make_ray({10, 2, 9}, {0, 0, -1}));
    REQUIRE(hit.has_value());
    CHECK(hit->instance == RawHit::kSphere);
    CHECK(hit->primitive == 1);
    CHECK(hit->t == doctest::Approx(5.75).epsilon(1e-6));
    hit = tracer->intersect(make_ray({0.5f, 0, 0}, {1, 0, 0}));
    REQUIRE(hit.has_value());
    CHECK(hit->primitive == 0);
    CHECK(hit->t == doctest::Approx(0.5).epsilon(1e-6));
    CHECK_FALSE(tracer->intersect(make_ray({0, 1.01f, 5}, {0, 0, -1})).has_value());
    CHECK(tracer->occluded(make_ray({0, 0.99f, 5}, {0, 0, -1})));
}

TEST_CASE("spheres that move are met where they are at the time of the ray, and nowhere else") {
    std::vector<Keyed<Sphere>> spheres;
    for (int i = 0; i < 5; ++i) {
        Keyed<Sphere> keys;
        for (int k = 0; k < 4; ++k) {
            const Vec3f center{float(hash_uniform(1, 4 * i + k)) * 6, float(i) * 3,
                               float(hash_uniform(2, 4 * i + k)) * 6};
            keys.times.push_back(k == 2 ? 0.3f : float(k) / 3);  // almost a jump at 1/3
            keys.values.push_back({center, 0.1f + float(hash_uniform(3, 4 * i + k))});
        }
        std::ranges::sort(keys.times);
        spheres.push_back(keys);
    }
    spheres.push_back({{0}, {{{0, -9, 0}, 1}}});  // static sphere
    const auto tracer = Intersector::build({}, {}, spheres, {});
    for (int i = 0; i < 3000; ++i) {
        const std::uint32_t which = i % 6;
        const float time = float(hash_uniform(4, i));
        const Sphere now = spheres[which].at(time);
        const double angle = 2 * kPiD * hash_uniform(5, i);
        const Vec3f toward{float(std::cos(angle)), 0, float(std::sin(angle))};
        Ray ray = make_ray(now.center - toward * 20, toward);
        ray.time = time;
        const auto hit = tracer->intersect(ray);
        REQUIRE(hit.has_value());
        CHECK(hit->instance == RawHit::kSphere);
        CHECK(hit->primitive == which);
        CHECK(hit->t == doctest::Approx(20 - now.radius).epsilon(1e-5));
        CHECK(tracer->occluded(ray));
        ray.t_max = 19.9f - now.radius;
        CHECK_FALSE(tracer->occluded(ray));
        ray = make_ray(now.center, toward);
        ray.time = time;
        CHECK(tracer->intersect(ray)->t == doctest::Approx(now.radius).epsilon(1e-5));
        ray = make_ray(now.center - toward * 20 + Vec3f{0, 1.01f * now.radius, 0}, toward);
        ray.time = time;
        CHECK_FALSE(tracer->intersect(ray).has_value());
    }
}

TEST_CASE("an empty scene is never hit") {
    const auto tracer = Intersector::build({}, {}, {}, {});
    CHECK_FALSE(tracer->intersect(make_ray({0, 0, 0}, {0, 0, 1})).has_value());
    CHECK_FALSE(tracer->occluded(make_ray({0, 0, 0}, {0, 0, 1})));
    CHECK(std::string(tracer->name()).find("Embree ") == 0);
}

TEST_CASE("cutout decides each hit, sees the world-space ray, and leaves others alone") {
    const std::vector<Mesh> meshes{triangle_mesh({-1, -1, 0}, {1, -1, 0}, {0, 1, 0})};
    Affine3f m;
    m.origin = {0, 0, 1};
    for (bool flat : {true, false}) {
        std::vector<InstanceGeometry> instances{{0, m, true}};
        if (!flat) instances = crowd(meshes[0], m, true);
        const auto behind = static_cast<std::uint32_t>(instances.size());
        Affine3f below;
        instances.push_back({0, below, false});
        bool ray_as_given = true;
        const auto tracer = Intersector::build(
            meshes, instances, {}, [&](const Ray& ray, const RawHit& hit) {
                ray_as_given = ray_as_given && ray.origin.z == 3 && hit.instance == 0;
                return ray.origin.x + ray.direction.x * hit.t > 0;
            });
        CHECK(tracer->is_flattened(0) == flat);
        const auto through = tracer->intersect(make_ray({0.1f, 0, 3}, {0, 0, -1}));
        REQUIRE(through.has_value());
        CHECK(through->instance == behind);
        CHECK(through->t == doctest::Approx(3));
        const auto stopped = tracer->intersect(make_ray({-0.1f, 0, 3}, {0, 0, -1}));
        REQUIRE(stopped.has_value());
        CHECK(stopped->instance == 0);
        CHECK(stopped->t == doctest::Approx(2));
        Ray ray = make_ray({0.1f, 0, 3}, {0, 0, -1});
        ray.t_max = 2.5f;
        CHECK_FALSE(tracer->occluded(ray));
        ray.origin.x = -0.1f;
        CHECK(tracer->occluded(ray));
        CHECK(ray_as_given);
    }
}

TEST_CASE("rays that Embree cannot take meet nothing, in the world and through a transform") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Mesh> meshes{triangle_mesh({-1, -1, 0}, {1, -1, 0}, {0, 1, 0})};
    for (const float scale : {1.f, 1e-19f}) {
        const Affine3f shrunk{{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}, {0, 0, 0}};
        const auto scene = Intersector::build(meshes, crowd(meshes[0], shrunk), {}, {});
        Ray ray = make_ray({0, 0, 1}, {0, 0, -1});
        CHECK(scene->intersect(ray).has_value() == (scale == 1));
        CHECK(scene->occluded(ray) == (scale == 1));
        for (const float odd : {nan, 2e18f, std::numeric_limits<float>::infinity()}) {
            for (const Ray& wrong : {Ray{{odd, 0, 1}, ray.direction}, Ray{ray.origin, {0, odd, -1}}}) {
                CHECK(!scene->intersect(wrong));
                CHECK(scene->occluded(wrong));
            }
        }
        ray.t_max = nan;
        CHECK(!scene->intersect(ray));
    }
}
