// bind_ray_map.cpp -- chief rays of pixels.
#include <nanobind/stl/tuple.h>

#include "bind/arrays.h"
#include "bind/region.h"
#include "bind/unlocked.h"
#include "render/truth/ray_map.h"
#include "render/render.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

auto planes(const std::vector<dg::Vec3d>& values, std::size_t height, std::size_t width) {
    std::vector<double> flat;
    flat.reserve(3 * values.size());
    for (const dg::Vec3d& v : values) flat.insert(flat.end(), {v.x, v.y, v.z});
    return dg::bind::to_numpy(std::move(flat), {height, width, std::size_t(3)});
}

auto rays(const dg::Camera& camera, const dg::RenderSettings& settings, const dg::bind::Crop& crop, bool world) {
    const dg::FilmLayout region = dg::bind::region_of(crop, "ray map");
    const std::size_t height = region.height, width = region.width;
    dg::PixelRays map;
    {
        dg::bind::Unlocked release;
        map = ray_map(camera, settings.sensor, settings.shutter, region,
                      world ? dg::RayFrame::world : dg::RayFrame::camera, settings.threads);
    }
    return std::tuple{planes(map.origins, height, width), planes(map.directions, height, width),
                      dg::bind::to_numpy(std::move(map.times), {height, width})};
}

}  // namespace

void bind_ray_map(nb::module_& m) {
    m.def("ray_map", &rays, "camera"_a, "settings"_a, "crop"_a, "world"_a = false,
          "(origins, directions, times) of the pixels (x0, y0, x1, y1), end exclusive: m, unit, "
          "fractions of the interval; NaN: no light comes there.");
}
