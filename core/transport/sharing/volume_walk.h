// volume_walk.h -- the volume that a path is in.
//
// Followed from the camera, what a volume absorbs depends on the order in which boundaries are met, unless
// volumes lie apart. So paths from the light share only in what passes air and one volume at a time, each
// left through the material by which it was entered. Lenses are in air; emitters may be in a volume, which
// then shows when it is left.
#pragma once
#include "material/bsdf_sample.h"

namespace dg {

struct VolumeWalk {
    enum class Where { air, inside, unknown } where = Where::air;
    Interior interior{};

    /// Crosses a boundary. False: not one volume after the other.
    bool cross(const Interior& beyond, bool entering) {
        if (entering) {
            if (where == Where::inside) return false;
            where = Where::inside;
            interior = beyond;
            return true;
        }
        if (where == Where::air || (where == Where::inside && !same(interior, beyond))) return false;
        where = Where::air;
        return true;
    }

  private:
    static bool same(const Interior& a, const Interior& b) {
        if (a.present != b.present) return false;
        return !a.present || (a.distance == b.distance && (a.color - b.color).is_black());
    }
};

}  // namespace dg
