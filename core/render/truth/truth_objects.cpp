#include "render/truth/truth_objects.h"

#include <algorithm>
#include <mutex>

#include "render/parallel.h"
#include "render/truth/truth_view.h"

namespace dg {
namespace {

constexpr int kLayers = 1024;  // limit of surfaces along a ray

/// Ray parameter behind a hit, offset by more than the rounding error of its position.
float past(const Ray& ray, float t) {
    const Vec3f o = ray.origin;
    return t + 4e-6f * (t + std::abs(o.x) + std::abs(o.y) + std::abs(o.z));
}

void hold(Silhouette& s, int x, int y) {
    if (s.whole++ == 0) {
        s.x0 = x, s.y0 = y, s.x1 = x + 1, s.y1 = y + 1;
        return;
    }
    s.x0 = std::min(s.x0, x), s.x1 = std::max(s.x1, x + 1);
    s.y0 = std::min(s.y0, y), s.y1 = std::max(s.y1, y + 1);
}

void join(Silhouette& all, const Silhouette& part) {
    if (part.whole == 0) return;
    if (all.whole == 0) {
        all = part;
        return;
    }
    all.visible += part.visible, all.whole += part.whole;
    all.x0 = std::min(all.x0, part.x0), all.x1 = std::max(all.x1, part.x1);
    all.y0 = std::min(all.y0, part.y0), all.y1 = std::max(all.y1, part.y1);
}

void hold(GroupOutline& outline, Vec2d px) {
    if (outline.empty) outline.low = outline.high = px;
    outline.empty = false;
    outline.low = {std::min(outline.low.x, px.x), std::min(outline.low.y, px.y)};
    outline.high = {std::max(outline.high.x, px.x), std::max(outline.high.y, px.y)};
}

void join(GroupOutline& all, const GroupOutline& part) {
    all.open |= part.open;
    if (part.empty) return;
    hold(all, part.low), hold(all, part.high);
}

/// The groups that a ray hits, front to back, each once.
void groups_along(const Scene& scene, Ray ray, Groups groups, std::vector<std::uint32_t>& met) {
    met.clear();
    for (int layer = 0; layer < kLayers; ++layer) {
        const auto hit = scene.first_hit(ray);
        if (!hit) return;
        const bool sphere = hit->instance == RawHit::kSphere;
        const std::uint32_t group = sphere ? kNoGroup : groups[hit->instance];
        // An instance without a group occludes, too. It is recorded only if it is the nearest hit.
        const bool counts = group != kNoGroup || met.empty();
        if (counts && std::ranges::find(met, group) == met.end()) met.push_back(group);
        ray.t_min = past(ray, hit->t);
    }
}

/// Outline of an instance on the film.
class InstanceOutline {
  public:
    InstanceOutline(const TruthView& view, std::uint32_t instance)
        : view_(view), instance_(instance), middle_(centre_of(view.settings().sensor)) {
        const SceneDescription& d = view.scene().description();
        mesh_ = &d.meshes[d.instances[instance].mesh];
        if (mesh_->empty() || !place(0, {0, 0}, view.time_at(middle_))) return;
        corners_.resize(mesh_->vertex_count());
        for (std::uint32_t i = 0; i < mesh_->triangles.size(); ++i) add_triangle(i);
        for (std::uint32_t i = 0; i < mesh_->curves.starts.size(); ++i) add_segment(i);
    }
    GroupOutline outline;

  private:
    static constexpr double kShort = 4;     // px: shorter edges are treated as straight
    static constexpr double kLong = 32;     // px: longer edges are always halved
    static constexpr double kStraight = 0.05;  // px
    static constexpr int kHalvings = 24;    // limit, for edges that leave the field of view
    static constexpr int kBlindHalvings = 5;
    static constexpr double kBlindAngle = 0.05;  // rad: shorter edges outside the field of view are skipped

    struct Corner {
        bool known = false;
        std::optional<Vec2d> px;
    };

    static Vec2d centre_of(const Sensor& s) { return {0.5 * s.width, 0.5 * s.height}; }

    std::optional<Vec3d> place(std::uint32_t triangle, Vec2d uv, float time) const {
        const RawHit hit{0, float(uv.x), float(uv.y), instance_, triangle};
        return view_.scene().follow(hit, {}, time);
    }

    std::optional<Vec2d> px_of(std::uint32_t triangle, Vec2d uv) const {
        const auto at = [&](float time) -> std::optional<Vec2d> {
            const auto point = place(triangle, uv, time);
            return point ? view_.px_of(*point, 1, time) : std::nullopt;
        };
        return view_.landing_of(at, middle_);
    }

    void add_triangle(std::uint32_t i) {
        constexpr std::array<Vec2d, 3> kCorners{Vec2d{0, 0}, Vec2d{1, 0}, Vec2d{0, 1}};
        std::array<std::optional<Vec2d>, 3> px;
        for (int k = 0; k < 3; ++k) {
            Corner& corner = corners_[mesh_->triangles[i][k]];
            if (!corner.known) corner = {true, note(px_of(i, kCorners[k]))};
            px[k] = corner.px;
        }
        for (int k = 0; k < 3; ++k) {
            const int n = (k + 1) % 3;
            add_edge(i, {kCorners[k], px[k]}, {kCorners[n], px[n]}, 0);
        }
    }

    /// Adds lines along a segment of a curve, in a number that depends on its thickness, and rings at its ends.
    void add_segment(std::uint32_t i) {
        const double first = mesh_->curves.cubic ? 0 : -1, last = mesh_->curves.cubic ? 1 : 2;
        const int lines = lines_along(i);
        for (int k = 0; k < lines; ++k) {
            const double v = double(k) / lines, next = double(k + 1) / lines;
            for (double u = first; u < last; ++u) add_line(i, {u, v}, {u + 1, v});
            for (const double u : {0.0, 1.0}) add_line(i, {u, v}, {u, next});
        }
    }

    /// Number of lines for which a polygon deviates by kStraight from a circle of this size on the film.
    int lines_along(std::uint32_t i) const {
        double radius = 0;
        for (const double u : {0.0, 1.0})
            for (const double v : {0.0, 0.25}) {
                const auto a = px_of(i, {u, v}), b = px_of(i, {u, v + 0.5});
                if (a && b) radius = std::max(radius, 0.5 * length(*a - *b));
            }
        return std::clamp(int(std::ceil(kPiD / std::sqrt(2 * kStraight / std::max(radius, 1e-3)))), 4, 128);
    }

    void add_line(std::uint32_t i, Vec2d from, Vec2d to) {
        const End a{from, note(px_of(i, from))}, b{to, note(px_of(i, to))};
        add_edge(i, a, b, 0);
    }

    std::optional<Vec2d> note(std::optional<Vec2d> px) {
        if (px)
            hold(outline, *px);
        else
            outline.open = true;
        return px;
    }

    struct End {
        Vec2d uv;
        std::optional<Vec2d> px;
    };

    void add_edge(std::uint32_t triangle, const End& a, const End& b, int halvings) {
        if (halvings == kHalvings || !may_reach_further(triangle, a, b, halvings)) return;
        End middle{(a.uv + b.uv) * 0.5, {}};
        middle.px = note(px_of(triangle, middle.uv));
        const bool seen = a.px && b.px && middle.px;
        const bool looked_at = halvings > 1 || (seen && length(*a.px - *b.px) < kLong);
        if (seen && looked_at && is_straight(*a.px, *middle.px, *b.px)) return;
        add_edge(triangle, a, middle, halvings + 1);
        add_edge(triangle, middle, b, halvings + 1);
    }

    bool may_reach_further(std::uint32_t triangle, const End& a, const End& b,
                           int halvings) const {
        if (a.px && b.px) return length(*a.px - *b.px) > kShort;
        if (a.px || b.px) return true;
        return halvings < kBlindHalvings && subtended(triangle, a.uv, b.uv) > kBlindAngle;
    }

    /// Angle that an edge subtends at the camera, rad.
    double subtended(std::uint32_t triangle, Vec2d a, Vec2d b) const {
        const float time = view_.time_at(middle_);
        const auto p = place(triangle, a, time), q = place(triangle, b, time);
        if (!p || !q) return 0;
        const Vec3d eye = view_.pose(time).origin;
        return length(normalize(*p - eye) - normalize(*q - eye));
    }

    static bool is_straight(Vec2d a, Vec2d middle, Vec2d b) {
        const Vec2d along = b - a, from = middle - a;
        const double size = length(along);
        return std::abs(along.x * from.y - along.y * from.x) < kStraight * size;
    }

    const TruthView& view_;
    std::uint32_t instance_;
    Vec2d middle_;
    const Mesh* mesh_;
    std::vector<Corner> corners_;
};

}  // namespace

std::vector<Silhouette> silhouettes(const TruthFrame& frame, const FilmLayout& region,
                                    const RenderSettings& settings, Groups groups,
                                    std::size_t count) {
    std::vector<Silhouette> all(count);
    std::mutex adding;
    const TruthView view(frame, settings);
    parallel_tasks(settings.threads, region.height, [&](std::int64_t row) {
        std::vector<Silhouette> found(count);
        std::vector<std::uint32_t> met;
        for (int x = 0; x < region.width; ++x) {
            const Vec2d px = centre(region, std::size_t(row) * region.width + x);
            const auto ray = view.ray(px);
            if (!ray) continue;
            groups_along(frame.scene, *ray, groups, met);
            for (std::size_t k = 0; k < met.size(); ++k) {
                if (met[k] == kNoGroup) continue;
                hold(found[met[k]], int(px.x), int(px.y));
                found[met[k]].visible += k == 0;
            }
        }
        const std::scoped_lock lock(adding);
        for (std::size_t i = 0; i < count; ++i) join(all[i], found[i]);
    });
    return all;
}

std::vector<GroupOutline> outlines(const TruthFrame& frame, const RenderSettings& settings,
                              Groups groups, std::size_t count) {
    std::vector<GroupOutline> of_instances(groups.size()), all(count);
    const TruthView view(frame, settings);
    parallel_tasks(settings.threads, std::int64_t(groups.size()), [&](std::int64_t i) {
        if (groups[i] != kNoGroup)
            of_instances[i] = InstanceOutline(view, std::uint32_t(i)).outline;
    });
    for (std::size_t i = 0; i < groups.size(); ++i)
        if (groups[i] != kNoGroup) join(all[groups[i]], of_instances[i]);
    return all;
}

}  // namespace dg
