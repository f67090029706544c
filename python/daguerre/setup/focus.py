"""Focus distance: given, measured along a ray, or the distance of a node."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera.camera import Camera
from daguerre.errors import InputError, UsageError
from daguerre.files.value import BriefRecord
from daguerre.scene.framing import bounds, is_framed
from daguerre.scene.node_names import find_node, no_node
from daguerre.scene.scene import Scene

from .apparent import Behind, around_frame, behind_window
from .near_clip import Directions, view_begins

_VERTICES_AT_ONCE = 1 << 18
_ROUNDS = 4

#: focus distance (m) at which a point of the camera's frame (m) is sharp
SharpAt = Callable[[NDArray[np.float64]], float]


@dataclass(frozen=True)
class Sharp:
    """A resolved focus.

    Attributes:
        distance_m: Distance from the entrance pupil along the axis; may be infinite.
        notes: How it was found, unless it was stated.
    """

    distance_m: float
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, repr=False)
class Focus(BriefRecord):
    """Finds the focus distance.

    Attributes:
        scene: Scene, for ``focus_on``.
        camera: Camera with its focus parameters.
        resolution: Width and height of the picture, px.
        frame_mm: Width and height of the picture on the film, without overscan.
        world: World from camera, m, shape (4, 4).
        core_scene: Scene for autofocus; None: it gives infinity.
        sharp_at: Function for the focus distance of a tilted lens for a point; None: the focus
            distance is the point's depth.
    """

    scene: Scene
    camera: Camera
    resolution: tuple[int, int]
    frame_mm: tuple[float, float]
    world: NDArray[np.float64]
    core_scene: _core.Scene | None
    sharp_at: SharpAt | None = None

    def distance(self, direction_of: Directions) -> Sharp:
        """Finds the focus distance, given the view directions of film points."""
        camera = self.camera
        if (
            camera.focus_at is None
            and camera.focus_on is None
            and camera.focus_distance is not None
        ):
            return Sharp(camera.focus_distance)
        if camera.focus_on is not None:
            return self._on_node(camera.focus_on)
        x, y = camera.focus_at or (self.resolution[0] / 2, self.resolution[1] / 2)
        if not (0 <= x <= self.resolution[0] and 0 <= y <= self.resolution[1]):
            raise UsageError(
                f"camera: focus_at: wanted a pixel within {self.resolution[0]} x "
                f"{self.resolution[1]}, got {x:g},{y:g}"
            )
        film_x = (x / self.resolution[0] - 0.5) * self.frame_mm[0] + camera.shift[0]
        film_y = (0.5 - y / self.resolution[1]) * self.frame_mm[1] + camera.shift[1]
        what = f"pixel {x:g},{y:g}" if camera.focus_at else "centre ray"
        direction = direction_of(film_x, film_y)
        start = view_begins(camera, direction_of, self.frame_mm, direction)
        around = around_frame(direction_of, self.frame_mm, camera.shift)
        return self._along(direction, around, start, what)

    def settled(self, direction_at: Callable[[float], Directions]) -> Sharp:
        """Finds the focus of a tilted lens, where view directions depend on the focus.

        Args:
            direction_at: View directions of film points, given a focus distance in m.
        """
        found = self.distance(direction_at(math.inf))
        if self.sharp_at is not None:
            for _ in range(_ROUNDS):
                found = self.distance(direction_at(found.distance_m))
        return found

    def _along(
        self, direction: NDArray[np.float64], around: NDArray[np.float64], start: float, what: str
    ) -> Sharp:
        hit = None
        if self.core_scene is not None:
            behind = behind_window(self.core_scene, self.world, direction, around, start)
            if behind is not None:
                return self._behind(direction, behind, what)
            origin = tuple(self.world[:3, 3])
            toward = tuple(self.world[:3, :3] @ direction)
            hit = self.core_scene.first_hit(origin, toward, start)
        if hit is None:
            return self._unmet(what)
        depth = float(hit[0]) * -float(direction[2])
        if not depth > 0:  # the camera stands in a surface
            note = f"autofocus: {what} begins on a surface; focus at infinity"
            return Sharp(math.inf, (note,))
        distance = depth if self.sharp_at is None else self.sharp_at(float(hit[0]) * direction)
        return Sharp(distance, (f"autofocus: {what} meets a surface {depth:.4g} m away",))

    def _behind(self, direction: NDArray[np.float64], behind: Behind, what: str) -> Sharp:
        """Focus on a surface behind a window, at its apparent distance."""
        if math.isinf(behind.apparent_m):
            return Sharp(math.inf, (f"autofocus: {what} meets nothing behind clear glass",))
        place = behind.apparent_m * direction
        depth = -float(place[2])
        distance = depth if self.sharp_at is None else self.sharp_at(place)
        note = f"autofocus: {what} meets a surface {behind.path_m:.4g} m away behind clear glass"
        return Sharp(distance, (f"{note}, which appears {depth:.4g} m away",))

    def _unmet(self, what: str) -> Sharp:
        """Focus of a ray that meets nothing: infinity, or the scene, if its file has no camera."""
        found = bounds(self.scene) if is_framed(self.scene) else None
        if found is not None:
            middle = (found[0] + found[1]) / 2 - self.world[:3, 3]
            depth = float(middle @ -self.world[:3, 2])
            if depth > 0:
                local = self.world[:3, :3].T @ middle
                distance = depth if self.sharp_at is None else self.sharp_at(local)
                note = f"autofocus: {what} meets nothing; focus on the middle of the scene"
                return Sharp(distance, (f"{note}, {depth:.4g} m away",))
        return Sharp(math.inf, (f"autofocus: {what} meets nothing; focus at infinity",))

    def _on_node(self, name: str) -> Sharp:
        """Depth of the visible surface at the middle of the node, else of its nearest vertex."""
        scene = self.scene
        known = set(scene.node_positions) | set(scene.nodes)
        found = find_node(name, known)
        if found is None:
            raise InputError(f"camera: focus_on: {no_node(name, known)}")
        name = found
        instances = [i for i in scene.nodes.get(name, []) if scene.instances[i].shown]
        eye, axis = self.world[:3, 3], -self.world[:3, 2]
        if not instances:
            place = scene.node_positions.get(name)
            if place is None:
                raise InputError(f"camera: focus_on: node {name!r} is hidden at {scene.time:g} s")
            return self._in_front(name, float((place - eye) @ axis), "", place - eye)
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        nearest, farthest = math.inf, -math.inf
        vertex = eye
        for points in _world_vertices(scene, instances):
            low, high = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
            depths = (points - eye) @ axis
            ahead = np.where(depths > 0, depths, math.inf)
            if ahead.min() < nearest:
                nearest, vertex = float(ahead.min()), points[ahead.argmin()]
            farthest = max(farthest, float(depths.max()))
        middle = (low + high) / 2 - eye
        if self.core_scene is not None and middle @ axis > 0:
            hit = self.core_scene.first_hit(tuple(eye), tuple(middle))
            if hit is not None and hit[1] in instances:
                depth = hit[0] * float(middle @ axis) / float(np.linalg.norm(middle))
                place = hit[0] / float(np.linalg.norm(middle)) * middle
                return self._in_front(name, depth, "the visible middle of", place)
        depth = nearest if nearest < math.inf else farthest
        return self._in_front(name, depth, "the nearest vertex of", vertex - eye)

    def _in_front(self, name: str, depth: float, part: str, from_eye: NDArray[np.float64]) -> Sharp:
        if not depth > 0:
            raise InputError(
                f"camera: focus_on: node {name!r} is behind the camera ({depth:.4g} m)"
            )
        distance = (
            depth if self.sharp_at is None else self.sharp_at(self.world[:3, :3].T @ from_eye)
        )
        what = f"{part} node {name!r}".lstrip()
        return Sharp(distance, (f"focus: {what} is {depth:.4g} m away",))


def _world_vertices(scene: Scene, instances: list[int]) -> Iterator[NDArray[np.float64]]:
    """Yields vertices of instances, shape (N, 3), m, in pieces that fit into memory."""
    by_mesh: dict[int, list[int]] = {}
    for i in instances:
        by_mesh.setdefault(scene.instances[i].mesh, []).append(i)
    for mesh, users in by_mesh.items():
        points = scene.meshes[mesh].points
        at_once = max(1, _VERTICES_AT_ONCE // max(1, len(points)))
        for start in range(0, len(users), at_once):
            piece = np.array([scene.instances[i].transform for i in users[start : start + at_once]])
            world = points @ piece[:, :3, :3].swapaxes(1, 2) + piece[:, None, :3, 3]
            if world.size:
                yield world.reshape(-1, 3)


def ideal_direction(film_distance: float) -> Directions:
    """View direction of a film point through the centre of an ideal lens."""

    def direction(x: float, y: float) -> NDArray[np.float64]:
        d = np.array([x, y, -film_distance])
        return np.asarray(d / np.linalg.norm(d))

    return direction
