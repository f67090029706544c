// camera_sample.h -- input and output records of all kinds of camera.
#pragma once
#include "geometry/ray.h"
#include "math/vec.h"

namespace dg {

struct CameraSample {
    Vec2f film_mm;          // upright image, +x right, +y up
    Vec2f u_lens;           // [0,1)^2
    float time;             // fraction of the scene's interval
    float wavelength_nm;
    float iris_opening = 1; // fraction of the iris radius, for leaf shutters
};

struct CameraRay {
    Ray ray;                // camera frame, m
    float weight = 0;       // relative exposure; 0: clipped
    float aim_weight = 0;   // exact lens: weight without the transmittance of the glass
    float iris_opening = 1; // copied from the sample
};

/// Landing point of a scene ray on the film, and its measures.
struct Reprojection {
    Vec2f film_mm;             // upright image
    float transmittance = 0;   // 0: clipped
    float aim_weight = 0;      // weight of the camera ray without transmittance; 0: outside the sampling domain
    float etendue = 0;   // m2 sr of scene rays per mm2 of film and unit square of lens samples; 0: outside the
                         // domain
    float response = 0;  // weight / etendue, also outside the sampling domain: relative exposure x mm2 of film per
                         // luminance 1 in a m2 sr of rays
};

}  // namespace dg
