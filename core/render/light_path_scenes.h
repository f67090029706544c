// light_path_scenes.h -- for tests: a table under lamps, rendered by camera paths alone, by light paths alone and by
// both. The three pictures must agree.
#pragma once
#include <doctest/doctest.h>

#include <cstdlib>
#include <string>

#include "math/statistics.h"
#include "optics/lens/test_lenses.h"
#include "render/render.h"
#include "scene/test_scenes.h"

namespace dg {

inline constexpr int kWidth = 16, kHeight = 12, kBlock = 4;   // px

inline Camera camera_of(LensKind lens) {
    Affine3d pose;
    const Vec3d eye{0.1, 0.5, 1.1}, back = normalize(eye - Vec3d{0, 0.05, 0});
    pose.z = back;
    pose.x = normalize(cross(Vec3d{0, 1, 0}, back));
    pose.y = cross(back, pose.x);
    pose.origin = eye;
    return {Motion(pose), std::move(lens)};
}

inline Camera thin() { return camera_of(ThinLens{50, 12, 1.2}); }

inline Camera exact() {
    ExactLensSettings s;
    s.f_stop = 4;
    s.focus_distance_m = 1.2;
    return camera_of(ExactLens(test::tessar(), s));
}

/// Luminances of blocks of pixels, one row per independent picture.
using Blocks = std::vector<std::vector<double>>;

struct Trial {
    double m2 = 2000;
    std::uint32_t camera_spp = 48, light_spp = 10, both_spp = 10;
    int pictures = 8;
    RenderSettings settings = RenderSettings();
    Filter filter = Filter(FilterKind::box);
};

inline Blocks draw(const Scene& scene, const Camera& camera, const Trial& look, Technique technique) {
    Blocks all;
    for (int k = 0; k < look.pictures; ++k) {
        RenderSettings s = look.settings;
        s.sensor = {kWidth, kHeight, 24, 18, {0, 0}};
        s.filter = look.filter;
        s.technique = technique;
        s.seed = std::uint64_t(100 * int(technique) + k + 1);
        static const char* more = std::getenv("DG_EFFORT");   // factor on the number of samples
        static const std::uint32_t effort = more ? std::uint32_t(std::atoi(more)) : 1;
        s.sample_end = effort * (technique == Technique::both     ? look.both_spp
                                 : technique == Technique::camera ? look.camera_spp
                                                         : look.light_spp);
        if (technique != Technique::camera) s.light.m2 = look.m2;
        Film film(FilmLayout{.width = kWidth, .height = kHeight, .layers = {{Layer::splats, !s.light.off()}}});
        render(scene, camera, film, s, nullptr);
        const auto xyz = film.mean_xyz();
        std::vector<double> blocks(std::size_t(kWidth / kBlock) * (kHeight / kBlock), 0);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                blocks[std::size_t(y / kBlock) * (kWidth / kBlock) + x / kBlock] +=
                    xyz[3 * (std::size_t(y) * kWidth + x) + 1] / (kBlock * kBlock);
        all.push_back(blocks);
    }
    return all;
}

inline SampleMoments block(const Blocks& b, std::size_t i) {
    std::vector<double> values;
    for (const auto& picture : b) values.push_back(picture[i]);
    return moments(values);
}

inline SampleMoments whole(const Blocks& b) {
    std::vector<double> values;
    for (const auto& picture : b) {
        double sum = 0;
        for (const double v : picture) sum += v;
        values.push_back(sum / double(picture.size()));
    }
    return moments(values);
}

/// Smallest p-value among the blocks and the whole picture, with a Bonferroni correction.
inline double equality(const Blocks& a, const Blocks& b, double factor = 1) {
    double least = 1;
    const auto compare = [&](SampleMoments x, SampleMoments y) {
        y.mean *= factor;
        least = std::min(least, welch_p_value(x, y));
    };
    for (std::size_t i = 0; i < a[0].size(); ++i) compare(block(a, i), block(b, i));
    compare(whole(a), whole(b));
    return 1 - std::pow(1 - least, double(a[0].size() + 1));
}

inline void check_one_picture(const Scene& scene, const Camera& camera, const Trial& look = {}) {
    const Blocks by_camera = draw(scene, camera, look, Technique::camera);
    const Blocks by_light = draw(scene, camera, look, Technique::light);
    const Blocks by_both = draw(scene, camera, look, Technique::both);
    const auto show = [](const char* name, const Blocks& b) {
        const SampleMoments m = whole(b);
        return std::string(name) + " " + std::to_string(m.mean) + " +- " +
               std::to_string(std::sqrt(m.variance / m.count));
    };
    INFO(show("camera", by_camera), show(", light", by_light), show(", both", by_both));
    CHECK(whole(by_camera).mean > 0);
    CHECK(equality(by_camera, by_light) > 1e-3);
    CHECK(equality(by_camera, by_both) > 1e-3);
}

inline GltfMaterial plain(float roughness = 1, Rgb color = {0.7f, 0.6f, 0.5f}) {
    GltfMaterial m;
    m.base_color = color;
    m.metallic = 0;
    m.roughness = roughness;
    return m;
}

inline Affine3f placed(Vec3f at, float scale, bool lies = false) {
    Affine3f a;
    a.x = {scale, 0, 0};
    a.y = lies ? Vec3f{0, 0, -scale} : Vec3f{0, scale, 0};
    a.z = lies ? Vec3f{0, scale, 0} : Vec3f{0, 0, scale};
    a.origin = at;
    return a;
}

/// A table in front of a wall, which light each other.
struct World {
    SceneDescription d;
    World(Material table = {"table", plain()}) {
        d.meshes = {quad_mesh(), ball_mesh(3)};
        add(0, std::move(table), placed({0, 0, 0}, 0.6f, true));
        add(0, {"wall", plain(1, {0.8f, 0.8f, 0.9f})}, placed({0, 0.3f, -0.35f}, 0.6f));
    }
    World& add(std::uint32_t mesh, Material material, Affine3f where) {
        d.instances.push_back({"it", mesh, std::uint32_t(d.materials.size()), where});
        d.materials.push_back(std::move(material));
        return *this;
    }
    World& light(Light light) {
        d.lights.push_back(std::move(light));
        return *this;
    }
    std::shared_ptr<const Scene> scene() { return Scene::build(std::move(d)); }
};

inline const SphereLight kLamp{{{-0.2f, 0.5f, 0.1f}, 0.08f}, {20, 20, 20}};

}  // namespace dg
