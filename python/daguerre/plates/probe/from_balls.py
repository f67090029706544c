"""Makes environments from photographs of balls."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from daguerre.errors import InputError

from .asked import Asked
from .ball import Ball, Circle, points_on, seen_ball
from .brackets import SetView, read_view
from .from_panorama import PanoramaLight
from .grey import Lighting, Shading, lighting_of, shading_of
from .harmonics import basis
from .latlong import centres, solid_angles, world_from_camera
from .outline import Outline, find_outline
from .unwrap import SeenBall, Unwrapped, unwrap, usual_width

#: Width of the map of a matt ball: the sun is a few pixels wide.
GREY_WIDTH = 1024


def mirror_balls(asked: Asked) -> PanoramaLight:
    """Unwraps photographs of mirror balls, from one or more sides.

    Raises:
        InputError: A photograph cannot be used, or shows no ball.
    """
    seen, views, balls = [], [], []
    for side, (yaw, paths) in enumerate(asked.sides):
        view = read_view(paths, asked.ev_of(side), asked.reading)
        ball, facts = _ball(asked, view, asked.circle, yaw)
        light = (view.merged.light / asked.reflectance).astype(np.float32)
        turn = world_from_camera(yaw + asked.rotate, asked.pitch)
        seen.append(SeenBall(light, view.merged.clipped, ball, turn))
        views.append(view)
        balls.append(facts)
    absolute = _one_unit(views)
    width = asked.res or usual_width(seen)
    made = unwrap(seen, width, width // 2)
    facts = {
        "photographs": [one for view in views for one in view.facts()],
        "response": views[0].curve,
        "kind": "mirror ball",
        "balls": balls,
        "unseen_share": _share(made),
    }
    return PanoramaLight(made.light, made.clipped, absolute, facts)


def _one_unit(views: list[SetView]) -> bool:
    """Checks that all sides have one unit; returns whether it is cd/m2."""
    absolute = all(view.exposures.absolute for view in views)
    if not absolute and len(views) > 1 and any(view.exposures.absolute for view in views):
        raise InputError(
            f"{views[1].path}: exposure: wanted a known exposure for every side or for none, "
            "got it for some"
        )
    return absolute


def _share(made: Unwrapped) -> float:
    """Share of the sphere that no ball shows."""
    height, width = made.unseen.shape
    return float((made.unseen.sum(axis=1) @ solid_angles(width, height)) / (4 * math.pi))


def _ball(
    asked: Asked, view: SetView, circle: Circle | None, yaw: float
) -> tuple[Ball, dict[str, Any]]:
    """Returns the ball of a view, found or as given, and facts for JSON."""
    outline = _outline(view, circle)
    focal = _focal_px(asked, view)
    ball = seen_ball(outline.circle, outline.points, view.shots[0].size, focal)
    facts: dict[str, Any] = {
        "circle_px": [round(v, 3) for v in outline.circle],
        "found": circle is None,
        "rim_seen": outline.seen,
        "rim_spread_px": outline.spread_px,
        "unseen_half_angle_deg": ball.unseen_deg,
        "camera_yaw_deg": yaw,
        "focal_px": None if math.isinf(focal) else focal,
    }
    return ball, facts


def _outline(view: SetView, circle: Circle | None) -> Outline:
    width, height = view.shots[0].size
    if circle is None:
        return find_outline(view.merged.light, str(view.path))
    x, y, radius = circle
    if not (0 < x < width and 0 < y < height and radius < max(width, height)):
        raise InputError(
            f"{view.path}: --circle: wanted a circle within {width}x{height} px, got "
            f"{x:g},{y:g},{radius:g}"
        )
    return Outline(circle, points_on(circle), 1.0, 0.0)


def _focal_px(asked: Asked, view: SetView) -> float:
    """Focal length, px, from the field of view, else from EXIF; infinite: unknown, or far away."""
    if asked.fov is not None:
        if asked.fov < 1e-6:
            return math.inf
        return view.shots[0].size[0] / 2 / math.tan(math.radians(asked.fov) / 2)
    known = view.shots[0].focal_px
    if known is None:
        asked.notes.add(
            "EXIF has no focal length: the ball is taken as seen from far away; --fov sets it"
        )
        return math.inf
    return known


def shading(asked: Asked, paths: list[Path], circle: Circle | None, yaw: float) -> Any:
    """Returns the shading of a matt ball, its view, and facts for JSON."""
    view = read_view(paths, asked.ev if asked.ball == "grey" else None, asked.reading)
    ball, facts = _ball(asked, view, circle, yaw)
    turn = world_from_camera(yaw + asked.rotate, asked.pitch)
    reflectance = asked.reflectance if asked.ball == "grey" else np.ones(3)
    return shading_of(view.merged, ball, turn, reflectance), view, facts


def grey_ball(asked: Asked) -> PanoramaLight:
    """Finds the light that explains a matt ball: soft light of order 2, and a sun.

    Raises:
        InputError: A photograph cannot be used, or shows no ball.
    """
    found: Shading
    found, view, ball = shading(asked, asked.photographs, asked.circle, asked.yaws[0])
    lighting = lighting_of(found)
    width = asked.res or GREY_WIDTH
    toward = centres(width, width // 2)
    light = np.maximum(basis(toward) @ lighting.coefficients, 0).astype(np.float32)
    facts = {
        "photographs": view.facts(),
        "response": view.curve,
        "kind": "grey ball",
        "balls": [ball],
        "fit_error": lighting.error,
    }
    none = np.zeros(light.shape[:2], bool)
    return PanoramaLight(light, none, view.exposures.absolute, facts, _sun(lighting))


def _sun(lighting: Lighting) -> Any:
    return None if lighting.direction is None else (lighting.direction, lighting.sun)
