"""The programs of examples/: each runs at a small size, and what it writes is true."""

from __future__ import annotations

import ast
import importlib.util
import json
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import cv2
import exifread
import numpy as np
import pytest
import rawpy

import daguerre as dg
from daguerre import analysis, charts

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
NAMES = (
    *("first_picture", "bokeh_and_focus", "scene_from_arrays", "motion_blur"),
    *("ground_truth", "calibrated_camera", "lens_report", "photograph"),
)


def example(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def tree(name: str) -> ast.Module:
    return ast.parse((EXAMPLES / f"{name}.py").read_text())


@pytest.mark.parametrize("name", NAMES)
def test_it_uses_public_names_alone(name: str) -> None:
    for node in ast.walk(tree(name)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("daguerre"):
            assert (node.module, [a.name for a in node.names]) == ("daguerre", ["analysis"])
        elif isinstance(node, ast.Import):
            found = {a.name for a in node.names if a.name.startswith("daguerre")}
            assert found <= {"daguerre"}
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            assert node.value.id != "dg" or node.attr in dg.__all__
            assert node.value.id != "analysis" or node.attr in analysis.__all__
        assert not (isinstance(node, ast.Attribute) and node.attr.startswith("_"))


@pytest.mark.parametrize("name", NAMES)
def test_its_first_lines_say_the_command(name: str) -> None:
    assert f"\n    python examples/{name}.py " in (ast.get_docstring(tree(name), clean=False) or "")


def test_the_readme_lists_every_program() -> None:
    text = (EXAMPLES / "README.md").read_text()
    for path in EXAMPLES.glob("*.py"):
        assert text.count(f"[`{path.name}`]({path.name})") == 1
    assert all((EXAMPLES / f"{name}.py").exists() for name in NAMES)


def test_first_picture(tmp_path: Path) -> None:
    chart = charts.make("colour")
    chart.save(tmp_path / "chart.glb")
    example("first_picture").main(tmp_path / "chart.glb", tmp_path, width=120, spp=16)
    frame = dg.load_frame(tmp_path / "first_picture.exr")
    assert frame.metadata["aperture"] == pytest.approx(2.0)
    shown = cv2.imread(str(tmp_path / "first_picture.png"))[..., ::-1]
    assert np.array_equal(shown, frame.display("soft"))
    seen = charts.means(frame.rgb, chart, frame.metadata, inner=0.4)
    for k in (8, 9, 14, 15):  # around the middle, where the lens darkens little
        wanted = 100 * np.array(chart.truth["patches"][k]["rgb"])
        assert seen[k] == pytest.approx(wanted, rel=0.15, abs=2)


def test_bokeh_and_focus(tmp_path: Path) -> None:
    """Discs hold the same light at f/4 and f/8, and are as wide as the pupil."""
    program = example("bokeh_and_focus")
    program.main(tmp_path, width=150, spp=8)
    sheet = dg.load_frame(tmp_path / "bokeh_and_focus.exr").rgb[..., 1]
    cells = sheet.reshape(3, 100, 3, 3, 50).transpose(0, 2, 3, 1, 4)  # stop, focus, lamp
    assert sheet.shape == (300, 450)
    light = cells.sum(axis=(3, 4))
    for lamp, focus in ((2, 0), (0, 2)):  # far away from the focus
        wide, half, quarter = (cells[stop, focus, lamp] for stop in range(3))
        assert light[1, focus, lamp] == pytest.approx(light[2, focus, lamp], rel=0.1)
        assert 0.7 < light[0, focus, lamp] / light[1, focus, lamp] < 1  # mounts cut it at f/2
        widths = [np.sqrt(spread(part)) for part in (wide, half, quarter)]
        assert widths[0] / widths[1] == pytest.approx(2, rel=0.2)
        assert widths[1] > widths[2]
    for lamp in range(3):
        widths = [spread(cells[0, focus, lamp]) for focus in range(3)]
        assert np.argmin(widths) == lamp  # sharp where it is in focus


def spread(light: np.ndarray) -> float:
    """Variance about the centroid, px^2."""
    y, x = np.mgrid[: light.shape[0], : light.shape[1]]
    total = light.sum()
    u, v = (x * light).sum() / total, (y * light).sum() / total
    return float((((x - u) ** 2 + (y - v) ** 2) * light).sum() / total)


def test_scene_from_arrays(tmp_path: Path) -> None:
    """Each point that is seen lies on the surface, and the middle one is what is looked at."""
    program = example("scene_from_arrays")
    program.main(tmp_path, width=90, spp=4)
    frame = dg.load_frame(tmp_path / "scene_from_arrays.exr")
    x, y, z = (frame.aovs[f"P.{axis}"] for axis in "XYZ")
    inside = np.zeros(x.shape, bool)
    inside[25:50, 20:70] = True  # no pixel there mixes water and sky
    r = np.hypot(x, z)
    assert frame.alpha[inside].min() == 1
    off = np.abs(y - 0.04 * np.cos(25 * r) * np.exp(-2 * r))[inside]
    assert np.median(off) < 1e-3
    assert np.quantile(off, 0.95) < 5e-3  # a pixel's mean is off where a crest hides a dip
    assert np.hypot(x, z)[30, 45] < 0.12
    reached = np.sqrt(sum((p - e) ** 2 for p, e in zip((x, y, z), program.EYE, strict=True)))
    assert reached[30, 45] == pytest.approx(np.linalg.norm(program.EYE - program.TARGET), abs=0.12)


def test_motion_blur(tmp_path: Path) -> None:
    program = example("motion_blur")
    program.main(tmp_path, width=180, spp=32)
    px_per_m = 180 / 2  # a frame of 36 mm, 36 mm behind the pinhole, is 2 m wide there
    rows = slice(30, 90)
    instant, blurred, rolling = (
        dg.load_frame(tmp_path / f"motion_{name}.exr").rgb[rows, :, 1].astype(float)
        for name in ("instant", "blurred", "rolling")
    )
    x = np.arange(180)
    for picture in (instant, blurred, rolling):
        assert picture.sum(axis=1).mean() == pytest.approx(0.2 * px_per_m, rel=0.02)

    def variance(picture: np.ndarray) -> float:
        row = picture.mean(axis=0)
        middle = (x * row).sum() / row.sum()
        return float(((x - middle) ** 2 * row).sum() / row.sum())

    way = program.SPEED / 60 * px_per_m
    assert variance(blurred) - variance(instant) == pytest.approx(way**2 / 12, rel=0.1)
    centres = (rolling * x).sum(axis=1) / rolling.sum(axis=1)
    lean = np.polyfit(np.arange(60), centres, 1)[0]
    assert lean == pytest.approx(program.SPEED / 30 * px_per_m / 120, rel=0.02)


def test_ground_truth(tmp_path: Path) -> None:
    """Boxes are those of the cubes' corners through a pinhole, by hand."""
    program = example("ground_truth")
    program.main(tmp_path, width=150, spp=4)
    coco = json.loads((tmp_path / "ground_truth.json").read_text())
    assert [one["name"] for one in coco["categories"]] == ["crate", "toy"]
    kinds = [box["category_id"] for box in coco["annotations"]]
    assert kinds[0] == kinds[1] != kinds[2]
    frame = dg.load_frame(tmp_path / "ground_truth.exr")
    unit = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2
    for box, (_, place, side) in zip(coco["annotations"], program.THINGS, strict=True):
        x, y, z = (side * unit + place).T
        seen = 150 * np.stack([x, -y]) / -z + [[75], [50]]
        left, top, wide, high = box["bbox"]
        low, end = seen.min(axis=1), seen.max(axis=1)
        if place[0] == -0.5:  # no other cube hides its edges
            assert [left, top] == pytest.approx(low, abs=1)
            assert [left + wide, top + high] == pytest.approx(end, abs=1)
        assert left >= low[0] - 1
        assert left + wide <= end[0] + 1
        assert box["area"] <= wide * high
    found = {int(i): int((frame.aovs["object_id"] == i).sum()) for i in (1, 2, 3)}
    assert list(found.values()) == [box["area"] for box in coco["annotations"]]
    depth = frame.aovs["depth.Z"]
    assert depth[depth > 0].min() == pytest.approx(1.8 - 0.15, abs=1e-4)


def test_calibrated_camera(tmp_path: Path) -> None:
    """OpenCV finds the corners of the straightened board where K alone puts them."""
    program = example("calibrated_camera")
    program.main(tmp_path, width=640, spp=4)
    board = charts.make("checkerboard", columns=10, rows=7, square=0.03)
    points = charts.object_points(board.truth["corners_m"])
    pose = board.camera(focal_length=36).transform
    view = np.diag((1.0, -1, -1, 1)) @ np.linalg.inv(pose)
    seen = np.c_[points, np.ones(len(points))] @ view.T @ np.eye(4, 3)
    k = np.array(program.FOUND["K"])
    wanted = (seen @ k.T)[:, :2] / seen[:, 2:]
    wanted = (wanted + 0.5) / 2 - 0.5  # half of the calibrated size
    apart = {}
    for name in ("bent", "straightened"):
        picture = cv2.imread(str(tmp_path / f"calibrated_{name}.png"), cv2.IMREAD_GRAYSCALE)
        assert picture.shape == (360, 640)
        found, corners = cv2.findChessboardCornersSB(picture, (9, 6))
        assert found
        off = np.linalg.norm(corners.reshape(-1, 1, 2) - wanted[None], axis=2).min(axis=1)
        apart[name] = float(off.max())
    assert apart["straightened"] < 0.3
    assert apart["bent"] > 3


def test_lens_report(tmp_path: Path) -> None:
    command = [sys.executable, str(EXAMPLES / "lens_report.py")]
    subprocess.run(command, check=True, capture_output=True, cwd=tmp_path)
    report = json.loads((tmp_path / "out" / "lens_report.json").read_text())
    assert report["efl_mm"] == pytest.approx(50, rel=1e-3)
    assert report["f_number"] == pytest.approx(2, rel=1e-3)
    wide, stopped = report["rows"][:3], report["rows"][3:]
    assert [row["f_stop"] for row in report["rows"]] == pytest.approx(3 * [2.0] + 3 * [4.0])
    for one, two in zip(wide, stopped, strict=True):
        assert two["spot_um"] < 0.6 * one["spot_um"]  # f/4 cuts the worst rays off
        for row in (one, two):
            assert row["mtf"] == sorted(row["mtf"], reverse=True)
            cycles = 587.5618e-6 * row["f_stop"] * np.array([10, 30, 50])
            perfect = 2 / np.pi * (np.arccos(cycles) - cycles * np.sqrt(1 - cycles**2))
            assert (np.array(row["mtf"]) < perfect + 0.01).all()
    assert stopped[0]["spot_um"] < stopped[1]["spot_um"] < stopped[2]["spot_um"]


def test_photograph(tmp_path: Path) -> None:
    """Numbers of the raw file follow the chart's greys; the JPEG says how it was taken."""
    example("photograph").main(tmp_path, width=180, spp=8)
    chart = charts.make("colour")
    facts = dg.load_frame(tmp_path / "photograph.exr").metadata
    with (tmp_path / "photograph.jpg").open("rb") as file:
        tags = exifread.process_file(file)
    assert str(tags["EXIF ExposureTime"]) == "1/60"
    assert float(tags["EXIF FNumber"].values[0]) == pytest.approx(5.6)
    greys = slice(18, 24)
    truth = np.array([patch["rgb"][1] for patch in chart.truth["patches"][greys]])
    with rawpy.imread(str(tmp_path / "photograph.dng")) as raw:
        numbers = raw.raw_image_visible.astype(float) - raw.black_level_per_channel[1]
        green = np.isin(raw.raw_colors_visible, (1, 3))
    share = charts.means(green, chart, facts)[greys]
    values = charts.means(np.where(green, numbers, 0), chart, facts)[greys] / share
    assert values / values[0] == pytest.approx(truth / truth[0], rel=0.05, abs=0.005)
    shown = cv2.imread(str(tmp_path / "photograph.jpg")).astype(float)
    rows = charts.means(shown, chart, facts)[greys]
    assert (np.diff(rows.mean(axis=1)) < -5).all()
    assert np.ptp(rows[:5], axis=1).max() < 12  # grey is grey


def test_the_first_one_says_how_to_call_it() -> None:
    command = [sys.executable, str(EXAMPLES / "first_picture.py"), "--help"]
    said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    assert "scene" in said
    assert "folder" in said
