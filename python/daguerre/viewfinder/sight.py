"""Sight: distances of visible surfaces along chief rays of the camera."""

from __future__ import annotations

import math
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.camera import Camera
from daguerre.rendering.session import Session
from daguerre.setup.apparent import around_frame, behind_window
from daguerre.setup.near_clip import Directions, directions_of, view_begins
from daguerre.setup.resolved import ResolvedLens

#: View directions of sessions, which take a while to set up.
_directions: WeakKeyDictionary[Session, Directions] = WeakKeyDictionary()


def ring_offset_m(session: Session) -> float:
    """Distance from the entrance pupil back to where the camera measures its focus, m."""
    return offset_m(session.camera, session.prepared.setup.lens)


def offset_m(camera: Camera, lens: ResolvedLens) -> float:
    """``ring_offset_m`` of a camera and its lens."""
    if camera.focus_from != "sensor":
        return 0.0
    return 1e-3 * (lens.entrance_pupil_offset_mm or lens.pinhole_focal_length_mm)


def distance_at(session: Session, x: float, y: float) -> float:
    """Distance at which the focus ring makes a point sharp, m; infinite: nothing is there.

    Args:
        session: Session with a camera that sees the point.
        x: Pixel of its picture, from the left.
        y: Pixel of its picture, from the top.
    """
    setup = session.prepared.setup
    (width, height), size = setup.resolution, setup.frame_size_mm
    film_x = (x / width - 0.5) * size[0] + setup.shift_mm[0]
    film_y = (0.5 - y / height) * size[1] + setup.shift_mm[1]
    return depth_m(session, _seen_by(session)(film_x, film_y)) + ring_offset_m(session)


def depth_m(session: Session, toward: NDArray[np.float64]) -> float:
    """Depth of the surface that a ray from the pupil meets, m; infinite: it meets none.

    Behind a window that fills the picture, this is the apparent depth.

    Args:
        session: Session of the camera.
        toward: Unit direction in the camera's frame.
    """
    setup = session.prepared.setup
    pose = setup.world_from_camera
    directions, frame = _seen_by(session), setup.frame_size_mm
    start = view_begins(setup.camera, directions, frame, toward)
    around = around_frame(directions, frame, setup.shift_mm)
    behind = behind_window(session.built.core, pose, toward, around, start)
    if behind is not None:
        return behind.apparent_m * -float(toward[2])
    hit = session.built.core.first_hit(tuple(pose[:3, 3]), tuple(pose[:3, :3] @ toward), start)
    depth = math.inf if hit is None else float(hit[0]) * -float(toward[2])
    return depth if depth > 0 else math.inf


def depths_m(session: Session) -> NDArray[np.float64]:
    """Depth that each pixel's chief ray meets, m, (H, W); infinite: it meets nothing."""
    planes = session.ground_truth.planes(motion=False)
    met = planes["object_id"] > 0
    return np.where(met, planes["depth.Z"], np.inf).astype(np.float64)


def _seen_by(session: Session) -> Directions:
    if session not in _directions:
        _directions[session] = directions_of(session.prepared.setup.core)
    return _directions[session]
