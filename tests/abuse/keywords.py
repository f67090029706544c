"""Parameters that stand in tables, not in signatures, by the path of what takes them."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Callable, Iterable

import daguerre as dg


def _camera() -> Iterable[str]:
    return [field.name for field in dataclasses.fields(dg.Camera)]


def _render() -> Iterable[str]:
    from daguerre.rendering.parameters import ROWS

    return [row.name for row in ROWS]


def _develop() -> Iterable[str]:
    return inspect.signature(dg.development.develop).parameters.keys() - {"source"}


def _effect(name: str) -> Callable[[], Iterable[str]]:
    def rows() -> Iterable[str]:
        from daguerre.post.effects.catalogue import EFFECTS

        return [row.name for row in EFFECTS[name].parameters]

    return rows


KEYWORDS: dict[str, Callable[[], Iterable[str]]] = {
    "dg.Camera.with_": _camera,
    "dg.RenderSettings.of": _render,
    "dg.RenderSettings.with_": _render,
    "dg.Raw.develop": _develop,
    "dg.Raw.save": _develop,
    "dg.stocks.Negative.develop": _develop,
    "dg.development.save_raw": _develop,
    "dg.post.bloom": _effect("bloom"),
    "dg.post.depth_of_field": _effect("depth-of-field"),
    "dg.post.diffract": _effect("diffraction"),
    "dg.post.fake_flare": _effect("fake-flare"),
    "dg.post.glare": _effect("glare"),
    "dg.post.grain": _effect("grain"),
    "dg.post.halo": _effect("halo"),
    "dg.post.lateral_colour": _effect("lateral-colour"),
    "dg.post.motion_blur": _effect("motion-blur"),
    "dg.post.remove_lateral_colour": _effect("lateral-colour"),
    "dg.post.spread_by": _effect("psf"),
    "dg.post.star": _effect("star"),
    "dg.post.through_lens": _effect("lens-psf"),
    "dg.post.undistort": _effect("distortion"),
    "dg.post.unvignette": _effect("vignetting"),
    "dg.post.unvignette_saturation": _effect("saturation-vignetting"),
    "dg.post.vignette": _effect("vignetting"),
    "dg.post.vignette_saturation": _effect("saturation-vignetting"),
}
