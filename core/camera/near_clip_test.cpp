// Exit distances of rays from the clipped region, against plane and ball.
#include "camera/near_clip.h"

#include <doctest/doctest.h>

#include "math/hash.h"

namespace dg {
namespace {

/// Random rays from around the pupil.
template <typename Use>
void for_rays(const Use& use) {
    for (int i = 0; i < 2000; ++i) {
        const auto u = [&](int k) { return 2 * hash_uniform(std::uint64_t(k), std::uint64_t(i)) - 1; };
        const Vec3d from{0.1 * u(1), 0.1 * u(2), 0.1 * u(3)}, way{u(4), u(5), u(6)};
        if (length(way) > 1e-3) use(from, normalize(way));
    }
}

}  // namespace

TEST_CASE("without a distance nothing is clipped") {
    for_rays([](Vec3d from, Vec3d way) {
        CHECK(NearClip{}.end(from, way) == 0);
        CHECK(NearClip{0, true}.end(from, way) == 0);
    });
}

TEST_CASE("a ray leaves the plane where it lies that far ahead, and never if it does not go there") {
    const NearClip clip{0.5};
    for_rays([&](Vec3d from, Vec3d way) {
        const double t = clip.end(from, way);
        if (way.z >= 0 || t >= 1e17)
            CHECK(t > 1e17);
        else
            CHECK((from + t * way).z == doctest::Approx(-0.5));
    });
    CHECK(clip.end({0, 0, -0.6}, {0, 0, -1}) == 0);   // the front of a long lens is beyond the plane
    CHECK(clip.end({0, 0, -0.6}, {0, 1, 0}) == 0);
}

TEST_CASE("a ray leaves the ball at its radius, whatever way it goes") {
    const NearClip clip{0.5, true};
    for_rays([&](Vec3d from, Vec3d way) { CHECK(length(from + clip.end(from, way) * way) == doctest::Approx(0.5)); });
    CHECK(clip.end({0, 0, -0.6}, {0, 0, -1}) == 0);
    CHECK(clip.end({0, 0, -0.6}, {1, 0, 0}) == 0);
}

}  // namespace dg
