// intersector.h -- interface of the ray tracer for the scene. The only implementation is
// embree.cpp; only the files embree* of this room include Embree (3.13 or 4).
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/crossings.h"
#include "geometry/mesh.h"
#include "geometry/ray.h"
#include "math/transform.h"
#include "motion/hull.h"
#include "motion/keyed.h"
#include "motion/motion.h"
#include "motion/shown.h"

namespace dg {

struct InstanceGeometry {
    std::uint32_t mesh;
    Affine3f world_from_local;
    bool cutout =
        false;  // textures may be transparent: the cutout function decides each hit
    Clear clear = Clear::no;  // whether shadow rays may pass and record crossings
    // Over the scene's interval (0 .. 1); both pointers must outlive the intersector.
    const Motion* motion = nullptr;  // replaces world_from_local; null: static
    const Shown* shown = nullptr;    // null: always visible
    bool catcher = false;            // also hit by rays with Ray::without_objects
    bool still() const { return !motion && !shown; }
};

/// Returns true if the surface is transparent at the hit (alpha). Must be thread-safe and a pure
/// function of its arguments, so that images do not depend on the order of traversal.
using CutoutFunction = std::function<bool(const Ray&, const RawHit&)>;

class Intersector {
  public:
    /// Builds the acceleration structures; meshes may be shared by instances. Meshes must be valid
    /// and must outlive the intersector unchanged, since their arrays are shared (positions are
    /// copied if they end at the end of a memory page, because Embree reads 16 bytes at the last
    /// vertex). Throws Error when memory runs out.
    static std::unique_ptr<Intersector> build(
        const std::vector<Mesh>& meshes, const std::vector<InstanceGeometry>& instances,
        std::vector<Keyed<Sphere>> spheres, CutoutFunction cutout);
    virtual ~Intersector() = default;
    /// A ray that is not is_traceable() misses, and counts as occluded.
    virtual std::optional<RawHit> intersect(const Ray& ray) const = 0;
    /// With `crossings`, the ray passes clear surfaces and records them.
    virtual bool occluded(const Ray& ray, Crossings* crossings = nullptr) const = 0;
    virtual const char* name() const = 0;  // "Embree 3.13.5"

    /// Whether hits on the instance are computed in world space, with vertices transformed once,
    /// instead of with a ray transformed to local space (see layout.h).
    virtual bool is_flattened(std::uint32_t instance) const = 0;

    /// World box of a moving instance over all times.
    virtual Box bounds_of_moving(std::uint32_t instance) const = 0;
};

}  // namespace dg
