// medium_crossing.h -- traces a path through the medium around it, up to the next surface.
//
// In a homogeneous medium, emission is integrated in closed form. In-scattered light of lamps is estimated like direct
// light at a surface: by a light sample (lamp_sampler.h), and by the path itself, which is scattered after a free path
// and may hit a lamp. In a grid, delta tracking samples a collision, which becomes a vertex like a surface vertex.
// Sources: Wilkie et al. 2014 (medium/segment.h); Pharr, Jakob and Humphreys 2023, Physically Based Rendering, ch. 14.
#pragma once
#include "transport/media/lamp_sampler.h"

namespace dg {

/// Result of tracing a path through a medium.
struct MediumEvent {
    enum class Kind {
        passed,              // reached the surface
        direction_sampled,   // scattered at `t` toward `wi`; `lamp` is the light sample
        collision,           // scatters at `t`, but the caller samples light and direction there, as at a surface
        ended,               // throughput 0, or ended by roulette
    } kind = Kind::ended;
    float t = 0;                       // m along the ray
    Vec3f wi;
    float phase_pdf = 0;               // of wi, 1/sr
    float light_samples_per_collision = 1;   // ratio of the expected numbers on the segment, for MIS
    Spectrum emitted{0.f};             // emission of the medium times the throughput
    LampSample lamp;                   // light sample on the segment; weight 0: none
    Spectrum lamp_throughput{0.f};
};

class MediumCrossing {
  public:
    /// `path` must be in a medium.
    explicit MediumCrossing(PathState& path);

    /// `t`: distance to the surface, m, or infinity. `last`: the path has reached its maximum depth and is not
    /// scattered.
    MediumEvent cross(float t, bool last);

  private:
    void cross_homogeneous(float t, bool last, MediumEvent& event);
    void scatter(float free_path, MediumEvent& event);
    void cross_grid(float t, bool last, MediumEvent& event);
    float scattering_fraction(const Segment& segment) const;
    void sample_lamp(const Segment& segment, float fraction, MediumEvent& event);
    bool take(const Segment::Onward& onward);
    bool survives_dark(Vec3f from, Vec3f at);

    PathState& path_;
    WalkState& walk_;
    const Medium& medium_;
    const MediumAt coefficients_;   // at the wavelengths of the path
};

}  // namespace dg
