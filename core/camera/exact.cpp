#include "camera/exact.h"

#include <cmath>
#include <functional>
#include <memory>

#include "camera/mean_ray.h"
#include "camera/tilt.h"
#include "math/thread_scratch.h"
#include "optics/expansion/lens_fit_simd.h"
#include "optics/lens/lens_error.h"
#include "optics/trace/intersect.h"
#include "spectrum/wavelengths.h"

namespace dg {
namespace {

constexpr double kMetre = 1e-3;  // m per mm
constexpr float kPerMm2 = 1e6f;  // mm2 per m2
// The aim covers slightly more than the frame, since pixel filters extend beyond its corners.
constexpr double kFilmMargin = 1.02;

/// Removes the clear diameter of the stop, which the iris replaces.
Prescription without_stop_aperture(const Prescription& lens) {
    Prescription open = lens;
    open.surfaces[lens.stop_index()].semi_diameter =
        std::numeric_limits<double>::infinity();
    open.surfaces[lens.stop_index()].semi_diameter_after = 0;
    return open;
}

/// Removes ripple, which would disturb fits and derivatives.
Prescription polished(Prescription lens) {
    for (Surface& s : lens.surfaces) s.ripple = {};
    return lens;
}

constexpr double kMaxTilt = 45;  // degrees
constexpr double kSharp = 2;     // um on the film: sufficient accuracy of a fit
constexpr int kMostSegments = 8;

/// Intersection of the chief ray of the camera's -z axis with the plane at `depth` behind the
/// centre of the entrance pupil; camera frame, mm. Tilting the lens does not move the centre of the
/// image.
Vec2d straight_ahead(const Tracer& tracer, const Affine3d& turn, double pupil_z, double depth) {
    const Vec3d d = inverse(turn).vector({0, 0, 1});
    const LensRay chief{Vec3d{0, 0, pupil_z} - d * ((pupil_z + 1) / d.z), d};
    const auto ray = tracer.to_film(chief, tracer.at(kDesignWavelength), {false, nullptr, 0});
    const Vec3d out = ray ? turn.vector(ray->ray.direction) : Vec3d{};
    if (!(out.z > 0))
        throw LensError(tracer.prescription().name +
                            ": tilt: the film would not see straight ahead",
                        "lens-no-light");
    const Vec3d p = turn.vector(ray->ray.origin - Vec3d{0, 0, pupil_z});
    const Vec3d at = p + out * ((depth - p.z) / out.z);
    return {at.x, at.y};
}

}  // namespace

struct ExactLens::State {
    ExactLensSettings settings;
    Prescription lens;   // original prescription
    Tracer tracer;
    FirstOrder order;
    double iris_radius, film_z;
    bool tilted;
    Affine3d turn;   // camera from lens, about the centre of the entrance pupil
    Vec2d ahead{};   // camera frame, mm: centre of the film
    LensTables tables;
    std::optional<LensFit> fit;
    FitTables fit_tables;
    Aim aim;
    double h0 = 0, transmittance = 0;

    State(const Prescription& lens, const ExactLensSettings& s)
        : settings(s), lens(lens), tracer(polished(without_stop_aperture(lens))), order(dg::first_order(lens)) {
        validate(lens);
        if (!(s.half_diagonal_mm > 0 && s.half_diagonal_mm < 1e4))
            throw input_error(lens.name, "half diagonal of the film", "0 to 1e4 mm",
                              std::to_string(s.half_diagonal_mm));
        if (!std::isfinite(order.entrance_pupil_z))
            throw LensError(
                lens.name +
                    ": the entrance pupil is at infinity: this lens has no place for"
                    " the camera's origin",
                "lens-pupil");
        if (settings.f_stop == 0) settings.f_stop = order.f_number;
        iris_radius = dg::iris_radius(lens, order, settings.f_stop);
        if (!(length(s.tilt_deg) <= kMaxTilt))
            throw input_error(lens.name, "tilt", "at most 45 degrees",
                              std::to_string(length(s.tilt_deg)) + " degrees");
        film_z = s.film_z ? *s.film_z
                          : film_position(lens, order, s.focus_distance_m, s.focus_from);
        if (!(film_z > tracer.vertices().back()))
            throw LensError(lens.name +
                                ": the film would be inside the lens (back focal length " +
                                std::to_string(order.bfl) + " mm)",
                            "lens-film");
        tilted = s.tilt_deg != Vec2d{};
        if (tilted) {
            turn = lens_turn(s.tilt_deg);
            ahead = straight_ahead(tracer, turn, order.entrance_pupil_z, film_depth());
        }
        AimRequest request{film_z, kFilmMargin * s.half_diagonal_mm, s.iris, iris_radius,
                           s.draw};
        if (tilted) request.tilted = film_plane();
        // The image is inverted on the film.
        request.film = {-1.0 * s.film_center_mm, kFilmMargin * s.film_half_mm};
        tables = make_lens_tables(Tracer(without_stop_aperture(lens)), film_plane(), true,
                                  &settings.iris, iris_radius);
        aim = make_aim(tracer, request);
        set_exposure();
        if (s.fitted) set_fit(fitted(request));
    }

    /// Depth of the film along the camera's axis, from the centre of the entrance pupil; the lens's
    /// axis meets the film at film_z.
    double film_depth() const { return (film_z - order.entrance_pupil_z) * turn.z.z; }

    /// Film plane in the lens frame. The film is fixed in the camera frame; the lens rotates about
    /// the centre of its entrance pupil.
    FilmPlane film_plane() const {
        if (!tilted) return {{0, 0, film_z}};
        const Affine3d back = inverse(turn);
        const Vec3d center = back.vector({ahead.x, ahead.y, film_depth()});
        return {center + Vec3d{0, 0, order.entrance_pupil_z}, back.x, back.y};
    }

    void set_fit(LensFit made) {
        fit = std::move(made), fit_tables = make_fit_tables(*fit, tables.iris);
    }

    /// Fits the lens at the requested degree; subdivides the film radius while the error is too
    /// large and decreases.
    LensFit fitted(const AimRequest& aim) const {
        LensFitRequest request{aim.film_z, aim.film_radius, aim.iris, aim.iris_radius, aim.tilted, aim.film};
        request.degree = settings.fitted->degree;
        LensFit best = make_lens_fit(tracer, request);
        while (best.symmetry.axial && best.error.all.film.rms > kSharp && request.segments < kMostSegments) {
            request.segments *= 2;
            LensFit finer = make_lens_fit(tracer, request);
            if (finer.error.all.film.rms < best.error.all.film.rms) best = std::move(finer);
        }
        return best;
    }

    /// Computes H0 and T by quadrature over wavelength in steps of 20 nm; both vary slowly.
    /// Evaluated on the axis of the lens, for any tilt.
    void set_exposure() {
        const bool symmetric = is_axially_symmetric(tracer.prescription());
        const RadialOpening opening(settings.iris);
        const Vec2d chief =
            symmetric ? Vec2d{} : ChiefMap(tracer, {{0, 0, film_z}}, {{}, {1, 1}}).slope({}, {});
        const LensRay axis{{0, 0, film_z}, normalize(Vec3d{-chief.x, -chief.y, -1})};
        double weights = 0;
        for (double nm = 390; nm <= 770; nm += symmetric ? 20 : 40) {
            const double w = cie_y(nm) * d65(nm);
            h0 += w * (symmetric ? axial_irradiance(tracer, film_z, opening, iris_radius, nm)
                                 : axial_irradiance(tracer, film_z, settings.iris, iris_radius,
                                                    chief, nm));
            if (const auto ray = tracer.to_scene(axis, tracer.at(nm), {true, nullptr, 0}))
                transmittance += w * ray->transmittance;
            weights += w;
        }
        h0 /= weights, transmittance /= weights;
        if (!(h0 > 0))
            throw LensError(tracer.prescription().name +
                                ": no light reaches the film's centre",
                            "lens-no-light");
    }
};

ExactLens::ExactLens(const Prescription& lens, const ExactLensSettings& settings)
    : state_(std::make_shared<State>(lens, settings)),
      fitted_(state_->fit.has_value()),
      unit_(state_->h0) {}

ExactLens ExactLens::with_fit(LensFit fit) const {
    auto state = std::make_shared<State>(*state_);
    state->set_fit(std::move(fit));
    ExactLens lens = *this;
    lens.state_ = std::move(state), lens.fitted_ = true, lens.chief_ = {};
    return lens;
}

ExactLens ExactLens::without_fit() const {
    if (!fitted_) return *this;
    ExactLens lens = *this;
    lens.fitted_ = false, lens.chief_ = {};
    return lens;
}

const LensFit* ExactLens::fit() const {
    return fitted_ ? &*state_->fit : nullptr;
}

ExactLens ExactLens::in_the_body_of(const ExactLens& middle) const {
    ExactLens lens = *this;
    lens.advance_ = middle.advance_ + middle.state_->film_depth() - state_->film_depth();
    const Vec2d film = middle.state_->ahead - state_->ahead;
    lens.film_shift_ = middle.film_shift_ + Vec2f{float(film.x), float(film.y)};
    lens.unit_ = middle.unit_, lens.chief_ = {};
    return lens;
}

/// Batch of rays as structure of arrays for the SIMD kernels.
struct ExactLens::Buffers {
    LensSamples samples;
    SceneRays scene;
    FilmRays film;
    alignas(64) float weight[kLensBatch];
};

float ExactLens::leaf_transmission(float opening, float x_mm, float y_mm) const {
    if (opening >= 1) return 1;
    if (!(opening > 0)) return 0;
    const double unit = 1 / (double(opening) * state_->iris_radius);
    return float(state_->settings.iris.transmission({x_mm * unit, y_mm * unit}));
}

ExactLens ExactLens::with_dirt(LensDirt dirt) const {
    check_mask(dirt.front, "front mask"), check_mask(dirt.iris, "iris mask");
    ExactLens lens = *this;
    lens.dirt_ = std::make_shared<const LensDirt>(std::move(dirt)), lens.chief_ = {};
    return lens;
}

float ExactLens::dirt_transmission(Vec2f front_mm, Vec2f iris_mm) const {
    if (!dirt_) return 1;
    const double front = clear_radius(state_->tracer.prescription().surfaces.front());
    const float half = float(std::isfinite(front) ? front : 0.5 * state_->order.entrance_pupil_diameter);
    float pass = 1;
    if (!dirt_->front.values.empty()) pass = dirt_->front.at(front_mm.x, front_mm.y, half);
    if (!dirt_->iris.values.empty())
        pass *= dirt_->iris.at(iris_mm.x, iris_mm.y, float(state_->order.stop_semi_diameter));
    return pass;
}

void ExactLens::generate(std::span<const CameraSample> samples,
                         std::span<CameraRay> rays) const {
    DG_CHECK(samples.size(), ==, rays.size());
    Buffers& b = thread_scratch<Buffers>([] {});
    const float inv_h0 = float(1 / unit_), origin = float(state_->order.entrance_pupil_z - advance_);
    const Vec2f shift = film_shift_;
    const bool tilted = state_->tilted;
    const double pupil = state_->order.entrance_pupil_z;
    for (std::size_t begin = 0; begin < samples.size(); begin += kLensBatch) {
        const int count = int(std::min<std::size_t>(kLensBatch, samples.size() - begin));
        for (int i = 0; i < count; ++i) {
            const CameraSample& s = samples[begin + i];
            b.samples.x[i] = shift.x - s.film_mm.x,
            b.samples.y[i] = shift.y - s.film_mm.y;  // inverted image
            b.samples.u[i] = s.u_lens.x, b.samples.v[i] = s.u_lens.y;
            b.samples.nm[i] = s.wavelength_nm;
        }
        const int padded = std::min(kLensBatch, (count + 31) / 32 * 32);
        for (int i = count; i < padded; ++i)
            b.samples.x[i] = b.samples.y[i] = b.samples.u[i] = b.samples.v[i] = 0,
            b.samples.nm[i] = 550;
        if (fitted_) {
            aimed_rays(state_->tables, state_->aim.tables, b.samples, b.film, b.weight, padded);
            fit_to_scene(state_->fit_tables, b.film, b.scene, padded);
        } else {
            guided_rays(state_->tables, state_->aim.tables, b.samples, b.scene, b.weight,
                        nullptr, padded);
        }
        for (int i = 0; i < count; ++i) {
            CameraRay& out = rays[begin + i];
            const float aim = b.weight[i] * inv_h0;
            const float weight = aim * b.scene.pass[i] *
                                 leaf_transmission(samples[begin + i].iris_opening,
                                                   b.scene.iris_x[i], b.scene.iris_y[i]) *
                                 dirt_transmission({b.scene.x[i], b.scene.y[i]},
                                                   {b.scene.iris_x[i], b.scene.iris_y[i]});
            const bool passed = weight > 0 && std::isfinite(weight);
            out.weight = passed ? weight : 0;
            out.aim_weight = passed ? aim : 0;
            out.ray.origin = {b.scene.x[i] * float(kMetre), b.scene.y[i] * float(kMetre),
                              (b.scene.z[i] - origin) * float(kMetre)};
            out.ray.direction = {b.scene.dx[i], b.scene.dy[i], b.scene.dz[i]};
            if (tilted) {
                const Affine3d& turn = state_->turn;
                const Vec3d p = turn.vector({b.scene.x[i], b.scene.y[i], b.scene.z[i] - pupil});
                out.ray.origin = to_float(kMetre * (p + Vec3d{0, 0, advance_}));
                out.ray.direction = to_float(turn.vector(to_double(out.ray.direction)));
            }
            out.ray.time = samples[begin + i].time;
            out.iris_opening = samples[begin + i].iris_opening;
        }
    }
}

int ExactLens::fill(Buffers& b, std::span<const CameraRay> rays, std::span<const float> wavelength_nm,
                    std::size_t begin, int count) const {
    const float origin = float(state_->order.entrance_pupil_z - advance_);
    const bool tilted = state_->tilted;
    const double pupil = state_->order.entrance_pupil_z;
    const Affine3d back = inverse(state_->turn);
    const int padded = std::min(kLensBatch, (count + 31) / 32 * 32);
    for (int i = 0; i < padded; ++i) {
        const std::size_t from = begin + std::min(i, count - 1);
        const Ray& ray = rays[from].ray;
        b.scene.x[i] = 1e3f * ray.origin.x, b.scene.y[i] = 1e3f * ray.origin.y;
        b.scene.z[i] = 1e3f * ray.origin.z + origin;
        b.scene.dx[i] = ray.direction.x, b.scene.dy[i] = ray.direction.y;
        b.scene.dz[i] = ray.direction.z;
        if (tilted) {
            const Vec3d o = to_double(ray.origin) / kMetre;
            const Vec3d p = back.vector(o - Vec3d{0, 0, advance_});
            const Vec3d d = back.vector(to_double(ray.direction));
            b.scene.x[i] = float(p.x), b.scene.y[i] = float(p.y);
            b.scene.z[i] = float(p.z + pupil);
            b.scene.dx[i] = float(d.x), b.scene.dy[i] = float(d.y), b.scene.dz[i] = float(d.z);
        }
        b.film.nm[i] = wavelength_nm[from];
    }
    return padded;
}

void ExactLens::reproject(std::span<const CameraRay> rays,
                          std::span<const float> wavelength_nm,
                          std::span<Reprojection> out) const {
    DG_CHECK(rays.size(), ==, wavelength_nm.size());
    DG_CHECK(rays.size(), ==, out.size());
    Buffers& b = thread_scratch<Buffers>([] {});
    const float inv_h0 = float(1 / unit_);
    const Vec2f shift = film_shift_;
    for (std::size_t begin = 0; begin < rays.size(); begin += kLensBatch) {
        const int count = int(std::min<std::size_t>(kLensBatch, rays.size() - begin));
        const int padded = fill(b, rays, wavelength_nm, begin, count);
        if (fitted_)
            fit_to_film(state_->fit_tables, b.scene, b.film, padded);
        else
            trace_to_film(state_->tables, b.scene, b.film, padded);
        aim_weights(state_->tables, state_->aim.tables, b.film, b.scene, b.weight,
                    padded);
        for (int i = 0; i < count; ++i) {
            const float aim = b.weight[i] * inv_h0;
            const float pass =
                b.scene.pass[i] * leaf_transmission(rays[begin + i].iris_opening,
                                                    b.scene.iris_x[i], b.scene.iris_y[i]) *
                dirt_transmission({b.scene.x[i], b.scene.y[i]},
                                  {b.scene.iris_x[i], b.scene.iris_y[i]});
            Reprojection& o = out[begin + i];
            o = {{shift.x - b.film.x[i], shift.y - b.film.y[i]}};
            if (!(pass > 0)) continue;
            // Rays outside the sampling domain of the aim still reach the film.
            o.transmittance = pass;
            o.response = pass * inv_h0 * kPerMm2;
            if (!(aim > 0) || !std::isfinite(aim)) continue;
            o.aim_weight = aim;
            o.etendue = b.weight[i] / kPerMm2;
        }
    }
}

GhostLens ExactLens::ghosts(const SensorStack& stack) const {
    const State& s = *state_;
    return {s.lens, s.film_plane(), s.settings.iris, s.iris_radius, stack, s.settings.half_diagonal_mm};
}

void ExactLens::reproject(std::span<const CameraRay> rays, std::span<const float> wavelength_nm,
                          const GhostLens& ghosts, const std::vector<GhostStep>& steps,
                          std::span<Reprojection> out) const {
    DG_CHECK(rays.size(), ==, wavelength_nm.size());
    DG_CHECK(rays.size(), ==, out.size());
    Buffers& b = thread_scratch<Buffers>([] {});
    const float inv_h0 = float(1 / unit_);
    for (std::size_t begin = 0; begin < rays.size(); begin += kLensBatch) {
        const int count = int(std::min<std::size_t>(kLensBatch, rays.size() - begin));
        const int padded = fill(b, rays, wavelength_nm, begin, count);
        bool leaf = false;
        for (int i = 0; i < padded; ++i) {
            b.weight[i] = rays[begin + std::min(i, count - 1)].iris_opening;
            leaf |= b.weight[i] < 1;
        }
        trace_ghost(ghosts, steps, b.scene, b.film, leaf ? b.weight : nullptr, padded);
        for (int i = 0; i < count; ++i) {
            Reprojection& o = out[begin + i];
            o = {{film_shift_.x - b.film.x[i], film_shift_.y - b.film.y[i]}};
            if (!(b.scene.pass[i] > 0)) continue;
            o.transmittance = b.scene.pass[i] * dirt_transmission({b.scene.x[i], b.scene.y[i]},
                                                                  {b.scene.iris_x[i], b.scene.iris_y[i]});
            o.response = o.transmittance * inv_h0 * kPerMm2;
        }
    }
}

Vec2f ExactLens::trace_open(std::span<const CameraRay> rays, std::span<const float> wavelength_nm,
                            const GhostLens& ghosts, const std::vector<GhostStep>& steps, OpenLandings& out) const {
    DG_CHECK(rays.size(), ==, wavelength_nm.size());
    DG_CHECK(rays.size(), <=, std::size_t(kLensBatch));
    Buffers& b = thread_scratch<Buffers>([] {});
    const int padded = fill(b, rays, wavelength_nm, 0, int(rays.size()));
    trace_open_ghost(ghosts, steps, b.scene, b.film, out, padded);
    return film_shift_;
}

ScatterLens ExactLens::scatter(const SensorStack& stack, const LensScatter& parts) const {
    const State& s = *state_;
    return {s.lens, s.film_plane(), s.settings.iris, s.iris_radius, stack, s.settings.half_diagonal_mm, parts};
}

ExactLens::Scattered ExactLens::reproject(const CameraRay& ray, const LensIndices& n, const ScatterLens& lens,
                                          std::uint64_t seed) const {
    const Affine3d back = inverse(state_->turn);
    const Vec3d pupil{0, 0, state_->order.entrance_pupil_z}, offset{0, 0, advance_};
    // Light travels opposite to the camera ray.
    const Vec3d start = back.vector(to_double(ray.ray.origin) / kMetre - offset) + pupil;
    const Vec3d direction = normalize(back.vector(-to_double(ray.ray.direction)));
    const auto light = lens.walk({start, direction}, n, ray.iris_opening, seed, {});
    if (!light) return {};
    Reprojection out{{film_shift_.x - float(light->film.x), film_shift_.y - float(light->film.y)}};
    out.transmittance =
        float(light->weight) * dirt_transmission({float(start.x), float(start.y)},
                                                 {float(light->iris.x), float(light->iris.y)});
    out.response = out.transmittance * float(1 / unit_) * kPerMm2;
    return {out, float(light->blur2)};
}

ExactLens::Ball ExactLens::front_ball() const {
    const Prescription& lens = state_->lens;
    double r = clear_radius(lens.surfaces.front());
    if (!std::isfinite(r)) {   // unknown clear radius: use a radius larger than all known ones
        r = 0.5 * state_->order.entrance_pupil_diameter;
        for (const Surface& s : lens.surfaces)
            if (std::isfinite(clear_radius(s))) r = std::max(r, clear_radius(s));
        r *= 2;
    }
    double low = 0, high = 0;   // range of the sag at all radii, since aspheres need not be monotonic
    const SurfaceForm& front = state_->tracer.form(0);
    for (int i = 0; i <= 64; ++i)
        for (const Vec2d way : {Vec2d{1, 0}, Vec2d{0, 1}, Vec2d{-1, 0}, Vec2d{0, -1}}) {
            const auto s = sag(front, way.x * r * i / 64, way.y * r * i / 64);
            if (s.defined) low = std::min(low, s.z), high = std::max(high, s.z);
        }
    const Vec3d middle = front.place.out_of(Vec3d{0, 0, 0.5 * (low + high)});
    const Vec3d at = state_->turn.vector(middle - Vec3d{0, 0, state_->order.entrance_pupil_z});
    return {kMetre * (at + Vec3d{0, 0, advance_}), kMetre * 1.001 * hypot(r, 0.5 * (high - low))};
}

std::optional<Vec3d> ExactLens::start(Vec3d point, Vec3d direction) const {
    const Affine3d& turn = state_->turn;
    const Affine3d back = inverse(turn);
    const Vec3d pupil{0, 0, state_->order.entrance_pupil_z}, offset{0, 0, advance_};
    const SurfaceForm& front = state_->tracer.form(0);
    const Vec3d from = back.vector(point / kMetre - offset) + pupil;
    const auto hit = meet(front, front.place.into(from),
                          front.place.turn_in(back.vector(-direction)), 1);
    if (!hit) return std::nullopt;
    return kMetre * (turn.vector(front.place.out_of(hit->point) - pupil) + offset);
}

Vec3d ExactLens::chief_direction(Vec2d film_mm) const {
    // Mean direction over a coarse grid of lens samples, weighted by exposure.
    const std::vector<CameraSample> samples =
        lens_cells({float(film_mm.x), float(film_mm.y)}, 12);
    std::vector<CameraRay> rays(samples.size());
    generate(samples, rays);
    const Vec3d sum = summed_direction(rays);
    return length(sum) > 0 ? normalize(sum) : Vec3d{0, 0, -1};
}

double ExactLens::h0() const {
    return state_->h0;
}
double ExactLens::transmittance() const {
    return state_->transmittance;
}
double ExactLens::f_stop() const {
    return state_->settings.f_stop;
}
double ExactLens::iris_radius_mm() const {
    return state_->iris_radius;
}
double ExactLens::film_z_mm() const {
    return state_->film_z;
}
double ExactLens::film_distance_mm() const {
    return state_->film_z - state_->order.back_principal_z;
}
double ExactLens::half_diagonal_mm() const {
    return state_->settings.half_diagonal_mm;
}
FilmPlane ExactLens::film_plane() const {
    return state_->film_plane();
}
const ExactLensSettings& ExactLens::settings() const {
    return state_->settings;
}
bool ExactLens::is_axial() const {
    return is_axially_symmetric(state_->tracer.prescription()) && state_->settings.tilt_deg == Vec2d{};
}
const FirstOrder& ExactLens::first_order() const {
    return state_->order;
}
const Aim& ExactLens::aim() const {
    return state_->aim;
}
const Tracer& ExactLens::tracer() const {
    return state_->tracer;
}
const LensTables& ExactLens::tables() const {
    return state_->tables;
}

}  // namespace dg
