"""Annotations of the objects that a camera sees: boxes, masks, 3D boxes; see docs/ground-truth.md.

Boxes in the picture are (x, y, width, height), px from the upper left corner of the picture, as in
COCO: the box of the first pixel is (0, 0, 1, 1). With a crop, the picture is the crop.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.camera.ideal import IDEAL
from daguerre.checks import short
from daguerre.errors import InputError, UsageError, core_errors
from daguerre.files.value import BriefRecord
from daguerre.rendering.session import Session
from daguerre.rendering.truth import GroundTruth, Moment
from daguerre.scene.scene import Scene

from .boxes import Balls, Box3, box_of
from .categories import Categories, Category, Thing

Box = tuple[float, float, float, float]
NO_GROUP = 0xFFFFFFFF
#: From Daguerre's camera frame to OpenCV's (x right, y down, z ahead).
FLIP = np.diag([1.0, -1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False, repr=False)
class Annotation(BriefRecord):
    """Annotation of one object in a picture.

    Attributes:
        name: Name of the object's node.
        category: Category of the object.
        instances: Indices of the object's instances in the scene.
        area: Number of pixels in which the object is visible.
        box: Box around the visible pixels; None: the object is hidden.
        full_box: Box around the whole object, with hidden parts, clipped to the picture.
        truncation: Share of the unclipped box outside of the picture; None: unknown, as parts of
            the object have no image point, such as parts behind the camera.
        visibility: Share of the pixels with a chief ray through the object in which the ray meets
            no other object before.
        box3: 3D box around the object in the world, m, at the picture's ``time``.
        camera_box3: 3D box in the camera's frame, x right, y down, z ahead.
        camera_from_node: Transform from the node's frame to the camera's, shape (4, 4), m: pose and
            scale, of the first of several instances.
    """

    name: str
    category: Category
    instances: tuple[int, ...]
    area: int
    box: Box | None
    full_box: Box
    truncation: float | None
    visibility: float
    box3: Box3
    camera_box3: Box3
    camera_from_node: NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class Annotations(BriefRecord):
    """Annotations of all objects in a picture.

    Attributes:
        things: Annotations of objects in the picture, hidden or not, in the order of the scene.
        categories: All categories, whether in the picture or not.
        labels: Object that each pixel shows, as index + 1 in ``things``, shape (H, W); 0: none.
        time: Time of the 3D boxes, s; with a rolling shutter, the time of the middle line.
        world_from_camera: Pose of the camera, x right, y down, z ahead, shape (4, 4), m.
        intrinsics: ``model``, ``camera_matrix`` (3, 3) and ``parameters`` as in OpenCV, with pixel
            centres at integers, if the camera has such a form.
    """

    things: list[Annotation]
    categories: list[Category]
    labels: NDArray[np.int32]
    time: float
    world_from_camera: NDArray[np.float64]
    intrinsics: dict[str, Any] = field(default_factory=dict)

    def mask(self, index: int) -> NDArray[np.bool_]:
        """Mask of the pixels in which one of ``things`` is visible, shape (H, W)."""
        return np.asarray(self.labels == index + 1)


@guarded(but=("categories",))
def annotate(
    scene: Scene,
    camera: Camera | str | None = None,
    *,
    categories: Categories | str | Path | None = None,
    **options: object,
) -> Annotations:
    """Annotates the objects of a scene that a camera sees, without drawing a picture.

    Args:
        scene: The scene.
        camera: Camera, or its name in the scene; default: the scene's own.
        categories: Categories of the objects, or a file of them; default: by node names.
        **options: Options of :class:`Session`: resolution, crop, threads, gt_time, gt_lens,
            gt_rays.
    """
    if isinstance(categories, str | Path):
        categories = Categories.read(categories)
    if not isinstance(categories, Categories | None):
        raise UsageError(f"categories: wanted Categories or a file, got {short(categories)}")
    given: dict[str, Any] = {"light_paths": "off", **options}
    session = Session(scene, camera, **given)
    return annotations_of(session, categories)


@core_errors(InputError, "render")
def annotations_of(session: Session, categories: Categories | None = None) -> Annotations:
    """Annotates the objects that a session's camera sees, at ``gt_time`` or at mid-exposure."""
    chosen = categories or Categories()
    truth = session.ground_truth
    moment = truth.moment(0)
    things, all_known = chosen.things(session.scene), chosen.all(session.scene)
    groups = np.full(len(session.scene.instances), NO_GROUP, np.uint32)
    for i, thing in enumerate(things):
        groups[list(thing.instances)] = i
    seen = _Seen(truth, moment, groups, len(things), session.object_ids(moment))
    world = moment.setup.world_from_camera @ FLIP
    found, kept = [], np.zeros(len(things) + 1, np.int32)
    for i, thing in enumerate(things):
        made = seen.annotation(i, thing, moment.scene, world)
        if made is not None:
            found.append(made)
            kept[i + 1] = len(found)
    intrinsics = _intrinsics(truth, moment)
    labels = kept[seen.labels]
    return Annotations(found, all_known, labels, moment.scene.time, world, intrinsics)


class _Seen:
    """Pixels and boxes of groups of instances."""

    def __init__(
        self,
        truth: GroundTruth,
        moment: Moment,
        groups: NDArray[np.uint32],
        count: int,
        ids: NDArray[np.uint32],
    ) -> None:
        x0, y0, x1, y1 = truth.crop
        self.corner, self.size = np.array([x0, y0]), np.array([x1 - x0, y1 - y0])
        shot = moment.shot
        self.pixels, boxes = _core.silhouettes(
            shot.scene, shot.camera, shot.settings, truth.crop, groups, count
        )
        self.outlines, self.open = _core.outlines(
            shot.scene, shot.camera, shot.settings, groups, count
        )
        self.silhouettes = np.asarray(boxes, np.float64)
        with_none = np.concatenate([[NO_GROUP], groups]).astype(np.uint32)
        self.labels = (with_none[ids] + np.uint32(1)).astype(np.int32)  # 2^32 - 1 becomes 0
        self._used: dict[int, Balls] = {}  # by mesh
        self.areas = np.bincount(self.labels.ravel(), minlength=count + 1)[1:]
        self.boxes = _boxes(self.labels, count)

    def annotation(self, i: int, thing: Thing, scene: Scene, world: Any) -> Annotation | None:
        """Annotates one object; None: it is not in the picture."""
        visible, whole = (int(n) for n in self.pixels[i])
        area = int(self.areas[i])
        if not (whole or area):
            return None
        box3 = box_of(scene, thing.instances, self._used)
        ends = self._ends(i, whole)
        shown = np.clip(ends, 0, self.size)
        x, y, width, height = self.boxes[i]
        return Annotation(
            name=thing.name,
            category=thing.category,
            instances=thing.instances,
            area=area,
            box=(float(x), float(y), float(width), float(height)) if area else None,
            full_box=_box(shown),
            truncation=None if self.open[i] else _beside(ends, shown),
            visibility=visible / whole if whole else 1.0,
            box3=box3,
            camera_box3=box3.seen_from(world),
            camera_from_node=np.linalg.inv(world) @ scene.instances[thing.instances[0]].transform,
        )

    def _ends(self, i: int, whole: int) -> NDArray[np.float64]:
        """Lower and upper limits of the whole object, px, in the whole picture."""
        outline: NDArray[np.float64] = self.outlines[i].reshape(2, 2) - self.corner
        if not whole:
            return outline
        pixels = self.silhouettes[i].reshape(2, 2) - self.corner
        if not self.open[i] and np.isfinite(outline).all():
            return outline
        # If all edges are out of view, they do not bound a face that fills the picture.
        low = np.fmin(outline[0], pixels[0])
        return np.stack([low, np.fmax(outline[1], pixels[1])])


def _boxes(labels: NDArray[np.int32], count: int) -> NDArray[np.int64]:
    """(x, y, width, height) of each label from 1 on, shape (count, 4)."""
    y, x = np.nonzero(labels)
    of = labels[y, x] - 1
    low = np.full((2, count), np.iinfo(np.int64).max)
    high = np.full((2, count), -1)
    for axis, values in enumerate((x, y)):
        np.minimum.at(low[axis], of, values)
        np.maximum.at(high[axis], of, values)
    return np.stack([*low, *(high - low + 1)], axis=1)


def _box(ends: NDArray[np.float64]) -> Box:
    x, y, width, height = np.concatenate([ends[0], ends[1] - ends[0]]).tolist()
    return x, y, width, height


def _beside(ends: NDArray[np.float64], shown: NDArray[np.float64]) -> float:
    """Share of a box that lies outside of the picture."""
    whole = float(np.prod(ends[1] - ends[0]))
    return max(0.0, 1 - float(np.prod(shown[1] - shown[0])) / whole) if whole > 0 else 0.0


def _intrinsics(truth: GroundTruth, moment: Moment) -> dict[str, Any]:
    """Intrinsics; empty for real lenses, tilted lenses and moving shifts."""
    camera, setup = truth.camera.frozen_at(moment.scene.time), moment.setup
    width, height = truth.resolution
    (x0, y0), model = truth.crop[:2], setup.lens.model
    if camera.projection is not None:
        made = camera.projection
        scale = width / made.size[0]
        focal = [scale * f for f in made.focal]
        (x, y), rows = made.center, made.size[1]  # equal centres: a shape's rows may be rounded
        center = [scale * (x + 0.5) - 0.5, scale * (y + 0.5 - rows / 2) + height / 2 - 0.5]
        named: dict[str, Any] = {"model": made.model, "parameters": list(made.parameters)}
    elif model in IDEAL and not any(camera.tilt):
        right, up = setup.shift_mm
        across, down = width / setup.frame_size_mm[0], height / setup.frame_size_mm[1]
        focal = [setup.lens.pinhole_focal_length_mm * pixels for pixels in (across, down)]
        center = [width / 2 - 0.5 - right * across, height / 2 - 0.5 + up * down]
        named = {"model": "pinhole", "parameters": []}
    else:
        return {}
    matrix = [[focal[0], 0.0, center[0] - x0], [0.0, focal[1], center[1] - y0], [0.0, 0.0, 1.0]]
    return named | {"camera_matrix": matrix}
