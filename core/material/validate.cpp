// validate.cpp -- range checks of material parameters.
#include <cmath>

#include "material/material.h"
#include "math/error.h"

namespace dg {
namespace {

struct Checker {
    std::string where;
    const std::vector<Texture>& textures;

    void number(const char* field, float v, float low, float high) const {
        if (v >= low && v <= high) return;  // false for NaN
        const std::string wanted =
            std::isfinite(high) ? "a number from " + text(low) + " to " + text(high)
                                : "a finite number of at least " + text(low);
        throw input_error(where, field, wanted, text(v));
    }
    void color(const char* field, Rgb c, float high) const {
        for (int i = 0; i < 3; ++i) number(field, c[i], 0, high);
    }
    void color(const char* field, const SpectralColor& c, float high) const {
        if (!c.sampled) return color(field, c.rgb, high);
        number(field, c.sampled->least(), 0, high);
        number(field, c.sampled->most(), 0, high);
    }
    void roughness(const char* field, const Roughness& a) const {
        number(field, a.u, 0, 1);
        number((std::string(field) + "_v").c_str(), a.v, 0, 1);
        slot((std::string(field) + "_texture").c_str(), a.texture);
    }
    void slot(const char* field, const TextureSlot& s) const {
        if (!s.used()) return;
        if (static_cast<std::size_t>(s.index) >= textures.size())
            throw input_error(where, field,
                              "one of " + std::to_string(textures.size()) + " textures",
                              "index " + std::to_string(s.index));
        if (s.uv_set != 0 && s.uv_set != 1)
            throw input_error(where, std::string(field) + ": texture set", "0 or 1",
                              std::to_string(s.uv_set));
        for (float m : s.m) number(field, m, -kLargest, kLargest);
    }
    static std::string text(float v) {
        std::ostringstream s;
        s << v;
        return s.str();
    }
    static constexpr float kLargest = std::numeric_limits<float>::max();
};

void check(const Checker& c, const DiffuseMaterial& m) {
    c.color("reflectance", m.reflectance, 1);
    c.slot("reflectance_texture", m.reflectance_texture);
    c.color("transmittance", m.transmittance, 1);
    c.slot("transmittance_texture", m.transmittance_texture);
}
void check(const Checker& c, const ConductorMaterial& m) {
    c.color("reflectance", m.reflectance, 1);
    c.slot("reflectance_texture", m.reflectance_texture);
    c.roughness("alpha", m.alpha);
    c.color("eta", m.eta, 1000);
    c.color("k", m.k, 1000);
}
void check(const Checker& c, const DielectricMaterial& m) {
    c.number("ior", m.ior, 0.1f, 10);
    if (m.ior_by_wavelength) {
        c.number("ior", m.ior_by_wavelength->least(), 0.1f, 10);
        c.number("ior", m.ior_by_wavelength->most(), 0.1f, 10);
    }
    c.roughness("alpha", m.alpha);
    c.color("tint", m.tint, 1);
    c.number("dispersion", m.dispersion, 0, Checker::kLargest);
    c.color("reflection_tint", m.reflection_tint, 1);
}
void check(const Checker& c, const CoatedMaterial& m) {
    if (m.metal) check(c, m.conductor);
    else check(c, m.diffuse);
    if (!m.diffuse.transmittance.is_black())
        throw input_error(c.where, "base: transmittance", "0 under a coat", "more");
    c.number("ior", m.ior, 1, 10);
    c.roughness("alpha", m.alpha);
    c.color("specular_tint", m.specular_tint, 1);
    c.number("thickness", m.thickness, 0, Checker::kLargest);
    c.color("absorption", m.absorption, Checker::kLargest);
}
void check(const Checker& c, const MixMaterial& m) {
    c.number("amount", m.amount, 0, 1);
    c.slot("amount_texture", m.amount_texture);
}
void check(const Checker&, const BoundaryMaterial&) {}

void check_layers(const Checker& c, const GltfMaterial& m) {
    c.number("clearcoat", m.clearcoat.factor, 0, 1);
    c.slot("clearcoat_texture", m.clearcoat.texture);
    c.number("clearcoat_roughness", m.clearcoat.roughness, 0, 1);
    c.slot("clearcoat_roughness_texture", m.clearcoat.roughness_texture);
    c.number("clearcoat_normal_scale", m.clearcoat.normal_scale, -Checker::kLargest,
             Checker::kLargest);
    c.slot("clearcoat_normal_texture", m.clearcoat.normal_texture);
    c.color("sheen_color", m.sheen.color, 1);
    c.slot("sheen_color_texture", m.sheen.color_texture);
    c.number("sheen_roughness", m.sheen.roughness, 0, 1);
    c.slot("sheen_roughness_texture", m.sheen.roughness_texture);
    c.number("anisotropy", m.anisotropy.strength, 0, 1);
    c.number("anisotropy_rotation", m.anisotropy.rotation, -Checker::kLargest,
             Checker::kLargest);
    c.slot("anisotropy_texture", m.anisotropy.texture);
    c.number("iridescence", m.iridescence.factor, 0, 1);
    c.slot("iridescence_texture", m.iridescence.texture);
    c.number("iridescence_ior", m.iridescence.ior, 1, Checker::kLargest);
    c.number("iridescence_thickness_min_nm", m.iridescence.thickness_min, 0, 1e6f);
    c.number("iridescence_thickness_max_nm", m.iridescence.thickness_max, 0, 1e6f);
    c.slot("iridescence_thickness_texture", m.iridescence.thickness_texture);
}

void check(const Checker& c, const GltfMaterial& m) {
    c.color("base_color", m.base_color, 1);
    c.number("base_alpha", m.base_alpha, 0, 1);
    c.number("metallic", m.metallic, 0, 1);
    c.number("roughness", m.roughness, 0, 1);
    c.number("normal_scale", m.normal_scale, -Checker::kLargest, Checker::kLargest);
    c.color("emissive", m.emissive, Checker::kLargest);
    c.number("alpha_cutoff", m.alpha_cutoff, 0, Checker::kLargest);
    if (m.ior != 0) c.number("ior (0 or at least 1)", m.ior, 1, Checker::kLargest);
    c.number("specular", m.specular, 0, 1);
    c.color("specular_color", m.specular_color, Checker::kLargest);
    c.number("transmission", m.transmission, 0, 1);
    c.number("thickness", m.thickness, 0, Checker::kLargest);
    if (!(m.attenuation_distance > 0))
        throw input_error(c.where, "attenuation_distance", "more than 0 m",
                          Checker::text(m.attenuation_distance));
    c.color("attenuation_color", m.attenuation_color, 1);
    c.number("diffuse_transmission", m.diffuse_transmission, 0, 1);
    c.color("diffuse_transmission_color", m.diffuse_transmission_color, 1);
    if (m.specular_glossiness) c.color("specular_color", m.specular_color, 1);
    c.number("glossiness", m.glossiness, 0, 1);
    c.number("dispersion", m.dispersion, 0, Checker::kLargest);
    c.slot("base_color_texture", m.base_color_texture);
    c.slot("metallic_roughness_texture", m.metallic_roughness_texture);
    c.slot("normal_texture", m.normal_texture);
    c.slot("occlusion_texture", m.occlusion_texture);
    c.slot("emissive_texture", m.emissive_texture);
    c.slot("specular_texture", m.specular_texture);
    c.slot("specular_color_texture", m.specular_color_texture);
    c.slot("transmission_texture", m.transmission_texture);
    c.slot("diffuse_transmission_texture", m.diffuse_transmission_texture);
    c.slot("diffuse_transmission_color_texture", m.diffuse_transmission_color_texture);
    c.slot("specular_glossiness_texture", m.specular_glossiness_texture);
    check_layers(c, m);
}

}  // namespace

void validate(const Material& material, const std::vector<Texture>& textures) {
    const Checker c{"material '" + material.name + "'", textures};
    c.color("emission", material.emission, Checker::kLargest);
    c.number("opacity", material.opacity, 0, 1);
    c.slot("opacity_texture", material.opacity_texture);
    c.slot("normal_texture", material.normal_texture);
    c.number("normal_scale", material.normal_scale, -Checker::kLargest, Checker::kLargest);
    c.slot("emission_texture", material.emission_texture);
    std::visit([&](const auto& kind) { check(c, kind); }, material.kind);
}

}  // namespace dg
