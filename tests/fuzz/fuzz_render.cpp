// fuzz_render.cpp -- any lens, shutter, film and settings before a scene that is sound: an Error, or a picture without a
// bad sample, whose sums go to words and back.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "input.h"
#include "math/error.h"
#include "render/render.h"

namespace dg {
namespace {

/// A floor of glass and paint under a lamp and a sky.
std::shared_ptr<const Scene> sound_scene() {
    SceneDescription d;
    Mesh floor;
    floor.name = "floor";
    floor.positions = std::vector<Vec3f>{{-3, -1, -8}, {3, -1, -8}, {3, -1, 1}, {-3, -1, 1}};
    floor.triangles = std::vector<std::array<std::uint32_t, 3>>{{0, 2, 1}, {0, 3, 2}};
    d.meshes = {floor};
    d.materials = {{"paint", DiffuseMaterial{{0.5f, 0.4f, 0.3f}}}, {"glass", DielectricMaterial{.ior = 1.5f}}};
    Affine3f up;
    up.origin = {0, 1, -1};
    d.instances = {{"floor", 0, 0, {}}, {"pane", 0, 1, up}};
    d.lights = {SphereLight{{{0, 2, -3}, 0.2f}, {9, 8, 7}}};
    d.environment = Environment::constant({0.4f, 0.5f, 0.6f});
    return Scene::build(std::move(d));
}

/// In 0 .. 1: what Python checks before the core sees it.
double tame(FuzzInput& in) { return in.below(255) / 254.0; }

LensKind any_lens(FuzzInput& in) {
    switch (in.below(3)) {
        case 0: return Pinhole{1 + 50 * tame(in)};
        case 1: return ThinLens{1 + 50 * tame(in), 10 * tame(in), 0.1 + 5 * tame(in)};
        default: {
            std::array<double, ProjectionModel::kMost> parameters{};
            for (int i = 0; i < 5; ++i) parameters[i] = in.flag() ? 0.2 * double(in.number()) : 0;
            const auto kind = ProjectionModel::Kind(in.below(int(ProjectionModel::Kind::ftheta) + 1));
            return Projection{.model = ProjectionModel(kind, parameters),
                              .focal_mm = {20, 20},
                              .aperture_radius_mm = 4 * tame(in)};
        }
    }
}

void draw(FuzzInput& in) {
    static const std::shared_ptr<const Scene> scene = sound_scene();
    const Camera camera{Motion(Affine3d{}), any_lens(in)};
    RenderSettings s;
    const int width = 1 + in.below(9), height = 1 + in.below(6);
    s.sensor = {width, height, 1 + 35 * tame(in), 24, {in.flag() ? 50 * tame(in) : 0., 0}};
    s.filter = Filter(FilterKind(in.below(4)));
    s.threads = 1, s.seed = in.raw<std::uint64_t>();
    s.sample_begin = in.below(3), s.sample_end = s.sample_begin + 1 + in.below(3);
    s.path.max_depth = 1 + in.below(6);
    s.path.see_through = in.flag();
    if (in.flag()) s.light = {double(in.below(40)), double(in.below(40))};
    FilmLayout layout{.width = width, .height = height, .layers = {Layer::coverage}};
    layout.layers[Layer::aovs] = in.flag(), layout.layers[Layer::objects] = in.flag();
    layout.layers[Layer::splats] = !s.light.off(), layout.layers[Layer::halves] = in.flag();
    layout.layers[Layer::bands] = in.flag() ? 4 : 0;
    Film film(layout);
    render(*scene, camera, film, s, nullptr);
    if (film.bad_sample_count()) {
        std::fprintf(stderr, "bad samples: %llu, lens %d, sensor %g mm at %g\n",
                     (unsigned long long)(film.bad_sample_count()), int(camera.lens.index()), s.sensor.width_mm,
                     double(s.sensor.center_mm.x));
        std::abort();
    }
    for (const float v : film.mean_xyz())
        if (!std::isfinite(v)) std::abort();
    if (!layout.layers[Layer::objects]) return;
    std::vector<std::uint32_t> words = film.state("objects").made;
    Film other(layout);
    other.set_state("objects", std::as_bytes(std::span(words)));
    if (other.state("objects").made != words) std::abort();
    for (int i = in.below(8); i > 0; --i) words[in.raw<std::uint16_t>() % words.size()] = in.raw<std::uint32_t>();
    other.set_state("objects", std::as_bytes(std::span(words)));
    const std::vector<std::uint32_t> ids{3, 5, 5};
    other.ranked(ids, 1 + in.below(4));
}

}  // namespace
}  // namespace dg

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    dg::FuzzInput in(data, size);
    try {
        dg::draw(in);
    } catch (const dg::Error&) {
    }
    return 0;
}
