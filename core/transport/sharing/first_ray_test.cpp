#include "transport/sharing/first_ray.h"

#include <doctest/doctest.h>

#include "scene/test_scenes.h"

namespace dg {
namespace {

/// A first ray with given densities of both techniques.
class Known final : public FirstRay {
  public:
    Known(const LightSharing& sharing, float lens, double camera)
        : FirstRay(sharing, 0), lens_(lens), camera_(camera) {}

  private:
    float lens_pdf(Vec3d, double w) const override { return w > 0 ? lens_ : 3 * lens_; }
    double camera_density() const override { return camera_; }
    Viewpoint viewpoint(float) const override { return {{0, 0, 0}, 0.01f}; }
    float lens_;
    double camera_;
};

}  // namespace

TEST_CASE("an emitter's light is shared by the densities of both techniques") {
    SceneDescription d;
    d.lights.push_back(SphereLight{{{0, 0, -3}, 0.5f}, {4, 4, 4}});
    d.environment = Environment::constant({1, 1, 1});
    const auto scene = Scene::build(std::move(d));
    const ViewCone view{{{0, 0, 0}, 0.01f}, 0};
    const EmissionSampler emission(scene->lights(), std::span(&view, 1));
    SurfaceHit hit;
    hit.position = {0, 0, -2.5f}, hit.wo = {0, 0, 1};
    const float point = emission.pdf_sphere(0, hit.position, 0, view.from), sky = emission.pdf_sky({0, 0, -1}, 0);
    REQUIRE(point > 0);
    const auto sharing = [&](Technique technique) {
        return LightSharing({2, 0}, technique, 0.5, &emission, nullptr);
    };
    const LightSharing both = sharing(Technique::both);
    const Known ray(both, 0.7f, 5);
    const double light = 2 * 0.5 * point * 0.7f;   // M x scale x densities, under a cosine of 1
    CHECK(*ray.weight_of_sphere(scene->lights(), 0, hit) == doctest::Approx(5 / (5 + light)));
    if (sky > 0) CHECK(*ray.weight_of_sky({0, 0, -1}) == doctest::Approx(5 / (5 + 3 * 0.7f * sky)));
    CHECK(ray.lens_over_camera({1, 2, 3}) == doctest::Approx(0.7 / 5));
    CHECK_FALSE(Known(both, 0, 5).weight_of_sphere(scene->lights(), 0, hit).has_value());
    const LightSharing camera = sharing(Technique::camera), other = sharing(Technique::light);
    CHECK(*Known(camera, 0.7f, 5).weight_of_sphere(scene->lights(), 0, hit) == 1);
    CHECK(*Known(other, 0.7f, 5).weight_of_sphere(scene->lights(), 0, hit) == 0);
}

}  // namespace dg
