"""Converts the surfaces of an imported file to a lens file's table: frames, dummies, positions.

Other programs chain local frames: each surface may move the frame before and after it, and its
thickness runs along the frame's own z. The lens file has one straight axis, and each surface may
be decentred and tilted about it. So each frame becomes a position on the axis, a decentre and a
tilt, which is exact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from daguerre.lenses.errors import LensError
from daguerre.lenses.groups import angles

Frame = NDArray[np.float64]
#: Objects farther away than this (mm) are at infinity: files write 1e10 for infinity.
FAR = 1e9
MAX_SURFACES = 1000


@dataclass
class Draft:
    """One surface as the imported file has it, in mm.

    Attributes:
        number: Number of the surface in the file.
        clips: Whether a plane in air is kept because its aperture stops light.
        before: Move of the frame before the surface; 4 x 4.
        after: Move of the frame after the surface; 4 x 4.
    """

    number: int
    thickness: float = 0.0
    curvature: float = 0.0
    conic: float = 0.0
    asphere: dict[int, float] = field(default_factory=dict)
    form: str = "conic"
    curvature_x: float = 0.0
    conic_x: float = 0.0
    glass: dict[str, Any] | None = None
    semi_diameter: float | None = None
    inner: float = 0.0
    after_semi_diameter: float | None = None
    stop: bool = False
    clips: bool = False
    before: Frame | None = None
    after: Frame | None = None


class SurfacePose(NamedTuple):
    """Decentre and tilt of a surface, as in the lens file.

    Attributes:
        decenter: Decentre along x, y and z, mm.
        tilt: Angles about x, the new y and the new z, degrees.
    """

    decenter: list[float]
    tilt: list[float]


@dataclass(frozen=True)
class Table:
    """The surfaces that are kept, at one configuration.

    Attributes:
        drafts: Surfaces that refract, stop light, or are the stop.
        gaps: Thickness after each surface, mm.
        places: Decentre and tilt of each surface; None: on the axis.
        object_distance: Distance from the object to the first surface, mm.
        film: Decentre and tilt of the film; None: square to the axis.
    """

    drafts: list[Draft]
    gaps: list[float]
    places: list[SurfacePose | None]
    object_distance: float
    film: SurfacePose | None


def moved(decenter: list[float], tilt: list[float], tilt_first: bool = False) -> Frame:
    """Transform that shifts (mm), then turns (degrees, right-handed) about x, the new y, the new z.

    With ``tilt_first`` it turns about z, y, x and then shifts, which undoes a move with numbers of
    the opposite sign.
    """
    shift, turn = np.eye(4), np.eye(4)
    shift[:3, 3] = decenter
    x, y, z = (_turn(axis, angle) for axis, angle in enumerate(tilt))
    turn[:3, :3] = z @ y @ x if tilt_first else x @ y @ z
    return turn @ shift if tilt_first else shift @ turn


def _turn(axis: int, degrees: float) -> Frame:
    a = math.radians(degrees)
    out = np.eye(3)
    i, j = [k for k in range(3) if k != axis]
    out[i, i] = out[j, j] = math.cos(a)
    sign = -1 if axis == 1 else 1
    out[i, j], out[j, i] = -sign * math.sin(a), sign * math.sin(a)
    return out


def undone(frame: Frame) -> Frame:
    """Inverse of a move."""
    return np.asarray(np.linalg.inv(frame), np.float64)


def lay_out(drafts: list[Draft], file: str) -> Table:
    """Lays out the table of one configuration; the first draft is the object, the last the image.

    Dummy surfaces are left out and their thicknesses joined.
    """
    if len(drafts) - 2 > MAX_SURFACES:
        raise LensError(
            f"{file}: surfaces: wanted at most {MAX_SURFACES}, got {len(drafts) - 2}",
            "lens-format",
        )
    frame = np.eye(4)
    kept: list[tuple[Draft, Frame, float]] = []
    run = [0.0]  # thicknesses since the last surface that was kept
    straight = True  # whether the frame has moved only along z since then
    gaps: list[float] = []
    glass = drafts[0].glass
    ahead = drafts[0].thickness
    for draft in drafts[1:]:
        if draft.before is not None:
            frame = frame @ draft.before
            straight = False
        last = draft is drafts[-1]
        if last or draft.glass != glass or draft.stop or draft.clips:
            if kept:
                z = frame[2, 3] - kept[-1][1][2, 3]
                gaps.append(math.fsum(run) if straight else float(z))
            else:
                ahead += float(frame[2, 3])
            if not last:
                kept.append((draft, frame.copy(), 0.0))
                run, straight, glass = [0.0], True, draft.glass
        if draft.after is not None:
            frame = frame @ draft.after
            straight = False
        run.append(draft.thickness)
        straight = straight and bool(np.array_equal(frame[:3, 2], (0, 0, 1)))
        frame = frame @ moved([0, 0, draft.thickness], [0, 0, 0])
        if not np.isfinite(frame).all():
            raise LensError(
                f"{file}: surface {draft.number}: wanted a finite position, got {frame[2, 3]:g}",
                "lens-format",
                draft.number,
            )
    if not kept:
        raise LensError(f"{file}: surfaces: none of them refracts", "lens-afocal")
    places = [_place(pose) for _, pose, _ in kept]
    return Table([d for d, _, _ in kept], gaps, places, ahead, _place(frame))


def _place(frame: Frame) -> SurfacePose | None:
    """Decentre and tilt of a frame; None: on the axis."""
    shift = [float(frame[0, 3]), float(frame[1, 3]), 0.0]
    tilt = list(angles(frame[:3, :3]))
    shift = [0.0 if abs(v) < 1e-12 else v for v in shift]
    tilt = [0.0 if abs(v) < 1e-12 else v for v in tilt]
    return SurfacePose(shift, tilt) if any(shift) or any(tilt) else None


def surface(draft: Draft, gap: float, place: SurfacePose | None) -> Any:
    """Converts a draft to a surface of the lens file."""
    flat = draft.form == "conic" and draft.curvature == 0 and not any(draft.asphere.values())
    aspheric = draft.conic != 0 or any(draft.asphere.values())
    kind = draft.form if draft.form != "conic" else "aspheric" if aspheric else "spherical"
    out: dict[str, Any] = {
        "kind": "stop" if draft.stop and flat else kind,
        "radius": _radius(draft.curvature),
        "thickness": gap,
        "semi_diameter": draft.semi_diameter,
        "glass": draft.glass,
        "from": draft.number,
    }
    if draft.stop and not flat:
        out["stop"] = True
    if draft.conic:
        out["conic"] = draft.conic
    if any(draft.asphere.values()):
        out["asphere"] = {f"a{p}": a for p, a in sorted(draft.asphere.items()) if a}
    if draft.form != "conic":
        out |= {"radius_x": _radius(draft.curvature_x), "conic_x": draft.conic_x}
    if draft.inner:
        out["inner_semi_diameter"] = draft.inner
    if draft.after_semi_diameter:
        out["semi_diameter_after"] = draft.after_semi_diameter
    if place is not None:
        out |= {"decenter": place.decenter, "tilt": place.tilt}
    return out


def _radius(curvature: float) -> float | None:
    return None if curvature == 0 else 1 / curvature


def with_thicknesses(drafts: list[Draft], thicknesses: dict[int, float]) -> list[Draft]:
    """Replaces thicknesses of drafts, by the surface's number in the file."""
    return [
        replace(d, thickness=thicknesses[d.number]) if d.number in thicknesses else d
        for d in drafts
    ]
