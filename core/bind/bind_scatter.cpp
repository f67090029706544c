// bind_scatter.cpp -- scattering parts of a lens, and random walks through a lens on the bench.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include "bind/arrays.h"
#include "bind/unlocked.h"
#include "optics/stray/film_walks.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Lobe = std::pair<double, double>;   // knee and slope

dg::Finish finish(const std::tuple<double, double, Lobe>& f) {
    const auto& [diffuse, gloss, lobe] = f;
    return {diffuse, gloss, {lobe.first, lobe.second}};
}

auto from_film(const dg::ScatterLens& lens, std::pair<double, double> point, double spot, double nm, int walks,
               std::uint64_t seed) {
    std::vector<double> flat;
    {
        dg::bind::Unlocked release;
        for (const dg::FilmWalk& w : film_walks(lens, {{point.first, point.second}, spot, nm, walks, seed}))
            flat.insert(flat.end(), {-w.direction.z, atan2(w.direction.y, w.direction.x), w.weight,
                                     double(w.events)});
    }
    const std::size_t n = flat.size() / 4;
    return dg::bind::to_numpy(std::move(flat), {n, std::size_t(4)});
}

}  // namespace

void bind_scatter(nb::module_& m) {
    using namespace dg;
    using FinishFacts = std::tuple<double, double, Lobe>;
    nb::class_<LensScatter>(m, "LensScatter")
        .def("__init__",
             [](LensScatter* self, const FinishFacts& barrel, const FinishFacts& blades, double rms_nm, Lobe lobe) {
                 const LensScatter made{finish(barrel), finish(blades), rms_nm, {lobe.first, lobe.second}};
                 check_scatter(made);
                 new (self) LensScatter(made);
             },
             "barrel"_a, "blades"_a, "surface_rms_nm"_a, "surface_lobe"_a,
             "Finishes as (diffuse, gloss, (knee, slope)); roughness of the glass and its lobe.");
    nb::class_<ScatterLens>(m, "ScatterLens")
        .def("__init__",
             [](ScatterLens* self, const Prescription& lens, double film_z_mm, const Iris& iris,
                double iris_radius_mm, const SensorStack& stack, double half_diagonal_mm,
                const LensScatter& scatter) {
                 new (self) ScatterLens(lens, {{0, 0, film_z_mm}}, iris, iris_radius_mm, stack, half_diagonal_mm,
                                        scatter);
             },
             "prescription"_a, "film_z_mm"_a, "iris"_a, "iris_radius_mm"_a, "stack"_a, "half_diagonal_mm"_a,
             "scatter"_a)
        .def_prop_ro("rims",
                     [](const ScatterLens& lens) {
                         std::vector<double> flat;
                         for (const auto& rim : lens.rims()) flat.insert(flat.end(), {rim.radius, rim.z});
                         const std::size_t n = lens.rims().size();
                         return bind::to_numpy(std::move(flat), {n, std::size_t(2)});
                     },
                     "Radius and z (mm) of the edges between which the barrel lies, by surface (N, 2).")
        .def("from_film", &from_film, "point_mm"_a, "spot_mm"_a, "wavelength_nm"_a, "walks"_a, "seed"_a = 0,
             "Walks (N, 4) that start in a disc of the film, go backward and leave the front: cosine of the angle "
             "to the axis, azimuth (rad), weight (of their sum the film's irradiance from a white world of "
             "radiance 1, sr) and how often they were scattered.");
}
