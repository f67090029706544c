// Camera, shutter and film together: exposure by a moving camera, compared with closed forms.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "optics/lens/test_lenses.h"
#include "render/render.h"

namespace dg {
namespace {

constexpr int kWide = 24, kHigh = 6;

/// A wall of luminance 1 in the plane z = -1 that covers x < 0, or y < 0 if `turned`.
std::shared_ptr<const Scene> half_wall(bool turned) {
    SceneDescription d;
    Mesh wall;
    wall.name = "wall";
    if (turned) wall.positions = {{-9, -9, -1}, {9, -9, -1}, {9, 0, -1}, {-9, 0, -1}};
    else wall.positions = {{-9, -9, -1}, {0, -9, -1}, {0, 9, -1}, {-9, 9, -1}};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}};
    d.meshes.push_back(wall);
    d.materials.push_back({"light", DiffuseMaterial{{0, 0, 0}}, {1, 1, 1}, true});
    d.instances.push_back({"wall", 0, 0, {}});
    return Scene::build(std::move(d));
}

/// Luminances of a frame of kWide x kHigh pixels by a camera that moves along the part [begin, end] of `path`.
std::vector<float> expose(const LensKind& lens, const ShutterSettings& shutter, Vec3d path, int spp,
                          double begin = 0, double end = 1, double pixel_mm = 1) {
    const double times[] = {0, 1};
    Affine3d from, to;
    from.origin = (begin - 0.5) * path, to.origin = (end - 0.5) * path;
    const Affine3d poses[] = {from, to};
    RenderSettings settings;
    settings.sensor = {kWide, kHigh, kWide * pixel_mm, kHigh * pixel_mm, {0, 0}};
    settings.filter = Filter(FilterKind::box);
    settings.shutter = Shutter(shutter, kWide, kHigh);
    settings.sample_end = std::uint32_t(spp);
    Film film(FilmLayout{kWide, kHigh, 0, 0});
    const Camera camera{Motion::keys(times, poses, Interpolation::decomposed), lens};
    render(*half_wall(path.y != 0), camera, film, settings, nullptr);
    const auto xyz = film.mean_xyz();
    std::vector<float> luminance;
    for (std::size_t i = 1; i < xyz.size(); i += 3) luminance.push_back(xyz[i]);
    return luminance;
}

/// Largest difference from the expected exposure of film points (mm across the edge), averaged over the pixel.
double largest_error(const std::vector<float>& picture, bool columns,
                     const std::function<double(double position_mm, int x, int y)>& expected) {
    double largest = 0;
    for (int y = 0; y < kHigh; ++y)
        for (int x = 0; x < kWide; ++x) {
            double mean = 0;
            for (int i = 0; i < 64; ++i) {
                const double in = (i + 0.5) / 64;
                mean += expected(columns ? kHigh / 2.0 - y - in : x + in - kWide / 2.0, x, y) / 64;
            }
            largest = std::max(largest, std::abs(picture[y * kWide + x] - mean));
        }
    return largest;
}

/// Integral of the opening curve s from 0 to u.
double opened_until(const OpeningCurve& s, double u) {
    double sum = 0;
    for (int i = 0; i < 400; ++i) sum += s.at((i + 0.5) / 400 * std::clamp(u, 0.0, 1.0));
    return sum / 400 * std::clamp(u, 0.0, 1.0);
}

ShutterSettings settings_of(const OpeningCurve& curve, double exposure, ScanOrder scan = ScanOrder::none,
                            double line = 0) {
    ShutterSettings s;
    s.exposure_s = exposure, s.curve = curve, s.scan = scan, s.line_time_s = line;
    return s;
}

constexpr double kPath = 0.32;   // m: 16 mm on the film of a 50 mm lens that sees the wall 1 m away

}  // namespace

TEST_CASE("the blur of a moving edge is the integral of the shutter's opening") {
    const double u[] = {0, 0.2, 0.2, 1}, s[] = {1, 1, 0.3, 0};
    const OpeningCurve measured = OpeningCurve::points(u, s);
    for (const OpeningCurve& curve : {OpeningCurve(), OpeningCurve::trapezoid(0.6), measured}) {
        const auto picture = expose(Pinhole{50}, settings_of(curve, 0.02), {kPath, 0, 0}, 1024);
        // At time t the wall's edge is at -path (t - 1/2) in the camera frame. A point at x mm sees the wall until the
        // edge passes it.
        const auto law = [&](const OpeningCurve& c, double x) {
            return opened_until(c, 0.5 - x / (50 * kPath));
        };
        const double right = largest_error(
            picture, false, [&](double x, int, int) { return law(curve, x); });
        CHECK(right < 0.02);
        const double wrong = largest_error(
            picture, false, [&](double x, int, int) { return law(OpeningCurve::trapezoid(0.8), x); });
        CHECK(wrong > 0.04);
    }
}

TEST_CASE("a rolling shutter slants what moves, by speed x line time per line, in each direction") {
    // The camera crosses the frame while 6 rows (24 columns) are exposed in sequence.
    for (const ScanOrder scan : {ScanOrder::top, ScanOrder::bottom, ScanOrder::left, ScanOrder::right}) {
        const bool columns = scan == ScanOrder::left || scan == ScanOrder::right;
        const int lines = columns ? kWide : kHigh;
        const double exposure = 0.25, line = 1.0, duration = exposure + (lines - 1) * line;
        const Vec3d path = columns ? Vec3d{0, 0.1, 0} : Vec3d{kPath, 0, 0};
        const auto picture = expose(
            Pinhole{50}, settings_of(OpeningCurve(), exposure, scan, line), path, 1024);
        const auto law = [&](ScanOrder order, double position, int x, int y) {
            const int i = order == ScanOrder::top ? y : order == ScanOrder::bottom ? kHigh - 1 - y
                          : order == ScanOrder::left ? x : kWide - 1 - x;
            const double passes = 0.5 - position / (50 * (columns ? path.y : path.x));
            return std::clamp((passes * duration - i * line) / exposure, 0.0, 1.0);
        };
        CHECK(largest_error(picture, columns, [&](double p, int x, int y) {
                  return law(scan, p, x, y);
              }) < 0.02);
        const ScanOrder flipped = scan == ScanOrder::top      ? ScanOrder::bottom
                                  : scan == ScanOrder::bottom ? ScanOrder::top
                                  : scan == ScanOrder::left   ? ScanOrder::right
                                                              : ScanOrder::left;
        CHECK(largest_error(picture, columns, [&](double p, int x, int y) {
                  return law(flipped, p, x, y);
              }) > 0.5);
    }
}

TEST_CASE("through glass that disperses, each line of a rolling shutter is the picture of its own moment") {
    // Wide open, longitudinal chromatic aberration moves wavelengths by several pixels of 4 um, to other lines.
    ExactLensSettings settings;
    settings.f_stop = 2.2, settings.focus_distance_m = 1, settings.half_diagonal_mm = 1;
    const ExactLens lens(test::check_lens(false, 0.5), settings);
    const double exposure = 0.5, duration = exposure + kHigh - 1, pixel = 0.004;   // 1 s from line to line
    const Vec3d path{kPath * pixel, 0, 0};
    const OpeningCurve curve = OpeningCurve::trapezoid(0.7);
    const auto rolled = expose(lens, settings_of(curve, exposure, ScanOrder::top, 1), path, 1024, 0, 1, pixel);
    double largest = 0, total = 0, change = 0;
    for (int y = 0; y < kHigh; ++y) {
        const auto still = expose(lens, settings_of(curve, exposure), path, 1024, y / duration,
                                  (y + exposure) / duration, pixel);
        for (int x = 0; x < kWide; ++x) {
            const int i = y * kWide + x;
            largest = std::max(largest, double(std::abs(rolled[i] - still[i])));
            total += (rolled[i] - still[i]) / (kWide * kHigh);
            if (y) change = std::max(change, double(std::abs(rolled[i] - rolled[i - kWide])));
        }
    }
    CHECK(change > 0.2);     // from line to line
    CHECK(largest < 0.03);
    CHECK(std::abs(total) < 0.001);
}

TEST_CASE("a leaf shutter's thin lens blurs what moves and what is out of focus together") {
    // A leaf shutter uncovers the pupil radius r while a(t) >= r. In focus the exposure is weighted by the open area,
    // a^2.
    ShutterSettings leaf = settings_of(OpeningCurve::trapezoid(0.7), 0.02);
    leaf.leaf = true;
    const OpeningCurve radius = leaf.curve;
    const auto sharp = expose(ThinLens{50, 5, 1}, leaf, {kPath, 0, 0}, 1024);
    const auto area = [&](double u) {
        double sum = 0;
        const double end = std::clamp(u, 0.0, 1.0);
        for (int i = 0; i < 400; ++i) sum += std::pow(radius.at((i + 0.5) / 400 * end), 2);
        return sum / 400 * end;
    };
    CHECK(largest_error(sharp, false, [&](double x, int, int) {
              return area(0.5 - x / (50 * kPath));
          }) < 0.03);
    // Focused at infinity, the ray through the pupil point p hits the wall at 1 m displaced by p.
    const ThinLens blurred{50, 60, std::numeric_limits<double>::infinity()};
    const auto joint = expose(blurred, leaf, {kPath, 0, 0}, 1024);
    const auto law = [&](double x) {
        double sum = 0;
        const int n = 60;
        for (int i = 0; i < n; ++i)         // quadrature over the disc in strips of x
            for (int j = 0; j < n; ++j) {
                const double u = (i + 0.5) / n, a = radius.at(u), q = -1 + 2 * (j + 0.5) / n;
                const double strip = std::abs(q) < a ? 2 * std::sqrt(a * a - q * q) * 2 / n / kPiD : 0;
                const double seen = kPath * (u - 0.5) + q * 0.06 + x / 50;
                sum += seen < 0 ? strip / n : 0;
            }
        return sum;
    };
    CHECK(largest_error(joint, false, [&](double x, int, int) { return law(x); }) < 0.03);
}

}  // namespace dg
