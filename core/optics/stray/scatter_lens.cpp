#include "optics/stray/scatter_lens.h"

#include <algorithm>
#include <cmath>

#include "optics/lens/lens_error.h"

namespace dg {
namespace {

constexpr double kRimShare = 0.1, kImageShare = 0.5;   // probabilities of aiming a scatter off metal at a rim or at
                                                       // an image of the iris
constexpr double kFlat = 1e-7;                           // mm, tolerated overlap
constexpr double kFarthest = 1e4;                        // mm: images farther away are not targets

double height(const SurfaceForm& form, double radius) {
    return form.place.origin.z + sag(form, radius, 0.0).z;
}

/// Radius up to which a surface stays on its side of a plane; smaller than `radius` if the iris is
/// inside the hollow of a lens.
double radius_within(const SurfaceForm& form, double plane, int side, double radius) {
    const auto beyond = [&](double r) { return side * (height(form, r) - plane) > 0; };
    if (!beyond(radius)) return std::numeric_limits<double>::infinity();
    double low = 0, high = radius;
    for (int i = 0; i < 60; ++i) (beyond(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    return low;
}

void check(const Prescription& lens) {
    if (!is_axially_symmetric(lens))
        throw LensError(lens.name + ": scatter: wanted a lens with axial symmetry, "
                                    "got one with elements that are turned, shifted or not round",
                        "lens-scatter");
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
        if (!lens.surfaces[i].stop && !std::isfinite(clear_radius(lens.surfaces[i])))
            throw lens_error("lens-scatter", int(i), surface_name(lens, int(i)), "scatter",
                             "a clear diameter, where the barrel begins", "none");
}

}  // namespace

void check_scatter(const LensScatter& scatter) {
    FinishScatter(scatter.barrel, "barrel"), FinishScatter(scatter.blades, "blades");
    check_lobe(scatter.surface_lobe, "surface");
    if (!(scatter.surface_rms_nm >= 0 && scatter.surface_rms_nm <= 1000))
        throw input_error("scatter", "roughness of the surfaces", "0 to 1000 nm RMS",
                          std::to_string(scatter.surface_rms_nm));
}

ScatterLens::ScatterLens(const Prescription& lens, const FilmPlane& film, const Iris& iris, double iris_radius,
                         const SensorStack& stack, double half_diagonal, const LensScatter& scatter)
    : ghosts_((check(lens), GhostLens(lens, film, iris, iris_radius, stack, half_diagonal))),
      scatter_(scatter),
      barrel_(scatter.barrel, "barrel"),
      blades_(scatter.blades, "blades") {
    check_scatter(scatter);
    const Prescription& whole = ghosts_.tracer().prescription();
    for (std::size_t i = 0; i < whole.surfaces.size(); ++i) {
        coatings_.push_back(coating_at(whole, int(i)));
        clear_.push_back(clear_radius(whole.surfaces[i]));
    }
    set_rims(lens), set_walls(), set_targets(half_diagonal);
    if (scatter.surface_rms_nm > 0)
        forced_ = 1 - std::pow(0.5, 1 / double(std::max<std::size_t>(lens.surfaces.size(), 2)));
}

/// Rims of the surfaces. The stop's rim spans its open diameter and the barrel between its
/// neighbours, but must not intersect their glass.
void ScatterLens::set_rims(const Prescription& lens) {
    const Tracer& tracer = ghosts_.tracer();
    const int count = int(lens.surfaces.size()), stop = tracer.stop();
    for (int i = 0; i < count; ++i)
        rims_.push_back({clear_[i], i == stop ? 0 : height(tracer.form(i), clear_[i])});
    const double own = clear_radius(lens.surfaces[stop]), z = tracer.vertices()[stop];
    double r = std::max(std::isfinite(own) ? own : 0, ghosts_.iris_radius() * ghosts_.iris().outer_radius());
    if (stop > 0 && stop + 1 < count) {
        const Rim a = rims_[stop - 1], b = rims_[stop + 1];
        const double s = b.z > a.z ? std::clamp((z - a.z) / (b.z - a.z), 0.0, 1.0) : 0.5;
        r = std::max(r, a.radius + s * (b.radius - a.radius));
    }
    if (stop > 0) r = std::min(r, radius_within(tracer.form(stop - 1), z, 1, clear_[stop - 1]));
    if (stop + 1 < count) r = std::min(r, radius_within(tracer.form(stop + 1), z, -1, clear_[stop + 1]));
    clear_[stop] = r;
    rims_[stop] = {r, height(tracer.form(stop), r)};
}

void ScatterLens::set_walls() {
    walls_.resize(rims_.size());
    for (std::size_t g = 1; g < rims_.size(); ++g) {
        const Rim a = rims_[g - 1], b = rims_[g];
        Wall& w = walls_[g];
        w = {a.radius, a.z, b.z - a.z, 0, b.radius};
        if (w.length > 0) w.slope = (b.radius - a.radius) / w.length;
        w.none = w.length < -kFlat;   // the surfaces intersect within their rims
    }
}

/// Targets in each gap for light scattered by metal: the rim at the end of the gap, and the
/// paraxial image of the iris, or of the film in gaps behind the iris.
void ScatterLens::set_targets(double half_diagonal) {
    const int stop = ghosts_.tracer().stop(), count = int(rims_.size());
    targets_.resize(rims_.size());
    for (int g = 1; g < count; ++g) {
        targets_[g].push_back({rims_[g].z, rims_[g].radius, kRimShare});
        const auto image =
            g <= stop ? image_in(g, stop, rims_[stop].z, ghosts_.iris_radius() * ghosts_.iris().outer_radius())
                      : image_in(g, ghosts_.passed(), ghosts_.film().center.z, half_diagonal);
        if (image) targets_[g].push_back(*image);
    }
}

/// Paraxial image, in a gap, of a disc behind it: n / s - n' / s' = (n' - n) c, surface by surface.
std::optional<ScatterLens::Target> ScatterLens::image_in(int gap, int from_gap, double z, double radius) const {
    const Tracer& tracer = ghosts_.tracer();
    const LensIndices n = tracer.at(kDesignWavelength);
    for (int i = from_gap - 1; i >= gap; --i) {
        const double s = z - tracer.vertices()[i], n1 = n.index[i], n2 = n.index[i + 1];
        if (s == 0) continue;
        const double vergence = n2 / s - (n2 - n1) * vertex_curvature_y(tracer.prescription().surfaces[i]);
        if (std::abs(vergence) * kFarthest < n1) return std::nullopt;
        const double seen = n1 / vergence;
        radius *= std::abs(n2 * seen / (n1 * s));
        z = tracer.vertices()[i] + seen;
    }
    return Target{z, radius, kImageShare};
}

}  // namespace dg
