// render_counters.h -- counts of rays and paths, for statistics; they do not affect the picture.
#pragma once
#include <cstdint>

namespace dg {

struct RenderCounters {
    std::uint64_t camera_rays = 0, stopped_rays = 0, rays = 0;
    std::uint64_t light_paths = 0;
    std::uint64_t splats_off_film = 0;   // light paths that passed the lens and missed the frame
    std::uint64_t flare_paths = 0;
    std::uint64_t flare_rays = 0, flare_hits = 0;   // rays: one per wavelength; hits: rays that reached the frame
    std::uint64_t flare_arrivals = 0;   // samples from maps of ghosts
    std::uint64_t scatter_paths = 0, scatter_hits = 0;   // hits: paths with a wavelength that reached the frame

    friend bool operator==(const RenderCounters&, const RenderCounters&) = default;
};

inline RenderCounters operator+(const RenderCounters& a, const RenderCounters& b) {
    return {a.camera_rays + b.camera_rays, a.stopped_rays + b.stopped_rays, a.rays + b.rays,
            a.light_paths + b.light_paths, a.splats_off_film + b.splats_off_film,
            a.flare_paths + b.flare_paths, a.flare_rays + b.flare_rays, a.flare_hits + b.flare_hits,
            a.flare_arrivals + b.flare_arrivals, a.scatter_paths + b.scatter_paths, a.scatter_hits + b.scatter_hits};
}
inline RenderCounters& operator+=(RenderCounters& a, const RenderCounters& b) { return a = a + b; }

}  // namespace dg
