"""Messages about files that a scene asks for."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import daguerre as dg

from .text import read

_BAD = "neither a mesh nor a picture\n1 2\n"
_CAMERA = 'Camera "perspective"'


@pytest.mark.parametrize(
    ("file", "directive", "text"),
    [
        ("a.ply", "Shape", 'Shape "plymesh" "string filename" "{}"'),
        ("a.spd", "LightSource", 'LightSource "distant" "spectrum L" "{}"'),
        ("odd.spd", "LightSource", 'LightSource "distant" "spectrum L" "{}"'),
        ("a.spd", "MakeNamedMedium", 'MakeNamedMedium "m" "string type" "homogeneous" '
         '"spectrum sigma_a" "{}" MediumInterface "m" "" Shape "sphere"'),
        ("a.exr", "LightSource", 'LightSource "infinite" "string filename" "{}"'),
        ("a.png", "LightSource", 'LightSource "projection" "string filename" "{}"'),
        ("a.png", "LightSource", 'LightSource "goniometric" "string filename" "{}"'),
        ("a.png", "Texture", 'Texture "t" "spectrum" "imagemap" "string filename" "{}" '
         'Material "diffuse" "texture reflectance" "t" Shape "sphere"'),
        ("a.png", "Material", 'Material "diffuse" "string normalmap" "{}" Shape "sphere"'),
        ("a.pbrt.gz", "Include", 'Include "{}"'),
    ],
)  # fmt: skip
def test_a_wrong_file_is_named_after_the_directive_that_asks_for_it(
    file: str, directive: str, text: str, tmp_path: Path
) -> None:
    odd = {"odd.spd": b"400 1 500", "a.pbrt.gz": b"\x1f\x8bdamaged"}
    (tmp_path / file).write_bytes(odd.get(file, _BAD.encode()))
    with pytest.raises(dg.InputError) as caught:
        read(tmp_path, "\n  " + text.format(file), _CAMERA)
    _asked(str(caught.value), rf"scene\.pbrt: line 4, column \d+: {directive}", file)


def test_a_wrong_lens_is_named_after_its_camera(tmp_path: Path) -> None:
    (tmp_path / "lens.dat").write_text(_BAD)
    with pytest.raises(dg.InputError) as caught:
        read(tmp_path, "", '\n  Camera "realistic" "string lensfile" "lens.dat"')
    _asked(str(caught.value), r"scene\.pbrt: line 2, column 3: Camera", "lens.dat")


def test_a_directive_of_an_included_file_is_named_there(tmp_path: Path) -> None:
    (tmp_path / "a.ply").write_text(_BAD)
    (tmp_path / "part.pbrt").write_text('\n\n Shape "plymesh" "string filename" "a.ply"')
    with pytest.raises(dg.InputError) as caught:
        read(tmp_path, 'Include "part.pbrt"', _CAMERA)
    _asked(str(caught.value), r"part\.pbrt: line 3, column 2: Shape", "a.ply")


def _asked(message: str, place: str, file: str) -> None:
    """Checks for one line: a place, then the file."""
    assert "\n" not in message
    found = re.search(f"^[^:]*{place}: ", message)
    assert found, message
    assert file in message[found.end() :]
