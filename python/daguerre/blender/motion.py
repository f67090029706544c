"""Motion while the shutter is open, from the scene at sub-frames; only of moving objects.

Each moment is read once. Matrices and points with the same bits at all moments as at the scene's
frame do not move, and take no memory.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.camera import Camera
from daguerre.camera.shutter import interval
from daguerre.files.notes import Notes, Silence

from .arrays import points_of
from .camera_panel import CameraPanel
from .film import resolution_of
from .frames import seconds_per_frame
from .meshes import Steps
from .objects import Identity, Seen, walk
from .shutters import shutter_of

if TYPE_CHECKING:
    import bpy


#: Goes to a frame and a fraction: ``Scene.frame_set`` or ``RenderEngine.frame_set``.
FrameSet = Callable[[int, float], None]
#: Reads further values of an object that change, such as of a light; None: no values.
Probe = Callable[[Seen], Any]
#: The shutter's parts are 2 to the power of the steps of an object; Blender allows up to 7 steps.
USUAL_STEPS, MOST_STEPS = 1, 7
_SHAPES = ("MESH", "CURVES")


def exposure_of(
    scene: bpy.types.Scene, camera: bpy.types.Object | None
) -> tuple[float, float] | None:
    """When a camera's exposure begins and ends, s from the frame; None: it freezes motion.

    Args:
        scene: ``bpy.types.Scene``.
        camera: Camera object; its panel takes precedence over Blender's shutter. None: Blender's
            shutter counts.
    """
    panel = CameraPanel(None if camera is None else camera.data)
    shutter = Camera(**shutter_of(scene.render, panel, Silence()))
    begin, end = interval(shutter, 0.0, resolution_of(scene.render))
    return (begin, end) if end > begin else None


@contextmanager
def moments(
    scene: bpy.types.Scene, frame_set: FrameSet | None
) -> Iterator[Callable[[float], None]]:
    """Goes to moments of a scene, s from its frame, and restores the frame.

    Args:
        scene: ``bpy.types.Scene``.
        frame_set: Goes to a frame; default: the scene does.
    """

    def of_scene(frame: int, part: float) -> None:
        scene.frame_set(frame, subframe=part)

    go = frame_set or of_scene
    frame, part = scene.frame_current, scene.frame_subframe

    def to(offset: float) -> None:
        place = frame + part + offset / seconds_per_frame(scene)
        go(int(np.floor(place)), float(place - np.floor(place)))

    try:
        yield to
    finally:
        go(frame, part)


@dataclass(frozen=True)
class Blur:
    """Settings of an object.

    Attributes:
        parts: Equal parts of the shutter's time; 0: the object rests.
        deforms: Whether its points may move, too.
    """

    parts: int
    deforms: bool


def blur_of(thing: bpy.types.Object) -> Blur:
    """Cycles' settings of an object, which it has if that add-on is there."""
    given = getattr(thing.original, "cycles", None)  # a script's changes do not reach the copy
    if given is None:
        return Blur(1 << USUAL_STEPS, True)
    if not given.use_motion_blur:
        return Blur(0, False)
    steps = min(max(int(given.motion_steps), 1), MOST_STEPS)
    return Blur(1 << steps, bool(given.use_deform_motion))


@dataclass
class Snapshot:
    """Things that the scene shows at one moment.

    Attributes:
        matrices: World from object, by thing.
        points: Points, by the first thing that has them; in Blender's memory there is one array
            for all copies.
        blurs: Settings, by thing.
        probed: Findings of the probe, by thing.
    """

    matrices: dict[Identity, NDArray[np.float64]] = field(default_factory=dict)
    points: dict[Identity, NDArray[np.float32]] = field(default_factory=dict)
    blurs: dict[Identity, Blur] = field(default_factory=dict)
    probed: dict[Identity, Any] = field(default_factory=dict)


def look(
    depsgraph: bpy.types.Depsgraph, probe: Probe, wanted: set[Identity] | None = None
) -> Snapshot:
    """Looks at a scene; points only of ``wanted`` things, if given."""
    found, pointers = Snapshot(), set()
    for seen in walk(depsgraph):
        key = seen.identity
        found.matrices[key] = seen.matrix
        found.blurs[key] = blur_of(seen.object)
        probed = probe(seen)
        if probed is not None:
            found.probed[key] = probed
        if seen.object.type not in _SHAPES or not found.blurs[key].deforms:
            continue
        pointer = seen.object.data.as_pointer()
        if key in wanted if wanted is not None else pointer not in pointers:
            pointers.add(pointer)
            found.points[key] = points_of(seen.object.data)
    return found


@dataclass(frozen=True)
class Motion:
    """Motion while the shutter is open.

    Attributes:
        matrices: Keys (time in s, world from object in Blender's frame), by thing.
        points: Times in s and points, by the first thing that has them.
        probed: Pairs (time in s, finding of the probe), by thing.
    """

    matrices: Mapping[Identity, list[tuple[float, NDArray[np.float64]]]] = field(
        default_factory=dict
    )
    points: Mapping[Identity, Steps] = field(default_factory=dict)
    probed: Mapping[Identity, list[tuple[float, Any]]] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.matrices or self.points or self.probed)


def motion_of(
    depsgraph: bpy.types.Depsgraph,
    shutter: tuple[float, float],
    time: float,
    probe: Probe,
    notes: Notes,
    frame_set: FrameSet | None = None,
) -> Motion:
    """Finds moving objects; the frame is the same afterwards.

    Args:
        depsgraph: Evaluated ``bpy.types.Depsgraph``.
        shutter: When the shutter opens and closes, s from the frame.
        time: Time of the frame, s.
        probe: Reads further values that may change.
        notes: Receives notes on motion that is left out.
        frame_set: Goes to a frame; default: the scene does.
    """
    now = look(depsgraph, probe)
    parts = max((blur.parts for blur in now.blurs.values()), default=0)
    if not parts:
        return Motion()
    offsets = np.linspace(*shutter, parts + 1)
    offsets[np.abs(offsets) < 1e-12] = 0
    wanted = set(now.points)
    looks = []
    with moments(depsgraph.scene, frame_set) as go:
        for offset in offsets:
            if offset == 0:
                looks.append(now)
                continue
            go(float(offset))
            looks.append(_thinned(look(depsgraph, probe, wanted), now))
    return _collected(now, looks, (offsets + time).tolist(), notes)


def _thinned(seen: Snapshot, now: Snapshot) -> Snapshot:
    """Shares arrays with the same bits as at the frame."""
    for mine, base in ((seen.matrices, now.matrices), (seen.points, now.points)):
        _share(mine, base)
    return seen


def _share(mine: dict[Identity, Any], base: Mapping[Identity, Any]) -> None:
    for key, value in mine.items():
        other = base.get(key)
        if other is not None and np.array_equal(value, other):
            mine[key] = other


def _collected(
    now: Snapshot, looks: Sequence[Snapshot], times: list[float], notes: Notes
) -> Motion:
    """Values over time of all things that change."""
    matrices, points, probed = {}, {}, {}
    for key, blur in now.blurs.items():
        if not blur.parts:
            continue
        stride = (len(looks) - 1) // blur.parts
        mine, at = looks[::stride], times[::stride]
        places = [one.matrices.get(key) for one in mine]
        if any(place is None for place in places):
            notes.add(
                "an object that appears or disappears while the shutter is open is drawn without "
                "motion"
            )
            continue
        if any(place is not now.matrices[key] for place in places):
            matrices[key] = [(t, place) for t, place in zip(at, places, strict=True)]
        steps = _steps([one.points.get(key) for one in mine], now.points.get(key), at, notes)
        if steps is not None:
            points[key] = steps
        if key in now.probed:
            probed[key] = [(t, one.probed.get(key)) for t, one in zip(at, mine, strict=True)]
    return Motion(matrices, points, probed)  # type: ignore[arg-type]  # no place is None


def _steps(
    shapes: Sequence[Any], base: NDArray[np.float32] | None, times: list[float], notes: Notes
) -> Steps | None:
    """Points over time; None: they do not change, or become more or fewer."""
    if base is None or all(shape is base for shape in shapes):
        return None
    if any(shape is None or shape.shape != base.shape for shape in shapes):
        notes.add(
            "a mesh that gains or loses vertices while the shutter is open is drawn without motion"
        )
        return None
    return Steps(times, np.stack(shapes))
