// fuzz_projection.cpp -- parameters of any projection: an Error, or directions and points that are numbers.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "camera/projection.h"
#include "input.h"
#include "math/error.h"

namespace dg {
namespace {

void need(bool holds, const char* what, const ProjectionModel& model, std::array<double, 3> at) {
    if (holds) return;
    std::fprintf(stderr, "model %d at %.9g, %.9g, %.9g: %s\n", int(model.kind()), at[0], at[1], at[2], what);
    std::abort();
}

double parameter(FuzzInput& in) { return in.flag() ? 0 : double(in.number()); }

void look(const ProjectionModel& model, FuzzInput& in) {
    const double angle = model.largest_angle(), radius = model.largest_radius();
    need(angle >= 0 && radius >= 0, "ends of the field", model, {angle, radius, 0});
    for (int i = 0; i < 12; ++i) {
        const Vec3f d = in.vec3();
        const double x = in.number(), y = in.number();
        if (!std::isfinite(dot(d, d)) || !(std::abs(x) + std::abs(y) < 1e4)) continue;   // focal lengths
        if (const auto p = model.project({d.x, d.y, d.z}))
            need(std::isfinite(p->x) && std::isfinite(p->y), "a point", model, {d.x, d.y, d.z});
        need(model.solid_angle({x, y}) >= 0, "a solid angle", model, {x, y, model.solid_angle({x, y})});
        if (const auto ray = model.unproject({x, y}))
            need(std::abs(dot(*ray, *ray) - 1) < 1e-6, "a direction", model, {x, y, dot(*ray, *ray)});
    }
}

void shoot(const ProjectionModel& model, FuzzInput& in) {
    Projection camera{.model = model};
    camera.focal_mm = {1 + 50 * std::abs(double(in.factor())), 1 + 50 * std::abs(double(in.factor()))};
    camera.aperture_radius_mm = in.flag() ? 5 * double(in.factor()) : 0;
    camera.focus_distance_m = 0.1 + std::abs(double(in.factor()));
    std::vector<CameraSample> samples(8);
    for (CameraSample& s : samples) {
        const float x = in.factor(), y = in.factor();
        s.film_mm = {30 * x - 15, 30 * y - 15};
        s.u_lens = {in.factor(), in.factor()};
    }
    std::vector<CameraRay> rays(samples.size());
    camera.generate(samples, rays);
    std::vector<Reprojection> back(samples.size());
    camera.reproject(rays, back);
}

}  // namespace
}  // namespace dg

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace dg;
    FuzzInput in(data, size);
    try {
        const auto kind = ProjectionModel::Kind(in.below(int(ProjectionModel::Kind::ftheta) + 1));
        std::array<double, ProjectionModel::kMost> parameters;
        for (double& p : parameters) p = parameter(in);
        const ProjectionModel model(kind, parameters);
        if (std::getenv("FUZZ_SHOW"))
            for (const double p : parameters) std::fprintf(stderr, "%.17g ", p);
        look(model, in);
        shoot(model, in);
    } catch (const Error&) {
    }
    return 0;
}
