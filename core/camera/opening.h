// opening.h -- the opening of a lens as a point of the scene sees it, where no glass changes it from place to place:
// a point, or an iris. Camera frame, m.
#pragma once
#include <variant>

#include "math/transform.h"

namespace dg {

/// All light goes through the origin.
struct Hole {
    bool all_around = false;   // what lies beside it and behind is seen, too
};

/// An iris that faces each chief ray, within a ball about the origin.
struct TurningIris {
    double radius;
    bool all_around;
};

/// A flat iris. Rays start on the plane z = start of its frame.
struct FlatIris {
    Affine3d frame;   // camera from iris
    double radius;    // unit of its shape; negative: an image turned by 180 degrees
    double start;
};

using Opening = std::variant<Hole, TurningIris, FlatIris>;

}  // namespace dg
