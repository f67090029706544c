// poisson.h -- Poisson-distributed electron counts.
#pragma once
#include "develop/random.h"

namespace dg {

/// Poisson variate with a mean from 0 to 1e9, by exact methods.
double poisson(double mean, PixelRandom& random);

}  // namespace dg
