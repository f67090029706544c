// module.cpp -- daguerre._core. Thin: arrays in, arrays out, no logic.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "bind/unlocked.h"
#include "version.h"

namespace nb = nanobind;

void bind_errors(nb::module_& m);
void bind_cancel(nb::module_& m);
void bind_codec(nb::module_& m);
void bind_motion(nb::module_& m);
void bind_glass(nb::module_& m);
void bind_prescription(nb::module_& m);
void bind_polynomial(nb::module_& m);
void bind_optics(nb::module_& m);
void bind_lens_fit(nb::module_& m);
void bind_ghosts(nb::module_& m);
void bind_scatter(nb::module_& m);
void bind_light_profile(nb::module_& m);
void bind_scene(nb::module_& m);
void bind_projection(nb::module_& m);
void bind_camera(nb::module_& m);
void bind_shutter(nb::module_& m);
void bind_spectrum(nb::module_& m);
void bind_film(nb::module_& m);
void bind_render_settings(nb::module_& m);
void bind_render(nb::module_& m);
void bind_ray_map(nb::module_& m);
void bind_truth(nb::module_& m);
void bind_develop_expose(nb::module_& m);
void bind_develop_picture(nb::module_& m);
void bind_post_warp(nb::module_& m);
void bind_post_blur(nb::module_& m);
void bind_post_grain(nb::module_& m);
void bind_post_waves(nb::module_& m);

/// Makes nanobind create its array type now: it would abort if memory ran out at the first array.
void make_array_type() {
    static const float zero = 0;
    nb::cast(nb::ndarray<nb::memview, const float, nb::shape<1>, nb::device::cpu>(&zero, {1}, nb::none()));
}

NB_MODULE(_core, m) {
    m.attr("__version__") = DG_VERSION;
    dg::bind::watch_process();
    m.def("is_ending", &dg::bind::is_ending, "Whether Python is about to end: other threads draw no more.");
    make_array_type();
    bind_errors(m);
    bind_cancel(m);
    bind_codec(m);
    bind_motion(m);
    bind_glass(m);
    bind_prescription(m);
    bind_polynomial(m);
    bind_optics(m);
    bind_lens_fit(m);
    bind_ghosts(m);
    bind_scatter(m);
    bind_light_profile(m);
    bind_scene(m);
    bind_projection(m);
    bind_camera(m);
    bind_shutter(m);
    bind_spectrum(m);
    bind_film(m);
    bind_render_settings(m);
    bind_render(m);
    bind_ray_map(m);
    bind_truth(m);
    bind_develop_expose(m);
    bind_develop_picture(m);
    bind_post_warp(m);
    bind_post_blur(m);
    bind_post_grain(m);
    bind_post_waves(m);
}
