// truth_objects.h -- where things are on the film, by themselves: whole, behind others, and
// beside the picture. Things are groups of instances; what they are called is not known here.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "render/truth/truth.h"

namespace dg {

/// Index of each instance's group, or kNoGroup.
using Groups = std::span<const std::uint32_t>;
constexpr std::uint32_t kNoGroup = 0xffffffffu;

/// Pixels of a region whose chief rays meet a group: first of all, or at all.
struct Silhouette {
    std::uint64_t visible = 0, whole = 0;
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // of the whole, px of the full frame, end exclusive
};
/// Rays go on through what they meet, to the end. Of the settings as of see().
std::vector<Silhouette> silhouettes(const TruthFrame& frame, const FilmLayout& region,
                                    const RenderSettings& settings, Groups groups,
                                    std::size_t count);

/// The box around all points of a group, px of the full frame, wherever they land.
struct GroupOutline {
    Vec2d low{0, 0}, high{0, 0};
    bool empty = true;  // none has a place
    bool open = false;  // some have none: behind the camera, or past the lens's field
};
/// Edges of triangles and lines along curves that the lens bends are followed, to 0.05 px or better.
std::vector<GroupOutline> outlines(const TruthFrame& frame, const RenderSettings& settings,
                              Groups groups, std::size_t count);

}  // namespace dg
