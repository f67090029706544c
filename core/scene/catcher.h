// catcher.h -- parts of the scene that stand for what the photograph shows already: the set. They catch what objects
// take from its light and add to it.
#pragma once
#include <cstdint>

namespace dg {

/// Effects of objects on one catcher. None of them: it only hides what lies behind it.
struct CatcherEffects {
    bool shadow = true;       // light of emitters, straight: what objects block
    bool reflection = true;   // what its glossy lobes see of objects
    bool gi = true;           // what its diffuse lobes get from objects, and lose by them
    bool all() const { return shadow && reflection && gi; }
};

}  // namespace dg
