// bind_scene.cpp -- scenes from arrays.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <cstring>

#include "bind/arrays.h"
#include "bind/choose.h"
#include "bind/material_values.h"
#include "bind/medium_values.h"
#include "bind/unlocked.h"
#include "math/error.h"
#include "scene/scene.h"
#include "transport/clear_way.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace dg::bind {
namespace {

using Triple = std::array<float, 3>;
using Place = std::array<double, 3>;   // in the world, m
Vec3f vec(const Triple& v) { return {v[0], v[1], v[2]}; }
Vec3d vec(const Place& v) { return {v[0], v[1], v[2]}; }
Rgb to_rgb(const Triple& c) { return {c[0], c[1], c[2]}; }

using Pixels8 = nb::ndarray<const std::uint8_t, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using PixelsF = nb::ndarray<const float, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

MinFilter to_min_filter(const std::string& name) {
    constexpr auto kNearest = TextureFilter::nearest;
    constexpr auto kLinear = TextureFilter::linear;
    using Mip = MinFilter::Mip;
    return choose<MinFilter>("min_filter", name,
                             {{"nearest", {kNearest, Mip::none}},
                              {"linear", {kLinear, Mip::none}},
                              {"nearest_mipmap_nearest", {kNearest, Mip::nearest}},
                              {"linear_mipmap_nearest", {kLinear, Mip::nearest}},
                              {"nearest_mipmap_linear", {kNearest, Mip::linear}},
                              {"linear_mipmap_linear", {kLinear, Mip::linear}}});
}

/// Vectors at one time, (N, 3), or at equal steps over the interval, (S, N, 3).
using Vectors3 = std::variant<Rows3f, Steps3f>;
using Vectors4 = std::variant<Rows4f, Steps4f>;

template <typename T, typename Vectors>
SharedArray<T> all_steps(const Vectors& vectors) {
    return std::visit([](const auto& array) { return shared<T>(array); }, vectors);
}

using Intervals = std::optional<std::vector<std::pair<double, double>>>;

std::shared_ptr<const Shown> to_shown(const Intervals& intervals) {
    if (!intervals) return nullptr;
    Shown shown;
    for (const auto& [open, close] : *intervals) shown.times.push_back({open, close});
    return std::make_shared<const Shown>(std::move(shown));
}

/// Collects the parts of a scene; Scene::build validates them.
struct Builder {
    SceneDescription description;

    /// A point, and a transform, in the scene's frame.
    Vec3f here(const Place& place) const { return to_float(vec(place) - description.origin); }
    Affine3d here(const Matrix4& matrix, const Place& local_origin = {}) const {
        Affine3d m = to_affine(matrix);
        m.origin = m.point(vec(local_origin)) - description.origin;
        return m;
    }

    int add_mesh(const std::string& name, const Vectors3& positions, const Rows3u& triangles,
                 std::optional<Vectors3> normals, std::optional<Rows2f> uv0,
                 std::optional<Rows2f> uv1, std::optional<Vectors4> tangents,
                 std::optional<Rows4f> colors) {
        Mesh mesh;
        mesh.name = name;
        if (const auto* steps = std::get_if<Steps3f>(&positions))
            mesh.steps = std::uint32_t(steps->shape(0));
        mesh.positions = all_steps<Vec3f>(positions);
        mesh.triangles = shared<std::array<std::uint32_t, 3>>(triangles);
        if (normals) mesh.normals = all_steps<Vec3f>(*normals);
        if (uv0) mesh.uv[0] = shared<Vec2f>(*uv0);
        if (uv1) mesh.uv[1] = shared<Vec2f>(*uv1);
        if (tangents) mesh.tangents = all_steps<std::array<float, 4>>(*tangents);
        if (colors) mesh.colors = shared<std::array<float, 4>>(*colors);
        description.meshes.push_back(std::move(mesh));
        return int(description.meshes.size()) - 1;
    }

    /// Adds curves; `shape` is (basis is cubic, closed).
    int add_curves(const std::string& name, const Vectors3& positions, const RowF& radii,
                   const RowU& starts, const RowU& ends, std::pair<bool, bool> shape,
                   std::optional<Rows2f> uv, std::optional<Rows4f> colors) {
        Mesh mesh;
        mesh.name = name;
        if (const auto* steps = std::get_if<Steps3f>(&positions))
            mesh.steps = std::uint32_t(steps->shape(0));
        mesh.positions = all_steps<Vec3f>(positions);
        mesh.curves.cubic = shape.first;
        mesh.curves.closed = shape.second;
        mesh.curves.radii = shared(radii);
        mesh.curves.starts = shared(starts);
        mesh.curves.ends = shared(ends);
        if (uv) mesh.uv[0] = shared<Vec2f>(*uv);
        if (colors) mesh.colors = shared<std::array<float, 4>>(*colors);
        description.meshes.push_back(std::move(mesh));
        return int(description.meshes.size()) - 1;
    }

    int add_texture(const std::string& name, std::variant<Pixels8, PixelsF> pixels, bool srgb,
                    const std::string& wrap_u, const std::string& wrap_v,
                    const std::string& filter, const std::string& min_filter) {
        Texture t;
        t.name = name;
        std::visit(
            [&](const auto& p) {
                t.height = int(p.shape(0));
                t.width = int(p.shape(1));
                t.channels = int(p.shape(2));
                t.pixels = shared(p);
            },
            pixels);
        t.srgb = srgb;
        const auto wrap = [](const std::string& name) {
            return choose<Wrap>("wrap", name,
                                {{"repeat", Wrap::repeat}, {"mirror", Wrap::mirror}, {"clamp", Wrap::clamp}});
        };
        t.wrap_u = wrap(wrap_u);
        t.wrap_v = wrap(wrap_v);
        t.filter = choose<TextureFilter>("filter", filter,
                                         {{"linear", TextureFilter::linear}, {"nearest", TextureFilter::nearest}});
        t.min_filter = to_min_filter(min_filter);
        description.textures.push_back(std::move(t));
        return int(description.textures.size()) - 1;
    }

    int add_material(const std::string& name, const std::string& kind, const nb::dict& values,
                     const nb::dict& common) {
        description.materials.push_back(to_material(name, kind, values, common));
        return int(description.materials.size()) - 1;
    }

    int add_instance(const std::string& name, std::uint32_t mesh, std::uint32_t material,
                     const Matrix4& matrix, const Intervals& shown, const Place& local_origin) {
        description.instances.push_back(
            {name, mesh, material, to_float(here(matrix, local_origin)), nullptr, to_shown(shown), {}, vec(local_origin)});
        return int(description.instances.size()) - 1;
    }

    int add_moving_instance(const std::string& name, std::uint32_t mesh, std::uint32_t material,
                            const Motion& motion, const Intervals& shown, const Place& local_origin) {
        const Motion own = motion.relative_to(description.origin, vec(local_origin));
        description.instances.push_back({name, mesh, material, {},
                                         std::make_shared<const Motion>(own), to_shown(shown), {}, vec(local_origin)});
        return int(description.instances.size()) - 1;
    }

    /// Makes an instance a catcher.
    void set_catcher(std::uint32_t instance, bool shadow, bool reflection, bool gi) {
        description.instances.at(instance).catcher = CatcherEffects{shadow, reflection, gi};
    }

    int add_medium(const MediumColor& absorption, const MediumColor& scattering, const MediumColor& emission,
                   const std::vector<std::pair<float, float>>& lobes, const MediumGrid& density) {
        description.media.all.push_back(to_medium({absorption, scattering, emission, lobes, density}));
        return int(description.media.all.size()) - 1;
    }
    void set_media(std::uint32_t material, int inside, int outside, bool invisible) {
        description.media.of_material[material] = {inside, outside, invisible};
    }

    void set_nesting(std::uint32_t material, int priority, bool literal) {
        description.nesting[material] = {priority, literal};
    }

    int add_profile(std::shared_ptr<LightProfile> profile) {
        description.profiles.push_back(std::move(profile));
        return int(description.profiles.size()) - 1;
    }

    void add_light(Light light) { description.lights.push_back(std::move(light)); }

    void fold_materials(const std::vector<double>& times) {
        fold(description.materials, times, description.material_keys);
    }
    void fold_lights(const std::vector<double>& times) {
        fold(description.lights, times, description.light_keys);
    }
    using Pose = std::pair<Triple, float>;
    void key_environment(const std::vector<double>& times, const std::vector<Pose>& poses) {
        Keyed<EnvironmentPose, double> keys{times, {}};
        for (const auto& [strength, turn] : poses) keys.values.push_back({to_rgb(strength), turn});
        description.environment_keys = std::move(keys);
    }

  private:
    /// Replaces the last entries of a list, one per time, by a single entry with keys.
    template <typename T>
    static void fold(std::vector<T>& list, const std::vector<double>& times,
                     std::map<std::uint32_t, Keyed<T, double>>& keys) {
        if (times.empty() || times.size() > list.size())
            throw input_error("keys", "times", "1 to " + std::to_string(list.size()),
                              std::to_string(times.size()));
        const std::size_t first = list.size() - times.size();
        keys[std::uint32_t(first)] = {times, {list.begin() + std::ptrdiff_t(first), list.end()}};
        list.resize(first + 1, list[first]);
    }
};


std::optional<std::tuple<float, std::uint32_t>> first_hit(const Scene& scene, const Place& origin,
                                                          const Triple& direction, float t_min) {
    Ray ray;
    ray.origin = to_float(vec(origin) - scene.origin());
    ray.direction = normalize(vec(direction));
    ray.time = 0.5f;
    ray.t_min = t_min;
    if (!is_traceable(ray)) return std::nullopt;
    const auto hit = scene.first_hit(ray);
    if (!hit) return std::nullopt;
    return std::tuple{hit->t, hit->instance};
}

using WaySurface = std::tuple<Place, std::uint32_t, std::optional<Triple>>;

std::vector<WaySurface> clear_surfaces(const Scene& scene, const Place& origin, const Triple& direction, float t_min) {
    const Ray ray{.origin = to_float(vec(origin) - scene.origin()), .direction = normalize(vec(direction)),
                  .time = 0.5f, .t_min = t_min};
    std::vector<WaySurface> found;
    for (const WayPoint& point : clear_way(scene, ray)) {
        const Vec3d place = to_double(point.position) + scene.origin();
        std::optional<Triple> onward;
        if (point.onward) onward = {point.onward->x, point.onward->y, point.onward->z};
        found.emplace_back(Place{place.x, place.y, place.z}, point.instance, onward);
    }
    return found;
}

std::vector<std::pair<std::uint32_t, float>> surroundings(const Scene& scene, const Place& point, float time) {
    std::vector<std::pair<std::uint32_t, float>> found;
    for (const auto& [instance, share] : scene.enclosing_solids(to_float(vec(point) - scene.origin()), time))
        found.emplace_back(instance, share);
    return found;
}

auto overlaps(const Scene& scene) {
    std::vector<std::tuple<std::uint32_t, std::uint32_t, std::string>> first;
    for (const Overlap& o : scene.overlaps()) first.emplace_back(o.lower, o.higher, o.by);
    return first;
}

std::vector<std::uint32_t> nested_solids(const Scene& scene) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < scene.description().instances.size(); ++i)
        if (scene.rank(i) > 0) found.push_back(i);
    return found;
}

void bind_built_scene(nb::module_& m) {
    nb::class_<Scene>(m, "Scene")
        .def_prop_ro("triangle_count", &Scene::triangle_count)
        .def_prop_ro("intersector", &Scene::intersector_name)
        .def_prop_ro("bounds",
                     [](const Scene& s) {
                         const Vec3d low = to_double(s.bounds().min) + s.origin();
                         const Vec3d high = to_double(s.bounds().max) + s.origin();
                         return std::tuple{Place{low.x, low.y, low.z}, Place{high.x, high.y, high.z}};
                     })
        .def_prop_ro("origin", [](const Scene& s) { return std::tuple{s.origin().x, s.origin().y, s.origin().z}; },
                     "Origin of the scene's frame in the world, m. Arguments and results are in the world.")
        .def_prop_ro("overlaps", &overlaps,
                     "The first pairs of overlapping solids, as instances: lower, higher, which fills the space, and the reason.")
        .def_prop_ro("nested_solids", &nested_solids, "Instances of solids that overlap others, in rising order.")
        .def_prop_ro("nests_too_deeply", &Scene::nests_too_deeply,
                     "Whether more solids are nested than a path can keep.")
        .def("surroundings", &surroundings, "point"_a, "time"_a,
             "Absorbing volumes around a point at a time (fraction of the interval): pairs of an instance and the share "
             "of directions in which its mesh is closed.")
        .def("clear_way", &clear_surfaces, "origin"_a, "direction"_a, "t_min"_a = 0.f,
             "Surfaces along a ray at mid-interval, which clear ones refract: position (m), instance, and the direction "
             "behind it; None where the ray ends.")
        .def("first_hit", &first_hit, "origin"_a, "direction"_a, "t_min"_a = 0.f,
             "Distance (m) and instance index of the nearest surface at mid-interval, beyond t_min, or None.");
}

/// Methods for meshes, textures and instances.
void def_shapes(nb::class_<Builder>& c) {
    c.def("add_mesh", &Builder::add_mesh, "name"_a, "positions"_a, "triangles"_a,
             "normals"_a.none(), "uv0"_a.none(), "uv1"_a.none(), "tangents"_a.none(),
             "colors"_a.none())
        .def("add_curves", &Builder::add_curves, "name"_a, "positions"_a, "radii"_a, "starts"_a,
             "ends"_a, "shape"_a, "uv"_a.none(), "colors"_a.none(),
             "shape: whether the segments are cubic, and whether the curves are closed.")
        .def("add_texture", &Builder::add_texture, "name"_a, "pixels"_a, "srgb"_a, "wrap_u"_a,
             "wrap_v"_a, "filter"_a, "min_filter"_a)
        .def("add_instance", &Builder::add_instance, "name"_a, "mesh"_a, "material"_a, "matrix"_a,
             "shown"_a = nb::none(), "local_origin"_a = Place{},
             "shown: intervals (open, close), s, in which it is there; None: always. local_origin: the mesh's "
             "positions are relative to this point of its space.")
        .def("add_instance", &Builder::add_moving_instance, "name"_a, "mesh"_a, "material"_a,
             "motion"_a, "shown"_a = nb::none(), "local_origin"_a = Place{})
        .def("set_catcher", &Builder::set_catcher, "instance"_a, "shadow"_a, "reflection"_a, "gi"_a,
             "Makes an instance a part of the set: which effects of objects it catches.");
}

/// Methods for media inside meshes and around the scene.
void def_media(nb::class_<Builder>& c) {
    c.def("add_medium", &Builder::add_medium, "absorption"_a, "scattering"_a, "emission"_a, "lobes"_a,
             "density"_a.none())
        .def("set_media", &Builder::set_media, "material"_a, "inside"_a, "outside"_a, "invisible"_a,
             "Media on both sides of a material's surfaces; -1: none inside, outside that of the world. invisible: "
             "nothing else is there.")
        .def("set_nesting", &Builder::set_nesting, "material"_a, "priority"_a, "literal"_a,
             "Where solids overlap, the higher priority replaces the lower; literal: the surfaces are interfaces as "
             "given, and never hidden.")
        .def("set_fog", [](Builder& b, int medium) { b.description.media.fog = medium; }, "medium"_a);
}

/// A lamp's profile by index (-1: none) and its axes in the world.
using Lamp = std::tuple<int, Triple, Triple, Triple>;
LampShape to_lamp(const Lamp& lamp) {
    const auto& [profile, x, y, z] = lamp;
    return {profile, {to_double(vec(x)), to_double(vec(y)), to_double(vec(z)), {}}};
}

/// Methods for each kind of light without a mesh.
void def_lights(nb::class_<Builder>& c) {
    c.def("add_profile", &Builder::add_profile, "profile"_a)
        .def("add_point_light",
             [](Builder& b, const Place& position, const Triple& intensity, float range, const Lamp& lamp) {
                 b.add_light(PointLight{b.here(position), to_rgb(intensity), range, to_lamp(lamp)});
             })
        .def("add_spot_light",
             [](Builder& b, const Place& position, const Triple& direction,
                const Triple& intensity, float inner_rad, float outer_rad, float range) {
                 b.add_light(SpotLight{b.here(position), normalize(vec(direction)), to_rgb(intensity),
                                       inner_rad, outer_rad, range});
             })
        .def("add_directional_light",
             [](Builder& b, const Triple& direction, const Triple& illuminance, float angle_rad) {
                 b.add_light(DirectionalLight{normalize(vec(direction)), to_rgb(illuminance), angle_rad});
             })
        .def("add_sphere_light",
             [](Builder& b, const Place& center, float radius, const Triple& luminance, const Lamp& lamp) {
                 b.add_light(SphereLight{{b.here(center), radius}, to_rgb(luminance), to_lamp(lamp)});
             });
}

/// Methods for light from infinity.
void def_environment(nb::class_<Builder>& c) {
    c.def("set_environment_image",
             [](Builder& b, const PixelsF& pixels, float scale, const Matrix4& matrix) {
                 EnvironmentImage image;
                 image.height = int(pixels.shape(0));
                 image.width = int(pixels.shape(1));
                 image.pixels.resize(std::size_t(image.width) * image.height);
                 if (pixels.shape(2) != 3)
                     throw input_error("environment", "channels", "3", std::to_string(pixels.shape(2)));
                 std::memcpy(static_cast<void*>(image.pixels.data()), pixels.data(), pixels.nbytes());
                 b.description.environment =
                     Environment::image(std::move(image), scale, to_float(to_affine(matrix)));
             })
        .def("set_environment_color",
             [](Builder& b, const Triple& luminance) {
                 b.description.environment = Environment::constant(to_rgb(luminance));
             });
}

/// Methods for motion during the exposure.
void def_time(nb::class_<Builder>& c) {
    c.def("set_interval",
             [](Builder& b, double open_s, double close_s) {
                 b.description.interval = {open_s, close_s};
             },
             "open_s"_a, "close_s"_a, "Exposed interval of the picture, s; keys of time are in s as well.")
        .def("fold_materials", &Builder::fold_materials, "times_s"_a,
             "The materials added last, one per time (s), become keys of a single one.")
        .def("fold_lights", &Builder::fold_lights, "times_s"_a,
             "The lights added last, one per time (s), become keys of a single one.")
        .def("key_environment", &Builder::key_environment, "times_s"_a, "poses"_a,
             "Poses of the environment: RGB that its light is multiplied by, and a turn about +y, rad.");
}

/// Builds a scene from its parts.
void def_build(nb::class_<Builder>& c) {
    c.def("build",
             [](Builder& b, const std::string& light_choice, std::uint64_t free_memory) {
                 b.description.free_memory = free_memory;
                 b.description.light_choice =
                     choose<LightChoice>("light_choice", light_choice,
                                         {{"tree", LightChoice::tree},
                                          {"power", LightChoice::power},
                                          {"even", LightChoice::even}},
                                         "scene");
                 dg::bind::Unlocked release;
                 return std::const_pointer_cast<Scene>(Scene::build(std::move(b.description)));
             },
             "light_choice"_a = "tree", "free_memory"_a = 0,
             "Checks everything, finds emissive triangles and builds the ray tracer; the builder is "
             "empty afterwards. free_memory: bytes that there are for it; 0: not known.");
}

}  // namespace
}  // namespace dg::bind

void bind_scene(nb::module_& m) {
    using namespace dg::bind;
    bind_built_scene(m);
    nb::class_<Builder> c(m, "SceneBuilder");
    c.def("__init__", [](Builder* b, const Place& origin) { new (b) Builder{.description = {.origin = vec(origin)}}; },
          "origin"_a = Place{}, "origin: of the scene's frame, in the world, m; its axes are the world's.");
    def_shapes(c);
    c.def("add_material", &Builder::add_material, "name"_a, "kind"_a, "values"_a, "common"_a,
          "values: fields of the kind; common: those of all materials, with the index of the profile.");
    def_media(c);
    def_lights(c);
    def_environment(c);
    def_time(c);
    def_build(c);
}
