"""The command line on a real file and the real core."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from daguerre.cli import main
from tests.support.formats.make_gltf import Builder

CHANNELS = {
    *"RGBA", "depth.Z", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "albedo.R", "albedo.G",
    "albedo.B", "object_id", "variance.R", "variance.G", "variance.B", "samples.Y",
}  # fmt: skip
QUICK = ["--res", "20x12", "--sky", "1,0.9,0.8", "--quiet"]
DISTANCE = 2.0


def pixels(path: str) -> dict[str, np.ndarray]:
    with OpenEXR.File(path, separate_channels=True) as file:
        return {name: c.pixels.copy() for name, c in file.channels().items()}


@pytest.fixture(autouse=True)
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A grey square of 4 m, 2 m in front of the camera, and a node off to the side."""
    monkeypatch.chdir(tmp_path)
    made = Builder()
    corners = np.array([[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], np.float32)
    normals = np.tile(np.float32([0, 0, 1]), (4, 1))
    ends = {"min": [-2, -2, 0], "max": [2, 2, 0]}
    attributes = {"POSITION": made.accessor(corners, **ends), "NORMAL": made.accessor(normals)}
    material = made.add(
        "materials",
        {"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.5, 0.25, 0.125, 1]}},
    )
    wall = made.mesh(attributes, indices=made.accessor([0, 1, 2, 0, 2, 3], "u2"), material=material)
    made.node(mesh=wall, name="Wall", translation=[0, 0, -DISTANCE])
    made.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.01}})
    made.node(camera=0, name="Camera")
    made.node(name="Target", translation=[0.5, 0, -1.25])
    return made.glb(tmp_path / "s.glb")


def test_channels_and_their_values() -> None:
    flags = ["--spp", "16", "--aov", "all", "--lens", "pinhole"]
    assert main(["render", "s.glb", "-o", "a.exr", *flags, *QUICK]) == 0
    planes = pixels("a.exr")
    assert set(planes) == CHANNELS
    np.testing.assert_allclose(planes["depth.Z"], DISTANCE, rtol=1e-6)
    np.testing.assert_allclose(planes["P.Z"], -DISTANCE, rtol=1e-6)
    np.testing.assert_allclose(planes["N.Z"], 1, rtol=1e-6)
    # 4 % of the light is reflected by the coat of a dielectric of index 1.5.
    np.testing.assert_allclose(planes["albedo.G"], 0.25 * 0.96 + 0.04, atol=0.04)
    assert planes["object_id"].dtype == np.uint32
    assert (planes["object_id"] == 1).all()
    assert (planes["samples.Y"] == 16).all()
    assert (planes["A"] == 1).all()


def test_split_merged_equals_whole() -> None:
    flags = [*QUICK, "--aov", "depth,N", "--f-stop", "2", "--focus", "1.5"]
    assert main(["render", "s.glb", "-o", "whole.exr", "--spp", "12", *flags]) == 0
    for samples, threads in (("0:5", "1"), ("5:6", "2"), ("6:12", "3")):
        name = f"{samples.replace(':', '-')}.exr"
        run = ["render", "s.glb", "-o", name, "--samples", samples, "--threads", threads]
        assert main([*run, *flags]) == 0
    assert main(["merge", "6-12.exr", "0-5.exr", "5-6.exr", "-o", "merged.exr", "-q"]) == 0
    assert Path("merged.exr").read_bytes() == Path("whole.exr").read_bytes()


def test_passes_of_another_command_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    for name, samples, more in (
        ("a", "0:2", []),
        ("b", "2:4", ["--f-stop", "4"]),
        ("c", "1:3", []),
    ):
        run = ["render", "s.glb", "-o", f"{name}.exr", "--samples", samples, *QUICK, *more]
        assert main(run) == 0
    assert main(["merge", "a.exr", "b.exr", "-o", "m.exr"]) == 4
    assert "the camera" in capsys.readouterr().err
    assert main(["merge", "a.exr", "c.exr", "-o", "m.exr"]) == 4
    assert "samples 1:2" in capsys.readouterr().err
    assert not Path("m.exr").exists()


def test_more_samples_after_a_pass_of_fewer() -> None:
    """A pass of the first samples, taken as a checkpoint, is continued to the same bits."""
    assert main(["render", "s.glb", "-o", "a.checkpoint.exr", "--samples", "0:7", *QUICK]) == 0
    assert main(["render", "s.glb", "-o", "a.exr", "--spp", "16", "--resume", *QUICK]) == 0
    assert main(["render", "s.glb", "-o", "b.exr", "--spp", "16", *QUICK]) == 0
    assert Path("a.exr").read_bytes() == Path("b.exr").read_bytes()
    assert not Path("a.checkpoint.exr").exists()


def test_autofocus_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    run = ["render", "s.glb", "-o", "a.exr", "--spp", "1", "--res", "20x12", "--sky", "1,1,1"]
    assert main(run) == 0
    assert "2 m" in capsys.readouterr().err
    assert main([*run, "--focus-on", "Target"]) == 0
    assert "'Target' is 1.25 m" in capsys.readouterr().err
    with OpenEXR.File("a.exr", header_only=True) as file:
        assert file.header()["focus"] == pytest.approx(1.25)
    assert main([*run, "--focus-on", "Taget"]) == 3  # codespell:ignore taget
    assert "did you mean 'Target'" in capsys.readouterr().err


def test_an_exact_lens_and_its_limits(capsys: pytest.CaptureFixture[str]) -> None:
    run = ["render", "s.glb", "-o", "a.exr", "--spp", "2", "--lens", "double-gauss-50mm-f2", *QUICK]
    assert main(run) == 0
    with OpenEXR.File("a.exr", header_only=True) as file:
        header = dict(file.header())
    assert header["nominalFocalLength"] == pytest.approx(50.0, abs=0.1)
    assert "ouble" in header["lensModel"]
    assert json.loads(header["daguerre:camera"])["lens_model"] == "exact"
    Path("a.exr").unlink()
    for flags, text in (
        (["--f-stop", "1.2"], "wanted 2 or more, as this lens opens to f/2; got 1.2"),
        (["--focus", "0.02"], "focus"),
        (["--lens", "double-gaus-50mm-f2"], "double-gauss-50mm-f2"),
    ):
        assert main([*run, *flags]) in (2, 3)
        error = capsys.readouterr().err
        assert text in error
        assert len(error.strip().splitlines()) == 1
    assert not Path("a.exr").exists()


def test_info(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", "s.glb", "--f-stop", "4", "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["triangles"] == 2
    assert facts["bounds_m"] == [[-2, -2, -2], [2, 2, -2]]
    camera = facts["cameras"]["Camera"]
    assert camera["focus_m"] == pytest.approx(DISTANCE)
    focal = 12 / math.tan(0.3)  # 24 mm of sensor height see yfov
    assert camera["focal_length_mm"] == pytest.approx(focal, rel=1e-6)
    assert camera["field_of_view_deg"][1] == pytest.approx(math.degrees(0.6))
    assert camera["near_m"] < DISTANCE < camera["far_m"]
    assert camera["pupil_diameter_mm"] == pytest.approx(focal / 4, rel=1e-6)
    assert main(["info", "s.glb", "--focus", "inf", "--shutter", "1/60"]) == 0
    text = capsys.readouterr().out
    for words in ("hyperfocal distance", "depth of field", "to infinity", "EV100", "deg", "mm"):
        assert words in text


def test_info_of_a_lens(capsys: pytest.CaptureFixture[str]) -> None:
    assert (
        main(["info", "s.glb", "--lens", "double-gauss-50mm-f2", "--f-stop", "2.8", "--json"]) == 0
    )
    camera = json.loads(capsys.readouterr().out)["cameras"]["Camera"]
    assert camera["focal_length_mm"] == pytest.approx(50, abs=0.1)
    assert camera["f_stop"] == pytest.approx(2.8)


def test_lenses(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lenses"]) == 0
    rows = capsys.readouterr().out.splitlines()
    assert len(rows) >= 4
    assert any(row.startswith("double-gauss-50mm-f2 ") and "mm" in row for row in rows)
    assert main(["lens", "double-gauss-50mm-f2", "--json", "--drawing", "x.svg"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["efl"] == pytest.approx(50, abs=0.1)
    assert facts["entrance_pupil"]["diameter"] > 0
    assert Path("x.svg").read_text().lstrip().startswith("<svg")
    for name, magic in (("x.png", b"\x89PNG"), ("x.pdf", b"%PDF")):
        assert main(["lens", "fisheye-16mm-f2.8", "--drawing", name]) == 0
        assert Path(name).read_bytes().startswith(magic)
    capsys.readouterr()
    assert main(["lens", "double-gauss-50mm-f2", "--plot", "x.gif"]) == 2
    assert main(["lens", "duble-gauss-50mm-f2"]) == 3
    assert "double-gauss-50mm-f2" in capsys.readouterr().err


def test_a_truncated_scene(capsys: pytest.CaptureFixture[str]) -> None:
    whole = Path("s.glb").read_bytes()
    Path("t.glb").write_bytes(whole[: len(whole) // 2])
    for name in ("t.glb", "missing.glb", "s.obj"):
        assert main(["render", name, "-o", "a.exr"]) == 3
        error = capsys.readouterr().err
        assert name in error
        assert len(error.strip().splitlines()) == 1
    assert not Path("a.exr").exists()


def test_noise_is_reached_and_told(capsys: pytest.CaptureFixture[str]) -> None:
    flags = ["--noise", "0.02", "--json-progress", *QUICK[:-1]]
    assert main(["render", "s.glb", "-o", "a.exr", *flags]) == 0
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    last = [e for e in events if e["event"] == "progress"][-1]
    assert last["noise"] <= last["noise_wanted"] == 0.02
    assert last["fraction"] == pytest.approx(1)
    assert any("noise 0.01" in e.get("text", "") for e in events)
    with OpenEXR.File("a.exr") as file:
        header = dict(file.header())
    assert header["daguerre:noise"] <= 0.02
    counts = pixels("a.exr")["samples.Y"]
    assert header["daguerre:samples"] == pytest.approx(counts.mean())
    assert header["daguerre:samples_min"] == counts.min()
    assert header["daguerre:samples_max"] == counts.max()
    assert main(["render", "s.glb", "-o", "a.exr", "--noise", "0.001", "--spp", "24", *QUICK]) == 0
    assert pixels("a.exr")["samples.Y"].max() == 24


def test_noise_goes_on_from_checkpoints_that_fit(capsys: pytest.CaptureFixture[str]) -> None:
    from daguerre.rendering import job

    noise = ["--noise", "0.01", *QUICK]
    assert main(["render", "s.glb", "-o", "whole.exr", *noise]) == 0
    finish = job.Drawing._finish

    def keep(self: job.Drawing) -> None:
        self.loop.save()

    job.Drawing._finish = keep  # type: ignore[method-assign]
    try:  # a coarser noise leaves the checkpoint of an interrupted run
        assert main(["render", "s.glb", "-o", "a.exr", "--noise", "0.03", *QUICK]) == 0
    finally:
        job.Drawing._finish = finish  # type: ignore[method-assign]
    capsys.readouterr()
    assert main(["render", "s.glb", "-o", "a.exr", "--resume", *QUICK]) == 4
    assert "drawn with --noise" in capsys.readouterr().err
    assert main(["merge", "a.checkpoint.exr", "-o", "b.exr"]) == 4
    assert main(["render", "s.glb", "-o", "a.exr", "--resume", *noise]) == 0
    assert pixels("a.exr")["samples.Y"].mean() > 16


def test_truth_of_a_photograph_lies_beside_it() -> None:
    """A sky of luminance 1 on a surface of 0.25: in lux s, and where that saturates."""
    told = ["--aov", "exposure,saturated", "--sensor", "ideal", "--exposure-f-stop", "4"]
    told += ["--exposure", "manual"]
    shot = [*told, "--exposure-time", "20", "--iso", "100", "--spp", "64"]
    assert main(["render", "s.glb", "-o", "a.exr", "-o", "a.dng", *QUICK, *shot]) == 0
    seen = pixels("a.exr")
    luminance = seen["R"] * 0.2126 + seen["G"] * 0.7152 + seen["B"] * 0.0722
    lux_s = math.pi / 4 / 4**2 * 20
    np.testing.assert_allclose(seen["exposure.Y"], luminance * lux_s, rtol=0.02)
    for name in "RGB":
        assert not seen[f"saturated.{name}"].any()
    longer = [*shot, "--exposure-time", "400"]
    assert main(["render", "s.glb", "-o", "b.exr", *QUICK, *longer]) == 0
    assert pixels("b.exr")["saturated.G"].all()


def test_a_pass_is_not_exposed(capsys: pytest.CaptureFixture[str]) -> None:
    flags = ["--samples", "0:1", "--spp", "2", "--aov", "depth,exposure"]
    assert main(["render", "s.glb", "-o", "a.exr", *QUICK, *flags]) == 2
    assert "wanted one of them, got both; a pass is not exposed" in capsys.readouterr().err
