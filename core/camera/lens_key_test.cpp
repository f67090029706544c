#include "camera/lens_key.h"

#include <doctest/doctest.h>

#include "optics/lens/test_lenses.h"

using namespace dg;

namespace {

ExactLensSettings at(double f_stop) {
    ExactLensSettings s;
    s.f_stop = f_stop, s.focus_distance_m = 3;
    return s;
}

}  // namespace

TEST_CASE("the key differs as soon as a number does") {
    const Prescription lens = test::tessar();
    const std::string key = lens_key(lens, at(4));
    CHECK(key == lens_key(lens, at(4)));
    std::vector<std::string> others{lens_key(lens, at(4.0001)), lens_key(test::sonnar(), at(4))};
    const auto with = [&](auto change) {
        Prescription l = lens;
        ExactLensSettings s = at(4);
        change(l, s);
        others.push_back(lens_key(l, s));
    };
    with([](Prescription& l, auto&) { l.surfaces[2].thickness += 1e-12; });
    with([](Prescription& l, auto&) { l.surfaces[1].semi_diameter *= 0.999; });
    with([](Prescription& l, auto&) { l.surfaces[1].conic = -1e-9; });
    with([](Prescription& l, auto&) { l.surfaces[1].asphere = {{4, 1e-9}}; });
    with([](Prescription& l, auto&) { l.surfaces[1].decenter.x = 1e-9; });
    with([](Prescription& l, auto&) { l.surfaces[0].glass = Glass{AbbeGlass{1.5, 60}, ""}; });
    with([](Prescription& l, auto&) { l.coating = Coating::uncoated; });
    with([](auto&, ExactLensSettings& s) { s.iris = Iris::polygon(5, 0, 0); });
    with([](auto&, ExactLensSettings& s) { s.iris = Iris::polygon(5, 1, 0); });
    with([](auto&, ExactLensSettings& s) { s.iris = Iris::image(2, 2, {1, 1, 1, 0.5f}); });
    with([](auto&, ExactLensSettings& s) { s.film_z = 100; });
    with([](auto&, ExactLensSettings& s) { s.tilt_deg = {0, 1}; });
    with([](auto&, ExactLensSettings& s) { s.film_half_mm = {18, 12}; });
    with([](auto&, ExactLensSettings& s) { s.half_diagonal_mm = 20; });
    with([](auto&, ExactLensSettings& s) { s.fitted = FittedGlass{5}; });
    with([](auto&, ExactLensSettings& s) { s.fitted = FittedGlass{7}; });
    others.push_back(key);
    for (std::size_t i = 0; i < others.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) CHECK(others[i] != others[k]);
    Prescription renamed = lens;
    renamed.name = "the same glass";
    CHECK(lens_key(renamed, at(4)) == key);
}
