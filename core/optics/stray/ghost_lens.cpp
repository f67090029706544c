#include "optics/stray/ghost_lens.h"

#include <algorithm>
#include <utility>

#include "optics/lens/lens_error.h"

namespace dg {
namespace {

[[noreturn]] void refuse(const char* what, const char* wanted, double got) {
    throw input_error("sensor stack", what, wanted, std::to_string(got));
}

/// Shift of the focus by the cover glass in front of the sensor.
double focus_shift(const SensorStack& stack) {
    return stack.cover_thickness > 0 ? stack.cover_thickness * (1 - 1 / stack.cover_index) : 0;
}

const char* name_of(Coating coating) {
    switch (coating) {
        case Coating::uncoated:
            return "uncoated";
        case Coating::mgf2:
            return "mgf2";
        case Coating::v_coat:
            return "v-coat";
        case Coating::broadband:
            return "broadband";
        default:
            return "perfect";
    }
}

/// Appends cover glass and sensor to a lens. The iris replaces the clear diameter of the stop.
Prescription with_stack(Prescription lens, const SensorStack& stack, double film_z, double half_diagonal) {
    Surface& stop = lens.surfaces[lens.stop_index()];
    stop.semi_diameter = std::numeric_limits<double>::infinity();
    stop.semi_diameter_after = 0;
    const double gap = film_z + focus_shift(stack) - lens.last_vertex();
    lens.surfaces.back().thickness = gap;
    if (stack.cover_thickness > 0) {
        const double before = gap - stack.cover_gap - stack.cover_thickness;
        if (!(before > 0))
            refuse("cover glass and gap",
                   ("less than the " + std::to_string(gap) + " mm behind the lens").c_str(),
                   stack.cover_thickness + stack.cover_gap);
        lens.surfaces.back().thickness = before;
        Surface front, back;
        front.glass.formula = ConstantIndex{stack.cover_index};
        front.thickness = stack.cover_thickness;
        front.coating = back.coating = name_of(stack.cover_coating);
        back.thickness = stack.cover_gap;
        back.glass = lens.surfaces.back().glass;
        lens.surfaces.push_back(front), lens.surfaces.push_back(back);
    }
    if (stack.reflectance > 0) {
        Surface sensor;
        sensor.glass = lens.surfaces.back().glass;
        sensor.reflectance = stack.reflectance;
        sensor.semi_diameter = half_diagonal;
        lens.surfaces.push_back(sensor);
    }
    return lens;
}

MirrorTables mirror_tables(const SurfaceCoating& coating, double n1, double n2) {
    using Kind = MirrorTables::Kind;
    if (coating.mirror > 0) return {.kind = Kind::constant, .reflectance = float(coating.mirror)};
    if (!coating.reflects || n1 == n2) return {};
    MirrorTables m{.kind = coating.films.empty() ? Kind::bare : Kind::films, .rarer_in_front = n1 < n2};
    for (const CoatingLayer& f : coating.films)
        m.layers.push_back({float(f.a), float(f.b), float(1e-3 * f.thickness_nm)});
    return m;
}

bool is_across(const FilmPlane& film) {
    return film.normal() == Vec3d{0, 0, 1};
}

}  // namespace

void check_stack(const SensorStack& s) {
    if (!(s.cover_thickness >= 0 && s.cover_thickness <= 100))
        refuse("thickness of the cover glass", "0 to 100 mm", s.cover_thickness);
    if (!(s.cover_index >= 1 && s.cover_index <= 4))
        refuse("index of the cover glass", "1 to 4", s.cover_index);
    if (!(s.cover_gap > 0 && s.cover_gap <= 100))
        refuse("gap behind the cover glass", "more than 0, at most 100 mm", s.cover_gap);
    if (!(s.reflectance >= 0 && s.reflectance <= 1))
        refuse("reflectance of the sensor", "0 to 1: no surface can send back more light than arrives",
               s.reflectance);
}

GhostLens::GhostLens(const Prescription& lens, const FilmPlane& film, const Iris& iris, double iris_radius,
                     const SensorStack& stack, double half_diagonal)
    : lens_((check_stack(stack), with_stack(lens, stack, film.center.z, half_diagonal))),
      passed_(int(lens_.surfaces.size()) - (stack.reflectance > 0 ? 1 : 0)),
      film_(film),
      tracer_(lens_),
      iris_(iris),
      iris_radius_(iris_radius) {
    if (!stack.empty() && !is_across(film))
        throw input_error(lens.name, "sensor stack", "a lens that is not tilted", "a tilt");
    film_.center.z += focus_shift(stack);
    tables_ = make_lens_tables(tracer_, film_, true, &iris_, iris_radius);
    tables_.film_gap = float(film_.center.z - tracer_.vertices()[passed_ - 1]);
    const LensIndices n = tracer_.at(kFilmWavelength);
    for (int i = 0; i < int(lens_.surfaces.size()); ++i) {
        mirrors_.push_back(mirror_tables(coating_at(lens_, i), n.index[i], n.index[i + 1]));
        if (mirrors_.back().kind != MirrorTables::Kind::none) reflecting_.push_back(i);
    }
}

std::vector<Mirrors> GhostLens::two_bounces() const {
    std::vector<Mirrors> all;
    for (std::size_t far = 0; far < reflecting_.size(); ++far)
        for (std::size_t near = 0; near < far; ++near)
            all.push_back({reflecting_[far], reflecting_[near]});
    return all;
}

double GhostLens::reflectance(int i) const {
    double sum = 0;
    for (const double nm : {450.0, 550.0, 650.0}) {
        const LensIndices n = tracer_.at(nm);
        sum += 1 - surface_transmittance(coating_at(lens_, i), n.index[i], 1, n.index[i + 1], 1, nm);
    }
    return std::max(sum / 3, 1e-6);
}

std::vector<Mirrors> GhostLens::four_bounces(std::size_t most) const {
    std::vector<std::pair<double, Mirrors>> all;
    std::vector<double> r;
    for (const int i : reflecting_) r.push_back(reflectance(i));
    const std::size_t n = r.size();
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < a; ++b)
            for (std::size_t c = b + 1; c < n; ++c)
                for (std::size_t d = 0; d < c; ++d)
                    all.push_back({r[a] * r[b] * r[c] * r[d],
                                   {reflecting_[a], reflecting_[b], reflecting_[c], reflecting_[d]}});
    std::ranges::stable_sort(all, std::ranges::greater{}, &std::pair<double, Mirrors>::first);
    if (all.size() > most) all.resize(most);
    std::vector<Mirrors> mirrors;
    for (auto& [bright, way] : all) mirrors.push_back(std::move(way));
    return mirrors;
}

std::vector<GhostStep> GhostLens::steps(const Mirrors& mirrors) const {
    std::vector<GhostStep> steps;
    double at = 0;
    for (const PathStep& step : path(mirrors)) {
        const double z = tracer_.vertices()[step.surface];
        steps.push_back({step.surface, step.sign, step.reflects, float(z - at)});
        at = z;
    }
    return steps;
}

}  // namespace dg
