"""Rough plastic in even light: as bright as Mitsuba's along every direction."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.importers.mitsuba.reader import read_all

from .peer import theirs

_SCENE = """<scene version="3.0.0">
<integrator type="path"><integer name="max_depth" value="2"/></integrator>
<sensor type="perspective"><float name="fov" value="1"/>
  <transform name="to_world">
    <lookat origin="{x},0,{z}" target="0,0,0" up="0,1,0"/>
  </transform>
  <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/>
    <rfilter type="box"/></film>
</sensor>
<emitter type="constant"><rgb name="radiance" value="1,1,1"/></emitter>
<shape type="rectangle"><transform name="to_world"><scale value="1000"/></transform>
  <bsdf type="roughplastic"><float name="alpha" value="{alpha}"/>
    <string name="distribution" value="{distribution}"/><float name="int_ior" value="1.5"/>
    <boolean name="nonlinear" value="{nonlinear}"/>
    <rgb name="diffuse_reflectance" value="0.8,0.8,0.8"/></bsdf>
</shape></scene>"""
SPP = 400


def _mean(scene: dg.Scene) -> float:
    camera: Any = scene.camera()
    frame = dg.render(scene, camera, resolution=(16, 16), filter="box", max_depth=1, spp=SPP)
    return float(frame.rgb[:, :, 1].mean())


@pytest.mark.parametrize("distribution", ["ggx", "beckmann"])
@pytest.mark.parametrize(("alpha", "error"), [(0.05, 0.025), (0.2, 0.025), (0.4, 0.05)])
@pytest.mark.parametrize("nonlinear", ["true", "false"])
def test_rough_plastic_is_as_bright_as_in_mitsuba(
    tmp_path: Path, distribution: str, alpha: float, error: float, nonlinear: str
) -> None:
    """Mitsuba's mean of what its coat reflects inside is 1.5 % too small, as 64 cosines count."""
    path = tmp_path / "plane.xml"
    for degrees in (0, 45, 70):
        x, z = (10 * f(math.radians(degrees)) for f in (math.sin, math.cos))
        path.write_text(
            _SCENE.format(x=x, z=z, alpha=alpha, distribution=distribution, nonlinear=nonlinear)
        )
        scene = read_all(path)[0]
        wanted = float(np.mean(theirs(path, SPP)[:, :, 1]))
        assert _mean(scene) == pytest.approx(wanted, rel=error), degrees
        if alpha >= 0.2:  # a coat that loses nothing
            (material,) = scene.materials
            kind: Any = material.kind
            scene.materials[0] = replace(material, kind=replace(kind, energy_compensation=True))
            assert _mean(scene) > (1 + error) * wanted, degrees
