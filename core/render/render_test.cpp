#include "render/render.h"

#include <doctest/doctest.h>

#include <cstring>

#include "math/error.h"
#include "optics/lens/test_lenses.h"
#include "render/light_path_scenes.h"

namespace dg {
namespace {

RenderSettings small(std::uint32_t begin, std::uint32_t end) {
    RenderSettings s;
    s.sensor = {20, 14, 24, 16.8, {0, 0}};
    s.sample_begin = begin, s.sample_end = end;
    s.seed = 5;
    return s;
}

FilmLayout layout() { return {.width = 20, .height = 14, .layers = {Layer::aovs, Layer::splats, Layer::coverage}}; }

/// All bytes of a film's sums.
std::vector<std::byte> bits(const Film& film) {
    std::vector<std::byte> all;
    for (const std::string& part : film.state_parts()) {
        const auto words = film.state(part).bytes;
        all.insert(all.end(), words.begin(), words.end());
    }
    return all;
}

std::shared_ptr<const Scene> lamp_scene() { return World().light(kLamp).scene(); }

/// A scene of a uniform sky.
std::shared_ptr<const Scene> sky_scene(Rgb color) {
    SceneDescription d;
    d.environment = Environment::constant(color);
    return Scene::build(std::move(d));
}

RenderSettings with_light(RenderSettings s) {
    s.light = {150, 100};
    return s;
}

}  // namespace

TEST_CASE("ranges of samples, windows with their holes and threads give one film to the bit") {
    const auto scene = lamp_scene();
    for (const Camera& camera : {thin(), exact()}) {
        Film whole(layout());
        const RenderCounters all = render(*scene, camera, whole, with_light(small(0, 6)), nullptr);
        CHECK(all.camera_rays == 20 * 14 * 6);
        CHECK(all.light_paths > 6 * (150 + 100) - 3);
        CHECK(all.rays > all.camera_rays - all.stopped_rays);

        Film parts(layout());
        RenderSettings one = with_light(small(0, 2)), two = with_light(small(2, 6));
        one.threads = 1, two.threads = 3;
        RenderCounters sum = render(*scene, camera, parts, one, nullptr);
        sum += render(*scene, camera, parts, two, nullptr);
        CHECK(bits(parts) == bits(whole));
        CHECK(sum.camera_rays == all.camera_rays);
        CHECK(sum.light_paths == all.light_paths);
        CHECK(sum.rays == all.rays);

        RenderSettings other = with_light(small(0, 6));
        other.seed = 6;
        Film changed(layout());
        render(*scene, camera, changed, other, nullptr);
        CHECK(bits(changed) != bits(whole));
    }
}

TEST_CASE("a window draws its own pixels as the whole picture does, where nothing crosses between them") {
    const auto scene = lamp_scene();
    RenderSettings s = small(0, 4);
    s.filter = Filter(FilterKind::box);
    Film whole(layout()), part(layout());
    render(*scene, thin(), whole, s, nullptr);
    s.window = {3, 2, 17, 11}, s.hole = {5, 5, 8, 9};
    render(*scene, thin(), part, s, nullptr);
    const auto a = whole.mean_xyz(), b = part.mean_xyz();
    const auto counts = part.sample_counts();
    int differ = 0, drawn = 0;
    for (int y = 0; y < 14; ++y)
        for (int x = 0; x < 20; ++x) {
            const std::size_t i = std::size_t(y) * 20 + std::size_t(x);
            const bool inside = s.window.contains(x, y) && !s.hole.contains(x, y);
            CHECK(counts[i] == (inside ? 4u : 0u));
            drawn += inside;
            for (std::size_t c = 0; c < 3; ++c) differ += inside && a[3 * i + c] != b[3 * i + c];
        }
    CHECK(drawn == 14 * 9 - 3 * 4);
    CHECK(differ == 0);
}

TEST_CASE("a white world is 1 in every pixel of a pinhole, and its light, depth and alpha say so") {
    Film film(layout());
    render(*sky_scene({1, 1, 1}), camera_of(Pinhole{30}), film, small(0, 64), nullptr);
    const auto xyz = film.mean_xyz();
    double mean = 0;
    for (std::size_t i = 1; i < xyz.size(); i += 3) mean += xyz[i] / (20 * 14);
    CHECK(mean == doctest::Approx(1).epsilon(0.01));
    for (const float alpha : film.coverage()) CHECK(alpha == 0);

    Film hit(layout());
    const Camera camera = camera_of(Pinhole{30});
    render(*lamp_scene(), camera, hit, small(0, 8), nullptr);
    const auto alpha = hit.coverage(), depth = hit.aov("depth.Z"), x = hit.aov("P.X"), y = hit.aov("P.Y"),
               z = hit.aov("P.Z");
    const Affine3d pose = camera.world_from_camera.at(0);
    int seen = 0;
    for (std::size_t i = 0; i < alpha.size(); ++i) {
        if (alpha[i] < 1 || depth[i] == 0) continue;   // sphere lights have no depth
        ++seen;
        const double along = -dot(Vec3d{x[i], y[i], z[i]} - pose.origin, pose.z);
        CHECK(depth[i] == doctest::Approx(along).epsilon(1e-4));
    }
    CHECK(seen > 50);
}

TEST_CASE("what cannot be drawn is refused in words") {
    const auto scene = lamp_scene();
    Film film(FilmLayout{.width = 20, .height = 14, .layers = {Layer::flare}});
    RenderSettings s = small(0, 1);
    s.flare.per_sample = 10;
    CHECK_THROWS_WITH_AS(render(*scene, thin(), film, s, nullptr), doctest::Contains("flare"), Error);
    s.flare.per_sample = 0, s.scatter.per_sample = 10;
    CHECK_THROWS_WITH_AS(render(*scene, thin(), film, s, nullptr), doctest::Contains("scatter"), Error);
    Film channels(FilmLayout{.width = 20, .height = 14, .layers = {{Layer::channels, 3}}});
    CHECK_THROWS_WITH_AS(render(*scene, thin(), channels, small(0, 1), nullptr), doctest::Contains("responses"),
                         Error);
}

TEST_CASE("progress ends at 1, and false ends the drawing") {
    const auto scene = lamp_scene();
    Film film(layout());
    RenderSettings s = small(0, 2);
    s.threads = 1;
    double last = 0;
    render(*scene, thin(), film, s, [&](double done) {
        CHECK(done > last);
        last = done;
        return true;
    });
    CHECK(last == 1);
    Film torn(layout());
    const RenderCounters counters = render(*scene, thin(), torn, s, [](double) { return false; });
    CHECK(counters.camera_rays > 0);
    CHECK(counters.camera_rays < 20 * 14 * 2);
}

}  // namespace dg
