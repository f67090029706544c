// paraxial.h -- first-order properties of a lens, and what follows from them: focus and
// f-number.
#pragma once
#include "optics/lens/prescription.h"

namespace dg {

/// The plane of a meridional section. Lenses with axial symmetry are alike in both.
enum class Section { y, x };

/// All z in the lens frame (mm, z = 0 at the first vertex), lengths in mm. With the same
/// medium on both sides the nodal points are the principal points.
struct FirstOrder {
    double wavelength_nm;
    double efl;       // rear focal length n'/power
    double bfl, ffl;  // last vertex -> rear focus; first vertex -> front focus (negative)
    double front_focal_z, back_focal_z;
    double front_principal_z, back_principal_z;
    double front_nodal_z, back_nodal_z;
    double entrance_pupil_z, exit_pupil_z;  // infinite when telecentric
    double entrance_magnification,
        exit_magnification;     // pupil diameter / stop diameter, signed
    double stop_semi_diameter;  // mm, clear
    double entrance_pupil_diameter, exit_pupil_diameter;  // wide open
    double f_number;  // wide open: efl / entrance pupil diameter
};

/// By two paraxial rays (height, n x slope) through the system: the ABCD matrix of each
/// half. Surfaces that are decentred or tilted count as if they were not. Source: Smith,
/// Modern Optical Engineering, 4th ed., ch. 3-4. Error if the lens is afocal.
FirstOrder first_order(const Prescription& lens,
                       double wavelength_nm = kDesignWavelength,
                       Section section = Section::y);

/// Exit pupil diameter / entrance pupil diameter, signed as the pupils' images are.
inline double pupil_magnification(const FirstOrder& f) {
    return f.exit_magnification / f.entrance_magnification;
}

/// Image size / object size of what is sharp on a film at film_z; negative: upside down.
inline double magnification(const FirstOrder& f, double film_z) {
    return (f.back_focal_z - film_z) / f.efl;
}

/// 1 / (2 n' |u'|) of the marginal ray: what exposure feels when the film is not at
/// infinity focus. Source: Smith, Modern Optical Engineering, 4th ed., sec. 9.
inline double working_f_number(const FirstOrder& f, double f_stop, double magnification) {
    return f_stop * (1 - magnification / pupil_magnification(f));
}

/// Radius of the iris (mm, circle of equal area) for an f-stop = efl / entrance pupil
/// diameter. Error naming the widest f-stop if the lens does not open that far (1 % is
/// granted: printed f-numbers are rounded).
double iris_radius(const Prescription& lens, const FirstOrder& first_order,
                   double f_stop);
double widest_f_stop(const Prescription& lens, const FirstOrder& first_order);

enum class FocusFrom { pupil, sensor };

/// Closest distance, m, for which the whole lens moves: 1:1.
double closest_focus_m(const Prescription& lens, const FirstOrder& first_order, FocusFrom from);

/// z of the film, mm, when the whole lens is moved to focus at a distance (m, infinity
/// allowed) along the axis, measured from the centre of the entrance pupil or from the
/// film. Exact conjugate by Newton's x x' = f^2. A magnification beyond 1:1 is an Error
/// that names the nearest distance.
double film_position(const Prescription& lens, const FirstOrder& first_order,
                     double distance_m, FocusFrom from = FocusFrom::pupil);

}  // namespace dg
