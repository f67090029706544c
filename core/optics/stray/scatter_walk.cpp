// scatter_walk.cpp -- random walk through a lens with walls (scatter_lens.h).
#include <algorithm>
#include <cmath>

#include "math/hash.h"
#include "optics/stray/scatter_blur.h"
#include "optics/stray/scatter_lens.h"

namespace dg {
namespace {

constexpr int kMostEvents = 256;
constexpr double kBackOff = 1e-2;    // mm, offset of the origin in front of the first surface
constexpr double kClear = 1e-7;      // mm, minimal distance of a hit, against self-intersection
constexpr double kLeastMirror = 0.15;     // least probability that a surface reflects scattered light that travels away
                                     // from the film
/// Defensive lobe: the tails of a narrow lobe carry little light but reach the whole frame.
constexpr HarveyShack kWide{0.25, -3};
constexpr double kWideShare = 0.5;
constexpr double kEntry = 0.25;      // relative to the iris radius: standard deviation of entry points over the
                                     // front, clipped or not
constexpr double kRoulette = 4;          // Russian roulette after a scatter off metal with a weight below 1 / kRoulette

/// Random numbers of a walk, indexed by event, so that wavelengths stay correlated after a
/// different number of draws.
class WalkRandom {
  public:
    explicit WalkRandom(std::uint64_t seed) : seed_(seed) {}
    void begin(int event) { at_ = std::uint64_t(event) << 8; }
    double next() { return hash_uniform(seed_, at_++); }
    Vec2d next_2d() {
        const double x = next();
        return {x, next()};
    }

  private:
    std::uint64_t seed_, at_ = 0;
};

/// Orthonormal basis about a normal. Source: Duff et al. 2017, as in vec.h.
struct TangentFrame {
    Vec3d x, y, z;
    explicit TangentFrame(Vec3d n) : z(n) {
        const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
        x = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
        y = {b, sign + n.y * n.y * a, -n.y};
    }
    Vec3d into(const Vec3d& v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    Vec3d out_of(const Vec3d& v) const { return v.x * x + v.y * y + v.z * z; }
};

}  // namespace

class ScatterLens::Walk {
  public:
    Walk(const ScatterLens& lens, const LensIndices& n, double iris_opening, std::uint64_t seed,
         const ScatterDraw& draw, LightEnds* ends)
        : lens_(lens), tracer_(lens.ghosts_.tracer()), n_(n), opening_(iris_opening), draw_(draw), u_(seed),
          ends_(ends),
          blur_(std::pow(kEntry * lens.ghosts_.iris_radius() * iris_opening, 2)) {}

    std::optional<ScatteredLight> follow(const LensRay& ray, LensRay* left);

  private:
    enum class Kind { nothing, surface, wall, film };
    struct Meeting {
        Kind kind = Kind::nothing;
        double distance = 1e30;
        int surface = -1, sign = 1;
        LensHit<double> hit{};   // at a wall, the normal points into the gap
    };

    Meeting next() const;
    void try_surface(int i, int sign, Meeting& nearest) const;
    void try_wall(Meeting& nearest) const;
    void try_film(Meeting& nearest) const;
    void travel(const Meeting& at);
    bool cross(const Meeting& at);
    bool pass_iris(const Meeting& at);
    void interface(const Meeting& at);
    void bend(const Meeting& at, double n, double n_on);
    double kernel(Vec2d from, double n_from, Vec2d to, double n_to, const Meeting& at) const;
    bool off_metal(const FinishScatter& finish, const LensHit<double>& hit);
    Vec3d aimed(const std::vector<Target>& targets, double choice, Vec2d u) const;
    double aimed_pdf(const std::vector<Target>& targets, const Vec3d& direction) const;
    bool land(const Meeting& at);
    bool counts() const { return draw_.all || scattered_ > 0; }
    bool end(LightEnd where) {
        deposit(where, weight_);
        weight_ = 0;
        return false;
    }
    void deposit(LightEnd where, double light) const {
        if (ends_) (*ends_)[int(where)] += light;
    }
    /// Changes the weight by random sampling; `absorbed` is the part lost to absorption.
    void reweigh(double weight, double absorbed = 0) {
        deposit(LightEnd::chance, weight_ - absorbed - weight);
        weight_ = weight;
    }
    double transmittance(int surface, double n1, double cos1, double n2, double cos2) const {
        return surface_transmittance(lens_.coatings_[surface], n1, cos1, n2, cos2, n_.wavelength_nm);
    }

    const ScatterLens& lens_;
    const Tracer& tracer_;
    const LensIndices& n_;
    double opening_;
    const ScatterDraw& draw_;
    WalkRandom u_;
    LightEnds* ends_;
    ScatterBlur blur_;
    LensRay ray_{};
    int gap_ = 0, scattered_ = 0, off_metal_ = 0;
    double weight_ = 1;
    Vec2d iris_{}, film_{};
};

std::optional<ScatteredLight> ScatterLens::walk(const LensRay& ray, const LensIndices& n, double iris_opening,
                                                std::uint64_t seed, const ScatterDraw& draw, LightEnds* ends,
                                                LensRay* left) const {
    return Walk(*this, n, iris_opening, seed, draw, ends).follow(ray, left);
}

std::optional<ScatteredLight> ScatterLens::Walk::follow(const LensRay& ray, LensRay* left) {
    ray_ = {ray.origin - kBackOff * ray.direction, ray.direction};
    gap_ = draw_.toward_film ? 0 : lens_.ghosts_.passed();
    for (int event = 0; event < kMostEvents; ++event) {
        u_.begin(event);
        const Meeting at = next();
        if (at.kind == Kind::nothing) {
            const bool front = gap_ == 0, rear = gap_ >= int(lens_.rims_.size());
            const double weight = weight_;
            end(front ? LightEnd::front : rear ? LightEnd::rear : LightEnd::lost);
            if (!front || draw_.toward_film || !counts()) return std::nullopt;
            if (left) *left = ray_;
            return ScatteredLight{{}, iris_, weight, scattered_};
        }
        travel(at);
        if (at.kind == Kind::film) {
            if (land(at)) continue;
            const double weight = weight_;
            end(LightEnd::film);
            if (!draw_.toward_film || !counts()) return std::nullopt;
            return ScatteredLight{film_, iris_, weight, scattered_, blur_.squared()};
        }
        if (!(at.kind == Kind::wall ? off_metal(lens_.barrel_, at.hit) : cross(at))) return std::nullopt;
    }
    end(LightEnd::truncated);
    return std::nullopt;
}

/// Nearest hit of the ray: the surfaces on either side of the current gap, or its wall.
ScatterLens::Walk::Meeting ScatterLens::Walk::next() const {
    Meeting nearest;
    const int passed = lens_.ghosts_.passed();
    if (gap_ < passed) try_surface(gap_, 1, nearest);
    if (gap_ > 0) try_surface(gap_ - 1, -1, nearest);
    if (gap_ > 0 && gap_ < int(lens_.walls_.size()) && !lens_.walls_[gap_].none) try_wall(nearest);
    if (gap_ == passed) try_film(nearest);
    return nearest;
}

void ScatterLens::Walk::try_surface(int i, int sign, Meeting& nearest) const {
    const SurfaceForm& form = tracer_.form(i);
    const Vec3d start = form.place.into(ray_.origin);
    const auto hit = meet(form, start, ray_.direction, sign);
    if (!hit) return;
    const double distance = dot(hit->point - start, ray_.direction);
    const double edge = lens_.clear_[i], r2 = hit->point.x * hit->point.x + hit->point.y * hit->point.y;
    if (!(distance > kClear && distance < nearest.distance && r2 <= edge * edge)) return;
    nearest = {Kind::surface, distance, i, sign, *hit};
    nearest.hit.point = form.place.out_of(hit->point);
}

/// Intersection with the inside of the cone x^2 + y^2 = (radius + slope (z - z0))^2, or with a flat
/// ring if its length is zero.
void ScatterLens::Walk::try_wall(Meeting& nearest) const {
    const Wall& w = lens_.walls_[gap_];
    const Vec3d o = ray_.origin - Vec3d{0, 0, w.z}, d = ray_.direction;
    const auto take = [&](double t, Vec3d normal) {
        if (!(t > kClear && t < nearest.distance && dot(d, normal) < 0)) return;
        nearest = {Kind::wall, t, -1, 1, {ray_.origin + t * d, normal, -dot(d, normal)}};
    };
    if (w.length < kClear) {
        const double t = -o.z / d.z;
        const Vec3d p = o + t * d;
        const double r = hypot(p.x, p.y), low = std::min(w.radius, w.end_radius);
        if (r >= low && r <= std::max(w.radius, w.end_radius))
            take(t, {0, 0, w.end_radius < w.radius ? -1.0 : 1.0});
        return;
    }
    const double k = w.slope, at = w.radius + k * o.z;
    const double a = d.x * d.x + d.y * d.y - k * k * d.z * d.z, b = o.x * d.x + o.y * d.y - k * d.z * at;
    const double c = o.x * o.x + o.y * o.y - at * at, discriminant = b * b - a * c;
    if (!(discriminant >= 0)) return;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    for (const double t : {q / a, c / q}) {
        const Vec3d p = o + t * d;
        const double radius = w.radius + k * p.z;
        if (!(p.z >= -kClear && p.z <= w.length + kClear && radius > 0)) continue;
        take(t, normalize(Vec3d{-p.x / radius, -p.y / radius, k}));
    }
}

void ScatterLens::Walk::try_film(Meeting& nearest) const {
    const FilmPlane& film = lens_.ghosts_.film();
    const Vec3d normal = film.normal();
    const double cosine = dot(ray_.direction, normal);
    const double t = dot(film.center - ray_.origin, normal) / cosine;
    if (!(cosine > 0 && t > kClear && t < nearest.distance)) return;
    nearest = {Kind::film, t, -1, 1, {ray_.origin + t * ray_.direction, normal, cosine}};
}

void ScatterLens::Walk::travel(const Meeting& at) {
    ray_.origin = at.hit.point;
    blur_.travel(at.distance / n_.index[gap_]);
    if (n_.absorption.empty()) return;
    const double passed = std::exp(-n_.absorption[gap_] * at.distance);
    deposit(LightEnd::glass, weight_ * (1 - passed));
    weight_ *= passed;
}

/// Crosses a surface or the plane of the iris. Returns false if the walk ends.
bool ScatterLens::Walk::cross(const Meeting& at) {
    const int i = at.surface;
    const Surface& surface = tracer_.prescription().surfaces[i];
    if (hypot(at.hit.point.x, at.hit.point.y) < surface.inner_semi_diameter) return end(LightEnd::metal);
    if (i == tracer_.stop() && !pass_iris(at)) {
        LensHit<double> blade = at.hit;
        blade.normal = -double(at.sign) * blade.normal;
        return off_metal(lens_.blades_, blade);
    }
    if (n_.index[i] == n_.index[i + 1])
        gap_ += at.sign;
    else
        interface(at);
    return weight_ > 0;
}

/// Passes the iris with a probability equal to its transmittance (partial for image shapes);
/// otherwise the walk hits a blade.
bool ScatterLens::Walk::pass_iris(const Meeting& at) {
    const GhostLens& g = lens_.ghosts_;
    const Vec2d p = Vec2d{at.hit.point.x, at.hit.point.y} * (1 / g.iris_radius());
    double open = g.iris().transmission(p);
    if (opening_ < 1) open *= opening_ > 0 ? g.iris().transmission(p * (1 / opening_)) : 0;
    if (!(open > 0) || (open < 1 && u_.next() >= open)) return false;
    iris_ = {at.hit.point.x, at.hit.point.y};
    return true;
}

/// Selects reflection, refraction, or scattering about either, by their shares.
void ScatterLens::Walk::interface(const Meeting& at) {
    const PathStep step{at.surface, at.sign};
    const double n1 = n_.index[step.before()], n2 = n_.index[step.behind()];
    const Vec3d d = ray_.direction;
    double cos2 = 0;
    const auto bent = refract(d, at.hit, at.sign, n1 / n2, cos2);
    const double through = bent ? transmittance(at.surface, n1, at.hit.cosine, n2, cos2) : 0, back = 1 - through;
    const double rms = lens_.scatter_.surface_rms_nm, nm = n_.wavelength_nm;
    const double rough_through = through * total_integrated_scatter(rms, n1 * at.hit.cosine - n2 * cos2, nm);
    const double rough_back = back * total_integrated_scatter(rms, 2 * n1 * at.hit.cosine, nm);
    const double rough = rough_through + rough_back;
    const double chance = draw_.forced && scattered_ == 0 && rough > 0 ? lens_.forced_ : rough;
    const double u = u_.next();
    if (u >= chance) {
        const double natural = (back - rough_back) / (1 - rough);
        const bool away = draw_.forced && draw_.toward_film && scattered_ > 0 && at.sign < 0;
        const double mirror = away ? std::max(natural, std::min(kLeastMirror, 1e3 * natural)) : natural;
        const bool goes_on = u_.next() >= mirror;
        const double factor = goes_on ? (1 - natural) / (1 - mirror) : natural / mirror;
        reweigh(weight_ * factor * (1 - rough) / (1 - chance));
        ray_.direction = goes_on ? *bent : reflect(d, at.hit, at.sign);
        bend(at, n1, goes_on ? n2 : -n1);
        gap_ += goes_on ? at.sign : 0;
        return;
    }
    const bool goes_on = u_.next() * rough < rough_through;
    const double part = (goes_on ? rough_through : rough_back) / rough, n = goes_on ? n2 : n1;
    const TangentFrame frame(at.hit.normal);
    const Vec3d local = frame.into(d);
    const Vec2d middle{n1 * local.x, n1 * local.y};
    const HarveyShack& lobe = lens_.scatter_.surface_lobe;
    const double wide = draw_.aimed && draw_.toward_film ? kWideShare : 0;
    const bool far = wide > 0 && u_.next() < wide;
    const Vec2d b = (far ? kWide : lobe).sample(middle, n, u_.next_2d());
    const double pdf =
        ((1 - wide) * lobe.pdf(middle, n, b) + (wide > 0 ? wide * kWide.pdf(middle, n, b) : 0)) * chance * part;
    const double value = draw_.toward_film ? kernel(middle, n1, b, n, at) : kernel(b, n, middle, n1, at);
    ++scattered_;
    bend(at, n1, goes_on ? n2 : -n1);
    const Vec2d off = b - middle;
    blur_.scatter(lobe.knee * lobe.knee + dot(off, off));
    reweigh(pdf > 0 ? weight_ * value / pdf : 0);
    const double across = std::sqrt(std::max(0.0, 1 - dot(b, b) / (n * n)));
    const double side = goes_on ? at.sign : -at.sign;
    ray_.direction = normalize(frame.out_of({b.x / n, b.y / n, side * across}));
    gap_ += goes_on ? at.sign : 0;
}

/// Propagates the footprint at a surface; n_on < 0 for reflection.
void ScatterLens::Walk::bend(const Meeting& at, double n, double n_on) {
    blur_.bend((n_on - n) * at.sign * vertex_curvature_y(tracer_.prescription().surfaces[at.surface]));
}

/// Scattered radiance per unit of direction cosines, from direction `from` in the medium n_from to
/// `to` in n_to.
double ScatterLens::Walk::kernel(Vec2d from, double n_from, Vec2d to, double n_to, const Meeting& at) const {
    const PathStep step{at.surface, at.sign};
    const double near = n_.index[step.before()], far = n_.index[step.behind()];
    const double n_other = n_from == near ? far : near;   // medium on the other side
    const double b2 = dot(from, from);
    const auto cosine = [&](double n) { return std::sqrt(std::max(0.0, 1 - b2 / (n * n))); };
    const double cos1 = cosine(n_from), cos2 = cosine(n_other);
    const double through = cos2 > 0 ? transmittance(at.surface, n_from, cos1, n_other, cos2) : 0;
    const bool reflects = n_to == n_from;
    const double share =
        (reflects ? 1 - through : through) *
        total_integrated_scatter(lens_.scatter_.surface_rms_nm,
                                 reflects ? 2 * n_from * cos1 : n_from * cos1 - n_other * cos2, n_.wavelength_nm);
    const HarveyShack& lobe = lens_.scatter_.surface_lobe;
    return share > 0 ? share * lobe.at(length(to - from)) / lobe.over_directions(std::sqrt(b2), n_to) : 0;
}

/// Scatters by the finish or toward a target. Returns false if the walk ends.
bool ScatterLens::Walk::off_metal(const FinishScatter& finish, const LensHit<double>& hit) {
    if (finish.is_black()) return end(LightEnd::metal);
    const TangentFrame frame(hit.normal);
    const Vec3d in = frame.into(-ray_.direction);
    const double albedo = finish.albedo(in.z), absorbed = weight_ * (1 - albedo);
    deposit(LightEnd::metal, absorbed);
    // Walls that face the scene have no target.
    static const std::vector<Target> kNone;
    const bool aims = draw_.aimed && draw_.toward_film && hit.normal.z > -0.999 &&
                      std::size_t(gap_) < lens_.targets_.size();
    const auto& targets = aims ? lens_.targets_[gap_] : kNone;
    // Limits the aimed share so that weights stay bounded; at white walls they would otherwise grow
    // with each bounce.
    double total = 0;
    for (const Target& t : targets) total += t.share;
    const double aim = total > 0 ? std::min(1.0, (1 - albedo) / total) : 0, finish_share = 1 - aim * total;
    const double choice = u_.next(), lobe = u_.next();
    const Vec2d u = u_.next_2d();
    const Vec3d direction = choice < finish_share ? finish.sample(in, lobe, u) : frame.into(aimed(targets, (choice - finish_share) / aim, u));
    const double pdf = finish_share * finish.pdf(in, direction) + aim * aimed_pdf(targets, frame.out_of(direction));
    const double factor = pdf > 0 ? finish.value(in, direction) * direction.z / pdf : 0;
    ++scattered_;
    const Vec2d off{direction.x + in.x, direction.y + in.y};   // offset from the mirror direction
    blur_.scatter(finish.lobe().knee * finish.lobe().knee + dot(off, off));
    reweigh(weight_ * factor, absorbed);
    const double survival = draw_.roulette && off_metal_++ > 0 ? std::min(1.0, kRoulette * factor) : 1;
    if (survival < 1) reweigh(u_.next() < survival ? weight_ / survival : 0);
    ray_.direction = frame.out_of(direction);
    return weight_ > 0;
}

/// Direction through a random point of a target disc, always toward the film.
Vec3d ScatterLens::Walk::aimed(const std::vector<Target>& targets, double choice, Vec2d u) const {
    std::size_t k = 0;
    while (k + 1 < targets.size() && choice >= targets[k].share) choice -= targets[k++].share;
    const Vec2d p = concentric_disc(u) * targets[k].radius;
    const Vec3d way = Vec3d{p.x, p.y, targets[k].z} - ray_.origin;
    return normalize(way.z < 0 ? -way : way);
}

double ScatterLens::Walk::aimed_pdf(const std::vector<Target>& targets, const Vec3d& d) const {
    double pdf = 0;
    if (!(d.z > 0)) return 0;
    for (const Target& t : targets) {
        const double distance = (t.z - ray_.origin.z) / d.z;
        const Vec3d p = ray_.origin + distance * d;
        if (p.x * p.x + p.y * p.y <= t.radius * t.radius)
            pdf += t.share * distance * distance / (kPiD * t.radius * t.radius * d.z);
    }
    return pdf;
}

/// Returns true if the sensor reflects the walk.
bool ScatterLens::Walk::land(const Meeting& at) {
    const FilmPlane& film = lens_.ghosts_.film();
    const Vec3d p = at.hit.point - film.center;
    film_ = {dot(p, film.x), dot(p, film.y)};
    const int sensor = lens_.ghosts_.passed();
    if (sensor >= int(lens_.coatings_.size())) return false;
    const double edge = lens_.clear_[sensor];
    if (dot(film_, film_) > edge * edge || u_.next() >= lens_.coatings_[sensor].mirror) return false;
    ray_.direction = reflect(ray_.direction, at.hit, 1);
    return true;
}

}  // namespace dg
