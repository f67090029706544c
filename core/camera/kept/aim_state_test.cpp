#include "camera/kept/aim_state.h"

#include <doctest/doctest.h>

#include "optics/lens/test_lenses.h"

using namespace dg;

namespace {

ExactLensSettings at(double f_stop) {
    ExactLensSettings s;
    s.f_stop = f_stop, s.focus_distance_m = 3;
    return s;
}

std::vector<CameraRay> drawn(const ExactLens& lens) {
    std::vector<CameraSample> samples;
    for (int i = 0; i < 1000; ++i)
        samples.push_back({{float(i % 30 - 15), float(i % 17 - 8)},
                           {(i % 50 + 0.5f) / 50, (float(i / 50) + 0.5f) / 20},
                           0,
                           float(390 + i * 0.38)});
    std::vector<CameraRay> rays(samples.size());
    lens.generate(samples, rays);
    return rays;
}

}  // namespace

TEST_CASE("a lens from a kept aim draws the same bits") {
    for (const double tilt : {0.0, 5.0}) {
        ExactLensSettings s = at(2.8);
        s.tilt_deg = {tilt, 0};
        const ExactLens cold(test::check_lens(true, 0.5), s);
        s.cache = cold.aim_state();
        const ExactLens kept(test::check_lens(true, 0.5), s);
        CHECK(kept.aim_state() == s.cache);
        CHECK(kept.h0() == cold.h0());
        CHECK(kept.transmittance() == cold.transmittance());
        const auto a = drawn(cold), b = drawn(kept);
        int passed = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            passed += a[i].weight > 0;
            CHECK(a[i].weight == b[i].weight);
            CHECK(a[i].ray.direction == b[i].ray.direction);
            CHECK(a[i].ray.origin == b[i].ray.origin);
        }
        CHECK(passed > 500);
    }
}

TEST_CASE("the key differs as soon as a number does") {
    const Prescription lens = test::tessar();
    const std::string key = aim_key(lens, at(4));
    CHECK(key.size() == 32);
    CHECK(key == aim_key(lens, at(4)));
    std::vector<std::string> others{aim_key(lens, at(4.0001)), aim_key(test::sonnar(), at(4))};
    const auto with = [&](auto change) {
        Prescription l = lens;
        ExactLensSettings s = at(4);
        change(l, s);
        others.push_back(aim_key(l, s));
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
    others.push_back(key);
    for (std::size_t i = 0; i < others.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) CHECK(others[i] != others[k]);
    Prescription renamed = lens;
    renamed.name = "the same glass";
    CHECK(aim_key(renamed, at(4)) == key);
}

TEST_CASE("damaged and foreign bytes are not used") {
    ExactLensSettings s = at(4);
    const ExactLens cold(test::tessar(), s);
    const std::string state = cold.aim_state(), key = aim_key(test::tessar(), s);
    CHECK(aim_from_bytes(state, key));
    CHECK_FALSE(aim_from_bytes(state, aim_key(test::tessar(), at(5))));
    CHECK_FALSE(aim_from_bytes("", key));
    CHECK_FALSE(aim_from_bytes(state.substr(0, state.size() - 1), key));
    for (std::size_t i = 0; i < state.size(); i += 997) {
        std::string bad = state;
        bad[i] = char(bad[i] ^ 16);
        CHECK_FALSE(aim_from_bytes(bad, key));
    }
    s.cache = "nonsense";
    CHECK(ExactLens(test::tessar(), s).aim_state() == state);
}
