"""From the surfaces of a foreign file to a lens file's table: frames, dummies, configurations.

A foreign file chains local frames: each surface may move the frame before it, and after it, and its
thickness runs along the frame's own z. The lens file has one straight axis, and each surface may
stand off it; so a frame becomes a place on the axis, a decentre and a tilt, which is exact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.lenses.errors import LensError
from daguerre.lenses.groups import angles

Frame = NDArray[np.float64]
#: Objects farther away than this (mm) are at infinity: files write 1e10 for it.
FAR = 1e9
MAX_SURFACES = 1000


@dataclass
class Draft:
    """One surface as the foreign file has it, in mm.

    Attributes:
        number: By the file's own count.
        clips: A plane of air that stays, because its aperture stops light.
        before: Moves the frame, before the surface; 4 x 4.
        after: Moves the frame, after the surface.
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


@dataclass(frozen=True)
class Table:
    """The surfaces that matter, at one configuration.

    Attributes:
        drafts: Those that refract, stop light, or are the stop.
        gaps: After each, mm.
        places: Decentre and tilt of each; None: on the axis.
        object_distance: From the object to the first of them, mm.
        film: Decentre and tilt of the film; None: across the axis.
    """

    drafts: list[Draft]
    gaps: list[float]
    places: list[tuple[list[float], list[float]] | None]
    object_distance: float
    film: tuple[list[float], list[float]] | None


def moved(decenter: list[float], tilt: list[float], tilt_first: bool = False) -> Frame:
    """A frame moved (mm) and turned (degrees, right-handed) about x, the new y, the new z.

    With ``tilt_first`` it is turned about z, y, x and then moved, which undoes a move whose
    numbers have the other sign.
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
    """The move that takes a frame back."""
    return np.asarray(np.linalg.inv(frame), np.float64)


def lay_out(drafts: list[Draft], file: str) -> Table:
    """The table of one configuration; the first draft is the object, the last the image."""
    if len(drafts) - 2 > MAX_SURFACES:
        raise LensError(
            f"{file}: surfaces: wanted at most {MAX_SURFACES}, got {len(drafts) - 2}",
            "lens-format",
        )
    frame = np.eye(4)
    kept: list[tuple[Draft, Frame, float]] = []
    run = [0.0]  # thicknesses since the last surface that was kept
    straight = True  # and whether the frame only moved along z since
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
                f"{file}: surface {draft.number}: wanted a place within reach, got {frame[2, 3]:g}",
                "lens-format",
                draft.number,
            )
    if not kept:
        raise LensError(f"{file}: surfaces: wanted at least one that refracts", "lens-afocal")
    places = [_place(pose) for _, pose, _ in kept]
    return Table([d for d, _, _ in kept], gaps, places, ahead, _place(frame))


def _place(frame: Frame) -> tuple[list[float], list[float]] | None:
    """Decentre (mm) and tilt (degrees, as in the lens file) of a frame; None: on the axis."""
    shift = [float(frame[0, 3]), float(frame[1, 3]), 0.0]
    tilt = list(angles(frame[:3, :3]))
    shift = [0.0 if abs(v) < 1e-12 else v for v in shift]
    tilt = [0.0 if abs(v) < 1e-12 else v for v in tilt]
    return (shift, tilt) if any(shift) or any(tilt) else None


def surface(draft: Draft, gap: float, place: tuple[list[float], list[float]] | None) -> Any:
    """The lens file's surface of a draft."""
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
        out |= {"decenter": place[0], "tilt": place[1]}
    return out


def _radius(curvature: float) -> float | None:
    return None if curvature == 0 else 1 / curvature


def with_thicknesses(drafts: list[Draft], thicknesses: dict[int, float]) -> list[Draft]:
    """The drafts with other thicknesses, by the file's number of the surface."""
    return [
        replace(d, thickness=thicknesses[d.number]) if d.number in thicknesses else d
        for d in drafts
    ]
