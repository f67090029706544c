// flare_guide.h -- which emitters light which ghosts, and through which part of the front lens: what ghosts are
// drawn by, found once for a picture.
//
// A flare path is a point of an emitter, a ghost, and a ray from the point to the front lens, which is aimed at
// a square across its way. Few pairs of source and ghost bring light to the frame, and each through a small
// part of the front. Both are learned from exact rays: how much light each pair brings, and from which cells of
// the front. A share of the paths is drawn without that knowledge, so that what the rays missed costs noise and
// no bias. Source: Pekkarinen and Balzer 2019, Physically Based Lens Flare Rendering in The Lego Movie 2,
// DigiPro (sampling of ghosts and front cells from traced rays).
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "light/flare_sources.h"
#include "math/distribution.h"
#include "render/render.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// A path from an emitter into the lens.
struct FlareArrival {
    CameraRay lens;           // camera frame; on the first surface
    int ghost = 0;
    Wavelengths wavelengths;
    Spectrum radiance{0.f};   // or what stands for it of lights without size
    double density = 0;       // of such paths, per m2 sr
    Vec2f at{};               // where it was aimed at, [-1, 1)^2
    FlarePoint from{};
};

/// From where it comes to where rays of the lens start; world.
Ray flare_shadow(const FlarePoint& from, const Ray& from_lens);

class FlareGuide {
  public:
    /// An exact lens; it and the scene outlive this. Of the settings: sensor, shutter, reach of the filter.
    FlareGuide(const Scene& scene, const Camera& camera, const RenderSettings& settings);

    /// Nothing shines, or nothing reflects: there is no flare.
    bool empty() const { return pairs_.empty(); }
    int ghosts() const { return int(mirrors_.size()); }

    /// From random numbers by purpose; nothing if the path cannot bring light.
    struct Random {
        float pair, select, lambda;
        Vec2f front, point;
        Moment moment;
    };
    std::optional<FlareArrival> draw(const Random& u) const;

    /// Which of the lens's states is in place at a time.
    std::size_t state_at(float time) const;
    /// All by one ghost through one state.
    void trace(std::size_t state, int ghost, std::span<const CameraRay> rays, std::span<const float> nm,
               std::span<Reprojection> out) const;

    /// Where on the frame a landing is, px; nothing outside of the filter's reach.
    std::optional<Vec2f> on_frame(const Reprojection& landing, float time) const;

  private:
    struct Rectangle {
        Vec2f low{-1, -1}, size{2, 2};
        Vec2f at(Vec2f u) const { return {low.x + size.x * u.x, low.y + size.y * u.y}; }
        Vec2f in(Vec2f p) const { return {(p.x - low.x) / size.x, (p.y - low.y) / size.y}; }
        float area() const { return size.x * size.y; }
        bool holds(Vec2f p) const {
            const Vec2f u = in(p);
            return u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1;
        }
    };
    /// Where light of a pair enters: cells of a rectangle of the square. A share of the paths goes to what was
    /// first thought to hold it, and to all of the square: the larger, the less is known.
    struct Cells {
        Rectangle inner, outer;
        Distribution2D weights;
        float blind = 1;
        Vec2f sample(Vec2f u) const;
        double pdf(Vec2f at) const;   // per unit of the square
    };
    struct State {
        ExactLens lens;
        GhostLens ghosts;
        std::vector<std::vector<GhostStep>> steps;
    };
    struct Probe;
    struct Found;

    void add_state(const Camera& camera, const ExactLens& lens);
    std::vector<ViewCone> views() const;
    double visible_share(int source) const;
    std::optional<FlareArrival> aimed(int source, int ghost, Vec2f at, double pdf, const Random& u) const;
    Found probe(const Probe& probe) const;
    void learn();
    void refine(const std::vector<Found>& found);
    void pool(std::vector<double>& weights) const;
    static Rectangle narrowed(const Rectangle& old, const Found& found);
    Cells cells_of(const Probe& wide, const Found& found, Found& fine) const;
    std::vector<double> blind() const;

    const Scene& scene_;
    const Camera& camera_;
    Sensor sensor_;
    Shutter shutter_;
    float reach_;                  // px
    int threads_;
    std::vector<float> times_;     // of the states; empty: one
    std::vector<State> states_;
    std::vector<Mirrors> mirrors_;
    Vec3d center_{};               // camera frame, m: of the front
    double radius_ = 0;
    FlareSources sources_;
    DiscreteDistribution pairs_;   // source x ghosts + ghost
    std::vector<int> cells_of_pair_;   // -1: evenly
    std::vector<Cells> cells_;
};

}  // namespace dg
