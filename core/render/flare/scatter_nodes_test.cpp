// Scattered light on nodes agrees with splats of single paths: over the frame, at its edges, near the light's image and
// far from it. The film's noise estimate is correct.
#include "render/flare/scatter_nodes.h"

#include <doctest/doctest.h>

#include "render/flare/flare_scenes.h"

using namespace dg;

namespace {

RenderSettings node_settings(std::uint64_t seed, double paths, bool nodes) {
    RenderSettings s = wide_settings(seed, 0);
    s.scatter.per_sample = paths, s.scatter.nodes = nodes;
    return s;
}

Camera scattering(const Prescription& lens) {
    Camera camera = camera_with(lens);
    camera.scatter = {};
    return camera;
}

/// A sun at an angle to the right, and slightly up.
std::shared_ptr<const Scene> sun_at(float tangent) {
    SceneDescription d;
    d.lights = {SphereLight{{normalize(Vec3f{tangent, 0.03f, -1}) * 1000.f, 4.6f}, {3e5f, 3e5f, 3e5f}}};
    return Scene::build(std::move(d));
}

Blocks pictures(const Scene& scene, const Camera& camera, int count, double paths, bool nodes) {
    Blocks all;
    RenderSettings s = node_settings(0, paths, nodes);
    s.scatter.guide = std::make_shared<const ScatterGuide>(std::make_shared<const FlareAim>(scene, camera, s), scene,
                                                           camera, s);
    for (int k = 0; k < count; ++k) {
        s.seed = std::uint64_t(k) + (nodes ? 1 : 101);
        Film film(FilmLayout{.width = kWide, .height = kHigh, .layers = {Layer::flare}});
        render(scene, camera, film, s, nullptr);
        all.push_back(blocks_of(film.means("flare")));
    }
    return all;
}

}  // namespace

TEST_CASE("scattered light on nodes is that of paths by themselves, in every channel and block") {
    for (const Prescription& lens : {test::tessar(), test::sonnar(), test::telephoto()})
        for (const float tangent : {0.1f, 0.5f}) {   // inside and outside the frame
            const Camera camera = scattering(lens);
            const auto scene = sun_at(tangent);
            const Blocks nodes = pictures(*scene, camera, 8, 15000, true), alone = pictures(*scene, camera, 8, 20000, false);
            INFO(lens.name << " " << tangent << ": on nodes " << show(nodes) << ", alone " << show(alone));
            CHECK(whole(alone).mean > 0);
            CHECK(equality(nodes, alone) > 1e-3);
            CHECK(welch_p_value(whole(nodes), whole(alone)) > 1e-3);
        }
}

TEST_CASE("nodes keep the peak that glass leaves about the image of a light") {
    const auto scene = sun_at(0.1f);
    for (const double knee : {0.01, 0.001}) {
        Camera camera = scattering(test::tessar());
        camera.scatter.surface_lobe.knee = knee;
        // The same paths, with and without nodes: the brightest square of 4 x 4 pixels.
        const auto peak = [&](bool nodes) {
            Film film(FilmLayout{.width = kWide, .height = kHigh, .layers = {Layer::flare}});
            render(*scene, camera, film, node_settings(1, 40000, nodes), nullptr);
            const std::vector<float> xyz = film.means("flare");
            double most = 0;
            for (int y = 0; y + 4 <= kHigh; ++y)
                for (int x = 0; x + 4 <= kWide; ++x) {
                    double sum = 0;
                    for (int i = 0; i < 16; ++i) sum += xyz[3 * (std::size_t(y + i / 4) * kWide + x + i % 4) + 1];
                    most = std::max(most, sum);
                }
            return most;
        };
        INFO("knee " << knee);
        CHECK(peak(true) == doctest::Approx(peak(false)).epsilon(0.05));
    }
}

TEST_CASE("scatter on nodes has the same bits on any number of threads, in ranges of samples and in a crop") {
    const Camera camera = scattering(test::tessar());
    for (const float tangent : {0.1f, 0.5f}) {
        const auto scene = sun_at(tangent);
        const auto drawn = [&](int threads, std::uint32_t begin, std::uint32_t end, Film& film) {
            RenderSettings s = node_settings(3, 3001.3, true);
            s.threads = threads, s.sample_begin = begin, s.sample_end = end;
            render(*scene, camera, film, s, nullptr);
        };
        check_same_bits({.width = kWide, .height = kHigh, .layers = {Layer::flare}}, drawn);
        check_crop(drawn);
    }
}

TEST_CASE("the film knows the variance of scatter on nodes") {
    const Camera camera = scattering(test::tessar());
    const auto scene = sun_at(0.5f);
    constexpr int kPictures = 40;
    RenderSettings s = node_settings(0, 4000, true);
    s.scatter.guide = std::make_shared<const ScatterGuide>(std::make_shared<const FlareAim>(*scene, camera, s), *scene,
                                                           camera, s);
    std::vector<double> sum(kWide * kHigh), squares(kWide * kHigh);
    double told = 0, found = 0;
    for (int k = 0; k < kPictures; ++k) {
        s.seed = std::uint64_t(k) + 1;
        Film film(FilmLayout{.width = kWide, .height = kHigh, .layers = {Layer::flare}});
        for (int y = 0; y < kHigh; ++y)
            for (int x = 0; x < kWide; ++x) film.count(x, y);
        render(*scene, camera, film, s, nullptr);
        const std::vector<float> xyz = film.means("flare"), variance = film.variance_rgb();
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const double g = rgb_from_xyz({xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}).y;
            sum[i] += g, squares[i] += g * g;
            told += double(variance[3 * i + 1]) / kPictures;
        }
    }
    for (std::size_t i = 0; i < sum.size(); ++i) found += (squares[i] - sum[i] * sum[i] / kPictures) / (kPictures - 1);
    INFO(told << " " << found);
    CHECK(told / found == doctest::Approx(1).epsilon(0.05));   // Approx adds 1: within a tenth
}

TEST_CASE("where nodes cannot serve, paths bring light to their own pixels") {
    const Camera camera = scattering(test::tessar());
    const auto scene = sun_at(0.1f);
    const auto drawn = [&](bool nodes, const Filter& filter, int bands) {
        RenderSettings s = node_settings(5, 3000, nodes);
        s.filter = filter;
        Film film(FilmLayout{.width = kWide, .height = kHigh, .layers = {Layer::flare, {Layer::bands, bands}}});
        render(*scene, camera, film, s, nullptr);
        return film.means("flare");
    };
    const Filter usual, wide(FilterKind::gaussian, 6);
    CHECK(drawn(true, usual, 0) != drawn(false, usual, 0));
    CHECK(drawn(true, usual, 8) == drawn(false, usual, 8));
    CHECK(drawn(true, wide, 0) == drawn(false, wide, 0));
}
