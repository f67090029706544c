// view_cases.h -- cameras of every kind with visible scene points, for tests of light transport
// through the lens in both directions.
#pragma once
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "optics/lens/test_lenses.h"

namespace dg::test {

using Random = std::mt19937;
inline Vec2f square(Random& random) {
    std::uniform_real_distribution<float> u(0, 1);
    const float a = u(random);
    return {a, u(random)};
}
/// Cycles through four wavelengths.
inline float wavelength(std::size_t i) {
    return 430.f + 70.f * float(i % 4);
}

struct ViewPoint {
    Vec3d at;  // m, or a direction
    double w = 1;
    double half = 0.01;  // half side of a square around the point: m, or a tangent
};

struct ViewCase {
    std::string name;
    Camera camera;
    std::vector<ViewPoint> points;
    float opening = 1;
    Vec2f half_film_mm{18, 12};

    /// Whether a film point is in the frame.
    bool on_film(Vec2f mm) const {
        return std::abs(mm.x) <= half_film_mm.x && std::abs(mm.y) <= half_film_mm.y;
    }
};

inline std::vector<ViewPoint> usual_points() {
    return {{{0, 0, -2}},
            {{0.5, -0.3, -2}},
            {{0.2, 0.1, -0.7}, 1, 0.004},
            {{-2, 1.2, -7}, 1, 0.04},
            {{0.2, 0.15, -1}, 0, 0.01}};
}

inline Camera still(LensKind lens) {
    return {Motion{}, std::move(lens)};
}

/// Whether all rays pass through one point.
inline bool is_hole(const LensKind& lens) {
    const auto* projection = std::get_if<Projection>(&lens);
    return std::holds_alternative<Pinhole>(lens) || (projection && projection->aperture_radius_mm == 0);
}

inline std::vector<ViewCase> projection_cases() {
    using Kind = ProjectionModel::Kind;
    const Iris pentagon = Iris::polygon(5, 20, 0.3);
    const ProjectionModel phone(Kind::opencv, {-0.21, 0.09, 0.002, -0.003, -0.02, 0.01, 0, 0, 0.004, 0, -0.003, 0,
                                               0.02, -0.03});
    const ProjectionModel fisheye(Kind::kannala_brandt, {-0.02, 0.004, -0.001, 0.0002});
    const ProjectionModel sphere(Kind::double_sphere, {-0.2, 0.58});
    std::vector<ViewPoint> around = usual_points();
    around.push_back({{1.5, 0.4, -0.2}, 1, 0.02});
    around.push_back({{-0.9, 0.5, 0.3}, 0, 0.01});
    std::vector<ViewCase> cases;
    Camera zooming = still(Projection{phone, {30, 31}, {0.5, -0.3}, 5, 2});
    zooming.lens_motion = {
        {0.2f, 0.9f},
        {Projection{phone, {25, 26}, {}, 3, 1.5, pentagon}, Projection{phone, {36, 37}, {1, -0.5}, 7, 4}}};
    cases.push_back({"projection, zooming", zooming, usual_points()});
    cases.push_back({"projection, hole", still(Projection{phone, {30, 31}, {0.5, -0.3}}), usual_points()});
    const ProjectionModel tracked(Kind::opencv_inverse, {0.15, -0.02, 0.002, -0.003});
    cases.push_back({"projection by the inverse, hole", still(Projection{tracked, {30, 31}, {0.5, -0.3}}), usual_points()});
    cases.push_back({"fisheye, hole", still(Projection{fisheye, {11, 11}, {0.2, 0}}), around});
    cases.push_back({"projection, iris", still(Projection{phone, {30, 31}, {0.5, -0.3}, 5, 2}), usual_points(), 0.7f});
    cases.push_back({"fisheye, iris", still(Projection{fisheye, {11, 11.5}, {0.2, 0}, 3, 1.5}), around});
    cases.push_back(
        {"double sphere, pentagon", still(Projection{sphere, {9, 9}, {}, 4, HUGE_VAL, pentagon}), around});
    return cases;
}

inline std::vector<ViewCase> ideal_cases() {
    const Iris pentagon = Iris::polygon(5, 20, 0.3);
    std::vector<ViewCase> cases;
    cases.push_back({"pinhole", still(Pinhole{50, false}), usual_points()});
    cases.push_back({"pinhole, cos^4", still(Pinhole{35, true}), usual_points(), 0.5f});
    cases.push_back({"thin", still(ThinLens{50, 9, 2, {}, false}), usual_points()});
    cases.push_back({"thin, pentagon, cos^4", still(ThinLens{50, 9, 2, pentagon, true}),
                     usual_points(), 0.7f});
    cases.push_back({"thin, tilted", still(ThinLens{50, 9, 2, pentagon, false, {6, -4}}),
                     usual_points()});
    cases.push_back({"thin, tilted, cos^4",
                     still(ThinLens{40, 15, 2, {}, true, {-12, 20}}), usual_points()});
    Camera moving = still(ThinLens{50, 9, 2});
    moving.lens_motion = {{0, 1},
                          {ThinLens{45, 5, 1.5}, ThinLens{60, 12, 4, {}, false, {0, 3}}}};
    cases.push_back({"thin, moving", moving, usual_points()});
    ThickLensSettings s;
    s.f_stop = 2.8, s.focus_distance_m = 2;
    cases.push_back(
        {"thick", still(ThickLens(check_lens(true, 0.5), s)), usual_points()});
    s.iris = pentagon, s.tilt_deg = {5, -4};
    const ThickLens tilted(check_lens(true, 0.5), s);
    cases.push_back({"thick, tilted", still(tilted), usual_points(), 0.8f});
    s.focus_distance_m = 0.6;
    Camera focusing = still(tilted);
    focusing.lens_motion = {
        {0.3f, 0.7f},
        {ThickLens(check_lens(true, 0.5), s).in_the_body_of(tilted), tilted}};
    cases.push_back({"thick, moving", focusing, usual_points()});
    for (ViewCase& c : projection_cases()) cases.push_back(std::move(c));
    return cases;
}

inline ExactLensSettings exact_settings(double f_stop, double focus_m, Iris iris = {}) {
    ExactLensSettings s;
    s.f_stop = f_stop, s.focus_distance_m = focus_m, s.iris = std::move(iris);
    return s;
}

/// Check lens with a weak cylinder at the front surface: no axial symmetry.
inline Prescription anamorphic() {
    Prescription lens = check_lens(true, 0.5);
    lens.name = "anamorphic";
    Surface& s = lens.surfaces[0];
    s.curvature_x = 0.9 * s.curvature;
    set_kind(s, "toroid");
    return lens;
}

inline Prescription decentred() {
    Prescription lens = check_lens(true, 0.5);
    lens.name = "decentred";
    lens.surfaces[3].decenter = {0.4, -0.3, 0};
    lens.surfaces[3].tilt = {0.5, 0.8, 0};
    return lens;
}

/// Iris with an off-centre opening.
inline Iris half_moon() {
    std::vector<float> values;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) {
            const double a = (x - 11.5) / 12, b = (y - 11.5) / 12;
            values.push_back(
                a * a + b * b < 1 && a + 0.4 * b > -0.2 ? (y % 5 ? 1.f : 0.6f) : 0.f);
        }
    return Iris::image(24, 24, values);
}

inline std::vector<ViewCase> exact_cases() {
    const Prescription gauss = check_lens(true, 0.5);
    std::vector<ViewPoint> points = usual_points();
    points.push_back({{0.02, 0.015, -0.12}, 1, 0.001});
    points.push_back({{0.01, -0.012, -0.05}, 1, 0.001});
    std::vector<ViewCase> cases;
    const auto add = [&](const char* name, const Prescription& lens,
                         const ExactLensSettings& s, const std::vector<ViewPoint>& seen,
                         float opening = 1) {
        cases.push_back({name, still(ExactLens(lens, s)), seen, opening});
    };
    add("double Gauss f/2", gauss, exact_settings(2, 2), points);
    add("double Gauss f/8", gauss, exact_settings(8, 2), points, 0.6f);
    add("pentagon", gauss, exact_settings(2.8, 2, Iris::polygon(5, 20, 0.3)), points);
    add("image", gauss, exact_settings(4, 2, half_moon()), points);
    add("wide angle", wide_angle(), exact_settings(2, 2), usual_points());
    add("telephoto", telephoto(), exact_settings(1.8, 10),
        {{{0, 0, -10}},
         {{0.7, -0.4, -10}},
         {{0.2, 0.1, -4}, 1, 0.004},
         {{0.06, 0.05, -1}, 0, 0.003}});
    add("fisheye", fisheye(), exact_settings(2.8, 1),
        {{{0, 0, -1}},
         {{1, 0.3, -1}},
         {{-2.2, 0.9, -0.75}, 1, 0.02},
         {{0.34, 0.17, -0.1}, 1, 0.003},
         {{0.85, -0.5, -0.1}, 0, 0.01}});
    ExactLensSettings s = exact_settings(2.8, 2);
    s.film_half_mm = {18, 12};
    add("anamorphic", anamorphic(), s, points);
    add("decentred", decentred(), s, points);
    s.tilt_deg = {5, -4};
    add("tilted", gauss, s, points);
    ExactLens middle(gauss, exact_settings(2.8, 2)),
        near(gauss, exact_settings(2.8, 0.7));
    Camera focusing = still(middle);
    focusing.lens_motion = {{0.3f, 0.7f}, {near.in_the_body_of(middle), middle}};
    cases.push_back({"focusing", focusing, points});
    return cases;
}

inline std::vector<ViewCase> view_cases() {
    std::vector<ViewCase> cases = ideal_cases();
    for (ViewCase& c : exact_cases()) cases.push_back(std::move(c));
    return cases;
}

}  // namespace dg::test
