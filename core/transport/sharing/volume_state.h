// volume_state.h -- the volume around a light path.
//
// On camera paths, absorption in nested or overlapping volumes depends on the order in which boundaries are hit. So MIS
// with light paths covers only paths through air and one volume at a time, entered and left through the same material.
// The lens is in air. An emitter may be inside a volume, which becomes known when the light leaves it.
#pragma once
#include "material/bsdf_sample.h"

namespace dg {

struct VolumeState {
    enum class Where { air, inside, unknown } where = Where::air;
    Interior interior{};

    bool may_nest = false;   // the scene has overlapping solids: an emitter may be in one that holds others

    /// Crosses a boundary. False: volumes are nested or overlap.
    bool cross(const Interior& beyond, bool entering) {
        if (entering) {
            if (where == Where::inside || (may_nest && where == Where::unknown)) return false;
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
