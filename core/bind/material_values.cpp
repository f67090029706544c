#include "bind/material_values.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <array>

#include "bind/choose.h"

namespace nb = nanobind;

namespace dg::bind {
namespace {

using Triple = std::array<float, 3>;
Rgb to_rgb(const Triple& c) { return {c[0], c[1], c[2]}; }

/// Fields of a Python record.
struct Fields {
    const nb::dict& values;

    float number(const char* key) const { return nb::cast<float>(values[key]); }
    /// A bool, or a number as a bool.
    bool flag(const char* key) const { return bool(nb::bool_(nb::object(values[key]))); }
    std::uint32_t index(const char* key) const { return nb::cast<std::uint32_t>(values[key]); }
    Rgb rgb(const char* key) const { return to_rgb(nb::cast<Triple>(values[key])); }
    TextureSlot slot(const char* key) const { return to_slot(values[key]); }
    /// A spectrum; null if the field is a number or a colour.
    std::shared_ptr<const SampledSpectrum> sampled(const char* key) const {
        const nb::object value = values[key];
        if (!nb::isinstance<SampledSpectrum>(value)) return nullptr;
        return nb::cast<std::shared_ptr<SampledSpectrum>>(value);
    }
    SpectralColor color(const char* key) const {
        if (auto spectrum = sampled(key)) return spectrum;
        return rgb(key);
    }
    Roughness roughness() const {
        return {number("alpha"), number("alpha_v"), slot("alpha_texture"),
                choose<Distribution>("distribution", nb::cast<std::string>(values["distribution"]),
                                     {{"ggx", Distribution::ggx}, {"beckmann", Distribution::beckmann}})};
    }
};

DiffuseMaterial to_diffuse(const Fields& f) {
    return {f.color("reflectance"), f.slot("reflectance_texture"), f.color("transmittance"),
            f.slot("transmittance_texture")};
}

ConductorMaterial to_conductor(const Fields& f) {
    ConductorMaterial m{f.color("reflectance"), f.roughness(), f.slot("reflectance_texture")};
    m.fresnel = !f.values["eta"].is_none();
    if (m.fresnel) m.eta = f.color("eta"), m.k = f.color("k");
    return m;
}

DielectricMaterial to_dielectric(const Fields& f) {
    DielectricMaterial m;
    m.ior_by_wavelength = f.sampled("ior");
    if (!m.ior_by_wavelength) m.ior = f.number("ior");
    m.alpha = f.roughness();
    m.tint = f.color("tint");
    m.dispersion = f.number("dispersion");
    m.reflection_tint = f.color("reflection_tint");
    m.thin = f.flag("thin");
    m.energy_compensation = f.flag("energy_compensation");
    return m;
}

CoatedMaterial to_coated(const Fields& f) {
    CoatedMaterial m;
    const nb::dict base = nb::cast<nb::dict>(f.values["base"]);
    m.metal = base.contains("eta");
    if (m.metal)
        m.conductor = to_conductor({base});
    else
        m.diffuse = to_diffuse({base});
    m.ior = f.number("ior");
    m.alpha = f.roughness();
    m.specular_tint = f.color("specular_tint");
    m.thickness = f.number("thickness");
    m.absorption = f.color("absorption");
    m.nonlinear = f.flag("nonlinear");
    m.energy_compensation = f.flag("energy_compensation");
    return m;
}

void set_layers(const nb::dict& d, GltfMaterial& m) {
    const auto number = [&](const char* key) { return nb::cast<float>(d[key]); };
    const auto slot = [&](const char* key) { return to_slot(d[key]); };
    m.clearcoat = {number("clearcoat"),
                   slot("clearcoat_texture"),
                   number("clearcoat_roughness"),
                   slot("clearcoat_roughness_texture"),
                   number("clearcoat_normal_scale"),
                   slot("clearcoat_normal_texture")};
    m.sheen = {to_rgb(nb::cast<Triple>(d["sheen_color"])), slot("sheen_color_texture"),
               number("sheen_roughness"), slot("sheen_roughness_texture")};
    m.anisotropy = {number("anisotropy"), number("anisotropy_rotation"), slot("anisotropy_texture")};
    m.iridescence = {number("iridescence"),
                     slot("iridescence_texture"),
                     number("iridescence_ior"),
                     number("iridescence_thickness_min_nm"),
                     number("iridescence_thickness_max_nm"),
                     slot("iridescence_thickness_texture")};
}

GltfMaterial to_gltf(const nb::dict& d) {
    const auto number = [&](const char* key) { return nb::cast<float>(d[key]); };
    const auto rgb = [&](const char* key) { return to_rgb(nb::cast<Triple>(d[key])); };
    const auto slot = [&](const char* key) { return to_slot(d[key]); };
    GltfMaterial m;
    m.base_color = rgb("base_color");
    m.base_alpha = number("base_alpha");
    m.base_color_texture = slot("base_color_texture");
    m.metallic = number("metallic");
    m.roughness = number("roughness");
    m.metallic_roughness_texture = slot("metallic_roughness_texture");
    m.normal_scale = number("normal_scale");
    m.normal_texture = slot("normal_texture");
    m.occlusion_texture = slot("occlusion_texture");
    m.emissive = rgb("emissive");
    m.emissive_texture = slot("emissive_texture");
    m.alpha_mode = choose<GltfMaterial::AlphaMode>("alpha_mode",
                                                   nb::cast<std::string>(d["alpha_mode"]),
                                                   {{"opaque", GltfMaterial::AlphaMode::opaque},
                                                    {"mask", GltfMaterial::AlphaMode::mask},
                                                    {"blend", GltfMaterial::AlphaMode::blend}});
    m.alpha_cutoff = number("alpha_cutoff");
    m.double_sided = nb::cast<bool>(d["double_sided"]);
    m.ior = number("ior");
    m.specular = number("specular");
    m.specular_texture = slot("specular_texture");
    m.specular_color = rgb("specular_color");
    m.specular_color_texture = slot("specular_color_texture");
    m.transmission = number("transmission");
    m.transmission_texture = slot("transmission_texture");
    m.thickness = number("thickness");
    m.attenuation_distance = number("attenuation_distance");
    m.attenuation_color = rgb("attenuation_color");
    m.dispersion = number("dispersion");
    set_layers(d, m);
    m.diffuse_transmission = number("diffuse_transmission");
    m.diffuse_transmission_texture = slot("diffuse_transmission_texture");
    m.diffuse_transmission_color = rgb("diffuse_transmission_color");
    m.diffuse_transmission_color_texture = slot("diffuse_transmission_color_texture");
    m.specular_glossiness = nb::cast<bool>(d["specular_glossiness"]);
    m.glossiness = number("glossiness");
    m.specular_glossiness_texture = slot("specular_glossiness_texture");
    m.unlit = nb::cast<bool>(d["unlit"]);
    return m;
}

}  // namespace

TextureSlot to_slot(nb::handle value) {
    TextureSlot slot;
    if (value.is_none()) return slot;
    const auto [index, set, m] = nb::cast<std::tuple<int, int, std::array<float, 6>>>(value);
    slot.index = index;
    slot.uv_set = set;
    std::copy(m.begin(), m.end(), slot.m);
    return slot;
}

Material to_material(const std::string& name, const std::string& kind, const nb::dict& values,
                     const nb::dict& common) {
    const Fields f{values}, all{common};
    using Make = decltype(Material::kind) (*)(const Fields&);
    const auto make = choose<Make>(
        "kind", kind,
        {{"diffuse", [](const Fields& x) -> decltype(Material::kind) { return to_diffuse(x); }},
         {"conductor", [](const Fields& x) -> decltype(Material::kind) { return to_conductor(x); }},
         {"dielectric", [](const Fields& x) -> decltype(Material::kind) { return to_dielectric(x); }},
         {"coated", [](const Fields& x) -> decltype(Material::kind) { return to_coated(x); }},
         {"mix",
          [](const Fields& x) -> decltype(Material::kind) {
              return MixMaterial{x.index("first"), x.index("second"), x.number("amount"), x.slot("amount_texture")};
          }},
         {"boundary", [](const Fields&) -> decltype(Material::kind) { return BoundaryMaterial{}; }},
         {"gltf", [](const Fields& x) -> decltype(Material::kind) { return to_gltf(x.values); }}},
        "material");
    Material m{name, make(f), all.rgb("emission"), all.flag("two_sided_emission")};
    m.profile = nb::cast<std::int32_t>(common["profile"]);
    m.opacity = all.number("opacity");
    m.opacity_texture = all.slot("opacity_texture");
    m.normal_texture = all.slot("normal_texture");
    m.normal_scale = all.number("normal_scale");
    m.two_sided = all.flag("two_sided");
    m.emission_texture = all.slot("emission_texture");
    return m;
}

}  // namespace dg::bind
