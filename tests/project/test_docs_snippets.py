"""Code and commands of pages about calibrated cameras run as they stand, but for fewer pixels."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

import daguerre as dg
from daguerre import charts
from daguerre.calibration import Calibration, write
from daguerre.cli import main

DOCS = Path(__file__).resolve().parents[2] / "docs"
SHOT = range(1, 101)  # frames of a sequence
PAGES = ("projections", "calibration-files", "charts", "plates")
K = np.array([[905.0, 0, 641], [0, 904, 358], [0, 0, 1]])
DIST = np.array([[-0.21, 0.06, 0.0004, -0.0007, 0.0]])
PLATE = dg.Projection("opencv", (1280, 720), (905, 904), (641, 358), tuple(DIST[0]))


def blocks(page: str) -> list[tuple[str, str]]:
    text = (DOCS / f"{page}.md").read_text()
    return re.findall(r"^```(\w*)\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


EUROC = """sensor_type: camera
resolution: [752, 480]
camera_model: pinhole
intrinsics: [458.6, 457.3, 367.2, 248.4]
distortion_model: radial-tangential
distortion_coefficients: [-0.283, 0.074, 0.0002, 0.00002]
"""
KITTI = "".join(f"P{n}: 718.9 0 607.2 {-54 * n} 0 718.9 185.2 0 0 0 1 0\n" for n in range(4))


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """A folder with the files that the pages name, and what their code has at hand."""
    monkeypatch.chdir(tmp_path)
    board = charts.make("checkerboard")
    for name in ("desk", "plate", "shot", "street", "edge"):
        board.save(Path(f"{name}.glb"))
    write_opencv()
    write("left.yaml", Calibration(PLATE, "left"), "ros")
    write("right.yaml", Calibration(PLATE, "right"), "ros")
    beside = np.eye(4)
    beside[0, 3] = 0.12
    chain = [Calibration(PLATE, "cam0"), Calibration(PLATE, "cam1", beside)]
    for name in ("camchain.yaml", "rig.yaml"):
        write(name, [Calibration(without_k3(one.projection), one.name) for one in chain], "kalibr")
    write("camera_info.yaml", Calibration(PLATE, "left"), "ros")
    write("sample.json", Calibration(PLATE, pixel_pitch=3.45), "opentrackio")
    write("plate.yaml", Calibration(PLATE), "opencv")
    Path("sparse/0").mkdir(parents=True)
    Path("sparse/0/cameras.txt").write_text("1 OPENCV 1280 720 905 904 641 358 -0.21 0.06 0 0\n")
    solved = [f"{n} 1 0 0 0 0 0 {2 + n / 100} 1 IMG_{n:04d}.jpg\n\n" for n in (42, *SHOT)]
    Path("sparse/0/images.txt").write_text("".join(dict.fromkeys(solved)))
    Path("mav0/cam0").mkdir(parents=True)
    Path("mav0/cam0/sensor.yaml").write_text(EUROC)
    Path("calib.txt").write_text(KITTI)
    sample = json.loads(Path("sample.json").read_text())
    sample["timing"] = {"sampleRate": {"num": 24, "denom": 1}}
    Path("take.jsonl").write_text(100 * (json.dumps(sample) + "\n"))
    names = ["images/a.jpg", *(f"images/frame_{n:05d}.png" for n in SHOT)]
    pictures = [{"file_path": n, "transform_matrix": np.eye(4).tolist()} for n in names]
    angles = {"w": 1280, "h": 720, "fl_x": 905, "fl_y": 904, "cx": 641.5, "cy": 358.5}
    Path("transforms.json").write_text(json.dumps(angles | {"frames": pictures}))
    scene = board.scene()
    base = dg.Camera(transform=board.camera().transform)
    at_hand = {"scene": scene, "base": base, "camera": base, "K": K, "dist": DIST}
    at_hand |= {"first": PLATE, "second": PLATE, "json": json, "Path": Path}
    return {"dg": dg, "charts": charts, "projection": PLATE, **at_hand}


def without_k3(projection: dg.Projection) -> dg.Projection:
    parameters = projection.parameters[:4]
    return dg.Projection(
        "opencv", projection.size, projection.focal, projection.principal, parameters
    )


def write_opencv() -> None:
    """By OpenCV: a camera, a fisheye of which nothing says so, and its sample's stereo pair."""
    values = {
        "camera.yml": {"camera_matrix": K, "distortion_coefficients": DIST},
        "fisheye.yml": {"camera_matrix": K, "distortion_coefficients": np.full((1, 4), 0.01)},
        "intrinsics.yml": {"M1": K, "D1": DIST, "M2": K, "D2": DIST},
        "extrinsics.yml": {"R": np.eye(3), "T": np.array([[-120.0], [0], [0]])},
    }
    pair = {"R1": np.eye(3), "R2": np.eye(3), "P1": np.c_[K, [0, 0, 0]]}
    values["extrinsics.yml"] |= pair | {"P2": np.c_[K, [-120.0 * K[0, 0], 0, 0]]}
    for name, matrices in values.items():
        file = cv2.FileStorage(name, cv2.FILE_STORAGE_WRITE)
        if name in ("camera.yml", "fisheye.yml"):
            file.write("image_width", 1280)
            file.write("image_height", 720)
        for key, matrix in matrices.items():
            file.write(key, matrix)
        file.release()


@pytest.mark.parametrize("page", PAGES)
def test_code_of_a_page_runs(
    page: str, desk: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    render, render_rig = dg.render, dg.render_rig

    def small(scene: dg.Scene, camera: Any, **given: Any) -> dg.Frame:
        size = tuple(side // 40 for side in given.pop("resolution"))
        return render(scene, camera, **given | {"resolution": size, "spp": 1})

    def small_rig(scene: dg.Scene, cameras: Any, **given: Any) -> dict[str, dg.Frame]:
        return render_rig(scene, cameras, **given | {"resolution": (32, 18), "spp": 1})

    monkeypatch.setattr(dg, "render", small)
    monkeypatch.setattr(dg, "render_rig", small_rig)
    ran = 0
    for kind, code in blocks(page):
        if kind == "python" and "row_time" not in code:  # needs a panning shot: test_row_time.py
            exec(compile(code, f"docs/{page}.md", "exec"), desk)
            ran += 1
    assert ran


@pytest.mark.parametrize("page", PAGES)
@pytest.mark.usefixtures("desk")
def test_commands_of_a_page_are_understood(page: str) -> None:
    lines = "".join(code for kind, code in blocks(page) if not kind).splitlines()
    for line in "\n".join(lines).replace("\\\n", " ").splitlines():
        # A # within a word is no comment, but shlex would take it for one.
        program, command, *rest = shlex.split(re.sub(r"\s#.*", "", line))
        assert program == "daguerre"
        if command == "render":
            rest += ["--dry-run", "--quiet"]
        # test_calibrate.py: it takes seconds; test_stmap.py: it takes what was only checked here.
        if command not in ("calibrate", "post"):
            assert main([command, *rest]) == 0, line
