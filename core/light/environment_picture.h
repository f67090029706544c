// environment_picture.h -- an environment's picture, with tables of its luminance.
#pragma once
#include "light/environment.h"
#include "light/sky_blocks.h"
#include "light/sky_grid.h"

namespace dg {

struct Environment::Picture {
    std::shared_ptr<const std::vector<Rgb>> pixels;  // cd/m2
    SkyGrid grid;
    SkyBlocks blocks;
    Affine3f world_from_environment, environment_from_world;

    Rgb at(SkyTexels texels) const;
    /// Density of samples, 1/sr. `direction`: in the frame of the picture.
    float pdf(SkyTexels at, Vec3f direction) const;
};

}  // namespace dg
