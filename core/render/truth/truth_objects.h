// truth_objects.h -- unoccluded silhouettes and bounding boxes of objects on the film, including parts that are hidden
// by other objects or outside the frame. Objects are groups of instances.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "render/truth/truth.h"

namespace dg {

/// Index of each instance's group, or kNoGroup.
using Groups = std::span<const std::uint32_t>;
constexpr std::uint32_t kNoGroup = 0xffffffffu;

/// Pixels of a region with chief rays that hit a group: as the nearest group, or at any depth.
struct Silhouette {
    std::uint64_t visible = 0, whole = 0;
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // bounds at any depth, px of the full frame, end exclusive
};
/// Traces chief rays through all surfaces along them. Uses the same settings as see().
std::vector<Silhouette> silhouettes(const TruthFrame& frame, const FilmLayout& region,
                                    const RenderSettings& settings, Groups groups,
                                    std::size_t count);

/// Bounding box of all points of a group, px of the full frame; it may extend beyond the frame.
struct GroupOutline {
    Vec2d low{0, 0}, high{0, 0};
    bool empty = true;  // no point is imaged
    bool open = false;  // some points are not imaged: behind the camera, or outside the field of the lens
};
/// Subdivides triangle edges and lines along curves that distortion bends, to an error of at most 0.05 px.
std::vector<GroupOutline> outlines(const TruthFrame& frame, const RenderSettings& settings,
                              Groups groups, std::size_t count);

}  // namespace dg
