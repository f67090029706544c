// indexed_albedo.h -- tables of what a lobe returns that depends on an index of refraction, besides angle and
// roughness.
#pragma once
#include <memory>

#include "material/ggx_albedo.h"

namespace dg {

/// Four numbers by index, roughness and cosine; linear in (n - 1) / (n + 1), in sqrt(cos) and in sqrt(alpha).
class IndexedAlbedo {
  public:
    static constexpr int kIndices = 16, kAngles = GgxAlbedo::kAngles, kRoughnesses = 16;
    static constexpr float kLargestIndex = 10;

    /// Fills the table from a function of cosine, alpha and n.
    using Integrand = LobeAlbedo (*)(float cosine, float alpha, float n);
    explicit IndexedAlbedo(Integrand integrand);

    /// One index and one roughness of the table.
    struct Row {
        const LobeAlbedo* corners[2][2] = {};   // by index and roughness
        float index_share = 0, roughness_share = 0;
        LobeAlbedo mean{0.f};   // of this very interpolant, weighted by cos

        LobeAlbedo at(float cosine) const;
    };
    /// n >= 1.
    Row row(float n, float alpha) const;

  private:
    struct Cells {
        LobeAlbedo values[kIndices][kRoughnesses][kAngles], means[kIndices][kRoughnesses];
    };
    std::unique_ptr<Cells> cells_;
};

}  // namespace dg
