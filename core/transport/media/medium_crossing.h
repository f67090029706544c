// medium_crossing.h -- takes a path through the medium around it, up to the next surface.
//
// In an even medium, the medium's own light is a closed form. The light of lamps that it scatters toward the path is
// found like direct light at a surface: by one light sample (lamp_sampler.h), and by the path itself, which is scattered
// after a free path and may meet a lamp. In a grid, delta tracking finds a collision; it is a vertex like one on a
// surface.
// Sources: Wilkie et al. 2014 (medium/segment.h); Pharr, Jakob and Humphreys 2023, Physically Based Rendering, ch. 14.
#pragma once
#include "transport/media/lamp_sampler.h"

namespace dg {

/// Result of a path's way through a medium.
struct MediumEvent {
    enum class Kind {
        passed,      // it is at the surface
        scattered,   // at `t`, toward `wi`
        collided,    // at `t`: a vertex, where light and the direction are still to be sampled
        ended,       // it carries nothing any more
    } kind = Kind::ended;
    float t = 0;                       // m along the ray
    Vec3f wi;
    float phase_pdf = 0;               // of wi, 1/sr
    float odds = 1;                    // light samples over collisions of the path
    Spectrum emitted{0.f};             // light of the medium, with the throughput
    LampSample lamp;                   // light that lamps bring to the way, of weight 0: none
    Spectrum lamp_throughput{0.f};
};

class MediumCrossing {
  public:
    /// `path` is in a medium.
    explicit MediumCrossing(PathState& path);

    /// `t`: distance of the surface, m. `last`: the path may not be scattered any more.
    MediumEvent cross(float t, bool last);

  private:
    void cross_even(float t, bool last, MediumEvent& event);
    void scatter(float free_path, MediumEvent& event);
    void cross_grid(float t, bool last, MediumEvent& event);
    float scattering_drawn(const Segment& way) const;
    void sample_lamp(const Segment& way, float drawn, MediumEvent& event);
    bool take(const Segment::Onward& onward);
    bool survives_dark(Vec3f from, Vec3f at);

    PathState& path_;
    Walk& walk_;
    const Medium& medium_;
    const MediumAt here_;
};

}  // namespace dg
