// bind_develop_expose.cpp -- conversion of exposure to sensor values.
#include "bind/arrays.h"
#include "bind/unlocked.h"
#include "develop/expose.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Picture = nb::ndarray<const float, nb::shape<-1, -1, -1>, nb::c_contig, nb::device::cpu>;
using Weights = nb::ndarray<const float, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;
using Cells = nb::ndarray<const std::uint8_t, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;

dg::Shot shot_of(const Weights& electrons, const Cells& cells) {
    dg::Shot shot;
    shot.channels = int(electrons.shape(0));
    shot.electrons.assign(electrons.data(), electrons.data() + electrons.size());
    shot.cell_height = int(cells.shape(0));
    shot.cell_width = int(cells.shape(1));
    shot.cells.assign(cells.data(), cells.data() + cells.size());
    return shot;
}

nb::tuple expose(const Picture& light, const dg::Shot& shot) {
    const std::size_t height = light.shape(0), width = light.shape(1);
    dg::Exposed out;
    {
        dg::bind::Unlocked release;
        out = dg::expose({light.data(), int(width), int(height), int(light.shape(2))}, shot);
    }
    return nb::make_tuple(dg::bind::to_numpy(std::move(out.mosaic), {height, width}),
                          dg::bind::to_numpy(std::move(out.saturated), {height, width}), out.negative,
                          out.bad, nb::make_tuple(out.bad_x, out.bad_y));
}

auto expected(const Picture& light, const dg::Shot& shot) {
    const std::size_t height = light.shape(0), width = light.shape(1);
    std::vector<float> out;
    {
        dg::bind::Unlocked release;
        out = dg::expected_electrons({light.data(), int(width), int(height), int(light.shape(2))}, shot);
    }
    return dg::bind::to_numpy(std::move(out), {height, width});
}

}  // namespace

void bind_develop_expose(nb::module_& m) {
    using dg::Shot;
    nb::class_<Shot>(m, "Shot", "A sensor and its settings; electrons, unless named otherwise.")
        .def("__init__",
             [](Shot* self, const Weights& electrons, const Cells& cells) {
                 new (self) Shot(shot_of(electrons, cells));
             },
             "electrons"_a, "cells"_a, "Electrons of a plane's 1 in each channel, (C, P); channels of photosites, (h, w).")
        .def_rw("low_pass_px", &Shot::low_pass_px)
        .def_rw("crosstalk", &Shot::crosstalk)
        .def_rw("prnu", &Shot::prnu)
        .def_rw("dsnu", &Shot::dsnu)
        .def_rw("dark", &Shot::dark)
        .def_rw("hot_share", &Shot::hot_share)
        .def_rw("hot_dark", &Shot::hot_dark)
        .def_rw("full_well", &Shot::full_well)
        .def_rw("read_noise", &Shot::read_noise)
        .def_rw("gain", &Shot::gain)
        .def_rw("black_dn", &Shot::black_dn)
        .def_rw("highest_dn", &Shot::highest_dn)
        .def_rw("serial", &Shot::serial)
        .def_rw("seed", &Shot::seed);
    m.def("expose", &expose, "light"_a, "shot"_a,
          "Light (H, W, P) to DN (H, W), saturated (H, W), and counts of negative and of bad photosites with "
          "the first of these.");
    m.def("expected_electrons", &expected, "light"_a, "shot"_a,
          "Light (H, W, P) to the electrons that it makes on average (H, W), without noise.");
}
