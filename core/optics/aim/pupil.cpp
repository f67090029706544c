#include "optics/aim/pupil.h"

#include <algorithm>

#include "optics/aim/free_aim.h"
#include "optics/aim/symmetric_aim.h"

namespace dg {

double outer_radius(const AimRequest& request) {
    return kEnlargement * request.iris_radius * request.iris.outer_radius();
}

void set_iris_scale(AimTables& t, const AimRequest& request) {
    t.iris_scale = float(kShapeMargin * outer_radius(request));
    set_enlargement(t, request, 1);
}

void set_enlargement(AimTables& t, const AimRequest& request, double iris_error) {
    // Three times the largest measured error, plus 0.001 for rays that were not tested.
    const double margin = 0.001 + 3 * iris_error;
    const double enlargement = 1 + std::clamp(margin, 0.002, kEnlargement - 1);
    const double scale = request.iris_radius / t.iris_scale;
    t.enlargement = float(enlargement);
    t.shape_area = float(request.iris.sampling_area(enlargement) * scale * scale);
}

Aim make_aim(const Tracer& tracer, const AimRequest& request) {
    if (request.tilted || !is_axially_symmetric(tracer.prescription()))
        return make_free_aim(tracer, request);
    return make_symmetric_aim(tracer, request);
}

}  // namespace dg
