"""The benches of rooms under a sky: figures, skies, and faults that spoil a table."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

import daguerre as dg

BENCH = Path(__file__).resolve().parents[2] / "bench"
FOLDERS = (BENCH, BENCH / "ajar_door")
SIZE, SKY = (32, 18), 128
#: A Mitsuba that is Daguerre, for files of Mitsuba.
STAND_IN = """
import os
from pathlib import Path
import daguerre as dg
from daguerre.importers.mitsuba.reader import read_all
__version__ = "stand-in"
folders = []
class Resolver:
    def prepend(self, folder): folders.append(folder)
def file_resolver(): return Resolver()
def set_variant(name): assert name == "llvm_ad_rgb"
def load_string(text):
    path = Path(folders[-1]) / "edited.xml"
    path.write_text(text)
    scene, settings, _ = read_all(path)
    return scene, next(iter(settings.values()))
def render(loaded, spp, seed):
    scene, found = loaded
    frame = dg.render(scene, resolution=found.resolution, filter=found.filter,
                      max_depth=found.max_depth, spp=spp, seed=seed, threads=1)
    return frame.rgb * float(os.environ.get("STAND_IN_LIGHT", "1"))
"""


@pytest.fixture(autouse=True)
def bench_is_importable(monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in FOLDERS:
        monkeypatch.syspath_prepend(str(folder))


def run(tmp_path: Path, *words: str, **more: str) -> subprocess.CompletedProcess[str]:
    """The bench of one small room."""
    options = {"w": 24, "h": 16, "spp": 4, "seeds": 2, "reference-spp": 8, "sky-width": 64}
    command = [sys.executable, str(BENCH / "rooms.py"), "--references", str(tmp_path / "kept")]
    command += [word for key, value in options.items() for word in (f"--{key}", str(value))]
    environment = dict(os.environ, **more)
    return subprocess.run([*command, *words], env=environment, capture_output=True, text=True)


def stand_in(tmp_path: Path) -> dict[str, str]:
    """Where Python finds the stand-in for Mitsuba."""
    folder = tmp_path / "modules"
    folder.mkdir()
    (folder / "mitsuba.py").write_text(STAND_IN)
    (folder / "drjit.py").write_text("def set_thread_count(count): pass\n")
    return {"PYTHONPATH": os.pathsep.join([str(folder), os.environ.get("PYTHONPATH", "")])}


def picture(scene: dg.Scene, seed: int, spp: int = 48) -> np.ndarray:
    frame = dg.render(scene, spp=spp, resolution=SIZE, filter="box", max_depth=12, seed=seed)
    return frame.rgb.astype(np.float64)


def test_rows_of_both_samplers(tmp_path: Path) -> None:
    done = run(tmp_path, "--rooms", "living-room", **stand_in(tmp_path))
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)["living-room"]
    assert done.stderr.startswith('rooms: {"living-room"')  # a long run that breaks keeps its rooms
    rows = ("daguerre", "mitsuba_independent", "mitsuba_multijitter")
    assert set(found) == {*rows, "ratio", "same_picture"}
    for name in rows:
        error, score = found[name]["error"], found[name]["score"]
        assert error["mean"] >= error["typical"] > 0
        assert score["mean"] == pytest.approx(error["mean"] * found[name]["cpu_s"], rel=1e-3)
    better = found["ratio"]["mean"]["better"]
    assert found["ratio"]["mean"]["ratio"] == pytest.approx(
        found["daguerre"]["score"]["mean"] / found[f"mitsuba_{better}"]["score"]["mean"], abs=2e-3
    )
    assert len(list((tmp_path / "kept").iterdir())) == 2  # one converged picture of each renderer


def test_a_dark_room_in_one_renderer_is_an_error(tmp_path: Path) -> None:
    faulty = stand_in(tmp_path) | {"STAND_IN_LIGHT": "0.5"}
    done = run(tmp_path, "--rooms", "staircase", **faulty)
    assert done.returncode != 0
    assert "rooms: staircase: mitsuba_independent draws another picture" in done.stderr


def test_a_missing_mitsuba_is_said() -> None:
    import rooms

    options = argparse.Namespace(only=None, mitsuba_python=sys.executable)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rooms, "can_import", lambda *_: False)
        names, skipped = rooms.renderers_there(options)
    assert names == ["daguerre"]
    assert skipped == f"mitsuba: {sys.executable} cannot import it"


def test_an_unknown_room_is_refused(tmp_path: Path) -> None:
    done = run(tmp_path, "--rooms", "attic")
    assert done.returncode != 0
    assert "wanted some of ['living-room'" in done.stderr


def test_a_folder_without_rooms_is_refused(tmp_path: Path) -> None:
    done = run(tmp_path, "--folder", str(tmp_path))
    assert done.returncode != 0
    assert "--folder: wanted rooms as NAME/scene.xml" in done.stderr


def exported(name: str, folder: Path) -> ElementTree.ElementTree[ElementTree.Element]:
    """The file of a room, edited as for Mitsuba."""
    from sky_rooms import draw_mitsuba
    from sky_rooms.made import ROOMS

    path = folder / "scene.xml"
    dg.export_scene(ROOMS[name](SKY), path, resolution=(99, 44), spp=1)
    width, height = SIZE
    settings = {"w": width, "h": height, "spp": 4, "depth": 12, "sampler": "multijitter"}
    return ElementTree.ElementTree(ElementTree.fromstring(draw_mitsuba.edited(path, settings)))


@pytest.mark.parametrize("name", ["living-room", "classroom", "dining-room", "staircase", "ajar"])
def test_the_file_for_mitsuba_draws_the_room(name: str, tmp_path: Path) -> None:
    from sky_rooms.figures import differences
    from sky_rooms.made import ROOMS

    exported(name, tmp_path).write(tmp_path / "edited.xml")
    native, read = ROOMS[name](SKY), dg.load(tmp_path / "edited.xml")
    own, theirs = ([picture(scene, seed) for seed in seeds] for scene, seeds in
                   ((native, (1, 2, 3)), (read, (4, 5, 6))))  # fmt: skip
    assert differences(own, theirs)["same"], differences(own, theirs)


@pytest.mark.parametrize("fault", ["no sky", "turned sky", "no texture", "other camera"])
def test_a_faulty_file_is_seen(fault: str, tmp_path: Path) -> None:
    from sky_rooms.figures import differences
    from sky_rooms.made import ROOMS

    tree = exported("classroom", tmp_path)
    root = tree.getroot()
    if fault == "no sky":
        (sky,) = (e for e in root.findall("emitter") if e.get("type") == "envmap")
        root.remove(sky)
        ElementTree.SubElement(root, "emitter", type="constant")
    elif fault == "turned sky":
        matrix = root.find("emitter[@type='envmap']/transform/matrix")
        assert matrix is not None
        matrix.set("value", "1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1")
    elif fault == "no texture":
        for bsdf in root.iter("bsdf"):
            for texture in bsdf.findall("texture"):
                bsdf.remove(texture)
    else:
        fov = root.find("sensor/float[@name='fov']")
        assert fov is not None
        fov.set("value", "50")
    tree.write(tmp_path / "edited.xml")
    native, read = ROOMS["classroom"](SKY), dg.load(tmp_path / "edited.xml")
    own = [picture(native, seed) for seed in (1, 2, 3)]
    theirs = [picture(read, seed) for seed in (4, 5, 6)]
    assert not differences(own, theirs)["same"]


def test_an_edited_file_has_the_settings_of_the_bench(tmp_path: Path) -> None:
    root = exported("staircase", tmp_path).getroot()
    values = {(e.get("name"), e.get("value")) for e in root.iter("integer")}
    assert {("width", "32"), ("height", "18"), ("max_depth", "13"), ("sample_count", "4")} <= values
    assert [e.get("type") for e in root.iter("sampler")] == ["multijitter"]
    assert [e.get("type") for e in root.iter("rfilter")] == ["box"]


def test_errors_of_a_known_picture() -> None:
    from sky_rooms.figures import errors

    true = np.full((10, 10, 3), 0.3)
    picture = true + 0.1
    picture[0, 0] += 10  # one spark, a hundredth of the frame
    found = errors(picture, true, noise=0.25)
    even = 0.1**2 / (0.3**2 + 0.01 * 0.3**2) / 1.25
    assert found["typical"] == pytest.approx(even)
    assert found["median"] == pytest.approx(even)
    assert found["mean"] == pytest.approx(0.99 * even + 0.01 * even * 101**2)


def test_the_ratio_is_beside_the_better_sampler() -> None:
    from sky_rooms.figures import ratios

    def scores(**values: float) -> dict[str, Any]:
        return {"score": values}

    found = ratios(
        {
            "daguerre": scores(mean=3.0, typical=1.0),
            "mitsuba_independent": scores(mean=2.0, typical=4.0),
            "mitsuba_multijitter": scores(mean=6.0, typical=2.0),
        }
    )
    assert found["mean"] == {"ratio": 1.5, "better": "independent"}
    assert found["typical"] == {"ratio": 0.5, "better": "multijitter"}


def test_noise_alone_is_the_same_picture() -> None:
    from sky_rooms.figures import differences

    rng = np.random.default_rng(1)
    many = [rng.gamma(0.5, 1, (45, 80, 3)) for _ in range(8)]
    assert differences(many[:4], many[4:])["same"]
    assert not differences(many[:4], [one * 0.8 for one in many[4:]])["same"]
    half_dark = [one * np.where(np.arange(80) < 20, 0.5, 1.2)[None, :, None] for one in many[4:]]
    assert not differences(many[:4], half_dark)["same"]


@pytest.mark.parametrize("width", [32, 256, 1024])
def test_skies_shine_alike_at_any_size(width: int) -> None:
    from sky_rooms import skies

    def flux(sky: np.ndarray) -> np.ndarray:
        """Light of the upper half, over all directions."""
        cosine = skies.directions(len(sky[0]))[..., 1:2]
        weight = np.sqrt(1 - cosine**2) * (cosine > 0)
        return np.asarray((sky * weight).sum(axis=(0, 1)) * (np.pi / len(sky)) ** 2)

    toward = (-0.76, 0.5, -0.3)
    for made in (skies.overcast, lambda w: skies.sunny(w, toward)):
        assert flux(made(width)) == pytest.approx(flux(made(512)), rel=0.03)


def test_the_sun_is_half_a_degree_wide() -> None:
    from sky_rooms import skies

    width = 4096
    sky = skies.sunny(width, (-0.76, 0.5, -0.3))[..., 1]
    row = sky[int(np.argmax(sky.max(axis=1)))]
    middle = sky[:, int(np.argmax(row))] > 100
    assert middle.sum() * 180 / (width // 2) == pytest.approx(0.5, abs=0.1)


def test_sky_sizes(tmp_path: Path) -> None:
    sizes = ["--widths", "32", "64", "--w", "24", "--h", "16", "--spp", "32", "--repeats", "1"]
    command = [sys.executable, str(BENCH / "sky_size.py"), "--json", *sizes]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert set(found["sun"]) == set(found["overcast"]) == {"32", "64"}
    assert found["sun"]["32"]["ratio"] == 1
    assert found["overcast"]["64"]["rays_per_sample"] > 3


def test_skies_with_other_rays_are_an_error() -> None:
    import sky_size

    sky_size.check_rays("sun", 6.1, 6.0)
    with pytest.raises(SystemExit, match="sun: wanted 6 rays a sample under each sky, got 5"):
        sky_size.check_rays("sun", 5.0, 6.0)


def test_other_benches_are_beside_the_better_sampler() -> None:
    import ajar
    import peers

    door = {"daguerre": 4.0, "mitsuba": 2.0, "mitsuba_multijitter": 1.6}
    rows = {name: {"cpu_s_to_0.01": {"mean": value}} for name, value in door.items()}
    assert ajar.ratios(rows) == {"ratio_to_better_mitsuba": {"mean": 2.5}}
    assert ajar.ratios({"daguerre": rows["daguerre"]}) == {}
    kinds = ("relmse", "relmse_typical", "relmse_median")
    table = {name: {"cpu_s": value, **dict.fromkeys(kinds, 0.5)} for name, value in door.items()}
    found = peers.ratios(table)
    assert found["ratio_to_mitsuba"] == 2.0
    assert found["ratio_to_better_mitsuba"] == dict.fromkeys(kinds, 2.5)


def test_pixel_errors_of_a_pair() -> None:
    import peers

    a, b = np.full((10, 10, 3), 0.4), np.full((10, 10, 3), 0.2)
    a[0, 0] += 10
    found = peers.pixel_errors(a, b)
    even = 0.2**2 / 2 / (0.3**2 + 0.01)
    assert found["relmse_typical"] == pytest.approx(even)
    assert found["relmse_median"] == pytest.approx(even)
    assert found["relmse"] > found["relmse_typical"]
