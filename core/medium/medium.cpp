#include "medium/medium.h"

#include "math/error.h"

namespace dg {

MediumAt Medium::at(const Wavelengths& wavelengths) const {
    MediumAt here;
    here.scattering = scattering.at(wavelengths);
    here.extinction = here.scattering + absorption.at(wavelengths);
    here.emission = wavelengths.d65 * emission.at(wavelengths);
    return here;
}

}  // namespace dg
