"""Messages about files that a scene asks for."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import daguerre as dg

from .scene_files import loaded

_BAD = "neither a mesh nor a picture\n1 2\n"
_NAMED = '<string name="filename" value="{}"/>'


@pytest.mark.parametrize(
    ("file", "element", "text"),
    [
        ("a.ply", "shape", f'<shape type="ply">{_NAMED}</shape>'),
        ("a.obj", "shape", f'<shape type="obj">{_NAMED}</shape>'),
        ("a.serialized", "shape", f'<shape type="serialized">{_NAMED}</shape>'),
        ("a.txt", "shape", f'<shape type="bsplinecurve">{_NAMED}</shape>'),
        ("a.exr", "emitter", f'<emitter type="envmap">{_NAMED}</emitter>'),
        ("a.png", "texture", '<shape type="sphere"><bsdf type="diffuse"><texture type="bitmap" '
         f'name="reflectance">{_NAMED}</texture></bsdf></shape>'),
        ("a.spd", "spectrum", '<shape type="sphere"><bsdf type="diffuse">'
         '<spectrum name="reflectance" filename="{}"/></bsdf></shape>'),
        ("a.spd", "spectrum", '<emitter type="constant"><spectrum type="irregular" '
         f'name="radiance">{_NAMED}</spectrum></emitter>'),
        ("down.spd", "spectrum", '<shape type="sphere"><bsdf type="diffuse">'
         '<spectrum name="reflectance" filename="{}"/></bsdf></shape>'),
        ("a.vol", "volume", '<shape type="sphere"><medium type="heterogeneous" name="interior">'
         f'<volume type="gridvolume" name="sigma_t">{_NAMED}</volume></medium></shape>'),
    ],
)  # fmt: skip
def test_a_wrong_file_is_named_after_the_element_that_asks_for_it(
    file: str, element: str, text: str, tmp_path: Path
) -> None:
    odd = {"down.spd": "500 1\n400 1\n", "a.obj": "v 0 0 0\nf 1 2 3\n"}
    (tmp_path / file).write_text(odd.get(file, _BAD))
    with pytest.raises(dg.InputError) as caught:
        loaded(tmp_path, text.format(file))
    message = str(caught.value)
    assert "\n" not in message
    found = re.search(rf"^[^:]*scene\.xml: line 2, column \d+: <{element} .*?>: ", message)
    assert found, message
    assert file in message[found.end() :]
