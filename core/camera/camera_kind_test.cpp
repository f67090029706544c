#include "camera/camera_kind.h"

#include <doctest/doctest.h>

#include "camera/camera.h"
#include "camera/inverse/inverse_kind.h"

namespace dg {
namespace {

/// Smallest complete kind, without optics.
struct Complete {
    struct Numbers {
        double focal_mm;
        NumberGroups groups() const { return {{focal_mm}}; }
    };
    Numbers numbers() const { return {50}; }
    void set(const Numbers&) {}
    void generate(std::span<const CameraSample>, std::span<CameraRay>) const {}
    void generate(const Numbers&, std::span<const CameraSample>, std::span<CameraRay>) const {}
    void reproject(std::span<const CameraRay>, std::span<Reprojection>) const {}
    void reproject(const Numbers&, std::span<const CameraRay>, std::span<Reprojection>) const {}
    Vec3d chief_direction(Vec2d) const { return {0, 0, -1}; }
    std::optional<Vec2d> film_point(Vec3d, double) const { return {}; }
    Opening opening() const { return Hole{}; }
    Opening opening(const Numbers&) const { return Hole{}; }
};
Complete::Numbers blend(const Complete::Numbers& a, const Complete::Numbers&, double) { return a; }

struct OneWay : Complete {
    void reproject() const {}
};
struct Blind : Complete {
    void chief_direction() const {}
};
struct Hidden : Complete {   // lacks the inverse
    void opening() const {}
};
struct Still : Complete {   // neither interpolated numbers nor states
    struct Numbers {};
};
struct Both : Complete {
    Both in_the_body_of(const Both&) const { return {}; }
};

static_assert(CameraKind<Complete>);
static_assert(!CameraKind<OneWay>);
static_assert(!CameraKind<Blind>);
static_assert(!CameraKind<Hidden>);
static_assert(!CameraKind<Still>);
static_assert(!CameraKind<Both>);
static_assert(!kCameraKinds<std::variant<Pinhole, OneWay>>);
static_assert(InverseKind<Complete>);   // film_point() and opening() suffice
static_assert(!InverseKind<Hidden>);
static_assert(ReprojectsByWavelength<ExactLens> && !ReprojectsByWavelength<Pinhole>);
static_assert(ChangesEvenly<Pinhole> && ChangesEvenly<ThinLens> && ChangesEvenly<Projection>);
static_assert(ChangesInSteps<ThickLens> && ChangesInSteps<ExactLens>);

}  // namespace

TEST_CASE("the view direction of ideal kinds is that of the ray through their middle") {
    const Vec2f film{7, -4};
    const std::vector<CameraSample> samples{{film, {0.5f, 0.5f}, 0, 550}};
    const auto check = [&](const auto& lens) {
        std::vector<CameraRay> rays(1);
        lens.generate(samples, rays);
        CHECK(length(to_float(lens.chief_direction({7, -4})) - rays[0].ray.direction) < 1e-6f);
    };
    check(Pinhole{35});
    check(ThinLens{50, 8, 2});
}

TEST_CASE("a film that is shifted is undone at each ray's own time") {
    Camera camera{Motion{}, Pinhole{50}};
    std::vector<CameraRay> rays(2);
    rays[0].ray.time = 0.25f, rays[1].ray.time = 1;
    std::vector<Reprojection> landings(2, {.film_mm = {1, 1}});
    undo_film_shift(camera, rays, landings);
    CHECK(landings[0].film_mm == Vec2f{1, 1});
    camera.setting = {{0, 1}, {{1, {0, 0}}, {1, {4, -8}}}};
    undo_film_shift(camera, rays, landings);
    CHECK(landings[0].film_mm == Vec2f{0, 3});
    CHECK(landings[1].film_mm == Vec2f{-3, 9});
    camera.setting = {{0}, {{1, {2, 2}}}};   // constant setting
    undo_film_shift(camera, rays, landings);
    CHECK(landings[0].film_mm == Vec2f{-2, 1});
}

}  // namespace dg
