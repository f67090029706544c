// fit_mounts.cpp -- selects the clear apertures that limit a lens.
#include <algorithm>

#include "optics/expansion/lens_fit_make.h"

namespace dg {
namespace {

constexpr double kMissed =
    1e-4;  // fraction of passing rays that ignored mounts may clip

bool stops(const Surface& s, Vec2d at) {
    const double r = length(at);
    return r > clear_radius(s) || r < s.inner_semi_diameter;
}

}  // namespace

std::vector<FitMount> limiting_mounts(const Tracer& tracer,
                                      const std::vector<FitSample>& samples) {
    const auto& surfaces = tracer.prescription().surfaces;
    std::vector<const FitSample*> stopped;
    int passing = 0;
    for (const FitSample& s : samples) {
        passing += s.passes;
        if (!s.passes) stopped.push_back(&s);
    }
    std::vector<FitMount> mounts;
    while (true) {
        std::vector<int> count(surfaces.size());
        for (const FitSample* s : stopped)
            for (std::size_t i = 0; i < surfaces.size(); ++i)
                count[i] += int(i) != tracer.stop() && stops(surfaces[i], s->met[i]);
        const int busiest =
            int(std::max_element(count.begin(), count.end()) - count.begin());
        if (count[busiest] <= kMissed * passing) return mounts;
        const Surface& mount = surfaces[busiest];
        mounts.push_back({busiest, clear_radius(mount), mount.inner_semi_diameter});
        std::erase_if(stopped,
                      [&](const FitSample* s) { return stops(mount, s->met[busiest]); });
    }
}

}  // namespace dg
