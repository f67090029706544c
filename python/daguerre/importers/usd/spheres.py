"""Reads points as spheres: instances of a ball, scaled to each width."""

from __future__ import annotations

import numpy as np
from pxr import UsdGeom

from daguerre.files.notes import Notes
from daguerre.motion.values import Dynamic, Keys
from daguerre.motion.values import at as value_at
from daguerre.scene.over_time.crowds import Crowd
from daguerre.scene.over_time.points import Ballistic
from daguerre.scene.over_time.surfaces import Array, Primvar
from daguerre.scene.scene import Scene

from .bindings import Bindings
from .instancers import Copies
from .placing import Placing, Spots, times
from .points import read_points
from .prims import Visit
from .primvars import as_rows, note_length
from .shapes import ball
from .values import Clock

#: Largest number of moving points; each is an instance with a motion.
_MAX_MOVING = 200_000


def read_widths(
    schema: UsdGeom.PointBased, count: int, clock: Clock, notes: Notes
) -> Primvar | None:
    """Reads the widths of points or curves; None if there are none that can be used."""
    api = UsdGeom.PrimvarsAPI(schema.GetPrim())
    primvar = api.GetPrimvar("widths")
    if primvar and primvar.HasValue():
        rows = as_rows(primvar.ComputeFlattened(clock.code), 1)
        kind = str(primvar.GetInterpolation())
    else:
        value = schema.GetWidthsAttr().Get(clock.code)
        rows = None if value is None else as_rows(value, 1)
        kind = str(schema.GetWidthsInterpolation())
    if rows is None or not len(rows):
        return None
    if schema.GetWidthsAttr().ValueMightBeTimeVarying():
        notes.add("widths that change over time stay as at the scene's time")
    if len(rows) == 1:
        kind = "constant"
    if kind == "vertex" and len(rows) != count:
        note_length("widths", notes)
        return None
    return Primvar(np.abs(rows), kind)


def read_spheres(
    visit: Visit,
    spots: Spots,
    scene: Scene,
    bindings: Bindings,
    placing: Placing,
    notes: Notes,
) -> None:
    """Adds the points of a prim at its places.

    Raises:
        InputError: Points are not finite, or there are too many.
    """
    schema, clock = UsdGeom.Points(visit.prim), bindings.clock
    points = read_points(schema, clock, notes)
    crowd = _crowd(points, clock.time, _radii(schema, value_at(points, clock.time), clock, notes))
    if not len(crowd.scales[0]):
        return
    solid = ball(1.0)
    assert solid is not None
    placing.check(len(crowd.scales[0]) * len(spots), visit.path)
    mesh = scene.add_mesh(
        solid.positions, solid.triangles, solid.normals, solid.uv, name=visit.path
    )
    now = crowd.at(clock.time)
    moves = crowd.moves or spots.moving is not None
    if moves and len(now) * len(spots) > _MAX_MOVING:
        notes.add("too many moving points: they rest")
        moves = False
    for material, chosen in bindings.colors(visit.prim, len(now)):
        chosen = chosen[crowd.scales[0, chosen, 0] > 0]
        moving = crowd.of(chosen) if moves and crowd.moves else None
        copies = Copies(visit.prim, now[chosen], moving)
        outer = spots if moves else Spots(spots.still)
        places = times(outer, copies, np.eye(4), spots.name, clock.time)
        placing.add(mesh, material, places, visit.name, visit.shown)


def _radii(schema: object, points: Array, clock: Clock, notes: Notes) -> Array:
    """Radius of each point, shape (N,)."""
    widths = read_widths(schema, len(points), clock, notes)
    if widths is not None and widths.interpolation != "constant" and len(widths) != len(points):
        note_length("widths", notes)
        widths = None
    if widths is None:
        notes.add("points without widths have a width of 1")
        return np.full(len(points), 0.5, np.float32)
    rows = 0.5 * widths.flat[:, 0]
    return np.repeat(rows[:1], len(points)) if widths.interpolation == "constant" else rows


def _crowd(points: Array | Dynamic, time: float, radii: Array) -> Crowd:
    """Unit balls that are scaled and moved to points, constant or over time."""
    velocities = accelerations = None
    if isinstance(points, Ballistic):
        moments, places = points.times, np.array(points.points, np.float64)
        velocities = np.array(points.velocities, np.float64)
        if points.accelerations is not None:
            accelerations = np.array(points.accelerations, np.float64)
    elif isinstance(points, Keys):
        moments, places = points.times, np.array(points.values, np.float64)
    else:
        moments, places = np.array([time]), np.array([points], np.float64)
    shape = places.shape[:2]
    turns = np.broadcast_to((0.0, 0.0, 0.0, 1.0), (*shape, 4))
    scales = np.broadcast_to(radii.astype(np.float64)[:, None], (*shape, 3))
    held = isinstance(points, Keys) and points.interpolation == "step"
    return Crowd(moments, places, turns, scales, velocities, accelerations, held=held)
