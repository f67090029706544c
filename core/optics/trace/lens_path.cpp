#include "optics/trace/lens_path.h"

#include <algorithm>
#include <array>

#include "math/error.h"

namespace dg {
namespace {

/// The path in reverse. A mirror keeps its sign, as light hits the same side of it.
LensPath turned(LensPath path) {
    std::ranges::reverse(path);
    for (PathStep& step : path)
        if (!step.reflects) step.sign = -step.sign;
    return path;
}

}  // namespace

LensPath straight_path(int surfaces, bool toward_film) {
    LensPath path;
    for (int i = 0; i < surfaces; ++i) path.push_back({i});
    return toward_film ? path : turned(std::move(path));
}

LensPath ghost_path(int surfaces, int near, int far, bool toward_film) {
    return ghost_path(surfaces, std::array{far, near}, toward_film);
}

LensPath ghost_path(int surfaces, std::span<const int> mirrors, bool toward_film) {
    LensPath path;
    int at = 0, sign = 1;
    if (mirrors.size() % 2)
        throw input_error("ghost", "mirrors", "an even number", std::to_string(mirrors.size()));
    for (const int mirror : mirrors) {
        if (sign > 0 ? mirror < at : mirror > at)
            throw input_error("ghost", "mirrors", "surfaces in the order in which the light meets them",
                              std::to_string(mirror));
        for (; at != mirror; at += sign) path.push_back({at, sign});
        path.push_back({mirror, sign, true});
        sign = -sign, at = mirror + sign;
    }
    for (; at < surfaces; ++at) path.push_back({at});
    return toward_film ? path : turned(std::move(path));
}

}  // namespace dg
