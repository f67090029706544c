// paraxial.h -- first-order properties of a lens, focus distance and f-number.
#pragma once
#include "optics/lens/prescription.h"

namespace dg {

/// Meridional section, y-z or x-z. They are equal for axially symmetric lenses.
enum class Section { y, x };

/// Cardinal points and pupils. z in the lens frame, lengths in mm. Nodal and principal points
/// coincide if both outer media are the same.
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

/// First-order properties from the ABCD matrices (height, n x slope) of the parts in front of the
/// stop and behind it. Ignores decentre and tilt of surfaces. Source: Smith, Modern Optical
/// Engineering, 4th ed., ch. 3-4. Throws Error for an afocal lens.
FirstOrder first_order(const Prescription& lens,
                       double wavelength_nm = kDesignWavelength,
                       Section section = Section::y);

/// Exit pupil diameter / entrance pupil diameter, signed like the magnifications of the pupils.
inline double pupil_magnification(const FirstOrder& f) {
    return f.exit_magnification / f.entrance_magnification;
}

/// Image size / object size for the plane in focus on a film at film_z; negative: inverted.
inline double magnification(const FirstOrder& f, double film_z) {
    return (f.back_focal_z - film_z) / f.efl;
}

/// Working f-number 1 / (2 n' |u'|) of the marginal ray, which determines exposure when the lens is
/// not focused at infinity. Source: Smith, Modern Optical Engineering, 4th ed., sec. 9.
inline double working_f_number(const FirstOrder& f, double f_stop, double magnification) {
    return f_stop * (1 - magnification / pupil_magnification(f));
}

/// Iris radius (mm, circle of equal area) for an f-stop = efl / entrance pupil diameter. Throws an
/// Error with the widest f-stop if the lens cannot open that far, with a tolerance of 1 % because
/// printed f-numbers are rounded.
double iris_radius(const Prescription& lens, const FirstOrder& first_order,
                   double f_stop);
double widest_f_stop(const Prescription& lens, const FirstOrder& first_order);

enum class FocusFrom { pupil, sensor };

/// Closest focus distance in m when the whole lens moves: 1:1.
double closest_focus_m(const Prescription& lens, const FirstOrder& first_order, FocusFrom from);

/// Film position z in mm for unit focusing at a distance along the axis (m, may be infinite),
/// measured from the centre of the entrance pupil or from the film. Exact conjugate by Newton's
/// equation x x' = f^2. Throws an Error with the nearest distance for magnifications beyond 1:1.
double film_position(const Prescription& lens, const FirstOrder& first_order,
                     double distance_m, FocusFrom from = FocusFrom::pupil);

}  // namespace dg
