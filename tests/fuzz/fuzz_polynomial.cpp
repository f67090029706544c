// fuzz_polynomial.cpp -- systems of a construction kit, of any numbers: an Error, or maps of the stated degree.
#include <cstdlib>

#include "input.h"
#include "math/error.h"
#include "math/vec.h"
#include "optics/expansion/elements.h"
#include "optics/expansion/system.h"

namespace dg {
namespace {

RayNumbers any_ray(FuzzInput& in) {
    RayNumbers ray{};
    if (in.below(4) == 0)
        for (double& r : ray) r = 0.1 * double(in.number());
    return ray;
}

RayMap any_element(FuzzInput& in, int degree) {
    const RayNumbers about = any_ray(in);
    Surface surface;
    switch (in.below(4)) {
        case 0: return propagation(10 * double(in.number()), degree, about);
        case 1: surface.curvature = 0.1 * double(in.number()); break;
        case 2: surface.curvature = 0.1 * double(in.number()), surface.conic = in.number(); break;
        default: {
            const Vec3f moved = in.vec3(), turned = in.vec3();
            return placement(to_double(moved), to_double(turned), in.flag(), degree, about);
        }
    }
    const SurfaceForm form(surface, 0);
    if (in.flag()) return reflection(form, degree, about);
    return refraction(form, 1 + double(in.factor()), 1 + double(in.factor()), degree, about);
}

PolynomialSystem any_system(FuzzInput& in, int degree) {
    PolynomialSystem system;
    const int nodes = in.below(4);
    double nm = 400;
    for (int i = 0; i < nodes; ++i) system.nm.push_back(nm += 50 * double(in.number()));
    for (int i = 0; i < std::max(nodes, 1); ++i) system.maps.push_back(any_element(in, degree));
    check(system);
    return system;
}

}  // namespace
}  // namespace dg

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace dg;
    FuzzInput in(data, size);
    const int degree = 1 + in.below(5);
    try {
        const PolynomialSystem first = any_system(in, degree), second = any_system(in, 1 + in.below(5));
        const RayMap map = first.at(450 + 10 * double(in.number()));
        if (map.degree() != first.degree()) std::abort();
        map.evaluate(any_ray(in));
        map.jacobian(any_ray(in));
        compose(second, first).at(500);
        inverse(truncated(first, 1 + in.below(degree)));
    } catch (const Error&) {
    }
    return 0;
}
