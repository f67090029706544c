// splat_buffer.h -- contributions to pixels that another thread owns, kept until nobody
// draws.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace dg {

/// What one camera sample brought to a pixel that is not its own (dispersion sends
/// wavelengths to different film points). One buffer per worker; Film::merge_splats adds
/// it when the workers rest. 24 bytes per splat: merge at least once per pass.
class SplatBuffer {
  public:
    struct Splat {
        int x, y;              // full-frame pixel
        std::uint32_t sample;  // index of the camera sample
        Vec3f xyz;
    };

    void add(int x, int y, std::uint32_t sample, Vec3f xyz) {
        splats_.push_back({x, y, sample, xyz});
    }
    void clear() { splats_.clear(); }
    std::size_t size() const { return splats_.size(); }
    bool empty() const { return splats_.empty(); }
    const std::vector<Splat>& splats() const { return splats_; }

  private:
    std::vector<Splat> splats_;
};

}  // namespace dg
