#include "optics/stray/ghost.h"

#include <algorithm>

#include "math/error.h"

namespace dg {

LensPath path_to_stop(const Tracer& tracer, LensPath path, int crossing) {
    std::vector<std::size_t> at;
    for (std::size_t k = 0; k < path.size(); ++k)
        if (path[k].surface == tracer.stop()) at.push_back(k);
    const int count = int(at.size()), which = crossing < 0 ? count + crossing : crossing;
    if (which < 0 || which >= count)
        throw input_error(
            tracer.prescription().name, "crossing of the iris",
            count ? "0 to " + std::to_string(count - 1) + ", or -1 for the last"
                  : "a path that meets the iris",
            std::to_string(crossing));
    path.resize(at[which] + 1);
    return path;
}

LensPath ghost_path(const Tracer& tracer, int one, int other, bool toward_film) {
    const Prescription& lens = tracer.prescription();
    const int count = int(lens.surfaces.size());
    const auto refuse = [&](const std::string& wanted, const std::string& got) {
        throw input_error(lens.name, "ghost", wanted, got);
    };
    for (const int i : {one, other}) {
        if (i < 0 || i >= count)
            refuse("surfaces of 0 .. " + std::to_string(count - 1), std::to_string(i));
        const LensIndices n = tracer.at(kDesignWavelength);
        if (n.index[i] == n.index[i + 1])
            refuse("surfaces that reflect", "surface " + std::to_string(i) +
                                                ", which has one medium on both sides");
    }
    if (one == other) refuse("two surfaces", "surface " + std::to_string(one) + " twice");
    return ghost_path(count, std::min(one, other), std::max(one, other), toward_film);
}

}  // namespace dg
