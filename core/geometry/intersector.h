// intersector.h -- what the scene asks of a ray tracer. The only implementation is
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
        false;  // some texel may be transparent: the cutout function decides each hit
    Clear clear = Clear::no;  // shadow rays that collect crossings pass it
    // Over the scene's interval (0 .. 1); both outlive the intersector.
    const Motion* motion = nullptr;  // in the place of world_from_local; null: stands still
    const Shown* shown = nullptr;    // null: always
    bool catcher = false;            // met by rays of the set, too (Ray::of_set)
    bool still() const { return !motion && !shown; }
};

/// Returns true when the surface lets the ray pass there (alpha). Must be thread safe and
/// a pure function of its arguments, so that frames do not depend on the order of
/// traversal.
using CutoutFunction = std::function<bool(const Ray&, const RawHit&)>;

class Intersector {
  public:
    /// Builds the acceleration structures once; meshes may be shared by instances. The
    /// meshes must be valid, and outlive the intersector unchanged: their arrays are read
    /// in place (positions are copied in the rare case that they end with a page of
    /// memory, since Embree reads 16 bytes at the last vertex). Throws Error when memory
    /// runs out.
    static std::unique_ptr<Intersector> build(
        const std::vector<Mesh>& meshes, const std::vector<InstanceGeometry>& instances,
        std::vector<Keyed<Sphere>> spheres, CutoutFunction cutout);
    virtual ~Intersector() = default;
    /// A ray that is not is_traceable() meets nothing, and is occluded.
    virtual std::optional<RawHit> intersect(const Ray& ray) const = 0;
    /// With `crossings` the ray goes through clear surfaces and notes them there.
    virtual bool occluded(const Ray& ray, Crossings* crossings = nullptr) const = 0;
    virtual const char* name() const = 0;  // "Embree 3.13.5"

    /// True when hits on the instance are found in world space, against vertices that
    /// were transformed once, and not by a ray transformed into the space of the mesh
    /// (see layout.h).
    virtual bool is_flattened(std::uint32_t instance) const = 0;

    /// World box that holds an instance with a motion at all times.
    virtual Box bounds_of_moving(std::uint32_t instance) const = 0;
};

}  // namespace dg
