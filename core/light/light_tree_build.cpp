#include "light/light_tree_build.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <ranges>
#include <utility>

#include "light/light_split.h"

namespace dg {
namespace {

constexpr int kWide = LightNode::kWide;
// Angle (rad) up to which normals count as equal.
constexpr float kFlatSpread = 1e-3f;
// Depth beyond which groups are halved by number, so that the depth never exceeds kLightTreeDepth, for up to 2^31
// lights.
constexpr int kDeepest = kLightTreeDepth - 33;
// Upper limit of intensities, so that sums do not overflow.
constexpr float kMostIntensity = 1e28f;
// Size above which groups are built in parallel.
constexpr std::size_t kOwnTask = 4096;

/// Lights of a group, with a buffer for sorting.
struct Group {
    std::span<LightItem> lights, room;
    float worth = 0;   // intensity times squared size: the largest group is split first

    Group(std::span<LightItem> lights, std::span<LightItem> room) : lights(lights), room(room) {
        if (lights.size() < 2) return;
        const LightBounds all = box_of(lights);
        worth = all.intensity * length_squared(all.max - all.min);
    }
};

/// Groups of a node's children: splits the largest until the node is full.
struct Groups {
    std::array<std::optional<Group>, 2 * kWide> of;
    std::size_t count = 1;

    Groups(const Group& whole, std::size_t most, bool halve) {
        of[0] = whole;
        while (count < most) {
            const std::size_t i = largest();
            if (of[i]->lights.size() < 2) break;
            const Group opened = *of[i];
            const std::size_t n = split_lights(opened.lights, opened.room, halve);
            of[i].emplace(opened.lights.first(n), opened.room.first(n));
            of[count++].emplace(opened.lights.subspan(n), opened.room.subspan(n));
        }
    }
    std::span<const std::optional<Group>> all() const { return {of.data(), count}; }

  private:
    std::size_t largest() const {
        const auto less = [](const auto& a, const auto& b) {
            const bool one_a = a->lights.size() < 2, one_b = b->lights.size() < 2;
            return one_a != one_b ? one_a : a->worth < b->worth;
        };
        return std::size_t(std::max_element(of.begin(), of.begin() + std::ptrdiff_t(count), less) - of.begin());
    }
};

LightEmission emission_of(const LightBounds& b) {
    LightEmission e;
    e.center = (b.min + b.max) * 0.5f;
    e.radius = 0.5f * length(b.max - b.min);
    e.axis = b.axis;
    e.cos_spread = std::cos(b.spread);
    e.cos_falloff = std::cos(b.falloff);
    e.intensity = b.intensity;
    // For lights with equal normals, such as signs on a wall or ceiling panels, their planes bound the lit half space.
    const bool flat = b.spread <= kFlatSpread && b.falloff <= kPi / 2;
    const Vec3f half = (b.max - b.min) * (0.5f + kCosineSlack);
    const Vec3f a{std::abs(b.axis.x), std::abs(b.axis.y), std::abs(b.axis.z)};
    e.reach = b.two_sided ? -1
              : flat      ? dot(a, half) + kFlatSpread * e.radius
                          : std::numeric_limits<float>::infinity();
    return e;
}

void put(LightNode& node, int place, const LightEmission& e, std::int32_t next) {
    const auto facts = std::bit_cast<std::array<float, LightNode::kFacts>>(e);
    for (std::size_t k = 0; k < facts.size(); ++k) node.facts[k][place] = facts[k];
    node.next[place] = next;
}

/// Appends a branch that was built separately, with adjusted indices.
void append(LightBranch& branch, const LightBranch& grown, std::int32_t place) {
    const auto first = std::int32_t(branch.nodes.size());
    for (LightNode node : grown.nodes) {
        for (std::int32_t& next : node.next)
            if (next > 0) next += first;
        branch.nodes.push_back(node);
    }
    for (const std::int32_t p : grown.parent) branch.parent.push_back(p < 0 ? place : p + first * kWide);
}

LightBounds grow(const Group& all, int depth, LightBranch& branch, std::int32_t place);

/// Builds the children of a node recursively; returns the bounds of all lights. Builds large groups in parallel.
LightBounds fill(std::int32_t node, std::span<const std::optional<Group>> groups, int depth, LightBranch& branch) {
    const auto apart = [&](std::size_t i) { return groups[i]->lights.size() > kOwnTask; };
    std::array<LightBranch, kWide> grown;
    std::array<LightBounds, kWide> bounds;
    if (std::ranges::any_of(std::views::iota(std::size_t(0), groups.size()), apart))
        tbb::parallel_for(std::size_t(0), groups.size(), [&](std::size_t i) {
            if (apart(i)) bounds[i] = grow(*groups[i], depth, grown[i], -1);
        });
    std::size_t nodes = branch.nodes.size();
    for (const LightBranch& own : grown) nodes += own.nodes.size();
    branch.nodes.reserve(nodes), branch.parent.reserve(nodes);
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const std::span<LightItem> lights = groups[i]->lights;
        const std::int32_t place = node * kWide + std::int32_t(i);
        std::int32_t next = std::int32_t(branch.nodes.size());
        if (lights.size() == 1)
            bounds[i] = lights[0].bounds, next = ~lights[0].light;
        else if (apart(i))
            append(branch, std::exchange(grown[i], {}), place);
        else
            bounds[i] = grow(*groups[i], depth, branch, place);
        put(branch.nodes[node], int(i), emission_of(bounds[i]), next);
    }
    for (std::size_t i = 1; i < groups.size(); ++i) bounds[0] = merge(bounds[0], bounds[i]);
    return bounds[0];
}

/// Appends a node for a group of lights.
LightBounds grow(const Group& all, int depth, LightBranch& branch, std::int32_t place) {
    const auto node = std::int32_t(branch.nodes.size());
    branch.nodes.emplace_back();
    branch.parent.push_back(place);
    const Groups groups(all, kWide, depth > kDeepest);
    return fill(node, groups.all(), depth + 1, branch);
}

}  // namespace

LightBranch build_light_tree(std::span<const LightBounds> lights) {
    std::vector<LightItem> items(lights.size()), room(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        LightBounds b = lights[i];
        b.intensity = std::min(b.intensity, kMostIntensity);
        items[i] = LightItem(b, std::int32_t(i));
    }
    const Groups groups(Group(items, room), 2 * kWide, false);
    const auto first = groups.all().first(std::min<std::size_t>(groups.count, kWide));
    const auto second = groups.all().subspan(first.size());
    LightBranch tree;
    tree.nodes.resize(second.empty() ? 1 : 2);
    tree.parent.resize(tree.nodes.size(), -1);
    fill(0, first, 1, tree);
    if (!second.empty()) fill(1, second, 1, tree);
    return tree;
}

}  // namespace dg
