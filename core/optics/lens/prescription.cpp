#include "optics/lens/prescription.h"

#include "optics/lens/lens_error.h"

namespace dg {
bool is_axially_symmetric(const Prescription& lens) {
    for (const Surface& s : lens.surfaces)
        if (!is_axially_symmetric(s)) return false;
    return true;
}

std::string surface_name(const Prescription& lens, int surface) {
    return (lens.name.empty() ? "lens" : lens.name) + ": surface " +
           std::to_string(surface);
}

SurfaceCoating coating_at(const Prescription& lens, int i) {
    const Surface& s = lens.surfaces[i];
    if (s.reflectance > 0) return {.films = {}, .mirror = s.reflectance};
    const Glass& before = i ? lens.surfaces[i - 1].glass : lens.object_medium;
    return coat(s.coating.empty() ? lens.coating : coating_from_name(s.coating),
                refractive_index(before, kFilmWavelength),
                refractive_index(s.glass, kFilmWavelength));
}

bool absorbs(const Prescription& lens) {
    bool any = !lens.object_medium.absorption.nm.empty();
    for (const Surface& s : lens.surfaces) any |= !s.glass.absorption.nm.empty();
    return any;
}

int Prescription::stop_index() const {
    for (int i = 0; i < int(surfaces.size()); ++i)
        if (surfaces[i].stop) return i;
    throw LensError((name.empty() ? "lens" : name) + ": no surface is the stop",
                    "lens-no-stop");
}

std::vector<double> Prescription::vertices() const {
    std::vector<double> z;
    double sum = 0;
    for (const Surface& s : surfaces) {
        z.push_back(sum);
        sum += s.thickness;
    }
    return z;
}

double Prescription::last_vertex() const {
    return vertices().back();
}

}  // namespace dg
