// live_source.h -- a small source for interactive previews: its points, and its colours as functions of the
// transmittance at several wavelengths.
#pragma once
#include <array>
#include <vector>

#include "render/flare/live/mesh_patch.h"
#include "render/flare/maps/small_source.h"

namespace dg {

struct LiveSource {
    static constexpr int kNodes = 16, kSteps = 960;   // wavelength nodes; steps of the table `at`
    static constexpr int kGroups = 3;                 // groups of wavelengths with separate landings
    SmallSource small;
    /// Colours of an arrival with all wavelengths, per group, per unit of transmittance at a node.
    std::array<std::array<Rgb, kNodes>, kGroups> colors;
    std::array<Rgb, kSteps> at;       // colour of an arrival at wavelength nm(), per unit of transmittance
    std::array<float, kNodes> seen;   // share of the luminance per node
    std::vector<float> brightness;   // of its points, relative to their mean
    float free;                      // unoccluded share of its light
    double light;                    // unoccluded light

    LiveSource(SmallSource own, float free_share);
    /// Luminance of its light after a transmittance.
    float light_of(const std::array<float, kNodes>& spectrum) const;
    /// Dependence of its light on the transmittance at the middle wavelength, lambda_node(1).
    GlassChange change(const std::array<float, kNodes>& spectrum) const;
    /// Wavelength for u in [0, 1), uniform in visible light; its group is int(u * kGroups).
    static float nm(float u);
    /// Wavelengths of the nodes, uniform in wavenumber like the reflectance of coatings, from 388 to 700 nm.
    static float node_nm(int k) { return 1e3f / (kFirst - kStep * float(k)); }
    /// Fractional index of a wavelength among the nodes.
    static float node_of(float nm) { return (kFirst - 1e3f / nm) / kStep; }

  private:
    static constexpr float kFirst = 1e3f / 388, kStep = (kFirst - 1e3f / 700) / (kNodes - 1);   // waves per um
};

}  // namespace dg
