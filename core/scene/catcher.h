// catcher.h -- shadow catchers: parts of the scene that model the things in a photograph, and receive the changes of
// light that objects cause.
#pragma once
#include <cstdint>

namespace dg {

/// Effects of objects on a catcher. Without effects it only occludes.
struct CatcherEffects {
    bool shadow = true;       // direct light that objects block
    bool reflection = true;   // light of objects in its glossy lobes
    bool gi = true;           // indirect light in its diffuse lobes that objects add or block
    bool all() const { return shadow && reflection && gi; }
};

}  // namespace dg
