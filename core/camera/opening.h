// opening.h -- opening of a lens as seen from a point of the scene, for kinds without vignetting
// glass: a point or an iris. Camera frame, m.
#pragma once
#include <variant>

#include "math/transform.h"

namespace dg {

/// Pinhole at the origin.
struct Hole {
    bool all_around = false;   // field of view includes the side and the back
};

/// Iris that faces each chief ray, centred on the origin.
struct TurningIris {
    double radius;
    bool all_around;
};

/// Plane iris. Rays start on the plane z = start of its frame.
struct FlatIris {
    Affine3d frame;   // camera from iris
    double radius;    // unit of its shape; negative: an image rotated by 180 degrees
    double start;
};

using Opening = std::variant<Hole, TurningIris, FlatIris>;

}  // namespace dg
