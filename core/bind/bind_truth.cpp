// bind_truth.cpp -- ground truth at a time, and motion in pixels.
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <limits>

#include "bind/arrays.h"
#include "bind/region.h"
#include "bind/unlocked.h"
#include "math/error.h"
#include "render/truth/truth_channels.h"
#include "render/truth/truth_mean.h"
#include "render/truth/truth_objects.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

/// One value per pixel: value_at(index).
template <typename Make>
nb::object plane(const dg::TruthPlanes& truth, const Make& value_at) {
    std::vector<decltype(value_at(0))> out(truth.depth.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = value_at(i);
    return nb::cast(dg::bind::to_numpy(std::move(out), {std::size_t(truth.region.height),
                                                        std::size_t(truth.region.width)}));
}

/// A plane by its name in files.
nb::object plane_named(const dg::TruthPlanes& t, const std::string& name) {
    std::string known;
    for (const dg::TruthChannel& channel : dg::kTruthChannels) {
        if (name == channel.name)
            return std::visit(
                [&](auto value) { return plane(t, [&](std::size_t i) { return value(t, i); }); },
                channel.value);
        known += (known.empty() ? "" : ", ") + std::string(channel.name);
    }
    throw dg::input_error("truth", "plane", "one of " + known, name);
}

/// Planes of means, which have an additional channel.
nb::object mean_plane_named(const dg::MeanTruth& t, const std::string& name) {
    if (name == dg::kCoverageChannel) return plane(t, [&](std::size_t i) { return t.coverage[i]; });
    return plane_named(t, name);
}

/// Points (px), one per pixel, computed by make().
template <typename Make>
auto points_of(const dg::FilmLayout& region, const Make& make) {
    std::vector<double> flat;
    {
        dg::bind::Unlocked release;
        for (const dg::Vec2d px : make()) flat.insert(flat.end(), {px.x, px.y});
    }
    return dg::bind::to_numpy(std::move(flat), {std::size_t(region.height),
                                                std::size_t(region.width), std::size_t(2)});
}

using dg::bind::Crop;

dg::FilmLayout region_of(const Crop& crop) { return dg::bind::region_of(crop, "truth"); }

auto places_of(const dg::Truth& truth, const dg::Scene& scene, const dg::Camera& camera,
               const dg::RenderSettings& settings) {
    return points_of(truth.region,
                     [&] { return dg::places(truth, {scene, camera}, settings); });
}

auto mean_motion_of(const dg::Scene& scene, const dg::Camera& camera,
                    const dg::RenderSettings& settings, const dg::Scene& other_scene,
                    const dg::Camera& other_camera, const dg::RenderSettings& other_settings,
                    const Crop& crop, int rays) {
    return points_of(region_of(crop), [&] {
        return dg::mean_motion({scene, camera}, settings, {other_scene, other_camera},
                               other_settings, region_of(crop), rays);
    });
}

using GroupArray = nb::ndarray<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// Validates group indices: one per instance, below `count` or none.
dg::Groups groups_of(const dg::Scene& scene, const GroupArray& groups, std::size_t count) {
    const std::size_t instances = scene.description().instances.size();
    const dg::Groups given{groups.data(), groups.shape(0)};
    if (given.size() != instances)
        throw dg::input_error("truth", "groups", std::to_string(instances) + " of instances",
                              std::to_string(given.size()));
    for (const std::uint32_t group : given)
        if (group != dg::kNoGroup && group >= count)
            throw dg::input_error("truth", "groups", "numbers below " + std::to_string(count),
                                  std::to_string(group));
    return given;
}

/// (visible, whole) pixel counts of each group, and the bounds of the whole, x0 y0 x1 y1.
auto silhouettes_of(const dg::Scene& scene, const dg::Camera& camera,
                    const dg::RenderSettings& settings, const Crop& crop,
                    const GroupArray& groups, std::size_t count) {
    const dg::Groups given = groups_of(scene, groups, count);
    std::vector<std::uint64_t> pixels;
    std::vector<int> boxes;
    {
        dg::bind::Unlocked release;
        for (const dg::Silhouette& s :
             dg::silhouettes({scene, camera}, region_of(crop), settings, given, count)) {
            pixels.insert(pixels.end(), {s.visible, s.whole});
            boxes.insert(boxes.end(), {s.x0, s.y0, s.x1, s.y1});
        }
    }
    return std::tuple{dg::bind::to_numpy(std::move(pixels), {count, std::size_t(2)}),
                      dg::bind::to_numpy(std::move(boxes), {count, std::size_t(4)})};
}

/// Bounds x0 y0 x1 y1 of each group, NaN if it is not imaged, and whether it is open.
auto outlines_of(const dg::Scene& scene, const dg::Camera& camera,
                 const dg::RenderSettings& settings, const GroupArray& groups,
                 std::size_t count) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const dg::Groups given = groups_of(scene, groups, count);
    std::vector<double> boxes;
    std::vector<std::uint8_t> open;
    {
        dg::bind::Unlocked release;
        for (const dg::GroupOutline& o : dg::outlines({scene, camera}, settings, given, count)) {
            const std::array box{o.low.x, o.low.y, o.high.x, o.high.y};
            for (const double value : box) boxes.push_back(o.empty ? kNone : value);
            open.push_back(o.open);
        }
    }
    return std::tuple{dg::bind::to_numpy(std::move(boxes), {count, std::size_t(4)}),
                      dg::bind::to_numpy(std::move(open), {count})};
}

}  // namespace

void bind_truth(nb::module_& m) {
    using namespace dg;
    m.attr("TRUTH_PLANES") = dg::bind::names_of(kTruthChannels);
    m.attr("COVERAGE_PLANE") = kCoverageChannel;
    nb::class_<Truth>(m, "Truth")
        .def("plane", [](const Truth& t, const std::string& name) { return plane_named(t, name); },
             "name"_a, "Values (H, W) by the name of the channel.")
        .def("places", &places_of, "scene"_a, "camera"_a, "settings"_a,
             "Where what was seen lies in another frame, px (H, W, 2); NaN: it is not "
             "there.");
    nb::class_<MeanTruth>(m, "MeanTruth")
        .def("plane", &mean_plane_named, "name"_a, "Values (H, W) by the name of the channel.");
    m.def(
        "see",
        [](const Scene& scene, const Camera& camera, const RenderSettings& settings,
           const Crop& crop) {
            dg::bind::Unlocked release;
            return see({scene, camera}, region_of(crop), settings);
        },
        "scene"_a, "camera"_a, "settings"_a, "crop"_a,
        "Ground truth of the pixels (x0, y0, x1, y1), end exclusive.");
    m.def(
        "see_mean",
        [](const Scene& scene, const Camera& camera, const RenderSettings& settings,
           const Crop& crop, int rays) {
            dg::bind::Unlocked release;
            return see_mean({scene, camera}, region_of(crop), settings, rays);
        },
        "scene"_a, "camera"_a, "settings"_a, "crop"_a, "rays"_a,
        "The same as means over so many rays of each pixel.");
    m.def("mean_motion", &mean_motion_of, "scene"_a, "camera"_a, "settings"_a, "other_scene"_a,
          "other_camera"_a, "other_settings"_a, "crop"_a, "rays"_a,
          "How far what is seen moves until another frame, px (H, W, 2), means over the same "
          "rays; NaN: it has no place there.");
    m.def("silhouettes", &silhouettes_of, "scene"_a, "camera"_a, "settings"_a, "crop"_a,
          "groups"_a, "count"_a,
          "Pixels whose chief rays meet a group of instances, first of all and at all (N, 2), and "
          "the box of the latter (N, 4), end exclusive; 2^32 - 1: an instance of no group.");
    m.def("outlines", &outlines_of, "scene"_a, "camera"_a, "settings"_a, "groups"_a, "count"_a,
          "Boxes (x0, y0, x1, y1), px, around all points of groups, and whether some of their "
          "points have no place; NaN: none has.");
}
