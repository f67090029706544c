// embree.cpp -- ray tracing by Embree: scene, filters, and both queries. Only this file and
// embree_*.cpp include Embree.
//
// A single top-level scene. Geometry `i` is instance `i`: either triangles in world space
// (flattened), or a user geometry that traces the mesh's scene (always for curves). Geometry
// `instances.size()` holds the sphere lights. Embree's ids are thus our indices, without a table.
// With shadow catchers, a second scene holds only them and the lights, under the same ids.
#include <cstring>
#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <span>
#include <tuple>

#include "geometry/embree_moving.h"
#include "geometry/embree_placed.h"
#include "geometry/embree_rounds.h"
#include "geometry/embree_spheres.h"
#include "geometry/embree_triangles.h"
#include "geometry/intersector.h"
#include "geometry/layout.h"

namespace dg::embree {
namespace {

class EmbreeIntersector final : public Intersector {
  public:
    EmbreeIntersector(const std::vector<Mesh>& meshes,
                      const std::vector<InstanceGeometry>& instances,
                      std::vector<Keyed<Sphere>> spheres, CutoutFunction cutout);

    std::optional<RawHit> intersect(const Ray& ray) const override;
    bool occluded(const Ray& ray, Crossings* crossings) const override;
    const char* name() const override { return name_.c_str(); }
    bool is_flattened(std::uint32_t instance) const override {
        return flattened_[instance];
    }
    Box bounds_of_moving(std::uint32_t instance) const override {
        return std::ranges::lower_bound(moving_, instance, {}, &MovingMesh::id)->box();
    }

  private:
    SceneOwner new_scene(std::size_t triangles);
    static bool has_shadow_filter(const InstanceGeometry& instance) {
        return instance.cutout || instance.clear != Clear::no;
    }
    void set_filters(RTCGeometry geometry, const InstanceGeometry& instance);
    void attach(RTCScene scene, GeometryOwner geometry, unsigned id);
    void attach_to_top(GeometryOwner geometry, unsigned id, bool is_catcher);
    RTCScene top_of(const Ray& ray) const { return ray.without_objects && catchers_ ? catchers_.get() : top_.get(); }
    void attach_instance(unsigned id, const InstanceGeometry& instance, const Mesh& mesh);
    RTCScene mesh_scene(const InstanceGeometry& instance, const Mesh& mesh);
    void attach_curves(RTCScene scene, const InstanceGeometry& instance, const Mesh& mesh);
    const TracedCurves* curves_of(const InstanceGeometry& instance) const {
        const auto found = curves_.find(instance.mesh);
        return found == curves_.end() ? nullptr : &found->second;
    }
    const Hull& hull_of(std::uint32_t index, const Mesh& mesh);
    RawHit raw_hit(float t, const RTCHit& hit) const;
    RawHit raw_hit_inside(const RTCFilterFunctionNArguments* arguments) const;
    static void filter(const RTCFilterFunctionNArguments* arguments);
    static void filter_shadow(const RTCFilterFunctionNArguments* arguments);

    Device device_;
    CutoutFunction cutout_;
    std::vector<Keyed<Sphere>> spheres_;  // Embree may keep a pointer
    std::vector<bool> flattened_, has_cutout_;
    std::vector<Clear> clear_;
    std::deque<PlacedMesh> placed_;  // deques have stable addresses: Embree keeps pointers
    std::deque<MovingMesh> moving_;
    std::deque<RoundSegments> rounds_;
    std::map<std::tuple<std::uint32_t, bool, bool>, SceneOwner>
        mesh_scenes_;  // by mesh, cutout and clearness
    std::map<std::uint32_t, TracedCurves> curves_;  // by mesh
    std::vector<const TracedCurves*> traced_;       // by instance; null: triangles
    std::map<std::uint32_t, Hull> hulls_;  // of moving meshes; during build only
    SceneOwner top_;
    SceneOwner catchers_;   // for Ray::without_objects; null: there are no catchers
    unsigned sphere_geometry_;
    std::string name_;
};

// Robust traversal. Otherwise one ray in 10^7 leaks through an edge of a closed mesh, and one in 20
// to 1000 of the rays aimed at an edge (measured; with it, none of 4 * 10^7). It costs 12 to 15 %
// of traversal time.
constexpr RTCSceneFlags kSceneFlags = RTC_SCENE_FLAG_ROBUST;

EmbreeIntersector::EmbreeIntersector(const std::vector<Mesh>& meshes,
                                     const std::vector<InstanceGeometry>& instances,
                                     std::vector<Keyed<Sphere>> spheres,
                                     CutoutFunction cutout)
    : cutout_(std::move(cutout)),
      spheres_(std::move(spheres)),
      flattened_(choose_flattened(meshes, instances)),
      top_(new_scene(count_flattened(meshes, instances, flattened_))),
      sphere_geometry_(static_cast<unsigned>(instances.size())),
      name_(device_.version()) {
    if (std::ranges::any_of(instances, &InstanceGeometry::catcher)) catchers_ = new_scene(0);
    for (const InstanceGeometry& i : instances)
        if (const Mesh& mesh = meshes[i.mesh]; !mesh.curves.empty()) curves_.try_emplace(i.mesh, mesh);
    for (unsigned i = 0; i < instances.size(); ++i) {
        const Mesh& mesh = meshes[instances[i].mesh];
        has_cutout_.push_back(instances[i].cutout);
        clear_.push_back(instances[i].clear);
        traced_.push_back(curves_of(instances[i]));
        if (!mesh.empty()) attach_instance(i, instances[i], mesh);
    }
    if (!spheres_.empty())
        attach_to_top(geometry_of_spheres(device_, spheres_), sphere_geometry_, true);
    hulls_.clear();
    rtcCommitScene(top_.get());
    if (catchers_) rtcCommitScene(catchers_.get());
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

void EmbreeIntersector::set_filters(RTCGeometry geometry,
                                    const InstanceGeometry& instance) {
    rtcSetGeometryUserData(geometry, this);
    if (instance.cutout)
        rtcSetGeometryIntersectFilterFunction(geometry, &EmbreeIntersector::filter);
    if (has_shadow_filter(instance))
        rtcSetGeometryOccludedFilterFunction(geometry, &EmbreeIntersector::filter_shadow);
}

void EmbreeIntersector::attach(RTCScene scene, GeometryOwner geometry, unsigned id) {
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene, geometry.get(),
                          id);  // the scene keeps a reference
}

void EmbreeIntersector::attach_to_top(GeometryOwner geometry, unsigned id, bool is_catcher) {
    if (catchers_ && is_catcher) rtcAttachGeometryByID(catchers_.get(), geometry.get(), id);
    attach(top_.get(), std::move(geometry), id);
}

RTCScene EmbreeIntersector::mesh_scene(const InstanceGeometry& instance,
                                       const Mesh& mesh) {
    SceneOwner& scene =
        mesh_scenes_[{instance.mesh, instance.cutout, instance.clear != Clear::no}];
    if (scene) return scene.get();
    scene = new_scene(mesh.triangles.size());
    if (mesh.curves.empty()) {
        GeometryOwner geometry = triangles_of(device_, mesh);
        set_filters(geometry.get(), instance);
        attach(scene.get(), std::move(geometry), 0);
    } else {
        attach_curves(scene.get(), instance, mesh);
    }
    rtcCommitScene(scene.get());
    device_.check("building the acceleration structure of mesh '" + mesh.name + "'");
    return scene.get();
}

void EmbreeIntersector::attach_curves(RTCScene scene, const InstanceGeometry& instance,
                                      const Mesh& mesh) {
    TracedCurves& curves = curves_.at(instance.mesh);
    if (!curves.cubic()) {
        RoundSegments& rounds = rounds_.emplace_back(RoundSegments{&mesh, this});
        if (instance.cutout) rounds.on_hit = &EmbreeIntersector::filter;
        if (has_shadow_filter(instance)) rounds.on_shadow = &EmbreeIntersector::filter_shadow;
        attach(scene, geometry_of(device_, rounds), 0);
        return;
    }
    unsigned id = 0;
    for (GeometryOwner& geometry : std::array{curves.segments(device_), curves.caps(device_)}) {
        if (!geometry) continue;
        set_filters(geometry.get(), instance);
        attach(scene, std::move(geometry), id++);
    }
}

const Hull& EmbreeIntersector::hull_of(std::uint32_t index, const Mesh& mesh) {
    const auto known = hulls_.find(index);
    if (known != hulls_.end()) return known->second;
    const Hull hull(std::span(mesh.positions.begin(), mesh.positions.end()));
    const float around = mesh.curves.largest_radius();
    return hulls_.try_emplace(index, around > 0 ? hull.grown(around) : hull).first->second;
}

void EmbreeIntersector::attach_instance(unsigned id, const InstanceGeometry& instance,
                                        const Mesh& mesh) {
    if (flattened_[id]) {
        GeometryOwner geometry =
            world_triangles_of(device_, mesh, instance.world_from_local);
        set_filters(geometry.get(), instance);
        attach_to_top(std::move(geometry), id, instance.catcher);
        return;
    }
    RTCScene local_scene = mesh_scene(instance, mesh);
    if (!instance.still()) {
        moving_.emplace_back(local_scene, id, hull_of(instance.mesh, mesh), instance);
        moving_.back().curves = traced_[id];
        attach_to_top(geometry_of(device_, moving_.back()), id, instance.catcher);
        return;
    }
    const Affine3f local = to_float(inverse(to_double(instance.world_from_local)));
    placed_.push_back({local_scene, id, local,
                       world_bounds(mesh, instance.world_from_local), traced_[id]});
    attach_to_top(geometry_of(device_, placed_.back()), id, instance.catcher);
}

RawHit EmbreeIntersector::raw_hit(float t, const RTCHit& hit) const {
    RawHit result{t, hit.u, hit.v, hit.instID[0], hit.primID};
    if (hit.instID[0] == RTC_INVALID_GEOMETRY_ID) {
        result.instance = hit.geomID == sphere_geometry_ ? RawHit::kSphere : hit.geomID;
    }
    return result;
}

/// Only single rays are traced, so N is 1 and the packets are plain structures.
RawHit EmbreeIntersector::raw_hit_inside(const RTCFilterFunctionNArguments* arguments) const {
    const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
    RTCHit hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
    const std::uint32_t instance = hit.instID[0];
    if (instance != RTC_INVALID_GEOMETRY_ID && traced_[instance]) traced_[instance]->set_place(ray, hit);
    return raw_hit(ray.tfar, hit);
}

void EmbreeIntersector::filter(const RTCFilterFunctionNArguments* arguments) {
    if (arguments->valid[0] == 0) return;
    const auto& self = *static_cast<const EmbreeIntersector*>(arguments->geometryUserPtr);
    const auto& context = *reinterpret_cast<const Context*>(arguments->context);
    if (self.cutout_(*context.ray, self.raw_hit_inside(arguments))) arguments->valid[0] = 0;
}

/// Any hit ends a shadow ray, so the filter decides which surfaces it passes.
void EmbreeIntersector::filter_shadow(const RTCFilterFunctionNArguments* arguments) {
    if (arguments->valid[0] == 0) return;
    const auto& self = *static_cast<const EmbreeIntersector*>(arguments->geometryUserPtr);
    const auto& context = *reinterpret_cast<const Context*>(arguments->context);
    const RawHit hit = self.raw_hit_inside(arguments);
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
            ray.time,
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
    if (!is_traceable(ray_hit.ray)) return std::nullopt;
    ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray_hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query(top_of(ray), context.embree, ray_hit);
    if (ray_hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return raw_hit(ray_hit.ray.tfar, ray_hit.hit);
}

bool EmbreeIntersector::occluded(const Ray& ray, Crossings* crossings) const {
    Context context;
    init_context(context.embree);
    context.ray = &ray;
    context.crossings = crossings;
    RTCRay shadow_ray = embree_ray(ray);
    // Lamps so far away that rays to them cannot be traced count as occluded (found by fuzz_scene).
    if (!is_traceable(shadow_ray)) return true;
    query(top_of(ray), context.embree, shadow_ray);
    return shadow_ray.tfar < 0;  // Embree's mark of an occluded ray
}

}  // namespace
}  // namespace dg::embree

namespace dg {

std::unique_ptr<Intersector> Intersector::build(
    const std::vector<Mesh>& meshes, const std::vector<InstanceGeometry>& instances,
    std::vector<Keyed<Sphere>> spheres, CutoutFunction cutout) {
    return std::make_unique<embree::EmbreeIntersector>(meshes, instances, std::move(spheres),
                                                       std::move(cutout));
}

}  // namespace dg
