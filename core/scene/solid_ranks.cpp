#include "scene/solid_ranks.h"

#include <tuple>

#include "geometry/triangle_distance.h"
#include "scene/scene.h"

namespace dg {
namespace {

constexpr std::size_t kMostOverlaps = 8;   // that are listed, of each kind
/// Boundaries closer than this fraction of their coordinates may be hit at the same place: 16 times SurfaceHit::error.
constexpr float kTouch = 0x1p-17f;
/// Cosine of the largest angle between triangles that touch along an area.
constexpr double kParallel = 0.98;

/// Most triangles tested for contact, some seconds. Beyond it, solids with overlapping boxes count as touching.
constexpr std::size_t kMostSearched = 20'000'000;

/// Contact of two solids.
struct Contact {
    bool overlap = false;    // their boundaries touch, or a solid contains the other
    bool coplanar = false;   // their boundaries touch along an area
};

class Solid {
  public:
    Solid(const SceneDescription& scene, std::uint32_t instance)
        : instance_(scene.instances[instance]), mesh_(scene.meshes[instance_.mesh]) {}

    /// Whether it moves or deforms.
    bool changes() const { return instance_.motion || mesh_.steps > 1; }
    Vec3d point(std::uint32_t vertex) const {
        return to_double(instance_.world_from_local.point(mesh_.positions[vertex]));
    }
    Triangle3d triangle(std::size_t i) const {
        const auto& t = mesh_.triangles[i];
        return {point(t[0]), point(t[1]), point(t[2])};
    }
    std::size_t size() const { return mesh_.triangles.size(); }

    /// Whether a point is inside, by the parity of a ray.
    bool holds(Vec3d from) const {
        constexpr Vec3d kDirection{0.35, 0.86, 0.37};   // along no axis
        bool inside = false;
        for (std::size_t i = 0; i < size(); ++i) {
            const auto [a, b, c] = triangle(i);
            const Vec3d p = a - from, q = b - from, r = c - from;
            const double u = dot(cross(q, r), kDirection), v = dot(cross(r, p), kDirection),
                         w = dot(cross(p, q), kDirection);
            const bool same_side = (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
            if (same_side && dot(p, cross(q, r)) / (u + v + w) > 0) inside = !inside;
        }
        return inside;
    }

  private:
    const Instance& instance_;
    const Mesh& mesh_;
};

struct BoundedTriangle {
    Bounds bounds;   // grown by kTouch
    Triangle3d corners;
};

std::vector<BoundedTriangle> triangles_in(const Solid& solid, const Bounds& box) {
    std::vector<BoundedTriangle> found;
    for (std::size_t i = 0; i < solid.size(); ++i) {
        const Triangle3d t = solid.triangle(i);
        Bounds b = Bounds::none();
        for (const Vec3d p : t) b.hold(to_float(p));
        const float reach = kTouch * std::max(largest_coordinate(b.min), largest_coordinate(b.max));
        b = {b.min - Vec3f{reach, reach, reach}, b.max + Vec3f{reach, reach, reach}};
        if (b.meets(box)) found.push_back({b, t});
    }
    return found;
}

bool are_parallel(const Triangle3d& a, const Triangle3d& b) {
    const Vec3d m = cross(a[1] - a[0], a[2] - a[0]), n = cross(b[1] - b[0], b[2] - b[0]);
    return std::abs(dot(m, n)) >= kParallel * length(m) * length(n);
}

Contact contact(const Solid& a, const Solid& b, const Bounds& both) {
    std::vector<BoundedTriangle> of_a = triangles_in(a, both), of_b = triangles_in(b, both);
    Contact found;
    each_meeting(std::span(of_a), std::span(of_b), [&](const BoundedTriangle& t, const BoundedTriangle& u) {
        const bool parallel = are_parallel(t.corners, u.corners);
        if (found.overlap && !parallel) return true;
        const float largest = std::max(largest_coordinate(t.bounds.min), largest_coordinate(t.bounds.max));
        const double reach = double(kTouch * largest);
        if (distance(t.corners, u.corners) > reach) return true;
        found.overlap = true;
        found.coplanar = parallel;
        return !parallel;   // contact along an area ends the search
    });
    return found;
}

/// A solid that takes part in nesting, with the data for its rank.
struct Nested {
    Bounds bounds;
    std::uint32_t instance;
    int priority;
    int depth = 0;   // overlapping solids that contain it, by their boxes
    bool overlaps = false, touches = false;

    auto order() const { return std::tuple(priority, depth, instance); }
};

std::vector<Nested> nesting_solids(const SceneDescription& scene, const std::vector<BoundedSolid>& solids) {
    std::vector<Nested> found;
    for (const BoundedSolid& s : solids) {
        const auto known = scene.nesting.find(scene.instances[s.instance].material);
        const Nesting nesting = known == scene.nesting.end() ? Nesting{} : known->second;
        const bool is_mesh = !scene.meshes[scene.instances[s.instance].mesh].triangles.empty();
        if (is_mesh && !nesting.literal) found.push_back({s.bounds, s.instance, nesting.priority});
    }
    return found;
}

/// Contact of two solids with overlapping boxes. Solids that move count as touching. `searched`: number of triangles
/// tested so far.
Contact contact_of(const SceneDescription& scene, const Nested& a, const Nested& b, std::size_t& searched) {
    const Solid first(scene, a.instance), second(scene, b.instance);
    searched += first.size() + second.size();
    if (first.changes() || second.changes() || searched > kMostSearched) return {true, true};
    Bounds both;
    for (int k = 0; k < 3; ++k) {
        both.min[k] = std::max(a.bounds.min[k], b.bounds.min[k]);
        both.max[k] = std::min(a.bounds.max[k], b.bounds.max[k]);
    }
    Contact found = contact(first, second, both);
    if (!found.overlap)
        found.overlap = (a.bounds.holds(b.bounds) && first.holds(second.point(0))) ||
                     (b.bounds.holds(a.bounds) && second.holds(first.point(0)));
    return found;
}

bool is_inside(const Nested& inner, const Nested& outer) {
    return outer.bounds.holds(inner.bounds) && !inner.bounds.holds(outer.bounds);
}

/// Whether priority or containment choose between two solids.
bool is_decided(const Nested& a, const Nested& b) {
    return a.priority != b.priority || is_inside(a, b) || is_inside(b, a);
}

Overlap described(const Nested& a, const Nested& b) {
    const auto& [low, high] = a.order() < b.order() ? std::tie(a, b) : std::tie(b, a);
    const char* by = low.priority != high.priority ? "priority"
                     : is_inside(high, low)        ? "containment"
                     : low.depth != high.depth     ? "the depth of nesting"
                                                   : "the order of the file";
    return {low.instance, high.instance, by};
}

}  // namespace

SolidRanks rank_solids(const SceneDescription& scene, const std::vector<BoundedSolid>& solids) {
    std::vector<Nested> nested = nesting_solids(scene, solids);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open, decided;   // the first pairs
    std::size_t searched = 0;
    each_meeting(std::span(nested), [&](Nested& a, Nested& b) {
        const Contact found = contact_of(scene, a, b, searched);
        if (!found.overlap) return true;
        a.overlaps = b.overlaps = true;
        a.touches |= found.coplanar, b.touches |= found.coplanar;
        b.depth += a.bounds.holds(b.bounds), a.depth += b.bounds.holds(a.bounds);
        auto& pairs = is_decided(a, b) ? decided : open;
        if (pairs.size() < kMostOverlaps) pairs.emplace_back(a.instance, b.instance);
        return true;
    });
    SolidRanks ranks;
    if (open.empty() && decided.empty()) return ranks;
    std::ranges::sort(nested, {}, &Nested::order);
    ranks.of_instance.resize(scene.instances.size());
    ranks.touches.resize(scene.instances.size());
    for (std::size_t i = 0; i < nested.size(); ++i) {
        if (nested[i].overlaps) ranks.of_instance[nested[i].instance] = std::uint32_t(i + 1);
        ranks.touches[nested[i].instance] = nested[i].touches;
        ranks.deepest = std::max(ranks.deepest, nested[i].depth + 1);
    }
    const auto of = [&](std::uint32_t instance) -> const Nested& {
        return nested[ranks.of_instance[instance] - 1];
    };
    for (const auto& pairs : {open, decided})
        for (const auto& [a, b] : pairs) ranks.overlaps.push_back(described(of(a), of(b)));
    return ranks;
}

}  // namespace dg
