"""Files of other programs, typed from what is published about them, against the same lens in JSON.

Nothing here is written by code that the readers' own tests use.
"""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import lenses

Data = dict[str, Any]
CROWN, FLINT = {"nd": 1.5168, "vd": 64.17}, {"nd": 1.67271, "vd": 32.25}


def row(radius: float | None, thickness: float, semi: float, **more: Any) -> Data:
    kind = "aspheric" if "asphere" in more else "spherical"
    return {
        "kind": kind,
        "radius": radius,
        "thickness": thickness,
        "semi_diameter": semi,
        "glass": None,
    } | more


LENS: Data = {
    "schema": "daguerre-lens/0.1",
    "name": "by hand",
    "nominal": {"image_circle_mm": 24},
    "surfaces": [
        row(40, 6, 11, glass=CROWN, conic=-0.7, asphere={"a4": 1.2e-6, "a6": -3e-9}),
        row(-55, 2, 11, glass=FLINT),
        row(-300, 3, 10.5),
        row(None, 4, 7, kind="stop"),
        row(-30, 2.5, 8, glass=CROWN, asphere={"a3": 2e-5, "a4": -1e-6, "a5": 1e-7}),
        row(-28, 60, 9),
    ],
    "configurations": [{"name": "infinity", "gaps": {}}],
}


def surf(
    number: int | str, form: str, curvature: str, distance: float | str, semi: float, *lines: str
) -> str:
    """A surface of a ZEMAX file; ``lines`` stand between its shape and its rim."""
    middle = "".join(f"  {line}\n" for line in lines)
    return (
        f'SURF {number}\n  TYPE {form}\n  CURV {curvature} 0 0 0 0 ""\n{middle}'
        f'  DISZ {distance}\n  DIAM {semi:g} 1 0 0 1 ""\n'
    )


GLASS_1 = "GLAS ___BLANK 1 0 1.5168 64.17 0 0 0 0 0 0"
GLASS_2 = "GLAS ___BLANK 1 0 1.67271 32.25 0 0 0 0 0 0"
EVEN = ("CONI -0.7", "PARM 1 0", "PARM 2 1.2E-06", "PARM 3 -3E-09", GLASS_1)
ODD = ("PARM 3 2E-05", "PARM 4 -1E-06", "PARM 5 1E-07", GLASS_1)
ZEMAX = (
    """VERS 190513 80 123457 L123457
MODE SEQ
NAME by hand
UNIT MM X W X CM MR CPMM
FLOA
ENVD 2.0E+1 1 0
SURF 0
  TYPE STANDARD
  CURV 0.0 0 0 0 0 ""
  DISZ INFINITY
"""
    + surf(1, "EVENASPH", "0.025", 6, 11, *EVEN)
    + surf(2, "STANDARD", "-1.8181818181818181E-02", 2, 11, GLASS_2)
    + surf(3, "STANDARD", "-3.3333333333333335E-03", 3, 10.5)
    + surf("4\n  STOP", "STANDARD", "0.0", 4, 7)
    + "{before}"
    + surf("{a}", "ODDASPHE", "-3.3333333333333333E-02", 2.5, 8, *ODD)
    + surf("{b}", "STANDARD", "-3.5714285714285712E-02", "{last}", 9)
    + """{after}SURF {c}
  TYPE STANDARD
  CURV 0.0 0 0 0 0 ""
  DISZ 0
"""
)

BREAK = """SURF 5
  TYPE COORDBRK
  CURV 0.0 0 0 0 0 ""
  PARM 1 0.2
  PARM 2 -0.3
  PARM 3 1.5
  DISZ 0
"""
BACK = """SURF 8
  TYPE COORDBRK
  CURV 0.0 0 0 0 0 ""
  PARM 1 -0.2
  PARM 2 0.3
  PARM 3 -1.5
  PARM 6 1
  DISZ 62.5
"""

CODE_V = """! by hand: the private glasses stand behind the surfaces
{mode};LEN "VERSION: 10.5"
TITLE 'by hand'
EPD 14
DIM M
WL 656.2725 587.5618 486.1327
SO 0 1e11
S {c1} 6 'CROWN_A'
  ASP; K -0.7; A 1.2e-6; B -3e-9; CIR 11
S {c2} 2 'FLINT_B'
  CIR 11
S {c3} 3
  CIR 10.5
S 0 4
  STO; CIR 7
S {c4} 2.5 'CROWN_A'
  CIR 8
S {c4} 60
  CIR 9
SI 0 0
PRV
PWL 656.2725 587.5618 486.1327
'CROWN_A' 1.514324 1.5168 1.522378
'FLINT_B' 1.666603 1.67271 1.687497
END
GO
"""

OPTICAL_BENCH = """[descriptive data]
title\tby hand
[variable distances]
F-Number\t4
d6\t60
[lens data]
1\t40\t6\t1.5168\t22\t64.17
2\t-55\t2\t1.67271\t22\t32.25
3\t-300\t3\t\t21
4\tAS\t4\t\t14
5\t-30\t2.5\t1.5168\t16\t64.17
6\t-28\td6\t\t18
[aspherical data]
1\t40\t-0.7\t1.2e-6\t-3e-9
"""

PBRT = """# radius, thickness, index, diameter
40 6 1.5168 22
-55 2 1.67271 22
-300 3 1 21
0 4 0 14
-28 2.5 1.5168 16
-28 60 1 18
"""


def written(folder: Path, name: str, text: str | bytes) -> lenses.Lens:
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return lenses.load(str(path))


def changed(folder: Path, **surfaces: Data) -> lenses.Lens:
    """The JSON lens with members of surfaces ``s0`` .. changed."""
    data = copy.deepcopy(LENS)
    for name, change in surfaces.items():
        data["surfaces"][int(name[1:])] |= change
    return written(folder, "reference.json", json.dumps(data))


def check_same(ours: lenses.Lens, theirs: lenses.Lens) -> None:
    """The same rays pass, and leave alike."""
    rng, n = np.random.default_rng(3), 300
    origins = np.column_stack([rng.uniform(-9, 9, (n, 2)), np.full(n, -20.0)])
    directions = np.column_stack([rng.uniform(-0.1, 0.1, (n, 2)), np.ones(n)])
    for nm in (486.1327, 587.5618, 656.2725):
        a, b = (
            lens.prescription.rays(origins, directions, np.full(n, nm), True)
            for lens in (ours, theirs)
        )
        passed = a[-1] < 0
        assert passed.sum() > 100
        np.testing.assert_array_equal(a[-1], b[-1])
        np.testing.assert_allclose(a[0][passed], b[0][passed], atol=1e-11)
        np.testing.assert_allclose(a[1][passed], b[1][passed], atol=1e-13)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-16-be"])
def test_zemax(encoding: str, tmp_path: Path) -> None:
    text = ZEMAX.format(before="", after="", a=5, b=6, c=7, last=60).replace("\n", "\r\n")
    mark = b"\xfe\xff" if encoding == "utf-16-be" else b""
    check_same(changed(tmp_path), written(tmp_path, "a.zmx", mark + text.encode(encoding)))


def test_zemax_coordinate_breaks(tmp_path: Path) -> None:
    text = ZEMAX.format(before=BREAK, after=BACK, a=6, b=7, c=9, last=-2.5)
    data = LENS | {
        "groups": [
            {"name": "g", "surfaces": [4, 5], "decenter": [0.2, -0.3, 0], "tilt": [1.5, 0, 0]}
        ]
    }
    ours = written(tmp_path, "reference.json", json.dumps(data))
    check_same(ours, written(tmp_path, "a.zmx", text))


@pytest.mark.parametrize("mode", ["RDM", "RDM N"])
def test_code_v(mode: str, tmp_path: Path) -> None:
    radii = (40, -55, -300, -28)
    values = radii if mode == "RDM" else [repr(1 / r) for r in radii]
    text = CODE_V.format(mode=mode, **{f"c{i}": v for i, v in enumerate(values, 1)})
    theirs = written(tmp_path, "a.seq", text)
    assert theirs.first_order().entrance_pupil.diameter == pytest.approx(14)
    crown = {"table": [[486.1327, 1.522378], [587.5618, 1.5168], [656.2725, 1.514324]]}
    flint = {"table": [[486.1327, 1.687497], [587.5618, 1.67271], [656.2725, 1.666603]]}
    ours = changed(
        tmp_path,
        s0={"glass": crown},
        s1={"glass": flint},
        s3={"semi_diameter": theirs.surfaces[3].semi_diameter},
        s4={"kind": "spherical", "radius": -28, "glass": crown, "asphere": {}},
    )
    check_same(ours, theirs)


def test_optical_bench(tmp_path: Path) -> None:
    ours = changed(tmp_path, s4={"kind": "spherical", "asphere": {}})
    check_same(ours, written(tmp_path, "a.txt", OPTICAL_BENCH))


def test_pbrt(tmp_path: Path) -> None:
    crown, flint = ({"table": [[400, n], [800, n]]} for n in (1.5168, 1.67271))
    plain = {"kind": "spherical", "asphere": {}, "conic": 0}
    ours = changed(
        tmp_path,
        s0=plain | {"glass": crown},
        s1={"glass": flint},
        s4=plain | {"radius": -28, "glass": crown},
    )
    check_same(ours, written(tmp_path, "a.dat", PBRT))


def test_two_stops_are_named(tmp_path: Path) -> None:
    with pytest.raises(lenses.LensError, match=r"surfaces 2, 3.*\[lens-two-stops\]") as caught:
        changed(tmp_path, s2={"stop": True})
    assert caught.value.surface == 3


def test_a_beam_that_the_mounts_cut_is_told(tmp_path: Path) -> None:
    text = CODE_V.format(mode="RDM", c1=40, c2=-55, c3=-300, c4=-28).replace("EPD 14", "EPD 200")
    notes = written(tmp_path, "a.seq", text).notes
    assert any("the lens is slower than the f/0.402 of its open stop" in note for note in notes)


def test_a_stop_of_unknown_size_renders_at_a_stated_f_stop(tmp_path: Path) -> None:
    lens = changed(tmp_path, s3={"semi_diameter": None})
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    camera = dg.Camera(lens=lens, f_stop=16, focus_distance=3, sensor_size=(3, 2))
    assert dg.render(scene, camera, resolution=(6, 4), spp=16).rgb.mean() == pytest.approx(1, 0.05)
