#include "optics/path.h"

#include <algorithm>

namespace dg {
namespace {

/// The same way, gone from its other end: a mirror is met from the same side.
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
    LensPath path;
    for (int i = 0; i < far; ++i) path.push_back({i});
    path.push_back({far, 1, true});
    for (int i = far - 1; i > near; --i) path.push_back({i, -1});
    path.push_back({near, -1, true});
    for (int i = near + 1; i < surfaces; ++i) path.push_back({i});
    return toward_film ? path : turned(std::move(path));
}

}  // namespace dg
