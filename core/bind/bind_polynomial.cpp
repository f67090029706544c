// bind_polynomial.cpp -- the construction kit of polynomial optics: systems, their
// elements, and the expansion of a lens.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <optional>

#include "bind/arrays.h"
#include "bind/unlocked.h"
#include "math/error.h"
#include "optics/stray/ghost.h"
#include "optics/expansion/elements.h"
#include "optics/expansion/system.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using dg::PolynomialSystem;
using dg::RayMap;
using Rays = nb::ndarray<const double, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu>;
using Column = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Coefficients =
    nb::ndarray<const double, nb::shape<-1, 4, -1>, nb::c_contig, nb::device::cpu>;
using Numbers = std::vector<double>;
using RayList = std::vector<dg::RayNumbers>;

/// A system with maps make(i), one per node, or a single map without nodes.
template <typename Make>
PolynomialSystem for_nodes(const Numbers& nm, const Make& make) {
    PolynomialSystem system{nm, {}};
    for (std::size_t i = 0; i < std::max<std::size_t>(1, nm.size()); ++i)
        system.maps.push_back(make(i));
    dg::check(system);
    return system;
}

/// The entry of node i; a single entry is shared by all nodes.
template <typename T>
const T& entry(const std::vector<T>& list, std::size_t i) {
    const std::size_t k = list.size() == 1 ? 0 : i;
    if (k >= list.size())
        throw dg::input_error("polynomial system", "list", "one entry, or one for each wavelength",
                              std::to_string(list.size()));
    return list[k];
}

PolynomialSystem from_arrays(int degree, const Numbers& nm, const RayList& origin,
                             const Coefficients& c) {
    dg::ray_series(degree, {});  // validates the degree
    const dg::Monomials& m = dg::Monomials::of(degree);
    if (c.shape(0) != std::max<std::size_t>(1, nm.size()) || int(c.shape(2)) != m.count())
        throw dg::input_error("polynomial system", "coefficients",
                              "shape (wavelengths, 4, " + std::to_string(m.count()) + ")",
                              "(" + std::to_string(c.shape(0)) + ", 4, " +
                                  std::to_string(c.shape(2)) + ")");
    return for_nodes(nm, [&](std::size_t i) {
        RayMap map{entry(origin, i), {}};
        for (int o = 0; o < 4; ++o) {
            const double* row = &c(i, o, 0);
            map.out[o] = dg::Series(m, Numbers(row, row + m.count()));
        }
        return map;
    });
}

auto coefficients(const PolynomialSystem& s) {
    const std::size_t count = dg::Monomials::of(s.degree()).count();
    Numbers flat;
    for (const RayMap& map : s.maps)
        for (const dg::Series& out : map.out)
            for (std::size_t i = 0; i < count; ++i) flat.push_back(out[int(i)]);
    return dg::bind::to_numpy(std::move(flat), {s.maps.size(), 4, count});
}

auto monomials(const PolynomialSystem& s) {
    const dg::Monomials& m = dg::Monomials::of(s.degree());
    std::vector<std::int32_t> flat;
    for (int i = 0; i < m.count(); ++i)
        flat.insert(flat.end(), m.exponents(i).begin(), m.exponents(i).end());
    return dg::bind::to_numpy(std::move(flat), {std::size_t(m.count()), 4});
}

auto origin(const PolynomialSystem& s) {
    Numbers flat;
    for (const RayMap& map : s.maps)
        flat.insert(flat.end(), map.origin.begin(), map.origin.end());
    return dg::bind::to_numpy(std::move(flat), {s.maps.size(), 4});
}

/// Calls each(i, ray i, the map at its wavelength). A single wavelength applies to all rays.
template <typename Each>
void for_rays(const PolynomialSystem& s, const Rays& rays, const Column& nm,
              const Each& each) {
    if (nm.shape(0) != 1 && nm.shape(0) != rays.shape(0))
        throw dg::input_error(
            "polynomial system", "wavelengths",
            "one, or one for each of " + std::to_string(rays.shape(0)) + " rays",
            std::to_string(nm.shape(0)));
    const dg::bind::Unlocked release;
    std::optional<RayMap> map;
    for (std::size_t i = 0; i < rays.shape(0); ++i) {
        const std::size_t k = nm.shape(0) == 1 ? 0 : i;
        if (!map || (k > 0 && nm(k) != nm(k - 1))) map = s.at(nm(k));
        each(i, dg::RayNumbers{rays(i, 0), rays(i, 1), rays(i, 2), rays(i, 3)}, *map);
    }
}

auto evaluate(const PolynomialSystem& s, const Rays& rays, const Column& nm) {
    Numbers flat(4 * rays.shape(0));
    for_rays(s, rays, nm,
             [&](std::size_t i, const dg::RayNumbers& ray, const RayMap& map) {
                 const dg::RayNumbers out = map.evaluate(ray);
                 std::copy(out.begin(), out.end(), &flat[4 * i]);
             });
    return dg::bind::to_numpy(std::move(flat), {rays.shape(0), 4});
}

auto jacobian(const PolynomialSystem& s, const Rays& rays, const Column& nm) {
    Numbers flat(16 * rays.shape(0));
    for_rays(s, rays, nm,
             [&](std::size_t i, const dg::RayNumbers& ray, const RayMap& map) {
                 const dg::Matrix4x4 j = map.jacobian(ray);
                 for (int row = 0; row < 4; ++row)
                     std::copy(j[row].begin(), j[row].end(), &flat[16 * i + 4 * row]);
             });
    return dg::bind::to_numpy(std::move(flat), {rays.shape(0), 4, 4});
}

PolynomialSystem of_lens(const dg::Prescription& lens, int degree, const Numbers& nm,
                         std::pair<double, double> z,
                         std::optional<std::pair<int, int>> ghost, bool toward_film,
                         std::optional<int> crossing, const dg::RayNumbers& about) {
    const dg::Tracer tracer(lens);
    dg::LensWay way{dg::straight_path(int(lens.surfaces.size()), toward_film), z.first,
                    z.second, crossing.has_value(), about};
    if (ghost)
        way.path = dg::ghost_path(tracer, ghost->first, ghost->second, toward_film);
    if (crossing) way.path = dg::path_to_stop(tracer, std::move(way.path), *crossing);
    return dg::lens_system(tracer, way, nm, degree);
}

void bind_elements(nb::module_& m) {
    using namespace dg;
    m.def(
        "polynomial_propagation",
        [](double distance, int degree, const Numbers& nm, const RayList& about) {
            return for_nodes(nm, [&](std::size_t i) {
                return propagation(distance, degree, entry(about, i));
            });
        },
        "distance"_a, "degree"_a, "nm"_a, "about"_a);
    m.def(
        "polynomial_refraction",
        [](const Surface& surface, const Numbers& n1, const Numbers& n2, int degree,
           const Numbers& nm, const RayList& about) {
            const SurfaceForm form(surface, 0);
            return for_nodes(nm, [&](std::size_t i) {
                return refraction(form, entry(n1, i), entry(n2, i), degree,
                                  entry(about, i));
            });
        },
        "surface"_a, "n1"_a, "n2"_a, "degree"_a, "nm"_a, "about"_a);
    m.def(
        "polynomial_reflection",
        [](const Surface& surface, int degree, const Numbers& nm, const RayList& about) {
            const SurfaceForm form(surface, 0);
            return for_nodes(nm, [&](std::size_t i) {
                return reflection(form, degree, entry(about, i));
            });
        },
        "surface"_a, "degree"_a, "nm"_a, "about"_a);
    m.def(
        "polynomial_placement",
        [](const std::array<double, 3>& decenter, const std::array<double, 3>& tilt,
           bool back, int degree, const Numbers& nm, const RayList& about) {
            return for_nodes(nm, [&](std::size_t i) {
                return placement({decenter[0], decenter[1], decenter[2]},
                                 {tilt[0], tilt[1], tilt[2]}, back, degree,
                                 entry(about, i));
            });
        },
        "decenter"_a, "tilt"_a, "back"_a, "degree"_a, "nm"_a, "about"_a);
}

}  // namespace

void bind_polynomial(nb::module_& m) {
    using namespace dg;
    nb::class_<PolynomialSystem>(m, "PolynomialSystem")
        .def(
            "__init__",
            [](PolynomialSystem* self, int degree, const Numbers& nm,
               const RayList& origin, const Coefficients& c) {
                new (self) PolynomialSystem(from_arrays(degree, nm, origin, c));
            },
            "degree"_a, "nm"_a, "origin"_a, "coefficients"_a)
        .def_prop_ro("degree", &PolynomialSystem::degree)
        .def_ro("nm", &PolynomialSystem::nm)
        .def("origin", &origin, "Base rays, (nodes, 4).")
        .def("monomials", &monomials, "Exponents, (monomials, 4).")
        .def("coefficients", &coefficients, "(nodes, outputs, monomials).")
        .def("evaluate", &evaluate, "rays"_a, "nm"_a, "(N, 4) to (N, 4).")
        .def("jacobian", &jacobian, "rays"_a, "nm"_a, "(N, 4) to (N, 4, 4).")
        .def(
            "at",
            [](const PolynomialSystem& s, double nm) {
                return PolynomialSystem{{nm}, {s.at(nm)}};
            },
            "wavelength_nm"_a)
        .def(
            "after",
            [](const PolynomialSystem& s, const PolynomialSystem& first) {
                return compose(s, first);
            },
            "first"_a)
        .def("inverse", [](const PolynomialSystem& s) { return inverse(s); })
        .def(
            "truncated",
            [](const PolynomialSystem& s, int degree) { return truncated(s, degree); },
            "degree"_a);
    bind_elements(m);
    m.def("polynomial_of_lens", &of_lens, "lens"_a, "degree"_a, "nm"_a, "z"_a, "ghost"_a,
          "toward_film"_a, "crossing"_a, "about"_a,
          "z: of the start and the end plane, mm. crossing: of the iris, at which it "
          "ends.");
    m.def("wavelength_nodes", &wavelength_nodes, "from_nm"_a, "to_nm"_a, "count"_a);
}
