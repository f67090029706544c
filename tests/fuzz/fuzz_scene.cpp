// fuzz_scene.cpp -- any scene description: an Error, or finite light along some rays.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "input.h"
#include "math/error.h"
#include "transport/path.h"

namespace dg {
namespace {

Mesh any_mesh(FuzzInput& in) {
    Mesh mesh;
    mesh.name = "mesh";
    const int vertices = in.below(8), triangles = in.below(8), extra = in.below(64);
    std::vector<Vec3f> positions, normals;
    std::vector<Vec2f> uv[2];
    std::vector<std::array<float, 4>> tangents, colors;
    std::vector<std::array<std::uint32_t, 3>> corners;
    for (int i = 0; i < vertices; ++i) positions.push_back(in.vec3());
    for (int i = 0; i < triangles; ++i) {
        std::array<std::uint32_t, 3> corner;
        for (auto& c : corner) c = vertices ? in.raw<std::uint8_t>() % (vertices + (extra == 63)) : 0;
        corners.push_back(corner);
    }
    const auto four = [&] {
        const Vec3f v = in.vec3();
        return std::array<float, 4>{v.x, v.y, v.z, in.number()};
    };
    for (int i = 0; i < vertices; ++i) {
        if (extra & 1) normals.push_back(in.vec3());
        for (int set = 0; set < 2; ++set)
            if (extra & (2 << set)) {
                const float u = in.number();
                uv[set].push_back({u, in.number()});
            }
        if (extra & 8) tangents.push_back(four());
        if (extra & 16) colors.push_back(four());
    }
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(corners);
    mesh.normals = std::move(normals);
    for (int set = 0; set < 2; ++set) mesh.uv[set] = std::move(uv[set]);
    mesh.tangents = std::move(tangents);
    mesh.colors = std::move(colors);
    return mesh;
}

Texture any_texture(FuzzInput& in) {
    Texture t;
    t.name = "texture";
    t.width = in.below(4);
    t.height = in.below(4);
    t.channels = 1 + in.below(4);
    t.srgb = in.flag();
    t.wrap_u = Wrap(in.below(3));
    t.wrap_v = Wrap(in.below(3));
    t.filter = TextureFilter(in.below(2));
    const int count = t.width * t.height * t.channels + (in.below(32) == 31);
    if (in.flag()) {
        std::vector<float> pixels;
        for (int i = 0; i < count; ++i) pixels.push_back(in.factor());
        t.pixels = std::move(pixels);
    } else {
        std::vector<std::uint8_t> pixels;
        for (int i = 0; i < count; ++i) pixels.push_back(in.raw<std::uint8_t>());
        t.pixels = std::move(pixels);
    }
    return t;
}

Rgb color(FuzzInput& in) {
    const float r = in.factor(), g = in.factor();
    return {r, g, in.factor()};
}

void any_slot(FuzzInput& in, TextureSlot& slot) {
    if (in.below(4) != 0) return;
    slot.index = in.below(4) - 1;
    slot.uv_set = in.below(2);
    if (in.flag())
        for (float& m : slot.m) m = in.number();
}

GltfMaterial any_gltf(FuzzInput& in) {
    GltfMaterial m;
    m.base_color = color(in);
    m.base_alpha = in.factor();
    m.metallic = in.factor();
    m.roughness = in.factor();
    m.normal_scale = in.number();
    m.emissive = in.flag() ? color(in) : Rgb{0, 0, 0};
    m.alpha_mode = GltfMaterial::AlphaMode(in.below(3));
    m.double_sided = in.flag();
    m.ior = 1 + in.number();
    m.specular = in.factor();
    m.specular_color = color(in);
    m.transmission = in.flag() ? in.factor() : 0;
    m.thickness = in.flag() ? in.factor() : 0;
    if (in.flag()) m.attenuation_distance = in.number();
    m.attenuation_color = color(in);
    m.dispersion = in.flag() ? in.factor() : 0;
    if (in.flag()) {
        m.clearcoat.factor = in.factor();
        m.clearcoat.roughness = in.factor();
        m.sheen.color = color(in);
        m.sheen.roughness = in.factor();
        m.anisotropy.strength = in.factor();
        m.anisotropy.rotation = in.number();
        m.iridescence.factor = in.factor();
        m.iridescence.ior = 1 + in.factor();
        m.iridescence.thickness_min = 400 * in.factor();
        m.iridescence.thickness_max = 400 * in.factor();
    }
    for (TextureSlot* slot :
         {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
          &m.emissive_texture, &m.specular_texture, &m.specular_color_texture,
          &m.transmission_texture, &m.clearcoat.texture, &m.clearcoat.normal_texture,
          &m.sheen.color_texture, &m.anisotropy.texture, &m.iridescence.texture})
        any_slot(in, *slot);
    return m;
}

SpectralColor any_color(FuzzInput& in) {
    if (in.flag()) return color(in);
    const std::vector<double> nm{400, 600}, values{in.factor(), in.factor()};
    return std::make_shared<const SampledSpectrum>(nm, values);
}

Roughness any_roughness(FuzzInput& in) {
    const float u = in.factor();
    Roughness a{u, in.flag() ? u : in.factor()};
    any_slot(in, a.texture);
    return a;
}

DiffuseMaterial any_diffuse(FuzzInput& in) {
    DiffuseMaterial m{any_color(in)};
    if (in.flag()) m.transmittance = any_color(in);
    any_slot(in, m.reflectance_texture);
    any_slot(in, m.transmittance_texture);
    return m;
}

ConductorMaterial any_conductor(FuzzInput& in) {
    ConductorMaterial m{any_color(in), any_roughness(in)};
    m.fresnel = in.flag();
    if (m.fresnel) m.eta = any_color(in), m.k = any_color(in);
    any_slot(in, m.reflectance_texture);
    return m;
}

DielectricMaterial any_dielectric(FuzzInput& in) {
    DielectricMaterial m{1 + in.factor(), any_roughness(in), any_color(in), in.factor()};
    if (in.flag()) m.reflection_tint = any_color(in);
    m.thin = in.flag();
    m.energy_compensation = in.flag();
    return m;
}

CoatedMaterial any_coated(FuzzInput& in) {
    CoatedMaterial m;
    m.metal = in.flag();
    if (m.metal) m.conductor = any_conductor(in);
    else m.diffuse = any_diffuse(in);
    m.ior = 1 + in.factor();
    m.alpha = any_roughness(in);
    m.specular_tint = any_color(in);
    m.thickness = in.number();
    m.absorption = any_color(in);
    m.nonlinear = in.flag();
    m.energy_compensation = in.flag();
    return m;
}

/// One of a scene that has `known` materials before it.
Material any_material(FuzzInput& in, int known) {
    Material m;
    m.name = "material";
    switch (in.below(9)) {
        case 0: m.kind = any_diffuse(in); break;
        case 1: m.kind = any_conductor(in); break;
        case 2: m.kind = any_dielectric(in); break;
        case 3: m.kind = any_coated(in); break;
        case 4: m.kind = BoundaryMaterial{}; break;
        case 5: {
            MixMaterial mix{std::uint32_t(in.below(known + 1)), std::uint32_t(in.below(known + 1)), in.factor()};
            any_slot(in, mix.amount_texture);
            m.kind = mix;
            break;
        }
        default: m.kind = any_gltf(in);
    }
    if (in.flag()) m.emission = color(in);
    m.two_sided_emission = in.flag();
    if (in.flag()) {
        m.opacity = in.factor();
        m.two_sided = in.flag();
        for (TextureSlot* slot : {&m.opacity_texture, &m.normal_texture, &m.emission_texture}) any_slot(in, *slot);
    }
    return m;
}

Light any_light(FuzzInput& in) {
    const Vec3f position = in.vec3();
    switch (in.below(4)) {
        case 0: return PointLight{position, color(in), in.number()};
        case 1: {
            const float outer = in.factor();
            return SpotLight{position, {0, 0, -1}, color(in), outer * in.factor(), outer, in.number()};
        }
        case 2: return DirectionalLight{{0, 0, -1}, color(in), in.number()};
        default: return SphereLight{{position, in.number()}, color(in)};
    }
}

Affine3f any_transform(FuzzInput& in) {
    Affine3f m;
    if (in.flag()) m.origin = in.vec3();
    if (in.flag()) {
        m.x = in.vec3();
        m.y = in.vec3();
        m.z = in.vec3();
    }
    return m;
}

SceneDescription any_scene(FuzzInput& in) {
    SceneDescription d;
    for (int n = in.below(4); n > 0; --n) d.textures.push_back(any_texture(in));
    for (int n = 1 + in.below(3); n > 0; --n) d.materials.push_back(any_material(in, int(d.materials.size())));
    for (int n = 1 + in.below(3); n > 0; --n) d.meshes.push_back(any_mesh(in));
    for (int n = in.below(5); n > 0; --n) {
        const auto mesh = std::uint32_t(in.below(int(d.meshes.size()) + (in.below(64) == 63)));
        const auto material = std::uint32_t(in.below(int(d.materials.size())));
        d.instances.push_back({"it", mesh, material, any_transform(in)});
    }
    for (int n = in.below(3); n > 0; --n) d.lights.push_back(any_light(in));
    if (in.flag()) d.environment = Environment::constant(color(in));
    return d;
}

/// Light from any point in any direction: a number that the film can take or drop.
void look_around(const Scene& scene, FuzzInput& in) {
    for (int i = 0; i < 4; ++i) {
        PathSampler sampler(i, in.below(16), i, 7);
        Wavelengths wavelengths = Wavelengths::sample(sampler.camera().lambda);
        Ray ray;
        ray.origin = i == 0 ? Vec3f{0, 0, 3} : in.vec3();
        const Vec3f towards = i == 0 ? Vec3f{0, 0, -1} : in.vec3();
        const float length2 = dot(towards, towards);
        if (!(length2 > 1e-12f && length2 < 1e12f)) continue;
        if (!std::isfinite(dot(ray.origin, ray.origin))) continue;
        ray.direction = normalize(towards);
        PathSettings settings;
        settings.max_depth = 8;
        FirstHit hit;
        radiance(scene, ray, wavelengths, sampler, settings, &hit, nullptr);
    }
}

}  // namespace
}  // namespace dg

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    dg::FuzzInput in(data, size);
    try {
        const auto scene = dg::Scene::build(dg::any_scene(in));
        dg::look_around(*scene, in);
    } catch (const dg::Error&) {
    }
    return 0;
}
