"""Lens: prescription, first-order properties, exact rays, drawing. Lengths in mm."""

from __future__ import annotations

import dataclasses
import html
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.cached import cached_property
from daguerre.checks import whole
from daguerre.errors import InputError
from daguerre.files.value import BriefRecord, Value

from .configurations import Configuration
from .errors import LensError, reported
from .glasses.catalogue import LINE_D
from .groups import Group, placed
from .medium import Medium
from .product import Product
from .setting import By, LensSetting, MeasuredFrom
from .surface import LensSurface, stop_of

if TYPE_CHECKING:
    from .focus import Focused
    from .zoom import Zoom

#: Wavelength at which lenses are specified, nm.
DESIGN_WAVELENGTH_NM = LINE_D


@guarded
@dataclass(frozen=True)
class Nominal:
    """Nominal values that the source states about the lens; None: not stated."""

    efl_mm: float | None = None
    f_number: float | None = None
    full_field_deg: float | None = None
    image_circle_mm: float | None = None
    projection: str | None = None
    efl_x_mm: float | None = None  # in the x-z plane, for an anamorphic lens


@guarded
@dataclass(frozen=True, repr=False)
class Pupil(BriefRecord):
    """An image of the stop: z in the lens frame and diameter wide open, mm."""

    z: float
    diameter: float


@guarded
@dataclass(frozen=True, repr=False)
class FirstOrder(BriefRecord):
    """First-order properties at one wavelength.

    Lengths in mm. Points and pupils are z in the lens frame: z = 0 at the first vertex, +z toward
    the film. ``bfl`` runs from the last vertex to the rear focal point, ``ffl`` from the first
    vertex to the front focal point (usually negative). ``f_number`` is efl / entrance pupil
    diameter, wide open. ``pupil_magnification`` is exit pupil / entrance pupil, signed. Lenses with
    cylinders have two sections, y-z and x-z, each with its own data.
    """

    wavelength_nm: float
    efl: float
    bfl: float
    ffl: float
    f_number: float
    entrance_pupil: Pupil
    exit_pupil: Pupil
    front_focal_point: float
    back_focal_point: float
    front_principal_point: float
    back_principal_point: float
    front_nodal_point: float
    back_nodal_point: float
    pupil_magnification: float
    stop_semi_diameter: float


@guarded(init=True, but=("distance_m",))
@dataclass(frozen=True, repr=False, eq=False)
class Lens(Value):
    """A lens prescription, read and checked.

    Lens frame: mm, +z from object to film, z = 0 at the first vertex, R > 0 when the centre lies
    toward +z.

    Attributes:
        name: Name of the lens.
        source: File from which it was read; a lens of the library: its name there.
        patent: Patent or book that gives the prescription.
        note: Remarks in the file.
        nominal: Values that the source states: focal length, f-number, field.
        surfaces: Surfaces from the object side to the film.
        coating: Coating of surfaces between air and glass.
        data: The parsed file.
        configurations: Zoom and focus positions of the file.
        object_medium: Medium before the first surface.
        zoom_mm: Focal length to which a zoom is set; None: not a zoom.
        notes: Deviations from the file, such as members that are ignored or diameters that are cut.
        product: How the product of the design focuses, if the file says so.
    """

    name: str
    source: str
    patent: str | None
    note: str | None
    nominal: Nominal
    surfaces: tuple[LensSurface, ...]
    coating: str
    data: dict[str, Any]
    configurations: tuple[Configuration, ...]
    object_medium: Medium
    zoom_mm: float | None = None
    notes: tuple[str, ...] = ()
    product: Product | None = None

    def __post_init__(self) -> None:
        with reported(self.source):
            _ = self.prescription  # raises if the core rejects the lens
        self._check_stop()

    def _check_stop(self) -> None:
        """Raises an error if other surfaces have a size, and nothing gives the size of the stop."""
        i = stop_of(self.surfaces)
        size, f_number = self.surfaces[i].semi_diameter, self.nominal.f_number
        if size is None and all(s.semi_diameter is None for s in self.surfaces):
            return  # a prescription without diameters
        if (size is None or not math.isfinite(size)) and not f_number:
            raise LensError(
                f"{self.source}: surface {i}: semi_diameter: wanted the clear radius of the stop, "
                f"or nominal.f_number, got neither",
                "lens-no-stop",
                i,
            )

    @cached_property
    def prescription(self) -> _core.Prescription:
        """Prescription in the core, for tracing."""
        surfaces = [surface.core() for surface in self.surfaces]
        medium, f_number = self.object_medium.core, self.nominal.f_number or 0.0
        return _core.Prescription(self.name, surfaces, medium, self.coating, f_number)

    def first_order(
        self, wavelength_nm: float = DESIGN_WAVELENGTH_NM, section: Literal["x", "y"] = "y"
    ) -> FirstOrder:
        """Returns focal length, focal points, principal and nodal points, and pupils.

        Args:
            wavelength_nm: Wavelength, nm.
            section: Section of a lens with cylinders: ``y`` for y-z, ``x`` for x-z.

        Raises:
            InputError: The lens is afocal.
        """
        check_wavelength(np.asarray(wavelength_nm, np.float64))
        with reported(self.source):
            f = self.prescription.first_order(float(wavelength_nm), section)
        return FirstOrder(
            wavelength_nm=f.wavelength_nm,
            efl=f.efl,
            bfl=f.bfl,
            ffl=f.ffl,
            f_number=f.f_number,
            entrance_pupil=Pupil(f.entrance_pupil_z, f.entrance_pupil_diameter),
            exit_pupil=Pupil(f.exit_pupil_z, f.exit_pupil_diameter),
            front_focal_point=f.front_focal_z,
            back_focal_point=f.back_focal_z,
            front_principal_point=f.front_principal_z,
            back_principal_point=f.back_principal_z,
            front_nodal_point=f.front_nodal_z,
            back_nodal_point=f.back_nodal_z,
            pupil_magnification=f.pupil_magnification,
            stop_semi_diameter=f.stop_semi_diameter,
        )

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Axial position of each surface's vertex, mm, shape (surfaces,)."""
        return np.asarray(self.prescription.vertices(), np.float64)

    @property
    def image_z(self) -> float:
        """Position of the image plane, mm: after the table's last gap, else the paraxial focus."""
        last = self.surfaces[-1].thickness
        if last:
            return float(self.vertices[-1] + last)
        return self.first_order().back_focal_point

    def axial_transmittance(self, wavelength_nm: ArrayLike) -> NDArray[np.float64]:
        """Returns the transmittance of coatings and glass along the axis.

        Args:
            wavelength_nm: Wavelengths, nm, any shape.

        Returns:
            0 to 1, in the shape of the wavelengths; NaN where no ray passes along the axis.
        """
        nm = np.asarray(wavelength_nm, np.float64)
        check_wavelength(nm)
        flat = np.ascontiguousarray(nm.reshape(-1))
        start = np.tile([0.0, 0.0, -1.0], (flat.size, 1))
        along = np.tile([0.0, 0.0, 1.0], (flat.size, 1))
        *_, share, stopped = self.prescription.rays(start, along, flat, False)
        return np.where(np.asarray(stopped) < 0, share, np.nan).reshape(nm.shape)

    def t_stop(
        self, f_stop: float | None = None, wavelength_nm: ArrayLike = DESIGN_WAVELENGTH_NM
    ) -> float:
        """Returns the T-stop: the f-number of a lossless lens with the same axial brightness.

        Args:
            f_stop: F-stop of the iris; default: wide open.
            wavelength_nm: Wavelengths over which the transmittance is averaged, nm.

        Returns:
            ``f_stop / sqrt(transmittance)``.
        """
        stop = self.first_order().f_number if f_stop is None else f_stop
        return float(stop / np.sqrt(self.axial_transmittance(wavelength_nm).mean()))

    def rebuilt(self, surfaces: Sequence[LensSurface], **changes: object) -> Lens:
        """Returns the lens with other surfaces, and other fields changed."""
        with reported(self.source):
            return dataclasses.replace(self, surfaces=tuple(surfaces), **dict[str, Any](changes))

    def with_gaps(self, gaps: Mapping[int, float]) -> Lens:
        """Returns the lens with other thicknesses after some surfaces, by index, mm."""
        surfaces = list(self.surfaces)
        for i, gap in gaps.items():
            whole(i, "with_gaps: gaps: index of a surface", 0, len(surfaces) - 1)
            surfaces[i] = surfaces[i].replaced(thickness=gap)
        return self.rebuilt(surfaces)

    @property
    def squeeze(self) -> float:
        """Anamorphic squeeze: the ratio of the focal lengths, y to x; 1 for other lenses."""
        ratio = abs(self.first_order().efl / self.first_order(section="x").efl)
        return 1.0 if math.isclose(ratio, 1, rel_tol=1e-6) else ratio

    @cached_property
    def zoom_range_mm(self) -> tuple[float, float] | None:
        """Shortest and longest focal length; None: not a zoom."""
        return self._zoom().range_mm()

    def at_zoom(self, zoom_mm: float) -> Lens:
        """Returns the zoom at one focal length, focused at infinity; film and focus as in its file.

        Raises:
            LensError: The focal length is outside the lens's range; code ``lens-zoom``.
        """
        return self._zoom().at(zoom_mm)

    def _zoom(self) -> Zoom:
        """The lens as a zoom."""
        from .zoom import Zoom

        return Zoom(self)

    def focused(
        self,
        distance_m: float,
        *,
        zoom_mm: float | None = None,
        f_stop: float | None = None,
        by: By = "paraxial",
        measured_from: MeasuredFrom = "pupil",
    ) -> Focused:
        """Focuses the lens on a plane square to the axis; returns it with its film position.

        If the file has configurations for near objects, the gaps follow them and the film stays;
        else the whole lens moves. An anamorphic lens is focused halfway between its two sections.

        Args:
            distance_m: Distance of the plane, m; infinity is allowed.
            zoom_mm: Focal length of a zoom, mm; default: the current focal length.
            f_stop: F-stop of the rays for the best focus; default: wide open.
            by: ``paraxial``: the paraxial image; ``best``: the smallest RMS spot on the axis.
            measured_from: Start of the distance: ``pupil``, the centre of the entrance pupil, or
                ``sensor``.

        Raises:
            UsageError: Unknown ``by`` or ``measured_from``.
            LensError: The distance is too near (the message gives the nearest,
                ``lens-focus-near``), or the focal length is out of range (``lens-zoom``).
        """
        from .focus import focused

        return focused(self, LensSetting(f_stop, distance_m, zoom_mm, by, measured_from))

    def decentered(
        self,
        surfaces: tuple[int, int],
        shift: tuple[float, float] = (0.0, 0.0),
        tilt: tuple[float, float] = (0.0, 0.0),
        pivot_mm: float = 0.0,
    ) -> Lens:
        """Returns the lens with a group of surfaces moved off its axis.

        Args:
            surfaces: Indices of the first and the last surface of the group.
            shift: Shift along x and y, mm.
            tilt: Tilt about x, then y, degrees.
            pivot_mm: Pivot of the tilt on the lens's axis, from the group's first vertex, mm.

        Raises:
            InputError: The lens does not have these surfaces.
        """
        first, last = surfaces
        if not 0 <= first <= last < len(self.surfaces):
            raise InputError(
                f"{self.name}: decentered: wanted surfaces (first, last) within 0 .. "
                f"{len(self.surfaces) - 1}, got ({first}, {last})"
            )
        group = Group(first, last, (*shift, 0.0), (*tilt, 0.0), pivot_mm)
        return self.rebuilt(placed(self.surfaces, group))

    def trace(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        wavelength_nm: ArrayLike = DESIGN_WAVELENGTH_NM,
        *,
        clip: bool = False,
        image_z: float | None = None,
    ) -> NDArray[np.float64]:
        """Traces rays in double precision from the object side to the image plane.

        Args:
            origins: Points of the rays before the first surface, shape (N, 3) or (3,), mm.
            directions: Directions toward the film, shape (N, 3) or (3,); need not be unit.
            wavelength_nm: One wavelength, or shape (N,), nm.
            clip: Whether to stop rays outside the clear apertures and the stop.
            image_z: Plane on which rays end, z, mm; default: the lens's image plane.

        Returns:
            Points on the image plane, float64, shape (N, 3), mm; NaN where a ray misses a surface,
            is totally reflected, or (with ``clip``) is stopped.

        Raises:
            InputError: Shapes do not match, or values are not finite.
        """
        o, d = _rays(origins, directions)
        nm = np.asarray(wavelength_nm, np.float64)
        if nm.ndim > 1 or (nm.ndim == 1 and nm.shape[0] not in (1, o.shape[0])):
            raise InputError(
                f"{self.name}: trace: wavelength_nm: wanted one number or shape ({o.shape[0]},), "
                f"got shape {nm.shape}"
            )
        check_wavelength(nm)
        nm = np.ascontiguousarray(np.broadcast_to(nm, (o.shape[0],)))
        z = self.image_z if image_z is None else float(image_z)
        points, _ = self.prescription.trace(o, d, nm, z, clip)
        return np.asarray(points)

    def __repr__(self) -> str:
        """Prescription as a table."""
        return "\n".join([*_headline(self), *_table(self)])

    def _repr_svg_(self) -> str:
        from daguerre.plots.lens_section import draw

        return draw(self)

    def _repr_html_(self) -> str:
        """The section above name, focal length, f-number and source."""
        name, source = (html.escape(line) for line in _headline(self))
        caption = f"<figcaption>{name}<br>{source}</figcaption>"
        return f"<figure>{self._repr_svg_()}{caption}</figure>"


def _rays(
    origins: ArrayLike, directions: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    o = np.atleast_2d(np.asarray(origins, np.float64))
    d = np.atleast_2d(np.asarray(directions, np.float64))
    for name, rows in (("origins", o), ("directions", d)):
        if rows.ndim != 2 or rows.shape[1] != 3:
            raise InputError(f"trace: {name}: wanted shape (N, 3), got {rows.shape}")
        if not np.isfinite(rows).all():
            raise InputError(f"trace: {name}: wanted finite numbers, got NaN or infinity")
    count = max(len(o), len(d))
    if len(o) not in (1, count) or len(d) not in (1, count):
        raise InputError(f"trace: wanted as many directions as origins, got {len(d)} and {len(o)}")
    if (d == 0).all(axis=1).any():
        raise InputError("trace: directions: wanted non-zero vectors, got (0, 0, 0)")
    o = np.ascontiguousarray(np.broadcast_to(o, (count, 3)))
    d = np.ascontiguousarray(np.broadcast_to(d, (count, 3)))
    return o, d


def check_wavelength(nm: NDArray[np.float64]) -> None:
    """Checks that wavelengths lie within 200 to 2500 nm, where glasses have an index."""
    if not ((nm >= 200) & (nm <= 2500)).all():
        raise InputError(f"wavelength_nm: wanted 200 to 2500 nm, got {nm.min():g} .. {nm.max():g}")


def _headline(lens: Lens) -> list[str]:
    order = lens.first_order()
    facts = f"{order.efl:.2f} mm  f/{order.f_number:.2f}"
    return [f"{lens.name}  {facts}", f"source: {lens.patent or 'not named'}"]


def _table(lens: Lens) -> list[str]:
    wide = max(len("glass"), *(len(s.glass) for s in lens.surfaces))
    heads = f"{'radius':>10} {'thickness':>10} {'semi-diam.':>10}  {'glass':{wide}}  dispersion"
    rows = [f"{'':9} {heads}"]
    for i, s in enumerate(lens.surfaces):
        cells = [
            "plane" if s.radius is None else f"{s.radius:.3f}",
            "" if s.thickness is None else f"{s.thickness:.3f}",
            "" if s.semi_diameter is None else f"{s.semi_diameter:.3f}" + _mark(s),
        ]
        mark = "stop" if s.stop else ""
        numbers = " ".join(f"{cell:>10}" for cell in cells)
        rows.append(f"{i:3} {mark:5} {numbers}  {s.glass:{wide}}  {s.dispersion or ''}".rstrip())
    if any(s.derived for s in lens.surfaces):
        rows.append("* not stated by the source; derived from rays")
    if any(s.widened_from for s in lens.surfaces):
        rows.append("+ wider than in the source, which blocks light of the corner")
    if any(s.fitted for s in lens.surfaces):
        rows.append("~ a mount, fitted to measured vignetting of the product")
    return rows


def _mark(surface: LensSurface) -> str:
    """Mark of a semi-diameter that is not the source's."""
    return "*" * surface.derived + "+" * bool(surface.widened_from) + "~" * surface.fitted
