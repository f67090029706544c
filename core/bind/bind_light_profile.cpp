// bind_light_profile.cpp -- light profiles from arrays.
#include <nanobind/stl/array.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "bind/arrays.h"
#include "light/light_profile.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace dg::bind {
namespace {

using Angles = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Values = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Triple = std::array<float, 3>;

std::vector<float> copied(const auto& array) {
    return {array.data(), array.data() + array.size()};
}
Triple triple(Rgb c) { return {c.x, c.y, c.z}; }

std::shared_ptr<LightProfile> make(float scale, const std::vector<std::tuple<float, float>>& cones,
                                   const std::vector<std::tuple<float, Triple>>& focuses,
                                   const std::vector<std::tuple<Angles, Angles, Values>>& tables) {
    ProfileParts parts{.scale = scale};
    for (const auto& [angle, softness] : cones) parts.cones.push_back({angle, softness});
    for (const auto& [exponent, tint] : focuses) parts.focuses.push_back({exponent, {tint[0], tint[1], tint[2]}});
    for (const auto& [theta, phi, values] : tables)
        parts.tables.push_back({copied(theta), copied(phi), copied(values)});
    return std::make_shared<LightProfile>(std::move(parts));
}

nb::ndarray<nb::numpy, float> factors(const LightProfile& profile, const Rows3f& directions) {
    const std::size_t count = directions.shape(0);
    std::vector<float> out;
    out.reserve(3 * count);
    for (const float* d = directions.data(); out.size() < 3 * count; d += 3) {
        const Rgb f = profile.at(normalize(Vec3f{d[0], d[1], d[2]}));
        out.insert(out.end(), {f.x, f.y, f.z});
    }
    return to_numpy(std::move(out), {count, 3});
}

}  // namespace
}  // namespace dg::bind

void bind_light_profile(nb::module_& m) {
    using namespace dg;
    using namespace dg::bind;
    nb::class_<LightProfile>(m, "LightProfile")
        .def_static("make", &make, "scale"_a, "cones"_a, "focuses"_a, "tables"_a,
                    "cones: (angle rad, softness); focuses: (exponent, tint); tables: theta (T,) and phi (P,) in rad, "
                    "values (T, P).")
        .def("factors", &factors, "directions"_a, "Factors (N, 3) along directions (N, 3) in the lamp's frame.")
        .def_prop_ro("peak", &LightProfile::peak)
        .def_prop_ro("spread", &LightProfile::spread)
        .def_prop_ro("mean", [](const LightProfile& p) { return triple(p.mean()); });
}
