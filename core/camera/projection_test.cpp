#include "camera/projection.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "camera/model_cases.h"

using namespace dg;
using Kind = ProjectionModel::Kind;

TEST_CASE("drawn rays come back to their film point with their weight") {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> u(0, 1);
    for (const double aperture : {0.0, 4.0})
        for (const double focus : {0.5, 3.0, double(HUGE_VAL)})
            for (const test::ModelCase& c : test::model_cases()) {
                CAPTURE(c.name);
                CAPTURE(aperture);
                CAPTURE(focus);
                Projection lens{c.model, {10, 10.3}, {0.4, -0.2}, aperture, focus, Iris::polygon(6, 10, 0.2)};
                std::vector<CameraSample> samples(200);
                for (CameraSample& s : samples)
                    s = {{24 * u(random) - 12, 16 * u(random) - 8}, {u(random), u(random)}, 0.5f, 550, 0.8f};
                std::vector<CameraRay> rays(samples.size());
                std::vector<Reprojection> back(samples.size());
                lens.generate(samples, rays);
                lens.reproject(rays, back);
                int seen = 0, near = 0;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    if (!(rays[i].weight > 0)) continue;
                    ++seen;
                    const Vec2f off = back[i].film_mm - samples[i].film_mm;
                    near += back[i].transmittance > 0 && length(off) < 2e-3f &&
                            std::abs(back[i].aim_weight * back[i].transmittance / rays[i].weight - 1) < 1e-4f;
                }
                CHECK(seen > 20);
                CHECK(near >= seen - 2);   // except at the rim of the iris, or of a cube face
            }
}

TEST_CASE("what is in focus is met by all rays of a film point") {
    const ProjectionModel fisheye(Kind::equidistant), phone(Kind::opencv, {-0.2, 0.05});
    for (const auto& [model, film] : {std::pair{fisheye, Vec2f{16, 4}}, std::pair{phone, Vec2f{5, -4}}}) {
        const Projection lens{model, {10, 10}, {}, 5, 2};
        std::vector<CameraSample> samples;
        for (float a = 0.05f; a < 1; a += 0.1f)
            for (float b = 0.05f; b < 1; b += 0.1f) samples.push_back({film, {a, b}, 0.5f, 550});
        std::vector<CameraRay> rays(samples.size());
        lens.generate(samples, rays);
        const Vec3d chief = *lens.chief_direction({film.x, film.y});
        const Vec3d point = chief * (model.is_wide() ? 2 : 2 / -chief.z);
        for (const CameraRay& r : rays) {
            const Vec3d to = point - to_double(r.ray.origin);
            CHECK(length(cross(normalize(to), to_double(r.ray.direction))) < 1e-6);
            CHECK(std::abs(dot(to_double(r.ray.origin), chief)) < 1e-7);   // the iris faces the chief ray
        }
    }
}
