// live_source.h -- a small source as pictures that pass by draw it: its points, and its colours by the transmittance at
// some wavelengths.
#pragma once
#include <array>
#include <vector>

#include "render/flare/live/mesh_patch.h"
#include "render/flare/maps/small_source.h"

namespace dg {

struct LiveSource {
    static constexpr int kNodes = 16, kSteps = 960;   // of the wavelength
    static constexpr int kGroups = 3;                 // of wavelengths, which land apart from each other
    SmallSource small;
    /// An arrival of all wavelengths has these, by groups, for each unit of transmittance at a node.
    std::array<std::array<Rgb, kNodes>, kGroups> colors;
    std::array<Rgb, kSteps> at;       // of an arrival of one wavelength, see nm(), for each unit of transmittance
    std::array<float, kNodes> seen;   // luminance of the same, over that of all of them
    std::vector<float> brightness;   // of its points, over their mean
    float free;                      // share of its light that nothing in the scene is in the way of
    double light;                    // of that share

    LiveSource(SmallSource own, float free_share);
    /// Luminance that a transmittance leaves of its light.
    float light_of(const std::array<float, kNodes>& spectrum) const;
    /// How light of this transmittance changes with the one at the middle wavelength, see lambda_node(1).
    GlassChange change(const std::array<float, kNodes>& spectrum) const;
    /// u in [0, 1), evenly as wavelengths are seen: its group is int(u * kGroups).
    static float nm(float u);
    /// Wavelengths of the nodes, even in the wavenumber, as the reflectance of coatings changes: from 388 to 700 nm.
    static float node_nm(int k) { return 1e3f / (kFirst - kStep * float(k)); }
    /// Place of a wavelength among the nodes, from 0 on.
    static float node_of(float nm) { return (kFirst - 1e3f / nm) / kStep; }

  private:
    static constexpr float kFirst = 1e3f / 388, kStep = (kFirst - 1e3f / 700) / (kNodes - 1);   // waves per um
};

}  // namespace dg
