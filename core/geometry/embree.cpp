// embree.cpp -- ray tracing by Embree, 3.13 or 4: the only file that includes it.
//
// One top-level scene. Geometry `i` in it is instance `i`, either as triangles in world
// space (flattened) or as a user geometry that traces the mesh's own scene; geometry
// `instances.size()` holds the sphere lights. So Embree's ids are ours, and no table
// stands between them.
//
// User geometries and not Embree's own instances, because those take the box of the
// transformed box of the mesh, up to three times the surface of the true one for a turned
// ball: rays enter many instances for nothing.
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <tuple>

#include "geometry/intersector.h"
#include "geometry/layout.h"
#include "math/error.h"

#if DG_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace dg {
namespace {

#if DG_EMBREE_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
void init_context(QueryContext& c) {
    rtcInitRayQueryContext(&c);
}
void query(RTCScene scene, QueryContext& context, RTCRayHit& ray_hit) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect1(scene, &ray_hit, &arguments);
}
void query(RTCScene scene, QueryContext& context, RTCRay& ray) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    rtcOccluded1(scene, &ray, &arguments);
}
#else
using QueryContext = RTCIntersectContext;
void init_context(QueryContext& c) {
    rtcInitIntersectContext(&c);
}
void query(RTCScene scene, QueryContext& context, RTCRayHit& ray_hit) {
    rtcIntersect1(scene, &context, &ray_hit);
}
void query(RTCScene scene, QueryContext& context, RTCRay& ray) {
    rtcOccluded1(scene, &context, &ray);
}
#endif

/// Embree hands its context to the filter; the world-space ray travels behind it, because
/// inside an instance the filter sees the transformed one.
struct Context {
    QueryContext embree;
    const Ray* ray;
    Crossings* crossings = nullptr;
};

struct WorldBounds {
    Vec3f min, max;
    Vec3f center;           // of the sphere around the middle of the box
    float radius_squared;

    /// Whether the ray (unit direction) comes near the sphere: most rays that enter the box of a
    /// roundish thing pass it by, and a question to Embree costs ten times this one.
    bool near(const RTCRay& ray) const {
        const Vec3f d{ray.dir_x, ray.dir_y, ray.dir_z};
        const Vec3f to = center - Vec3f{ray.org_x, ray.org_y, ray.org_z};
        const Vec3f aside = to - d * dot(to, d);
        return length_squared(aside) <= radius_squared;
    }
};

/// Box and sphere of the transformed vertices, grown by the rounding of the two transforms.
WorldBounds world_bounds(const Mesh& mesh, const Affine3f& world_from_local) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    WorldBounds b{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}, {}, 0};
    float largest = 0;
    for (const Vec3f& p : mesh.positions) {
        const Vec3f q = world_from_local.point(p);
        for (int k = 0; k < 3; ++k) {
            b.min[k] = std::min(b.min[k], q[k]);
            b.max[k] = std::max(b.max[k], q[k]);
            largest = std::max(largest, std::abs(q[k]));
        }
    }
    const float slack = 16 * 0x1p-24f * largest;
    const Vec3f grow{slack, slack, slack};
    b.min = b.min - grow;
    b.max = b.max + grow;
    b.center = (b.min + b.max) * 0.5f;
    for (const Vec3f& p : mesh.positions) {
        const float r2 = length_squared(world_from_local.point(p) - b.center);
        b.radius_squared = std::max(b.radius_squared, r2);
    }
    const float radius = 1.0001f * std::sqrt(b.radius_squared) + 4 * slack;
    b.radius_squared = radius * radius;
    return b;
}

/// A mesh in its place; what the callbacks of a user geometry see.
struct PlacedMesh {
    RTCScene scene;             // of the mesh, in its own space
    std::uint32_t id;           // of the instance
    Affine3f local_from_world;
    WorldBounds bounds;

    RTCRay to_local(const RTCRay& ray) const {
        const Vec3f o = local_from_world.point({ray.org_x, ray.org_y, ray.org_z});
        const Vec3f d = local_from_world.vector({ray.dir_x, ray.dir_y, ray.dir_z});
        RTCRay local = ray;     // t is the same in both spaces, as d is not normalised
        local.org_x = o.x, local.org_y = o.y, local.org_z = o.z;
        local.dir_x = d.x, local.dir_y = d.y, local.dir_z = d.z;
        return local;
    }
    /// The context of a query inside, which tells hits and filters the instance.
    Context inside(const void* outer) const {
        Context context;
        init_context(context.embree);
        context.embree.instID[0] = id;
        context.ray = static_cast<const Context*>(outer)->ray;
        context.crossings = static_cast<const Context*>(outer)->crossings;
        return context;
    }
};

// Only single rays are traced, so N is 1 and the packets are plain structures.
void bounds_of_placed(const RTCBoundsFunctionArguments* a) {
    const WorldBounds& b = static_cast<const PlacedMesh*>(a->geometryUserPtr)->bounds;
    RTCBounds& out = *a->bounds_o;
    out.lower_x = b.min.x, out.lower_y = b.min.y, out.lower_z = b.min.z;
    out.upper_x = b.max.x, out.upper_y = b.max.y, out.upper_z = b.max.z;
}

void intersect_placed(const RTCIntersectFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    const auto& placed = *static_cast<const PlacedMesh*>(a->geometryUserPtr);
    auto& world = *reinterpret_cast<RTCRayHit*>(a->rayhit);
    if (!placed.bounds.near(world.ray)) return;
    Context context = placed.inside(a->context);
    RTCRayHit local;
    local.ray = placed.to_local(world.ray);
    local.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query(placed.scene, context.embree, local);
    if (local.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
    world.ray.tfar = local.ray.tfar;
    world.hit = local.hit;
    world.hit.instID[0] = placed.id;
}

void occlude_placed(const RTCOccludedFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    const auto& placed = *static_cast<const PlacedMesh*>(a->geometryUserPtr);
    auto& world = *reinterpret_cast<RTCRay*>(a->ray);
    if (!placed.bounds.near(world)) return;
    Context context = placed.inside(a->context);
    RTCRay local = placed.to_local(world);
    query(placed.scene, context.embree, local);
    if (local.tfar < 0) world.tfar = local.tfar;
}

/// Owners of Embree's handles.
struct ReleaseDevice {
    void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
};
struct ReleaseScene {
    void operator()(RTCScene s) const { rtcReleaseScene(s); }
};
struct ReleaseGeometry {
    void operator()(RTCGeometry g) const { rtcReleaseGeometry(g); }
};
using DeviceOwner = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using SceneOwner = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;
using GeometryOwner =
    std::unique_ptr<std::remove_pointer_t<RTCGeometry>, ReleaseGeometry>;

/// Errors come by callback, from any thread; the first one is kept and thrown by check().
class Device {
  public:
    Device() : handle_(rtcNewDevice(nullptr)) {
        if (!handle_) {
            throw Error("Embree: no device: error " +
                        std::to_string(rtcGetDeviceError(nullptr)) +
                        " (the CPU or the installation of Embree is not supported)");
        }
        rtcSetDeviceErrorFunction(handle_.get(), &Device::on_error, this);
    }
    RTCDevice get() const { return handle_.get(); }

    void check(const std::string& what) {
        const std::lock_guard lock(mutex_);
        if (code_ == RTC_ERROR_NONE) return;
        if (code_ == RTC_ERROR_OUT_OF_MEMORY) throw Error(what + ": out of memory");
        throw Error(what + ": Embree error " + std::to_string(code_) + ": " + message_);
    }

  private:
    static void on_error(void* self, RTCError code, const char* message) {
        Device& device = *static_cast<Device*>(self);
        const std::lock_guard lock(device.mutex_);
        if (device.code_ != RTC_ERROR_NONE) return;
        device.code_ = code;
        device.message_ = message ? message : "";
    }

    DeviceOwner handle_;
    std::mutex mutex_;
    RTCError code_ = RTC_ERROR_NONE;
    std::string message_;
};

class EmbreeIntersector final : public Intersector {
  public:
    EmbreeIntersector(const std::vector<Mesh>& meshes,
                      const std::vector<InstanceGeometry>& instances,
                      const std::vector<Sphere>& spheres, CutoutFunction cutout);

    std::optional<RawHit> intersect(const Ray& ray) const override;
    bool occluded(const Ray& ray, Crossings* crossings) const override;
    const char* name() const override { return name_.c_str(); }
    bool is_flattened(std::uint32_t instance) const override {
        return flattened_[instance];
    }

  private:
    SceneOwner new_scene(std::size_t triangles);
    GeometryOwner triangles_of(const Mesh& mesh);
    void set_positions(RTCGeometry geometry, const Mesh& mesh);
    void set_world_positions(RTCGeometry geometry, const Mesh& mesh,
                             const Affine3f& transform);
    void set_filters(RTCGeometry geometry, const InstanceGeometry& instance);
    void attach(RTCScene scene, GeometryOwner geometry, unsigned id);
    void attach_instance(unsigned id, const InstanceGeometry& instance, const Mesh& mesh);
    void attach_spheres(const std::vector<Sphere>& spheres);
    RTCScene mesh_scene(const InstanceGeometry& instance, const Mesh& mesh);
    RawHit raw_hit(float t, const RTCHit& hit) const;
    static void filter(const RTCFilterFunctionNArguments* arguments);
    static void filter_shadow(const RTCFilterFunctionNArguments* arguments);

    Device device_;
    CutoutFunction cutout_;
    std::vector<bool> flattened_, has_cutout_;
    std::vector<Clear> clear_;
    std::deque<PlacedMesh> placed_;  // by address: Embree keeps pointers
    std::map<std::tuple<std::uint32_t, bool, bool>, SceneOwner>
        mesh_scenes_;  // by mesh, and whether it is cut out, and clear
    SceneOwner top_;
    unsigned sphere_geometry_;
    std::string name_;
};

// Robust traversal: without it one ray in 10^7 leaks through an edge of a closed mesh,
// and one in 20 to 1000 of those aimed at an edge (measured; with it none of 4 * 10^7).
// It costs 12 to 15 % of traversal.
constexpr RTCSceneFlags kSceneFlags = RTC_SCENE_FLAG_ROBUST;
// High quality (spatial splits) traced no faster in robust mode.
constexpr RTCBuildQuality kBuildQuality = RTC_BUILD_QUALITY_MEDIUM;

std::string version_name(RTCDevice device) {
    auto property = [&](RTCDeviceProperty p) {
        return std::to_string(rtcGetDeviceProperty(device, p));
    };
    return "Embree " + property(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." +
           property(RTC_DEVICE_PROPERTY_VERSION_MINOR) + "." +
           property(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

EmbreeIntersector::EmbreeIntersector(const std::vector<Mesh>& meshes,
                                     const std::vector<InstanceGeometry>& instances,
                                     const std::vector<Sphere>& spheres,
                                     CutoutFunction cutout)
    : cutout_(std::move(cutout)),
      flattened_(choose_flattened(meshes, instances)),
      top_(new_scene(count_flattened(meshes, instances, flattened_))),
      sphere_geometry_(static_cast<unsigned>(instances.size())),
      name_(version_name(device_.get())) {
    for (unsigned i = 0; i < instances.size(); ++i) {
        const Mesh& mesh = meshes[instances[i].mesh];
        has_cutout_.push_back(instances[i].cutout);
        clear_.push_back(instances[i].clear);
        if (!mesh.triangles.empty()) attach_instance(i, instances[i], mesh);
    }
    if (!spheres.empty()) attach_spheres(spheres);
    rtcCommitScene(top_.get());
    device_.check("building the acceleration structure of the scene");
}

SceneOwner EmbreeIntersector::new_scene(std::size_t triangles) {
    SceneOwner scene(rtcNewScene(device_.get()));
    device_.check("creating an acceleration structure");
    const int compact = triangles > kCompactLimit ? RTC_SCENE_FLAG_COMPACT : 0;
    rtcSetSceneFlags(scene.get(), RTCSceneFlags(kSceneFlags | compact));
    rtcSetSceneBuildQuality(scene.get(), kBuildQuality);
    return scene;
}

GeometryOwner EmbreeIntersector::triangles_of(const Mesh& mesh) {
    GeometryOwner geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    device_.check("mesh '" + mesh.name + "'");
    rtcSetGeometryBuildQuality(geometry.get(), kBuildQuality);
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.triangles.data(), 0, sizeof(mesh.triangles[0]),
                               mesh.triangles.size());
    return geometry;
}

/// Whether the bytes behind an array can be read: memory comes in pages (of 4096 bytes or a
/// multiple), and a page that holds the end of an array is readable as a whole.
bool readable_behind(const void* end, std::size_t bytes) {
    constexpr std::uintptr_t kPage = 4096;
    const std::uintptr_t used = reinterpret_cast<std::uintptr_t>(end) % kPage;
    return used != 0 && used + bytes <= kPage;
}

void EmbreeIntersector::set_positions(RTCGeometry geometry, const Mesh& mesh) {
    const SharedArray<Vec3f>& p = mesh.positions;
    if (readable_behind(p.end(), 4)) {  // 16 bytes are read at the last vertex
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   p.data(), 0, sizeof(Vec3f), p.size());
        return;
    }
    void* copy = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                         RTC_FORMAT_FLOAT3, sizeof(Vec3f), p.size());
    device_.check("vertices of mesh '" + mesh.name + "'");
    std::memcpy(copy, p.data(), p.size() * sizeof(Vec3f));
}

void EmbreeIntersector::set_world_positions(RTCGeometry geometry, const Mesh& mesh,
                                            const Affine3f& transform) {
    if (is_identity(transform)) return set_positions(geometry, mesh);
    void* copy =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Vec3f), mesh.positions.size());
    device_.check("vertices of mesh '" + mesh.name + "'");
    auto* world = static_cast<Vec3f*>(copy);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        world[i] = transform.point(mesh.positions[i]);
    }
}

void EmbreeIntersector::set_filters(RTCGeometry geometry,
                                    const InstanceGeometry& instance) {
    rtcSetGeometryUserData(geometry, this);
    if (instance.cutout)
        rtcSetGeometryIntersectFilterFunction(geometry, &EmbreeIntersector::filter);
    if (instance.cutout || instance.clear != Clear::no)
        rtcSetGeometryOccludedFilterFunction(geometry, &EmbreeIntersector::filter_shadow);
}

void EmbreeIntersector::attach(RTCScene scene, GeometryOwner geometry, unsigned id) {
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene, geometry.get(),
                          id);  // the scene keeps a reference of its own
}

RTCScene EmbreeIntersector::mesh_scene(const InstanceGeometry& instance,
                                       const Mesh& mesh) {
    SceneOwner& scene =
        mesh_scenes_[{instance.mesh, instance.cutout, instance.clear != Clear::no}];
    if (scene) return scene.get();
    scene = new_scene(mesh.triangles.size());
    GeometryOwner geometry = triangles_of(mesh);
    set_positions(geometry.get(), mesh);
    set_filters(geometry.get(), instance);
    attach(scene.get(), std::move(geometry), 0);
    rtcCommitScene(scene.get());
    device_.check("building the acceleration structure of mesh '" + mesh.name + "'");
    return scene.get();
}

void EmbreeIntersector::attach_instance(unsigned id, const InstanceGeometry& instance,
                                        const Mesh& mesh) {
    if (flattened_[id]) {
        GeometryOwner geometry = triangles_of(mesh);
        set_world_positions(geometry.get(), mesh, instance.world_from_local);
        set_filters(geometry.get(), instance);
        attach(top_.get(), std::move(geometry), id);
        return;
    }
    GeometryOwner geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
    device_.check("instance of mesh '" + mesh.name + "'");
    const Affine3f local = to_float(inverse(to_double(instance.world_from_local)));
    placed_.push_back({mesh_scene(instance, mesh), id, local,
                       world_bounds(mesh, instance.world_from_local)});
    rtcSetGeometryUserPrimitiveCount(geometry.get(), 1);
    rtcSetGeometryUserData(geometry.get(), &placed_.back());
    rtcSetGeometryBoundsFunction(geometry.get(), &bounds_of_placed, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), &intersect_placed);
    rtcSetGeometryOccludedFunction(geometry.get(), &occlude_placed);
    attach(top_.get(), std::move(geometry), id);
}

void EmbreeIntersector::attach_spheres(const std::vector<Sphere>& spheres) {
    static_assert(sizeof(Sphere) == 16, "read in place as x, y, z, radius");
    GeometryOwner geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT));
    device_.check("sphere lights");
    void* copy =
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                RTC_FORMAT_FLOAT4, sizeof(Sphere), spheres.size());
    device_.check("sphere lights");
    std::memcpy(copy, spheres.data(), spheres.size() * sizeof(Sphere));
    attach(top_.get(), std::move(geometry), sphere_geometry_);
}

RawHit EmbreeIntersector::raw_hit(float t, const RTCHit& hit) const {
    RawHit result{t, hit.u, hit.v, hit.instID[0], hit.primID};
    if (hit.instID[0] == RTC_INVALID_GEOMETRY_ID) {
        result.instance = hit.geomID == sphere_geometry_ ? RawHit::kSphere : hit.geomID;
    }
    return result;
}

void EmbreeIntersector::filter(const RTCFilterFunctionNArguments* arguments) {
    if (arguments->valid[0] == 0) return;
    const auto& self = *static_cast<const EmbreeIntersector*>(arguments->geometryUserPtr);
    const auto& context = *reinterpret_cast<const Context*>(arguments->context);
    // Only single rays are traced, so N is 1 and the packets are plain structures.
    const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
    const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
    if (self.cutout_(*context.ray, self.raw_hit(ray.tfar, hit))) arguments->valid[0] = 0;
}

/// Any hit will do for a shadow, so what may be passed is passed here.
void EmbreeIntersector::filter_shadow(const RTCFilterFunctionNArguments* arguments) {
    if (arguments->valid[0] == 0) return;
    const auto& self = *static_cast<const EmbreeIntersector*>(arguments->geometryUserPtr);
    const auto& context = *reinterpret_cast<const Context*>(arguments->context);
    const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
    const RawHit hit =
        self.raw_hit(ray.tfar, *reinterpret_cast<const RTCHit*>(arguments->hit));
    const bool passed =
        (self.has_cutout_[hit.instance] && self.cutout_(*context.ray, hit)) ||
        (context.crossings && context.crossings->add(self.clear_[hit.instance], hit));
    if (passed) arguments->valid[0] = 0;
}

RTCRay embree_ray(const Ray& ray) {
    return {ray.origin.x,
            ray.origin.y,
            ray.origin.z,
            ray.t_min,
            ray.direction.x,
            ray.direction.y,
            ray.direction.z,
            0,
            ray.t_max,
            0xffffffffu,
            0,
            0};
}

std::optional<RawHit> EmbreeIntersector::intersect(const Ray& ray) const {
    Context context;
    init_context(context.embree);
    context.ray = &ray;
    RTCRayHit ray_hit;
    ray_hit.ray = embree_ray(ray);
    ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray_hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query(top_.get(), context.embree, ray_hit);
    if (ray_hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return raw_hit(ray_hit.ray.tfar, ray_hit.hit);
}

bool EmbreeIntersector::occluded(const Ray& ray, Crossings* crossings) const {
    Context context;
    init_context(context.embree);
    context.ray = &ray;
    context.crossings = crossings;
    RTCRay shadow_ray = embree_ray(ray);
    query(top_.get(), context.embree, shadow_ray);
    return shadow_ray.tfar < 0;  // Embree's sign for "something was met"
}

}  // namespace

std::unique_ptr<Intersector> Intersector::build(
    const std::vector<Mesh>& meshes, const std::vector<InstanceGeometry>& instances,
    const std::vector<Sphere>& spheres, CutoutFunction cutout) {
    return std::make_unique<EmbreeIntersector>(meshes, instances, spheres,
                                               std::move(cutout));
}

}  // namespace dg
