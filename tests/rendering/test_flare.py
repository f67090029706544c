"""Ghosts in a picture: the session, its layer in the file, bits and splits, bad input."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import analysis
from daguerre.analysis.ghosts import Ghosts
from daguerre.cli import main
from daguerre.errors import InputError, MismatchError, UsageError
from daguerre.rendering.diffraction import Diffraction
from daguerre.rendering.merging import merge
from daguerre.rendering.session import Session
from tests.support.formats.pass_files import through_files
from tests.support.scene import scenes

LENS = "double-gauss-50mm-f2"
SIZE = (36, 24)
PATHS = 20000.0


def sunny() -> dg.Scene:
    """A sun above the frame's middle, and nothing else."""
    scene = dg.Scene()
    to_sun = np.array([0.06, 0.12, -1.0])
    z = to_sun / np.linalg.norm(to_sun)  # it shines along its own -z
    pose = np.eye(4)
    pose[:3, 0] = np.cross([0.0, 1.0, 0.0], z) / np.hypot(z[0], z[2])
    pose[:3, 1], pose[:3, 2] = np.cross(z, pose[:3, 0]), z
    scene.add_light(dg.DirectionalLight((1e4, 1e4, 1e4)), pose)
    return scene


def camera(**changes: Any) -> dg.Camera:
    return dg.Camera(**{"lens": LENS, "f_stop": 4.0, "focus_distance": 10.0, **changes})


def session(scene: dg.Scene | None = None, eye: dg.Camera | None = None, **options: Any) -> Session:
    options = {"resolution": SIZE, "flare": PATHS, "light_paths": "off", **options}
    return Session(scene or sunny(), eye or camera(), **options)


def same_bits(a: Session, b: Session) -> bool:
    first, second = a.state(), b.state()
    return first.keys() == second.keys() and all(
        np.array_equal(first[part], second[part]) for part in first
    )


def test_the_flare_is_in_the_picture_and_by_itself() -> None:
    drawn = session()
    drawn.draw(0, 2)
    frame = drawn.frame()
    assert frame.flare is not None
    assert frame.flare.max() > 0
    # Nothing else shines: a light without size is never seen.
    np.testing.assert_allclose(frame.rgb, frame.flare, atol=1e-6)
    drawn_of_maps = drawn.counters.flare_arrivals + drawn.counters.flare_rays
    assert drawn_of_maps == pytest.approx(2 * 4 * PATHS, rel=0.1)  # 4 arrivals for each path


def test_paths_alone_draw_what_maps_draw() -> None:
    """A film with bands has no maps: its ghosts are the same but for noise."""
    maps, paths = session(flare=4 * PATHS), session(flare=40 * PATHS, diffraction=Diffraction(4))
    for one in (maps, paths):
        one.draw(0, 1)
    assert maps.counters.flare_arrivals > 0
    assert paths.counters.flare_arrivals == 0
    assert paths.counters.flare_paths == 40 * PATHS
    assert paths.counters.flare_hits > 0.8 * paths.counters.flare_rays
    light = [one.frame(waves=False).rgb.mean(axis=(0, 1)) for one in (maps, paths)]
    np.testing.assert_allclose(light[0], light[1], rtol=0.02)


def test_without_flare_nothing_changes() -> None:
    plain, off = session(flare="off"), session(flare=0)
    plain.draw(0, 1)
    off.draw(0, 1)
    assert plain.frame().flare is None
    assert same_bits(plain, off)
    assert "flare" not in plain.metadata
    assert session(flare="auto").flare == 0.5 * SIZE[0] * SIZE[1]


def test_threads_ranges_and_crops_bring_the_same_light(tmp_path: Path) -> None:
    whole = session(threads=1)
    whole.draw(0, 3)
    first, second = session(threads=3), session(threads=2)
    first.draw(0, 1)
    second.draw(1, 3)
    frame, _ = merge(through_files(tmp_path, first, second))
    assert frame.flare is not None
    np.testing.assert_array_equal(frame.rgb, whole.frame().rgb)
    np.testing.assert_array_equal(frame.flare, whole.frame().flare)
    crop = session(crop=(10, 4, 30, 20))
    crop.draw(0, 3)
    np.testing.assert_array_equal(crop.frame().flare, frame.flare[4:20, 10:30])


def test_another_number_of_paths_is_another_picture(tmp_path: Path) -> None:
    parts = []
    for i, paths in enumerate((PATHS, 2 * PATHS)):
        drawn = session(flare=paths)
        drawn.draw(i, i + 1)
        parts.append(drawn)
    passes = through_files(tmp_path, *parts)
    with pytest.raises(MismatchError, match="flare"):
        merge(passes)


def test_the_file_has_the_layer(tmp_path: Path) -> None:
    import OpenEXR

    drawn = session()
    drawn.draw(0, 1)
    drawn.frame().save(tmp_path / "f.exr")
    with OpenEXR.File(str(tmp_path / "f.exr"), separate_channels=True) as file:
        names = set(file.channels())
        assert {"flare.R", "flare.G", "flare.B"} <= names
        assert file.header()["daguerre:flare"] == "20000"


def test_a_wall_before_the_sun_takes_the_ghosts_away() -> None:
    scene = sunny()
    points, faces = scenes.quad(50)
    black = dg.Material(dg.Diffuse((0, 0, 0)))
    scene.add_instance(scene.add_mesh(points, faces), black, scenes.at(0, 0, -5))
    drawn = session(scene)
    drawn.draw(0, 1)
    flare = drawn.frame().flare
    assert flare is not None
    assert flare.max() == 0


def test_the_sensor_and_its_glass_add_ghosts() -> None:
    bright = []
    for changes in ({}, {"sensor_reflectance": 0.2}, {"cover_glass": (2.0, 1.0)}):
        drawn = session(eye=camera(**changes))
        drawn.draw(0, 1)
        flare = drawn.frame().flare
        assert flare is not None
        bright.append(float(flare.sum()))
    assert bright[1] > 1.02 * bright[0]
    assert bright[2] != bright[0]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"lens": "thin"}, "wanted a lens with surfaces.*got thin"),
        ({"lens": "pinhole", "f_stop": None, "focus_distance": None}, "got pinhole"),
        ({"lens_model": "thick"}, "got thick"),
        ({"sensor_reflectance": 1.5}, "more light than arrives"),
        ({"cover_glass": (2.0,)}, "cover_glass: wanted"),
        ({"cover_glass": (2.0, 1.0, 9.0)}, "cover_glass"),
        ({"lens": "thin", "sensor_reflectance": 0.1}, "sensor_reflectance: wanted a lens"),
    ],
)
def test_bad_cameras_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        session(eye=camera(**changes))


def test_glass_that_does_not_fit_is_refused() -> None:
    with pytest.raises(InputError, match="behind the lens"):
        session(eye=camera(cover_glass=(60.0, 1.0)))


def test_four_reflections_add_a_little() -> None:
    bright = []
    for order in (2, 4):
        drawn = session(flare_order=order, eye=camera(sensor_reflectance=0.5))
        drawn.draw(0, 1)
        flare = drawn.frame().flare
        assert flare is not None
        bright.append(float(flare.sum()))
    assert 1 < bright[1] / bright[0] < 1.3
    with pytest.raises(UsageError, match="flare_order: wanted 2 or 4"):
        session(flare_order=3)


def mirrored() -> dg.Scene:
    """A lamp behind the camera's right shoulder, in a mirror before it."""
    scene = dg.Scene()
    points, faces = scenes.quad(0.2)
    chrome = dg.Material(dg.Conductor((1, 1, 1), alpha=0))
    scene.add_instance(scene.add_mesh(points, faces), chrome, scenes.at(0.05, 0, -1))
    scene.add_light(dg.SphereLight((1e6, 1e6, 1e6), 0.02), scenes.at(0.3, 0.2, 0.5))
    return scene


def test_a_lamp_in_a_mirror_has_ghosts() -> None:
    bright = []
    for highlights in ("on", "off"):
        drawn = session(mirrored(), flare_highlights=highlights)
        drawn.draw(0, 1)
        flare = drawn.frame().flare
        bright.append(0.0 if flare is None else float(flare.sum()))
        assert drawn.flare_spots == (highlights == "on")
        assert (drawn.survey_rays > 0) == (highlights == "on")
    assert bright[0] > 100 * bright[1]


def test_highlights_are_the_same_with_any_threads_and_another_picture_without(
    tmp_path: Path,
) -> None:
    whole = session(mirrored(), threads=1)
    whole.draw(0, 2)
    parts = [session(mirrored(), threads=3), session(mirrored(), threads=2)]
    parts.append(session(mirrored(), flare_highlights=False))
    for i, part in enumerate(parts):
        part.draw(min(i, 1), min(i, 1) + 1)
    passes = through_files(tmp_path, *parts)
    frame, _ = merge(passes[:2])
    np.testing.assert_array_equal(frame.flare, whole.frame().flare)
    with pytest.raises(MismatchError, match="flare"):
        merge([passes[0], passes[2]])
    with pytest.raises(UsageError, match="flare_highlights: wanted on or off, got 'maybe'"):
        session(flare_highlights="maybe")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"flare_order": 4}, "flare_order needs flare$"),
        ({"flare_highlights": "off"}, "flare_highlights needs flare or scatter$"),
    ],
)
def test_what_nothing_would_heed_is_refused(
    options: dict[str, Any], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(UsageError, match=message):
        session(flare="off", **options)
    ((name, value),) = options.items()
    flag = "--" + name.replace("_", "-")
    assert main(["render", "s.glb", "-o", "a.exr", flag, str(value)]) == 2
    assert f"{flag} needs --flare" in capsys.readouterr().err


def test_scattered_highlights_are_another_picture() -> None:
    on, off = (session(flare="off", scatter=100.0, flare_highlights=h) for h in (True, False))
    assert on.scatter > 0
    assert on.key != off.key


@pytest.mark.parametrize("value", ["on", -1, "1,2", True, float("nan"), 1e10])
def test_bad_numbers_are_refused(value: Any) -> None:
    with pytest.raises(UsageError, match="flare: wanted auto, off, or a number"):
        session(flare=value)


def test_the_bench_lists_ghosts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    drawing = tmp_path / "g.svg"
    assert main(["lens", LENS, "--flare", "10", "--json", "--drawing", str(drawing)]) == 0
    facts = json.loads(capsys.readouterr().out)
    lights = [g["light"] for g in facts["ghosts"]]
    n = 10  # surfaces but the stop
    assert len(lights) == n * (n - 1) // 2
    assert lights == sorted(lights, reverse=True)
    assert 0 < lights[0] < 0.01
    assert drawing.read_text().count("<polyline") > 5
    assert main(["lens", LENS, "--flare", "10", "--sensor-reflectance", "0.1"]) == 0
    assert "55 ghosts" in capsys.readouterr().out
    assert main(["lens", LENS, "--flare", "10", "--cover-glass", "2,1"]) == 0
    assert "66 ghosts" in capsys.readouterr().out


@pytest.mark.parametrize("angle", [12.0, 80.0])
def test_few_rays_find_the_ghosts_of_a_fisheye(angle: float) -> None:
    bench = analysis.set_up(dg.lenses.load("nikon-fisheye-6mm-f5.6"))
    few, many = (Ghosts(bench, angle, rays=rays) for rays in (1024, 16384))
    lights = [{g.surfaces: g.light for g in ghosts.all} for ghosts in (few, many)]
    total = sum(lights[1].values())
    assert sum(lights[0].values()) == pytest.approx(total, rel=0.1)
    for surfaces, light in lights[1].items():
        assert lights[0][surfaces] == pytest.approx(light, abs=0.02 * total)


@pytest.mark.parametrize(
    ("flags", "code", "message"),
    [
        (["--flare", "95"], 2, "below 90 degrees"),
        (["--ghost", "4,1"], 2, "--ghost needs --flare"),
        (["--flare", "10", "--ghost", "3,3", "--drawing", "x.svg"], 3, "two different surfaces"),
        (["--flare", "10", "--ghost", "1,99"], 3, "two different surfaces"),
        (["--flare", "10", "--sensor-reflectance", "2"], 2, "sensor_reflectance"),
    ],
)
def test_the_bench_refuses(
    flags: list[str],
    code: int,
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["lens", LENS, *flags]) == code
    assert message in capsys.readouterr().err
