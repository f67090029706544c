// light_tree_test.cpp -- probabilities add to 1, match the samples, and are positive for every light that reaches a
// point.
#include "light/light_tree.h"

#include <doctest/doctest.h>

#include <numeric>

#include "light/direction_test.h"
#include "light/light_segment.h"

using namespace dg;

namespace {

Vec3f random_vector(std::uint64_t stream, int i) {
    return {float(hash_uniform(stream, 3 * i)) - 0.5f,
            float(hash_uniform(stream, 3 * i + 1)) - 0.5f,
            float(hash_uniform(stream, 3 * i + 2)) - 0.5f};
}

/// Small facets with random normals.
std::vector<LightBounds> random_lights(int n) {
    std::vector<LightBounds> lights(n);
    for (int i = 0; i < n; ++i) {
        const Vec3f p = random_vector(1, i) * 10;
        lights[i].min = p - Vec3f{0.1f, 0.1f, 0.1f};
        lights[i].max = p + Vec3f{0.1f, 0.1f, 0.1f};
        lights[i].axis = normalize(random_vector(2, i));
        lights[i].spread = i % 3 == 0 ? kPi : 0.3f;
        lights[i].two_sided = i % 5 == 0;
        lights[i].intensity = float(0.1 + hash_uniform(3, i));
    }
    return lights;
}

/// Whether a point of the light's box may illuminate p for a normal in its cone.
bool shines(const LightBounds& b, Vec3f p) {
    const Vec3f to = normalize(p - (b.min + b.max) * 0.5f);
    float cosine = dot(to, b.axis);
    if (b.two_sided) cosine = std::abs(cosine);
    return std::acos(std::clamp(cosine, -1.f, 1.f)) < b.spread + b.falloff;
}

}  // namespace

TEST_CASE("probabilities: they add to 1, and no light that shines has none") {
    for (int n : {1, 2, 7, 9, 100}) {
        const auto lights = random_lights(n);
        const LightTree tree(lights);
        for (int k = 0; k < 50; ++k) {
            const Vec3f p = random_vector(4, k) * 20;
            double sum = 0;
            bool any = false;
            for (int i = 0; i < n; ++i) {
                const float probability = tree.probability(p, i);
                sum += probability;
                if (!shines(lights[i], p)) continue;
                any = true;
                CHECK(probability > 0);
            }
            if (const auto choice = tree.sample(p, float(hash_uniform(5, k))))
                CHECK(choice->probability == tree.probability(p, choice->light));
            // Branches with lights that face away account for the difference to 1.
            CHECK(sum < 1.0001);
            if (any && n == 1) CHECK(sum == doctest::Approx(1));
        }
    }
}

TEST_CASE("samples follow the probabilities: chi-square, and 2 % would be noticed") {
    const int n = 60, draws = 1000000;
    const LightTree tree(random_lights(n));
    const Vec3f p{1, 2, -1};
    std::vector<double> observed(n + 1, 0), expected(n + 1, draws);
    for (int i = 0; i < draws; ++i) {
        const auto choice = tree.sample(p, float(hash_uniform(9, i)));
        if (!choice) {
            observed[n] += 1;
            continue;
        }
        observed[choice->light] += 1;
        if (i < 1000) CHECK(choice->probability == tree.probability(p, choice->light));
    }
    for (int i = 0; i < n; ++i) {
        expected[i] = draws * double(tree.probability(p, i));
        expected[n] -= expected[i];
    }
    expected[n] = expected[n] < 1 ? 0 : expected[n];
    CHECK(chi_square_test(observed, expected).p_value > 1e-3);
    for (int i = 0; i < n; ++i) expected[i] *= i % 2 ? 1.02 : 0.98;
    CHECK(chi_square_test(observed, expected).p_value < 1e-6);
}

TEST_CASE("many lights: a choice weighed by its probability sums them all up, and has it to the bit") {
    const int n = 60000, draws = 200000;   // enough for building branches in parallel
    const auto lights = random_lights(n);
    const LightTree tree(lights);
    const Vec3f p{9, 2, -1};
    std::vector<double> brought(n);
    for (int i = 0; i < n; ++i) brought[i] = LightTree(std::span(lights).subspan(i, 1)).importance(p);
    const double sum = std::accumulate(brought.begin(), brought.end(), 0.);
    std::vector<double> estimates(draws, 0);
    for (int i = 0; i < draws; ++i)
        if (const auto choice = tree.sample(p, float(hash_uniform(9, i)))) {
            REQUIRE(choice->probability == tree.probability(p, choice->light));
            estimates[i] = brought[choice->light] / double(choice->probability) / sum;
        }
    const SampleMoments found = moments(estimates);
    CHECK(welch_p_value(found, {1, 0, 2}) > 1e-3);
    CHECK(welch_p_value(found, {1.01, 0, 2}) < 1e-3);
}

TEST_CASE("lamps are chosen for a way by the light that it scatters once, facets by that of the part before them") {
    constexpr int kLamps = 7, kSteps = 4000;
    constexpr float kG = 0.6f, kLength = 6;
    const auto phase = [](float turn) { return std::pow((1 - kG) * (1 - kG) + 2 * kG * turn, -1.5f); };
    const PhaseAngles angles(phase);
    const Vec3f origin{1, 2, 3}, d = normalize(Vec3f{1, -1, 0.5f});
    const LightSegment way{origin, d, kLength, 0, angles};
    for (int layout = 0; layout < 12; ++layout) {
        std::vector<LightBounds> lights(kLamps);
        std::vector<double> brought(kLamps, 0);
        for (int i = 0; i < kLamps; ++i) {
            LightBounds& lamp = lights[i];
            lamp.min = lamp.max = origin + d * 3 + random_vector(20 + layout, i) * 6;
            lamp.axis = normalize(random_vector(40 + layout, i));
            lamp.intensity = float(0.5 + hash_uniform(3, i));
            const bool facet = i % 2 == 0;
            if (facet) lamp.spread = 0;
            for (int k = 0; k < kSteps; ++k) {
                const Vec3f to = lamp.min - origin - d * (kLength * (float(k) + 0.5f) / kSteps);
                if (facet && dot(lamp.axis, to) >= 0) continue;
                const float turn = 1 - dot(to, d) / length(to);
                brought[i] += double(lamp.intensity * phase(turn) / length_squared(to)) / kSteps;
            }
        }
        const double sum = std::accumulate(brought.begin(), brought.end(), 0.);
        const LightTree tree(lights);
        const LightTree::Weights weights = tree.weigh(way);
        for (int i = 0; i < 1000; ++i) {
            const auto choice = tree.sample(weights, way, float(hash_uniform(9, i)));
            REQUIRE(choice);
            const double expected = brought[choice->light] / sum;
            CHECK(std::abs(double(choice->probability) - expected) < 0.02 + 0.1 * expected);
        }
    }
}

TEST_CASE("facets that light any part of a way are chosen for it, and none that is turned away") {
    constexpr int kFacets = 300, kDraws = 400000;
    std::vector<LightBounds> lights = random_lights(kFacets);
    for (LightBounds& b : lights) {
        const Vec3f middle = (b.min + b.max) * 0.5f;
        b.min = b.max = middle;
        b.spread = 0, b.two_sided = false;
    }
    const LightTree tree(lights);
    const PhaseAngles even;
    for (const float length : {2.f, 15.f, std::numeric_limits<float>::infinity()}) {
        const LightSegment way{{-6, 1, 2}, normalize(Vec3f{1, -0.3f, -0.2f}), length, 0.1f, even};
        const LightTree::Weights weights = tree.weigh(way);
        std::vector<double> counted(kFacets, 0);
        for (int i = 0; i < kDraws; ++i)
            if (const auto choice = tree.sample(weights, way, float(hash_uniform(11, i))))
                counted[choice->light] += 1 / (double(choice->probability) * kDraws);
        double shine = 0, chosen = 0;
        for (int i = 0; i < kFacets; ++i) {
            const auto before = [&](float t) {
                return dot(lights[i].axis, way.origin + way.direction * t - lights[i].min);
            };
            if (std::max(before(0), before(std::min(length, 1e6f))) > 0)
                ++shine, chosen += counted[i];
            else
                CHECK(counted[i] == 0);
        }
        CAPTURE(length);
        CHECK(chosen == doctest::Approx(shine).epsilon(0.03));
    }
}

TEST_CASE("several at once are those that come one by one, to the bit") {
    for (const int n : {1, 3, 8, 700}) {
        const auto lights = random_lights(n);
        const LightTree tree(lights);
        for (int i = 0; i < 200; ++i) {
            const Vec3f p = random_vector(6, i) * 12;
            const LightTree::Weights weights = tree.weigh(p);
            std::array<float, LightTree::kMostAtOnce> u;
            std::array<LightTree::Choice, LightTree::kMostAtOnce> found;
            for (std::size_t k = 0; k < u.size(); ++k) u[k] = float(hash_uniform(7 + k, i));
            tree.sample(weights, p, u, found);
            for (std::size_t k = 0; k < u.size(); ++k) {
                const auto alone = tree.sample(p, u[k]);
                REQUIRE(alone.has_value() == (found[k].probability > 0));
                if (!alone) continue;
                REQUIRE(found[k].light == alone->light);
                REQUIRE(found[k].probability == alone->probability);
            }
        }
    }
}

TEST_CASE("a near lamp wins over a far one") {
    std::vector<LightBounds> lights(2);
    for (LightBounds& b : lights) b.intensity = 1;
    lights[1].min = lights[1].max = {10, 0, 0};
    const LightTree tree(lights);
    CHECK(tree.probability({1, 0, 0}, 0) == doctest::Approx(81.0 / 82));
    CHECK(tree.probability({9, 0, 0}, 0) == doctest::Approx(1.0 / 82));
    CHECK(tree.importance({5, 0, 0}) == doctest::Approx(2.0 / 25));
}

TEST_CASE("importance: the formula in angles; a cut adds up its nodes") {
    int compared = 0;
    for (int n : {1, 3, 4, 5, 8}) {
        const auto lights = random_lights(n);
        for (int k = 0; k < 200; ++k) {
            const Vec3f p = random_vector(4, k) * 20;
            double sum = 0;
            for (const LightBounds& b : lights) {
                const Vec3d to = to_double(p - (b.min + b.max) * 0.5f);
                const double d = length(to), r = length(to_double(b.max - b.min)) / 2;
                double cosine = dot(to, to_double(b.axis)) / d;
                if (b.two_sided) cosine = std::abs(cosine);
                const double theta = std::max(
                    0.0, std::acos(cosine) - double(b.spread) - std::asin(r / d));
                const bool lit = b.spread >= kPi || theta < double(b.falloff);
                const double slant = b.spread >= kPi ? 1 : std::cos(theta);
                if (lit) sum += b.intensity / (d * d) * std::max(slant, 1e-3);
            }
            if (sum < 0.01) continue;  // rounding at the edge of a cone
            ++compared;
            CHECK(LightTree(lights).importance(p) / sum == doctest::Approx(1).epsilon(0.01));
        }
    }
    CHECK(compared > 200);
}

TEST_CASE("lights so far apart that floats overflow make a tree, without undefined behaviour") {
    auto lights = random_lights(40);   // found by fuzz_scene, under UBSan
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Vec3f p = random_vector(5, int(i)) * 6e38f;
        lights[i].min = lights[i].max = p;
    }
    const LightTree tree(lights);
    for (int i = 0; i < 40; ++i) CHECK_FALSE(tree.probability({0, 0, 0}, i) < 0);
}

TEST_CASE("lights so bright that their sum overflows are chosen, and none beyond them") {
    auto lights = random_lights(40);
    for (LightBounds& b : lights) b.intensity = 3e38f;
    const LightTree tree(lights);
    for (int k = 0; k < 200; ++k) {
        const auto choice = tree.sample(random_vector(4, k) * 20, float(hash_uniform(5, k)));
        if (!choice) continue;
        CHECK(choice->light >= 0);
        CHECK(choice->light < 40);
        CHECK(choice->probability <= 1);
    }
}

TEST_CASE("signs on a wall: dark behind their planes, none forgotten before them") {
    // Lights with equal normals in two rows; the sphere around a group extends far behind the wall.
    std::vector<LightBounds> signs(200);
    for (int i = 0; i < 200; ++i) {
        const float x = i % 2 ? 0.f : 0.5f;
        const Vec3f p{x, random_vector(1, i).y * 4, random_vector(1, i).z * 40};
        signs[i].min = p - Vec3f{0, 0.1f, 0.1f};
        signs[i].max = p + Vec3f{0, 0.1f, 0.1f};
        signs[i].axis = {1, 0, 0};
        signs[i].spread = 0;
        signs[i].intensity = 1;
    }
    const LightTree tree(signs);
    for (int k = 0; k < 200; ++k) {
        const Vec3f v = random_vector(4, k);
        CHECK(tree.importance({-0.01f - std::abs(v.x), v.y * 4, v.z * 40}) == 0);
        const Vec3f between{0.25f, v.y * 4, v.z * 40};
        double sum = 0;
        for (int i = 0; i < 200; ++i) {
            const float probability = tree.probability(between, i);
            CHECK((probability > 0) == (i % 2 == 1));
            sum += probability;
        }
        CHECK(sum > 0.9);  // the difference to 1 is wasted on signs that face away
    }
}

TEST_CASE("lights that crowd ever closer to a point make no endless tree") {
    std::vector<LightBounds> lights(3000);
    float x = 1;
    for (LightBounds& b : lights) {
        b.min = b.max = {x, 0, 0};
        b.intensity = 1;
        x *= 0.97f;
    }
    const LightTree tree(lights);
    double sum = 0;
    for (int i = 0; i < 3000; ++i) sum += tree.probability({0, 1, 0}, i);
    CHECK(sum == doctest::Approx(1).epsilon(1e-3));
}
