"""Engraved stops: up to 3 % wider than the lens opens is wide open, with a note."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.lenses.engraved import opened, remark

SUMMILUX = "leica-summilux-sl-50mm-f1.4"  # f/1.44


@pytest.mark.parametrize(
    ("given", "used"), [(2.0, 2.0), (1.44, 1.44), (1.43, 1.43), (1.42, 1.44), (1.4, 1.44)]
)
def test_up_to_three_per_cent(given: float, used: float) -> None:
    assert opened(given, 1.44) == used
    assert (remark("L", given, used) is None) == (given == used)
    assert opened(1.39, 1.44) == 1.39  # which is refused elsewhere


def test_bench_fit_and_camera() -> None:
    lens = dg.lenses.load(SUMMILUX)
    widest = lens.first_order().f_number
    assert dg.analysis.set_up(lens, f_stop=1.4).f_stop == widest
    assert dg.polynomial.fit(lens, 3, f_stop=1.4).setting.f_stop == widest
    with pytest.raises(dg.InputError, match="lens-f-stop"):
        dg.analysis.set_up(lens, f_stop=1.38)
    camera = dg.Camera(lens=SUMMILUX, f_stop=1.4)
    scene = dg.Scene()
    scene.set_environment(np.ones((4, 8, 3), np.float32))
    same = [
        dg.render(scene, one, resolution=(12, 8), spp=2)
        for one in (camera, camera.with_(f_stop=widest))
    ]
    assert np.array_equal(same[0].rgb, same[1].rgb)
    assert same[0].metadata["aperture"] == pytest.approx(widest)
    with pytest.raises(dg.InputError, match="lens-f-stop"):
        dg.render(scene, camera.with_(f_stop=1.38), resolution=(12, 8), spp=1)


def test_t_stops_and_stops_that_change() -> None:
    camera = dg.Camera(lens=SUMMILUX, t_stop=1.45, shutter_time=1.0)  # T/1.49
    scene = dg.Scene()
    scene.set_environment(np.ones((4, 8, 3), np.float32))
    frame = dg.render(scene, camera, resolution=(12, 8), spp=1)
    assert frame.metadata["aperture"] == pytest.approx(1.44, rel=1e-3)
    moving = dg.Camera(lens=SUMMILUX, f_stop=dg.keys([(-1, 1.4), (1, 2.8)]), shutter_time=1.0)
    assert np.isfinite(dg.render(scene, moving, resolution=(12, 8), spp=1).rgb).all()


def test_commands_say_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = "f/1.4: Leica Summilux-SL 50 mm f/1.4 ASPH opens to f/1.44, which is used"
    assert main(["lens", SUMMILUX, "--f-stop", "1.4"]) == 0
    assert said in capsys.readouterr().err
    assert main(["chart", "colour", "-o", str(tmp_path / "s.glb")]) == 0
    words = ["render", str(tmp_path / "s.glb"), "--lens", SUMMILUX, "--res", "12x8", "--spp", "1"]
    assert main([*words, "--f-stop", "1.4", "-o", str(tmp_path / "a.png")]) == 0
    assert said in capsys.readouterr().err
    assert main([*words, "--f-stop", "2", "-o", str(tmp_path / "a.png")]) == 0
    assert "opens to" not in capsys.readouterr().err
