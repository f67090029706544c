// poisson.h -- how many electrons, where so many are expected.
#pragma once
#include "develop/random.h"

namespace dg {

/// A number of the Poisson distribution of this mean, which is at least 0 and at most 1e9; by exact methods
/// for small means and large ones.
double poisson(double mean, PixelRandom& random);

}  // namespace dg
