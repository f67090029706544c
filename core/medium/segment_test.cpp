#include "medium/segment.h"

#include <doctest/doctest.h>

#include <vector>

#include "math/hash.h"
#include "math/statistics.h"
#include "medium/equiangular.h"

namespace dg {
namespace {

MediumAt medium(Spectrum scattering, Spectrum absorption, Spectrum emission = 0.f) {
    return {scattering, scattering + absorption, emission};
}

const MediumAt kGrey = medium(0.6f, 0.2f);
const MediumAt kColorful = medium({0.1f, 0.5f, 2.f, 0}, {0.f, 0.1f, 0.5f, 0});
constexpr float kEndless = std::numeric_limits<float>::infinity();

/// Lanes of a path after a length of `way` m through the medium.
Spectrum lanes_after(const MediumAt& m, float way) { return Segment(m, way, 1.f, false).passed().lanes; }

/// Distance to a collision; infinite if the path passes.
float free_path(const Segment& way, float u) {
    return u < way.collides() ? way.free_collision(u / way.collides()) : kEndless;
}

/// Density of free_path(): the mean over the wavelengths that may have drawn the path.
float free_path_density(const MediumAt& m, Spectrum lanes, float t) {
    return (lanes * m.extinction * transmittance(m.extinction, t)).average();
}

/// Chi-square test of distances against the integral of a density. Distances beyond `end` form a single cell.
template <typename Draw, typename Density>
double p_value(float end, Draw draw, Density density, int stream) {
    constexpr int kCells = 30, kCount = 60000, kSteps = 200;
    std::vector<double> observed(kCells + 1), expected(kCells + 1);
    double inside = 0;
    for (int i = 0; i < kCells; ++i) {
        for (int k = 0; k < kSteps; ++k)
            expected[i] += kCount * double(density(end * (i + (k + 0.5f) / kSteps) / kCells)) * end / kCells / kSteps;
        inside += expected[i];
    }
    expected[kCells] = std::max(0., kCount - inside);
    for (int n = 0; n < kCount; ++n) {
        const float t = draw(float(hash_uniform(stream, n)));
        ++observed[t < end ? int(t / end * kCells) : kCells];
    }
    if (expected[kCells] < 1) expected.pop_back(), observed[kCells - 1] += observed[kCells], observed.pop_back();
    return chi_square_test(observed, expected).p_value;
}

}  // namespace

TEST_CASE("free paths are drawn by their density, by all wavelengths together") {
    int stream = 10;
    for (const MediumAt& m : {kGrey, kColorful})
        for (const Spectrum lanes : {Spectrum(1.f), lanes_after(m, 1)}) {
            const Segment segment(m, 3, lanes, false);
            const auto draw = [&](float u) { return free_path(segment, u); };
            const auto density = [&](float t) { return free_path_density(m, lanes, t); };
            CHECK(p_value(3, draw, density, ++stream) > 1e-3);
            CHECK(p_value(3, draw, [&](float t) { return density(t) * 1.08f; }, stream) < 1e-3);
            const auto within = [&](float u) { return segment.collision(u); };
            const auto within_density = [&](float t) { return segment.collision_density(t); };
            CHECK(p_value(3, within, within_density, ++stream) > 1e-3);
        }
}

TEST_CASE("what passes and what is scattered have the right mean at each wavelength") {
    // E[passed] = exp(-extinction length), E[scattered] = albedo (1 - E[passed]), for every wavelength that draws.
    for (const bool hero_only : {false, true}) {
        const MediumAt m = kColorful;
        const Segment segment(m, 1.5f, hero_only ? Spectrum(1.f) : lanes_after(m, 0.7f), hero_only);
        constexpr int kCount = 400000;
        double passed[4]{}, scattered[4]{};
        for (int n = 0; n < kCount; ++n) {
            const float t = free_path(segment, float((n + hash_uniform(5, n)) / kCount));
            const auto onward = t < segment.length() ? segment.scattered(t) : segment.passed();
            double* const sum = t < segment.length() ? scattered : passed;
            for (int k = 0; k < 4; ++k) sum[k] += double(onward.weight[k]) / kCount;
            CHECK(onward.lanes.average() == doctest::Approx(1).epsilon(1e-4));
        }
        for (int k = 0; k < (hero_only ? 1 : 4); ++k) {
            const double left = std::exp(-double(m.extinction[k]) * 1.5);
            const double albedo = m.extinction[k] > 0 ? m.scattering[k] / m.extinction[k] : 0;
            CHECK(passed[k] == doctest::Approx(left).epsilon(0.003));
            CHECK(scattered[k] == doctest::Approx(albedo * (1 - left)).epsilon(0.003));
        }
    }
}


TEST_CASE("no wavelength of a path ever carries more than 4, however colourful the medium") {
    const MediumAt m = medium({0.01f, 30, 1, 0.2f}, 0.f);
    Spectrum lanes{1.f}, carried{1.f};
    for (int n = 0; n < 2000; ++n) {
        if (n % 8 == 0) lanes = carried = 1.f;
        const Segment segment(m, 1, lanes, false);
        const float t = free_path(segment, float(hash_uniform(9, n)));
        const auto onward = t < 1 ? segment.scattered(t) : segment.passed();
        carried *= onward.weight, lanes = onward.lanes;
        CHECK(carried.max() < 4.001f);
    }
}

TEST_CASE("emission is (1 - exp(-s d)) j / s") {
    const MediumAt m = medium({0.3f, 1, 0, 0}, {0.2f, 0, 0, 1e-7f}, {2, 1, 3, 0.5f});
    const Spectrum found = Segment(m, 2, 1.f, false).emitted();
    CHECK(found[0] == doctest::Approx((1 - std::exp(-1.)) * 2 / 0.5).epsilon(1e-5));
    CHECK(found[1] == doctest::Approx(1 - std::exp(-2.)).epsilon(1e-5));
    CHECK(found[2] == doctest::Approx(6));
    CHECK(found[3] == doctest::Approx(1).epsilon(1e-5));
    CHECK(Segment(m, kEndless, 1.f, false).emitted()[1] == doctest::Approx(1));
}

TEST_CASE("an endless way lets nothing pass but what meets nothing") {
    const Segment grey(kGrey, kEndless, 1.f, false);
    CHECK(free_path(grey, 0.999999f) < 1000);
    CHECK(grey.transmittance_to(kEndless).is_black());
    const Segment colorful(kColorful, kEndless, 1.f, false);
    CHECK(colorful.transmittance_to(kEndless)[3] == 1);
    CHECK(colorful.passed().weight[3] == doctest::Approx(4));
}

TEST_CASE("a path that is scattered at a share of its collisions brings the same, passing and scattered") {
    for (const MediumAt& m : {kGrey, kColorful})
        for (const float drawn : {1.f, 0.5f, 0.1f})
            for (const Spectrum lanes : {Spectrum(1.f), lanes_after(m, 0.3f)}) {
                const Segment way(m, 1.5f, lanes, false);
                const float scatters = drawn * way.collides();
                const Spectrum passed = way.passed(drawn).weight * (1 - scatters);
                Spectrum scattered(0.f);
                constexpr int kCount = 20000;
                for (int i = 0; i < kCount; ++i)
                    scattered += way.scattered(way.free_collision((float(i) + 0.5f) / kCount), drawn).weight / kCount;
                for (int k = 0; k < kWavelengths; ++k) {
                    CHECK(passed[k] == doctest::Approx(way.transmittance_to(1.5f)[k]).epsilon(1e-3));
                    const float met = m.extinction[k] > 0 ? -std::expm1(-1.5f * m.extinction[k]) / m.extinction[k] : 0;
                    CHECK(scattered[k] * scatters == doctest::Approx(m.scattering[k] * met).epsilon(5e-3));
                }
            }
}

TEST_CASE("equiangular distances are drawn by their density") {
    const Vec3f origin{1, 2, 3}, d = normalize(Vec3f{1, -1, 0.5f});
    int stream = 40;
    const std::vector<PhaseLobe> lobes{{0.7f, 3}, {-0.4f, 1}};
    for (const Vec3f lamp : {Vec3f{2, 1.2f, 3}, Vec3f{0, 3, 3}, Vec3f{6, 0, 5}})
        for (const auto& [phase, length] : {std::pair{Phase(), 4.f}, {Phase(), kEndless}, {Phase(lobes), 4.f},
                                            {Phase(lobes), kEndless}}) {
            const Equiangular e(origin, d, {0, length}, lamp, phase.angles());
            const auto draw = [&](float u) { return e.sample(u); };
            const auto density = [&](float t) { return e.pdf(t); };
            REQUIRE(e.usable());
            CHECK(p_value(4, draw, density, ++stream) > 1e-3);
            const float middle = e.sample(0.5f);
            const auto wrong = [&](float t) { return density(t) * (t < middle ? 1.1f : 0.9f); };
            CHECK(p_value(4, draw, wrong, stream) < 1e-3);
        }
}

TEST_CASE("a part of a way before a plane is as long as the plane leaves it, and distances stay there") {
    const RayPart way{0, kEndless};
    CHECK(way.before_plane(-2, 0.5f).begin == 4);
    CHECK(way.before_plane(-2, 0.5f).end == kEndless);
    CHECK(way.before_plane(2, -0.5f).end == 4);
    CHECK(way.before_plane(2, -0.5f).begin == 0);
    CHECK(way.before_plane(2, 0.5f).begin == 0);
    CHECK(way.before_plane(-2, -0.5f).empty());
    CHECK(way.before_plane(-2, 0).empty());
    CHECK_FALSE(way.before_plane(2, 0).empty());
    const std::vector<PhaseLobe> lobes{{0.7f, 3}, {-0.4f, 1}};
    const Phase phase(lobes);
    int stream = 70;
    for (const RayPart part : {RayPart{0.7f, 2.5f}, {1.5f, 4}, {2, kEndless}}) {
        const Equiangular e({1, 2, 3}, normalize(Vec3f{1, -1, 0.5f}), part, {2, 1.2f, 3}, phase.angles());
        const auto density = [&](float t) { return e.pdf(t); };
        CHECK(p_value(4, [&](float u) { return e.sample(u); }, density, ++stream) > 1e-3);
        CHECK(density(part.begin * 0.99f) == 0);
        CHECK(density(part.begin * 1.01f) > 0);
        CHECK(density(part.end * 1.01f) == 0);
    }
}

TEST_CASE("with the phase function's angles, what a lamp brings falls evenly on its distances") {
    const Vec3f origin{0, 0, 0}, d{0, 0, -1}, lamp{0.3f, 0.4f, -2};
    for (const float g : {0.f, 0.4f, 0.7f, -0.6f}) {
        const std::vector<PhaseLobe> lobe{{g, 1}};
        const Phase phase(lobe);
        const Equiangular e(origin, d, {0, 6}, lamp, phase.angles());
        float least = kEndless, most = 0;
        for (int i = 0; i < 500; ++i) {
            const float t = e.sample((float(i) + 0.5f) / 500);
            const Vec3f to = lamp - d * t;
            const float brought = phase.value(-d, normalize(to)) / length_squared(to) / e.pdf(t);
            least = std::min(least, brought), most = std::max(most, brought);
        }
        CHECK(most < 1.6f * least);   // the uniform part oversamples angles with little scattering
    }
}

}  // namespace dg
