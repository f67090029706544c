#include "optics/lens/surface.h"

#include <utility>

#include "optics/lens/lens_error.h"

namespace dg {

void set_kind(Surface& s, const std::string& kind) {
    if (kind == "spherical" || kind == "aspheric" || kind == "stop") {
        s.shape = Shape::conic;
    } else if (kind == "biconic") {
        s.shape = Shape::biconic;
    } else if (kind == "toroid") {
        s.shape = Shape::toroid;
    } else if (kind == "cyl-x") {
        s.shape = Shape::biconic;
        s.curvature_x = s.conic_x = 0;
    } else if (kind == "cyl-y") {
        s.shape = Shape::biconic;
        s.curvature_x = std::exchange(s.curvature, 0.0);
        s.conic_x = std::exchange(s.conic, 0.0);
    } else {
        throw lens_error("lens-surface", -1, "surface", "kind",
                         "spherical, aspheric, stop, cyl-x, cyl-y, biconic or toroid",
                         kind);
    }
}

}  // namespace dg
