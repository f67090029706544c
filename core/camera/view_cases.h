// view_cases.h -- cameras of every kind, with points of the scene that they see: for the tests of light that
// goes through the lens from either side.
#pragma once
#include <string>
#include <vector>

#include "camera/camera.h"
#include "optics/test_lenses.h"

namespace dg::test {

struct ViewPoint {
    Vec3d at;      // m, or a direction
    double w = 1;
    double half = 0.01;   // of a square around it: m, or a tangent
};

struct ViewCase {
    std::string name;
    Camera camera;
    std::vector<ViewPoint> points;
    float half_diagonal_mm = 21.64f, opening = 1;
};

inline std::vector<ViewPoint> usual_points() {
    return {{{0, 0, -2}}, {{0.5, -0.3, -2}}, {{0.2, 0.1, -0.7}, 1, 0.004}, {{-2, 1.2, -7}, 1, 0.04},
            {{0.2, 0.15, -1}, 0, 0.01}};
}

inline Camera still(LensKind lens) { return {Motion{}, std::move(lens)}; }

inline std::vector<ViewCase> ideal_cases() {
    const Iris pentagon = Iris::polygon(5, 20, 0.3);
    std::vector<ViewCase> cases;
    cases.push_back({"pinhole", still(Pinhole{50, false}), usual_points()});
    cases.push_back({"pinhole, cos^4", still(Pinhole{35, true}), usual_points(), 21.64f, 0.5f});
    cases.push_back({"thin", still(ThinLens{50, 9, 2, {}, false}), usual_points()});
    cases.push_back({"thin, pentagon, cos^4", still(ThinLens{50, 9, 2, pentagon, true}),
                     usual_points(), 21.64f, 0.7f});
    cases.push_back({"thin, tilted", still(ThinLens{50, 9, 2, pentagon, false, {6, -4}}),
                     usual_points()});
    cases.push_back({"thin, tilted, cos^4", still(ThinLens{40, 9, 2, {}, true, {-8, 12}}),
                     usual_points()});
    Camera moving = still(ThinLens{50, 9, 2});
    moving.lens_motion = {{0, 1}, {ThinLens{45, 5, 1.5}, ThinLens{60, 12, 4, {}, false, {0, 3}}}};
    cases.push_back({"thin, moving", moving, usual_points()});
    ThickLensSettings s;
    s.f_stop = 2.8, s.focus_distance_m = 2;
    cases.push_back({"thick", still(ThickLens(check_lens(true, 0.5), s)), usual_points()});
    s.iris = pentagon, s.tilt_deg = {5, -4};
    const ThickLens tilted(check_lens(true, 0.5), s);
    cases.push_back({"thick, tilted", still(tilted), usual_points(), 21.64f, 0.8f});
    s.focus_distance_m = 0.6;
    Camera focusing = still(tilted);
    focusing.lens_motion = {{0.3f, 0.7f},
                            {ThickLens(check_lens(true, 0.5), s).in_the_body_of(tilted), tilted}};
    cases.push_back({"thick, moving", focusing, usual_points()});
    return cases;
}

inline std::vector<ViewCase> view_cases() {
    return ideal_cases();
}

}  // namespace dg::test
