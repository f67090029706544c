#include "optics/pupil.h"

#include "optics/free_aim.h"
#include "optics/symmetric_aim.h"

namespace dg {

Aim make_aim(const Tracer& tracer, const AimRequest& request) {
    if (request.tilted || !is_axially_symmetric(tracer.prescription()))
        return make_free_aim(tracer, request);
    return make_symmetric_aim(tracer, request);
}

}  // namespace dg
