"""Normal maps and bump maps of Mitsuba as the normal maps of glTF: R along u, G against v.

A bump map has heights; its slopes depend on how far a unit of texture coordinates reaches, for
which the mean over the mesh is taken. Neither is read from a mipmap, as Mitsuba has none: the mean
of normals is another normal.

Source: Mitsuba 3, documentation of ``normalmap`` and ``bumpmap``.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.shading.arithmetic import Arithmetic
from daguerre.shading.channels import Channel, Plane, Texel, Value
from daguerre.shading.textures import top_down

from .look import Chart, Relief

Heights = NDArray[np.float64]


def normal_map(relief: Relief, chart: Chart, arithmetic: Arithmetic) -> Value | None:
    """Channels of a normal map; None: the relief is flat."""
    made = _normals(relief, chart, arithmetic)
    return None if made is None else tuple(_without_mipmap(channel) for channel in made)


def _without_mipmap(channel: Channel) -> Channel:
    if not isinstance(channel, Texel):
        return channel
    mapping = channel.mapping
    return replace(channel, mapping=replace(mapping, min_filter=mapping.filter))


def _normals(relief: Relief, chart: Chart, arithmetic: Arithmetic) -> Value | None:
    if relief.normals is not None:
        x, y, z = relief.normals
        if chart.right_handed:
            (y,) = arithmetic.each(lambda v: 1 - v, (y,))
        return x, y, z
    return None if relief.heights is None else _from_heights(relief.heights, relief.scale, chart)


def _from_heights(heights: Channel, scale: float, chart: Chart) -> Value | None:
    if not isinstance(heights, Texel):
        return None
    values = heights.values().astype(np.float64)
    rows, columns = values.shape
    wrap_u, wrap_v = heights.mapping.wrap
    across = _slope(values, 1, wrap_u) * columns
    down = _slope(values, 0, wrap_v) * rows
    a, b, _, d, e, _ = top_down(heights.mapping.transform)  # of coordinates from the top left
    along_u = scale * (a * across + d * down) / chart.lengths[0]
    along_v = scale * (b * across + e * down) / chart.lengths[1]
    normals = np.stack([-along_u, along_v, np.ones_like(values)])
    normals /= np.linalg.norm(normals, axis=0)
    encoded = (0.5 + 0.5 * normals).astype(np.float32)
    name = heights.plane.name
    return tuple(
        Texel(Plane(freeze_in_place(np.ascontiguousarray(channel)), name=name), heights.mapping)
        for channel in encoded
    )


def _slope(values: Heights, axis: int, wrap: str) -> Heights:
    """Central differences between texels."""
    if values.shape[axis] < 2:
        return np.zeros_like(values)
    if wrap == "repeat":
        return (np.roll(values, -1, axis) - np.roll(values, 1, axis)) / 2
    return np.asarray(np.gradient(values, axis=axis))
