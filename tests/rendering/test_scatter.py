"""Scattered light in a picture: the session, its layer in the file, bits and splits, bad input."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.analysis import set_up
from daguerre.analysis.glare import VeilingGlare
from daguerre.cli import main
from daguerre.errors import InputError, MismatchError, UsageError
from daguerre.rendering.merging import merge
from daguerre.rendering.session import Session
from tests.support.formats.pass_files import through_files
from tests.support.scene import scenes

LENS = "double-gauss-50mm-f2"
SIZE = (36, 24)
PATHS = 4000.0
BLACK = dg.LensScatter(0, 0, 0, 0, surface_rms_nm=0)


def sunny(degrees: float = 26.0) -> dg.Scene:
    """A sun beside the frame, and nothing else."""
    scene = dg.Scene()
    to_sun = np.array([math.tan(math.radians(degrees)), 0.0, -1.0])
    z = to_sun / np.linalg.norm(to_sun)  # it shines along its own -z
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 2] = np.cross([0.0, 1.0, 0.0], z), z
    scene.add_light(dg.DirectionalLight((1e4, 1e4, 1e4)), pose)
    return scene


def camera(**changes: Any) -> dg.Camera:
    return dg.Camera(**{"lens": LENS, "f_stop": 4.0, "focus_distance": 10.0, **changes})


def session(scene: dg.Scene | None = None, eye: dg.Camera | None = None, **options: Any) -> Session:
    options = {"resolution": SIZE, "scatter": PATHS, "light_paths": "off", **options}
    return Session(scene or sunny(), eye or camera(), **options)


def layer(drawn: Session, samples: int = 1) -> Any:
    drawn.draw(0, samples)
    flare = drawn.frame().flare
    assert flare is not None
    return flare


def test_scattered_light_is_in_the_picture_and_in_the_layer_of_flare() -> None:
    drawn = session()
    flare = layer(drawn, 2)
    assert flare.max() > 0
    # Nothing else shines: the sun is beside the frame.
    np.testing.assert_allclose(drawn.frame().rgb, flare, atol=1e-6)
    assert drawn.counters.scatter_paths == 2 * PATHS
    assert drawn.counters.scatter_hits > 0.02 * drawn.counters.scatter_paths


def test_the_barrel_is_lit_on_the_side_away_from_the_sun() -> None:
    parts = dg.LensScatter(blades=0, blades_gloss=0, surface_rms_nm=0)
    flare = layer(session(eye=camera(scatter=parts), scatter=20000.0))[..., 1]
    left, right = flare[:, : SIZE[0] // 2].mean(), flare[:, SIZE[0] // 2 :].mean()
    assert left > 3 * right  # the sun stands to the right; its light falls on the wall to the left


def test_brighter_parts_scatter_in_proportion() -> None:
    bright = []
    for share in (0.01, 0.02):
        parts = dg.LensScatter(share, 0, 0, 0, surface_rms_nm=0)
        bright.append(float(layer(session(eye=camera(scatter=parts), scatter=20000.0)).sum()))
    assert bright[1] / bright[0] == pytest.approx(2, rel=0.1)


def test_without_scatter_nothing_changes() -> None:
    plain, off = session(scatter="off"), session(scatter=0, eye=camera(scatter=dg.LensScatter(0.2)))
    plain.draw(0, 1)
    off.draw(0, 1)
    assert plain.frame().flare is None
    assert plain.state().keys() == off.state().keys()
    assert plain.key == off.key
    assert "scatter" not in plain.metadata
    assert session(scatter="auto").scatter == 2 * SIZE[0] * SIZE[1]


def test_threads_and_ranges_bring_the_same_light(tmp_path: Path) -> None:
    whole, first, second = session(threads=1), session(threads=3), session(threads=2)
    whole.draw(0, 3)
    first.draw(0, 1)
    second.draw(1, 3)
    frame, _ = merge(through_files(tmp_path, first, second))
    np.testing.assert_array_equal(frame.rgb, whole.frame().rgb)
    np.testing.assert_array_equal(frame.flare, whole.frame().flare)


@pytest.mark.parametrize(
    "change", [{"scatter": 2 * PATHS}, {"eye": camera(scatter=dg.LensScatter(barrel=0.05))}]
)
def test_other_paths_or_parts_are_another_picture(change: dict[str, Any], tmp_path: Path) -> None:
    parts = []
    for i, options in enumerate(({}, change)):
        drawn = session(**options)
        drawn.draw(i, i + 1)
        parts.append(drawn)
    passes = through_files(tmp_path, *parts)
    with pytest.raises(MismatchError, match="scatter"):
        merge(passes)


def test_the_file_says_so(tmp_path: Path) -> None:
    import OpenEXR

    drawn = session()
    drawn.draw(0, 1)
    drawn.frame().save(tmp_path / "f.exr")
    with OpenEXR.File(str(tmp_path / "f.exr"), separate_channels=True) as file:
        assert {"flare.R", "flare.G", "flare.B"} <= set(file.channels())
        assert file.header()["daguerre:scatter"] == "4000"


def test_a_wall_before_the_sun_takes_the_light_away() -> None:
    scene = sunny()
    points, faces = scenes.quad(50)
    black = dg.Material(dg.Diffuse((0, 0, 0)))
    scene.add_instance(scene.add_mesh(points, faces), black, scenes.at(0, 0, -5))
    drawn = session(scene)
    drawn.draw(0, 1)
    assert drawn.frame().rgb.max() == 0


def test_black_and_smooth_parts_scatter_nothing() -> None:
    drawn = session(eye=camera(scatter=BLACK))
    assert drawn.scatter == 0
    assert any("scatters nothing" in note for note in drawn.notes)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"lens": "thin"}, "scatter: wanted a lens with surfaces.*got thin"),
        ({"lens_model": "thick"}, "got thick"),
        ({"lens": "thin", "scatter": dg.LensScatter()}, "camera: scatter: wanted a lens with"),
        ({"scatter": 0.04}, "scatter: wanted a LensScatter, got 0.04"),
        ({"scatter": dg.LensScatter(barrel=1.5)}, "scatter: barrel: wanted"),
        ({"scatter": dg.LensScatter(barrel=0.9, barrel_gloss=0.1)}, "at most all light"),
        ({"scatter": dg.LensScatter(surface_rms_nm=-1)}, "surface_rms_nm: wanted"),
        ({"scatter": dg.LensScatter(surface_lobe=(0.0, -2.0))}, "surface, knee: wanted"),
        ({"scatter": dg.LensScatter(gloss_lobe=(0.1,))}, "gloss_lobe"),  # type: ignore[arg-type]
    ],
)
def test_bad_cameras_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        session(eye=camera(**changes))


def test_a_lens_whose_barrel_is_not_known_is_refused() -> None:
    with pytest.raises(InputError, match="wanted a lens with axial symmetry"):
        session(eye=camera(decenter=(((0, 1), (0.2, 0.0), (0.0, 0.0)),)))


@pytest.mark.parametrize("value", ["on", -1, "1,2", True, float("nan"), 1e10])
def test_bad_numbers_are_refused(value: Any) -> None:
    with pytest.raises(UsageError, match="scatter: wanted auto, off, or a number"):
        session(scatter=value)


def test_the_veiling_glare_index_counts_ghosts_and_scatter() -> None:
    bench = set_up(dg.lenses.load(LENS), f_stop=4.0)
    quiet = VeilingGlare(bench, scatter=BLACK, walks=20000)
    rough, rougher = (
        VeilingGlare(bench, scatter=dg.LensScatter(0, 0, 0, 0, surface_rms_nm=rms), walks=20000)
        for rms in (5, 10)
    )
    assert quiet.scatter == 0
    assert 0 < quiet.ghosts < 0.02
    assert quiet.index == pytest.approx(100 * quiet.ghosts / (1 + quiet.ghosts))
    assert abs(rough.ghosts - quiet.ghosts) < 5 * (rough.ghosts_error + quiet.ghosts_error)
    assert rougher.scatter / rough.scatter == pytest.approx(4, rel=0.15)
    # Ten surfaces with steps of index of about 0.7; what lands within the black patch is no glare.
    assert 0.3 < rough.scatter / (10 * (2 * np.pi * 5 * 0.7 / 550) ** 2) < 1.3


def test_the_bench_tells_the_veiling_glare(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lens", LENS, "--veiling-glare", "--json"]) == 0
    glare = json.loads(capsys.readouterr().out)["veiling_glare"]
    assert 0 < glare["index_percent"] < 5
    assert main(["lens", LENS, "--veiling-glare"]) == 0
    assert "veiling glare index" in capsys.readouterr().out


def test_flags_of_parts_want_scatter(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code = main(["render", "x.glb", "-o", str(tmp_path / "o.exr"), "--scatter-barrel", "0.1"])
    assert code == 2
    assert "--scatter" in capsys.readouterr().err
