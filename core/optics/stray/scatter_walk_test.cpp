#include "optics/stray/scatter_lens.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "math/error.h"
#include "math/statistics.h"
#include "optics/lens/test_lenses.h"

using namespace dg;

namespace {

constexpr double kFilmRadius = 20;   // mm
const Finish kBlack{.diffuse = 0, .gloss = 0};

LensScatter parts(double barrel, double blades, double rms_nm) {
    const auto finish = [](double albedo) {
        return albedo > 0 ? Finish{.diffuse = albedo, .gloss = 0.2 * (1 - albedo) / 6, .lobe = {0.2, -2.5}} : kBlack;
    };
    return {finish(barrel), finish(blades), rms_nm, {0.05, -2}};
}

ScatterLens make(const Prescription& lens, double film_z, double iris_radius, const LensScatter& scatter,
                 const SensorStack& stack = {}) {
    return {lens, {{0, 0, film_z}}, Iris::polygon(6, 10, 0), iris_radius, stack, kFilmRadius, scatter};
}

/// Lens with the film at the thickness of the last surface.
ScatterLens make(const Prescription& lens, double iris_radius, const LensScatter& scatter) {
    return make(lens, lens.last_vertex() + lens.surfaces.back().thickness, iris_radius, scatter);
}

struct Uniform {
    std::mt19937_64 rng;
    std::uniform_real_distribution<double> uniform{0, 1};
    explicit Uniform(unsigned seed) : rng(seed) {}
    double operator()() { return uniform(rng); }
};

/// Cosine-weighted direction about a normal.
Vec3d diffuse_about(Vec3d n, Uniform& u) {
    const Vec2d p = concentric_disc({u(), u()});
    const Vec3d x = normalize(cross(std::abs(n.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}, n)), y = cross(n, x);
    return p.x * x + p.y * y + std::sqrt(std::max(0.0, 1 - dot(p, p))) * n;
}

/// Uniform sky over the front surface, a cap or a disc.
struct Sky {
    double radius, curvature, area;
    explicit Sky(const Prescription& lens)
        : radius(clear_radius(lens.surfaces[0])), curvature(lens.surfaces[0].curvature) {
        const double c2r2 = curvature * curvature * radius * radius;
        area = c2r2 > 0 ? 2 * kPiD * (1 - std::sqrt(1 - c2r2)) / (curvature * curvature) : kPiD * radius * radius;
    }
    LensRay ray(Uniform& u) const {
        const double phi = 2 * kPiD * u();
        double r = radius * std::sqrt(u()), z = 0;
        Vec3d normal{0, 0, 1};
        if (curvature > 0) {   // uniform in height (Archimedes)
            z = u() * (1 - std::sqrt(1 - curvature * curvature * radius * radius)) / curvature;
            r = std::sqrt(z * (2 / curvature - z));
            normal = {-curvature * r * std::cos(phi), -curvature * r * std::sin(phi), 1 - curvature * z};
        }
        return {{r * std::cos(phi), r * std::sin(phi), z}, diffuse_about(normal, u)};
    }
};

/// Scattered light from a uniform sky of radiance 1 / pi on a disc of the film, in batches;
/// `counts` filters the walks.
using Counts = std::function<bool(const ScatteredLight&)>;
std::vector<double> from_sky(const ScatterLens& lens, const Prescription& as_given, const ScatterDraw& draw,
                             int batches, int walks, unsigned seed, const Counts& counts = nullptr) {
    Uniform u(seed);
    const Sky sky(as_given);
    const LensIndices n = lens.at(550);
    std::vector<double> out(batches);
    for (double& sum : out)
        for (int i = 0; i < walks; ++i) {
            const auto light = lens.walk(sky.ray(u), n, 1, seed + u.rng(), draw);
            if (light && length(light->film) < kFilmRadius && (!counts || counts(*light)))
                sum += sky.area * light->weight / walks;
        }
    return out;
}

/// Adjoint of from_sky: light from the disc, uniform over all directions, that leaves the front.
std::vector<double> from_film(const ScatterLens& lens, int batches, int walks, unsigned seed) {
    Uniform u(seed);
    const ScatterDraw draw{.toward_film = false};
    const Prescription& whole = lens.ghosts().tracer().prescription();
    const double reflectance = whole.surfaces.back().reflectance;
    // All rays to the last surface pass a slightly larger disc at its vertex.
    const double last = lens.ghosts().tracer().vertices()[lens.rims().size() - 1];
    const double rear = lens.rims().back().radius + 2;
    const double area = kPiD * kFilmRadius * kFilmRadius * rear * rear;   // both areas, times the sky's 1 / pi
    const LensIndices n = lens.at(550);
    const double z = lens.ghosts().film().center.z;
    std::vector<double> out(batches);
    for (double& sum : out)
        for (int i = 0; i < walks; ++i) {
            const Vec2d p = concentric_disc({u(), u()}) * kFilmRadius, q = concentric_disc({u(), u()}) * rear;
            const Vec3d way = Vec3d{q.x, q.y, last} - Vec3d{p.x, p.y, z};
            const double cosine = -way.z / length(way), etendue = area * std::pow(cosine, 4) / (way.z * way.z);
            const auto light = lens.walk({{p.x, p.y, z}, normalize(way)}, n, 1, seed + u.rng(), draw);
            // The sensor records the part that it does not reflect.
            if (light) sum += etendue * light->weight * (1 - reflectance) / walks;
        }
    return out;
}

/// Open tube: three planes between air and air, with a stop as wide as the tube.
constexpr double kTube = 10, kLength = 30;
Prescription tube() {
    Prescription lens = test::lens_from_rows("tube", {{0, 12, 1, 0, kTube},
                                                      {0, kLength - 12, 1, 0, kTube, true},
                                                      {0, 1e-3, 1, 0, kTube}});
    return lens;
}

/// View factor between two discs of radius a at distance h. Source: Howell, A Catalog of Radiation
/// Heat Transfer Configuration Factors, C-41.
double disc_to_disc(double a, double h) {
    const double x = 2 + h * h / (a * a);
    return 0.5 * (x - std::sqrt(x * x - 4));
}

/// View factor from an element inside a tube of radius a to the disc at its end, x away: C-79 of
/// the catalogue.
double tube_to_disc(double a, double x) {
    const double z = x / (2 * a);
    return (z * z + 0.5) / std::sqrt(z * z + 1) - z;
}

const ScatterDraw kPlain{.aimed = false, .forced = false, .roulette = false};

}  // namespace

TEST_CASE("all of a walk's light ends somewhere, and drawing it adds none in the mean") {
    Prescription lenses[] = {test::tessar(), test::sonnar(), test::check_lens()};
    lenses[0].coating = Coating::uncoated;
    for (const Prescription& lens : lenses)
        for (const ScatterDraw& draw :
             {kPlain, ScatterDraw{}, ScatterDraw{.aimed = false, .roulette = false}, ScatterDraw{.toward_film = false}}) {
            const ScatterLens scatter = make(lens, lens.surfaces[lens.stop_index()].semi_diameter * 0.5,
                                             parts(0.4, 0.7, 40));
            Uniform u(4);
            const Sky sky(lens);
            const LensIndices n = scatter.at(550);
            LightEnds all{};
            std::vector<double> chance;
            constexpr int kWalks = 8000;
            for (int i = 0; i < kWalks; ++i) {
                LightEnds ends{};
                LensRay ray = sky.ray(u);
                if (!draw.toward_film) {
                    const Vec2d p = concentric_disc({u(), u()}) * kFilmRadius;
                    ray = {{p.x, p.y, scatter.ghosts().film().center.z}, diffuse_about({0, 0, -1}, u)};
                }
                scatter.walk(ray, n, 1, u.rng(), draw, &ends);
                REQUIRE(std::accumulate(ends.begin(), ends.end(), 0.0) == doctest::Approx(1).epsilon(1e-12));
                for (int k = 0; k < kLightEnds; ++k) all[k] += ends[k] / kWalks;
                chance.push_back(ends[int(LightEnd::chance)]);
            }
            const SampleMoments m = moments(chance);
            INFO(lens.name << " film " << all[0] << " front " << all[1] << " metal " << all[2] << " glass " << all[3]
                           << " rear " << all[4] << " truncated " << all[5] << " lost " << all[6] << " chance "
                           << m.mean << " +- " << std::sqrt(m.variance / m.count));
            CHECK(std::abs(m.mean) <= 4 * std::sqrt(m.variance / m.count));
            CHECK(all[int(LightEnd::truncated)] < 1e-3);
            CHECK(all[int(LightEnd::lost)] < (lens.name == "sonnar" ? 0.03 : 1e-4));   // its iris is inside a
                                                                                       // hollow
            CHECK(all[int(LightEnd::metal)] > 0.01);
        }
}

TEST_CASE("in a white furnace all light comes out again") {
    const Prescription lens = test::tessar();
    const LensScatter white{.barrel = {1, 0}, .blades = {1, 0}, .surface_rms_nm = 30};
    const ScatterLens scatter = make(lens, 3, white);
    Uniform u(8);
    LightEnds all{};
    std::vector<double> chance;
    constexpr int kWalks = 60000;
    for (int i = 0; i < kWalks; ++i) {
        LightEnds ends{};
        const LensRay ray = Sky(lens).ray(u);
        scatter.walk(ray, scatter.at(550), 1, u.rng(), kPlain, &ends);
        for (int k = 0; k < kLightEnds; ++k) all[k] += ends[k] / kWalks;
        chance.push_back(ends[int(LightEnd::chance)]);
    }
    CHECK(all[int(LightEnd::metal)] == doctest::Approx(0));
    CHECK(all[int(LightEnd::glass)] == 0);
    CHECK(all[int(LightEnd::truncated)] + all[int(LightEnd::lost)] < 1e-3);
    const SampleMoments m = moments(chance);
    CHECK(std::abs(m.mean) <= 4 * std::sqrt(m.variance / m.count));
    CHECK(all[int(LightEnd::film)] + all[int(LightEnd::front)] + all[int(LightEnd::rear)] ==
          doctest::Approx(1 - m.mean).epsilon(1e-3));
}

TEST_CASE("light from a white sky to the film is light from the film to the sky") {
    struct Case {
        const char* name;
        Prescription lens;
        LensScatter scatter;
        double iris;
        double reflectance = 0;   // of the sensor
    };
    Prescription bare = test::tessar();
    bare.coating = Coating::uncoated;
    const Case cases[] = {{"barrel", test::tessar(), parts(0.5, 0, 0), 7},
                          {"blades", test::sonnar(), parts(0, 0.8, 0), 3, 0.6},
                          {"surfaces", test::tessar(), parts(0, 0, 60), 7},
                          {"all", bare, parts(0.4, 0.4, 60), 6},
                          {"all of another", test::check_lens(), parts(0.4, 0.4, 60), 14}};
    static const char* more = std::getenv("DG_EFFORT");
    const int effort = more ? std::atoi(more) : 1;
    for (const Case& c : cases) {
        const double film = c.lens.last_vertex() + c.lens.surfaces.back().thickness;
        const ScatterLens lens = make(c.lens, film, c.iris, c.scatter, {.reflectance = c.reflectance});
        const SampleMoments forward = moments(from_sky(lens, c.lens, {}, 20, 1500 * effort, 11)),
                            plain = moments(from_sky(lens, c.lens, kPlain, 20, 2000 * effort, 12)),
                            backward = moments(from_film(lens, 20, 1500 * effort, 13));
        const auto sigma = [](const SampleMoments& m) { return std::sqrt(m.variance / m.count); };
        INFO(std::string(c.name) << ": aimed " << forward.mean << " +- " << sigma(forward) << ", plain " << plain.mean << " +- "
                    << sigma(plain) << ", backward " << backward.mean << " +- " << sigma(backward));
        if (more)
            MESSAGE(std::string(c.name) << ": aimed " << forward.mean << " +- " << sigma(forward) << ", plain " << plain.mean
                           << " +- " << sigma(plain) << ", backward " << backward.mean << " +- " << sigma(backward));
        CHECK(forward.mean > 0);
        CHECK(welch_p_value(forward, plain) > 1e-3);
        CHECK(welch_p_value(forward, backward) > 1e-3);
    }
}

TEST_CASE("once off the wall of a tube: form factors") {
    const double albedo = 0.6;
    const LensScatter walls{.barrel = {albedo, 0}, .blades = kBlack, .surface_rms_nm = 0};
    const ScatterLens lens{tube(), {{0, 0, kLength + 1e-3}}, Iris(), kTube, {}, kFilmRadius, walls};
    double wanted = 0;   // expected share of light that enters through the disc uniformly over all directions
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
        const double x = (i + 0.5) / kSteps * kLength;
        wanted += albedo * tube_to_disc(kTube, x) * tube_to_disc(kTube, kLength - x) * 2 * kPiD * kTube * kLength / kSteps;
    }
    for (const ScatterDraw& draw : {kPlain, ScatterDraw{}}) {
        const auto once = [](const ScatteredLight& light) { return light.events == 1; };
        const SampleMoments found = moments(from_sky(lens, tube(), draw, 20, 12000, 21, once));
        const double sigma = std::sqrt(found.variance / found.count);
        INFO("wanted " << wanted << ", found " << found.mean << " +- " << sigma);
        CHECK(sigma < 0.01 * wanted);
        CHECK(std::abs(found.mean - wanted) < 4 * sigma);
    }
}

TEST_CASE("closed blades send back what form factors say, and nothing comes to the film") {
    const double albedo = 0.5;
    const ScatterLens lens{tube(), {{0, 0, kLength + 1e-3}}, Iris(), kTube, {}, kFilmRadius,
                           {.barrel = kBlack, .blades = {albedo, 0}, .surface_rms_nm = 0}};
    Uniform u(31);
    LightEnds all{};
    constexpr int kWalks = 100000;
    for (int i = 0; i < kWalks; ++i)
        CHECK_FALSE(lens.walk(Sky(tube()).ray(u), lens.at(550), 0, u.rng(), {}, &all).has_value());
    const double there = disc_to_disc(kTube, 12), wanted = there * there * albedo;
    // Light through the front hits the blades first, the only parts that are not black.
    CHECK(all[int(LightEnd::front)] / kWalks == doctest::Approx(wanted).epsilon(0.03));
    CHECK(all[int(LightEnd::film)] == 0);
}

TEST_CASE("polished surfaces scatter the sum of their shares") {
    Prescription lens = test::tessar();
    lens.coating = Coating::perfect;
    const LensScatter rough{.barrel = kBlack, .blades = kBlack, .surface_rms_nm = 4, .surface_lobe = {0.001, -4}};
    const ScatterLens scatter = make(lens, 5, rough);
    const LensIndices n = scatter.at(550);
    double wanted = 0;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
        wanted += std::pow(2 * kPiD * 4 / 550 * (n.index[i + 1] - n.index[i]), 2);
    std::vector<double> found;
    for (int i = 0; i < 20000; ++i) {
        const auto light = scatter.walk({{0, 0, -1}, {0, 0, 1}}, n, 1, std::uint64_t(i), {});
        found.push_back(light ? light->weight : 0);
    }
    const SampleMoments m = moments(found);
    const double sigma = std::sqrt(m.variance / m.count);
    INFO("wanted " << wanted << ", found " << m.mean << " +- " << sigma);
    CHECK(sigma < 0.02 * wanted);
    CHECK(std::abs(m.mean - wanted) < 4 * sigma + 0.01 * wanted);   // the tails of the lobe miss the film
}

TEST_CASE("the halo of a rough last surface has the lobe's shape") {
    // Plate with light along the axis, scattered by one of the faces. It leaves at b = n
    // sin(theta), whether scattered inside the glass or behind it, and is displaced by z tan(theta)
    // on the film.
    Prescription lens = test::lens_from_rows("plate", {{0, 1e-3, 1, 0, 40, true}, {0, 1e-3, 1.7, 0, 40}, {0, 50, 1, 0, 40}});
    const LensScatter rough{.barrel = kBlack, .blades = kBlack, .surface_rms_nm = 2, .surface_lobe = {0.2, -2}};
    const ScatterLens scatter{lens, {{0, 0, 50}}, Iris(), 40, {}, 1000, rough};
    const LensIndices n = scatter.at(550);
    const HarveyShack lobe = rough.surface_lobe;
    double inner = 0, outer = 0;   // light within 30 degrees, and between 30 and 60
    for (int i = 0; i < 40000; ++i) {
        const auto light = scatter.walk({{0, 0, -1}, {0, 0, 1}}, n, 1, std::uint64_t(i), {});
        if (!light) continue;
        const double sine = std::sin(std::atan(length(light->film) / 50));
        if (sine < 0.866) (sine < 0.5 ? inner : outer) += light->weight;
    }
    const double in = lobe.within(0.5), all = lobe.within(0.866);
    // Oblique light loses a few percent more by reflection.
    CHECK(outer / inner == doctest::Approx((all - in) / in).epsilon(0.06));
}

TEST_CASE("a walk is a function of its seed, and a shut iris lets none through") {
    const Prescription lens = test::tessar();
    const ScatterLens scatter = make(lens, 4, parts(0.4, 0, 20));
    Uniform u(9);
    const Sky sky(lens);
    const LensIndices n = scatter.at(550);
    int found = 0, others = 0;
    for (int i = 0; i < 2000; ++i) {
        const LensRay ray = sky.ray(u);
        const auto a = scatter.walk(ray, n, 1, std::uint64_t(i), {}), b = scatter.walk(ray, n, 1, std::uint64_t(i), {}),
                   c = scatter.walk(ray, n, 1, std::uint64_t(i) + 5000, {});
        REQUIRE(a.has_value() == b.has_value());
        if (!a) continue;
        ++found;
        CHECK(a->weight == b->weight);
        CHECK(length(a->film - b->film) == 0);
        CHECK(a->events > 0);
        others += !c || length(a->film - c->film) > 0;
        CHECK_FALSE(scatter.walk(ray, n, 1e-6, std::uint64_t(i), {}).has_value());
    }
    CHECK(found > 100);
    CHECK(others > found / 2);
}
