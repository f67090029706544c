// camera_sample.h -- the small records that go into and come out of every kind of camera.
#pragma once
#include "geometry/ray.h"
#include "math/vec.h"

namespace dg {

struct CameraSample {
    Vec2f film_mm;          // upright picture, +x right, +y up
    Vec2f u_lens;           // [0,1)^2
    float time;             // fraction of the scene's interval
    float wavelength_nm;
    float iris_opening = 1; // of its radius: a leaf shutter opens and closes it
};

struct CameraRay {
    Ray ray;                // camera frame, m
    float weight = 0;       // relative exposure; 0: stopped
    float aim_weight = 0;   // exact lens: the weight before the glass's transmittance
    float iris_opening = 1; // as the sample says
};

/// Where a scene ray meets the film, and what it does there.
struct Reprojection {
    Vec2f film_mm;             // upright picture
    float transmittance = 0;   // 0: stopped
    float aim_weight = 0;      // the camera ray's weight without it; 0: a ray that is never drawn
    float etendue = 0;   // m2 sr of scene rays per mm2 of film and unit square of lens samples; 0: never drawn
    float response = 0;  // weight / etendue, also of rays that are never drawn: relative exposure x mm2 of
                         // film that luminance 1 brings in a m2 sr of such rays
};

}  // namespace dg
