// solid_ranks_test.cpp -- which solids overlap, touch or stay apart, and which of two is there.
#include <doctest/doctest.h>

#include "scene/instance_bounds.h"
#include "scene/scene.h"
#include "scene/test_scenes.h"

using namespace dg;

namespace {

Material glass() {
    return {"glass", DielectricMaterial{}};
}

/// Cubes of a half width, each about a centre.
SceneDescription cubes(std::initializer_list<std::pair<float, Vec3f>> all) {
    SceneDescription d;
    for (const auto& [half, center] : all) {
        add(d, cube_mesh(), glass());
        d.instances.back().world_from_local = {{half, 0, 0}, {0, half, 0}, {0, 0, half}, center};
    }
    return d;
}

SolidRanks ranks_of(const SceneDescription& d) {
    std::vector<BoundedSolid> solids;
    for (std::uint32_t i = 0; i < d.instances.size(); ++i)
        solids.push_back({i, bounds_over_time(d.meshes[d.instances[i].mesh], d.instances[i])});
    return rank_solids(d, solids);
}

}  // namespace

TEST_CASE("solids apart, and solids with an air gap in another's hollow, have no ranks") {
    CHECK(ranks_of(cubes({{1, {0, 0, 0}}, {1, {2.001f, 0, 0}}})).of_instance.empty());
    SceneDescription d;   // two balls with boxes that meet
    for (const float x : {0.f, 1.5f}) {
        add(d, ball_mesh(3), glass());
        d.instances.back().world_from_local.origin = {x, 1.5f * (x > 0), 0};
    }
    CHECK(ranks_of(d).of_instance.empty());
    d.instances.back().world_from_local.origin = {1.3f, 1.3f, 0};
    CHECK_FALSE(ranks_of(d).of_instance.empty());
}

TEST_CASE("the inner solid is there, then the later one; a priority comes first") {
    const SceneDescription inner = cubes({{1, {0, 0, 0}}, {2, {0, 0, 0}}});
    const SolidRanks by_containment = ranks_of(inner);
    CHECK(by_containment.of_instance[0] > by_containment.of_instance[1]);
    CHECK(std::string(by_containment.overlaps.at(0).by) == "containment");
    CHECK_FALSE(by_containment.touches[0]);

    SceneDescription d = cubes({{1, {0, 0, 0}}, {1, {1, 1, 1}}});
    CHECK(ranks_of(d).overlaps.at(0).higher == 1);
    CHECK(std::string(ranks_of(d).overlaps[0].by) == "the order of the file");
    d.nesting[0] = {2, false};
    CHECK(ranks_of(d).overlaps.at(0).higher == 0);
    CHECK(std::string(ranks_of(d).overlaps[0].by) == "priority");
    d.nesting[0] = {0, true};
    CHECK(ranks_of(d).of_instance.empty());   // literal
}

TEST_CASE("overlaps that only the order of the file decides are listed beside many others") {
    SceneDescription d = cubes({{1, {0, 0, 0}}});
    for (int i = 0; i < 20; ++i) {
        add(d, cube_mesh(), glass());
        d.instances.back().world_from_local = {{.01f, 0, 0}, {0, .01f, 0}, {0, 0, .01f}, {.04f * float(i) - .5f, 0, 0}};
    }
    add(d, cube_mesh(), glass());
    d.instances.back().world_from_local.origin = {1.6f, 0, 0};
    const SolidRanks ranks = ranks_of(d);
    CHECK(ranks.overlaps.size() == 9);
    CHECK(std::string(ranks.overlaps.at(0).by) == "the order of the file");
    CHECK(ranks.overlaps[0].higher == 21);
}

TEST_CASE("boundaries at the same place touch; boundaries that cross do not") {
    const SolidRanks same = ranks_of(cubes({{1, {0, 0, 0}}, {1, {2, 0, 0}}}));
    CHECK(same.touches.at(0));
    CHECK(same.touches.at(1));
    SceneDescription d = cubes({{1, {0, 0, 0}}});
    add(d, ball_mesh(2), glass());
    d.instances.back().world_from_local = {{0.6f, 0, 0}, {0, 0.6f, 0}, {0, 0, 0.6f}, {1, 1, 1}};
    const SolidRanks crossing = ranks_of(d);
    CHECK(crossing.of_instance.at(0) > 0);
    CHECK_FALSE(crossing.touches[0]);
}

TEST_CASE("solids that move may overlap and touch") {
    SceneDescription d = cubes({{1, {0, 0, 0}}, {1, {1.5f, 0, 0}}});
    d.meshes[1].steps = 2;
    const SolidRanks ranks = ranks_of(d);
    CHECK(ranks.touches.at(0));
}
