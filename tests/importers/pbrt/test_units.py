"""Scenes of pbrt in units other than metres."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli.flags.scene_file import SceneFileFlags
from daguerre.lenses import Lens

from .text import written

_CAMERA = (
    'LookAt 0 3 -8 0 0 0 0 1 0 Camera "perspective" "float fov" 30 "float lensradius" 0.2 '
    '"float focaldistance" 8 Film "rgb" "integer xresolution" 24 "integer yresolution" 16'
)
_LENS = (
    'LookAt 0 3 -8 0 0 0 0 1 0 Camera "realistic" "string lensfile" "lens.dat" '
    '"float aperturediameter" 4 "float focusdistance" 800'
)
_FLOOR = (
    'Shape "trianglemesh" "point3 P" [-4 -1 -4  -4 -1 4  4 -1 4  4 -1 -4] '
    '"integer indices" [0 1 2 0 2 3] "point2 uv" [0 0 0 1 1 1 1 0] '
)
_THINGS = {
    "point": f'LightSource "point" "rgb I" [9 8 7] "point3 from" [0 4 0] {_FLOOR}',
    "spot": 'LightSource "spot" "float power" 90 "point3 from" [0 4 0] "point3 to" [0 0 0] '
    f"{_FLOOR}",
    "distant": f'LightSource "distant" "point3 from" [1 4 0] "point3 to" [0 0 0] {_FLOOR}',
    "area": f'AttributeBegin AreaLightSource "diffuse" "float power" 90 Translate 0 3 0 '
    f'Rotate 90 1 0 0 Shape "disk" "float radius" 1 AttributeEnd {_FLOOR}',
    "bump": f'LightSource "distant" "point3 from" [1 4 0] "point3 to" [0 0 0] '
    'Texture "h" "float" "checkerboard" "float tex1" 0.2 "float tex2" 0 '
    f'Material "diffuse" "texture displacement" "h" {_FLOOR}',
    "curve": 'LightSource "infinite" "rgb L" [1 1 1] Material "diffuse" '
    'Shape "curve" "point3 P" [-2 0 0  -1 1 0  1 -1 0  2 0 0] "float width" 1',
    "smoke": 'LightSource "infinite" "rgb L" [1 1 1] MakeNamedMedium "m" '
    '"string type" "homogeneous" "rgb sigma_a" [0.2 0.5 0.9] "rgb sigma_s" [0 0 0] '
    '"float Lescale" 0.3 "rgb Le" [1 2 3] '
    'MediumInterface "m" "" Material "interface" Shape "sphere" "float radius" 2',
    "grid": 'LightSource "infinite" "rgb L" [1 1 1] MakeNamedMedium "m" '
    '"string type" "uniformgrid" "integer nx" 2 "integer ny" 1 "integer nz" 1 '
    '"float density" [1 3] "point3 p0" [-2 -2 -2] "point3 p1" [2 2 2] '
    '"rgb sigma_a" [0.2 0.5 0.9] "rgb sigma_s" [0 0 0] '
    'MediumInterface "m" "" Material "interface" Shape "sphere" "float radius" 2',
}


@pytest.mark.parametrize("thing", _THINGS)
def test_a_picture_is_the_same_in_all_units(thing: str, tmp_path: Path) -> None:
    path = written(tmp_path, _THINGS[thing], _CAMERA)
    metres, inches = (
        dg.render(dg.load(path, unit_m=unit), resolution=(24, 16), spp=256, seed=3).rgb
        for unit in (1.0, 0.0254)
    )
    assert metres.mean() > 0.01
    assert np.allclose(_blocks(inches), _blocks(metres), rtol=0.02, atol=0.01 * metres.mean())


def _blocks(picture: np.ndarray) -> np.ndarray:
    """Means of 8 x 8 pixels."""
    return np.asarray(picture.reshape(2, 8, 3, 8, 3).mean(axis=(1, 3)))


def test_a_realistic_lens_keeps_its_millimetres(tmp_path: Path) -> None:
    (tmp_path / "lens.dat").write_text("# a lens\n50 5 1.5 20\n-50 5 0 20\n0 40 0 10\n")
    camera = SceneFileFlags(scene_unit="cm").read(written(tmp_path, _FLOOR, _LENS)).camera()
    metres = dg.load(tmp_path / "scene.pbrt").camera()
    assert isinstance(camera.lens, Lens)
    assert isinstance(metres.lens, Lens)
    assert camera.lens.vertices == pytest.approx(metres.lens.vertices)
    assert (camera.focus_distance, metres.focus_distance) == pytest.approx((8, 800))
    assert camera.transform[:3, 3] == pytest.approx((0, 0.03, 0.08), abs=0.1)


def test_a_unit_is_a_length(tmp_path: Path) -> None:
    path = written(tmp_path, _FLOOR)
    for wrong in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(dg.UsageError, match="unit_m: wanted a length"):
            dg.load(path, unit_m=wrong)
