// embree_api.h -- common names for Embree 3.13 and 4: single rays, query contexts, and owners of
// handles. Only for the files embree*.cpp of this room.
#pragma once
#include <cmath>
#include <memory>
#include <type_traits>

#include "geometry/crossings.h"
#include "geometry/ray.h"
#include "math/forks.h"
#include "math/transform.h"

#if DG_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace dg::embree {

#if DG_EMBREE_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
inline void init_context(QueryContext& c) {
    rtcInitRayQueryContext(&c);
}
inline void query(RTCScene scene, QueryContext& context, RTCRayHit& ray_hit) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect1(scene, &ray_hit, &arguments);
}
inline void query(RTCScene scene, QueryContext& context, RTCRay& ray) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    rtcOccluded1(scene, &ray, &arguments);
}
#else
using QueryContext = RTCIntersectContext;
inline void init_context(QueryContext& c) {
    rtcInitIntersectContext(&c);
}
inline void query(RTCScene scene, QueryContext& context, RTCRayHit& ray_hit) {
    rtcIntersect1(scene, &context, &ray_hit);
}
inline void query(RTCScene scene, QueryContext& context, RTCRay& ray) {
    rtcOccluded1(scene, &context, &ray);
}
#endif

/// Embree passes its context to filters; the world-space ray follows it in memory, because inside
/// an instance the filter receives the transformed ray.
struct Context {
    QueryContext embree;
    const Ray* ray;
    Crossings* crossings = nullptr;
};

/// Owners of Embree's handles. After a fork that tore threads off (forks.h), handles leak, since
/// releasing them takes locks.
struct ReleaseDevice {
    void operator()(RTCDevice d) const {
        if (!forks::torn) rtcReleaseDevice(d);
    }
};
struct ReleaseScene {
    void operator()(RTCScene s) const {
        if (!forks::torn) rtcReleaseScene(s);
    }
};
struct ReleaseGeometry {
    void operator()(RTCGeometry g) const {
        if (!forks::torn) rtcReleaseGeometry(g);
    }
};
using DeviceOwner = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using SceneOwner = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;
using GeometryOwner =
    std::unique_ptr<std::remove_pointer_t<RTCGeometry>, ReleaseGeometry>;

}  // namespace dg::embree
