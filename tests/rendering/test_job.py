"""The driver for front ends: jobs, checkpoints and progress of ``dg.render``, without a console."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.rendering import (
    Control,
    Finished,
    Job,
    Output,
    Picture,
    RenderSettings,
    Reporter,
    Status,
    Stopped,
    View,
    in_order,
)
from daguerre.rendering.checkpoint import Checkpoint
from daguerre.rendering.loop import Loop
from daguerre.rendering.schedule import Range
from daguerre.rendering.session import Session

SMALL = RenderSettings.of(resolution=(12, 8), spp=6)


def sky() -> dg.Scene:
    scene = dg.Scene()
    scene.set_environment(color=(0.5, 1, 2))
    scene.add_camera("A", dg.Camera(lens_model="pinhole"))
    return scene


class Told(Reporter):
    """Keeps what it is told."""

    def __init__(self) -> None:
        self.notes: list[str] = []
        self.progressed: list[float] = []
        self.done: list[Finished] = []
        self.given_up: list[Stopped] = []

    def note(self, text: str) -> None:
        self.notes.append(text)

    def progress(self, status: Status) -> None:
        self.progressed.append(status.fraction)

    def finished(self, result: Finished) -> None:
        self.done.append(result)

    def stopped(self, result: Stopped) -> None:
        self.given_up.append(result)


class StopsAfter(Control):
    """Stops when so many samples are drawn."""

    def __init__(self, told: Told, share: float) -> None:
        self._told, self._share = told, share

    def poll(self) -> None:
        self.stops = int(max(self._told.progressed) >= self._share)


def test_a_job_writes_the_bits_of_a_render(tmp_path: Path) -> None:
    told = Told()
    output = Output((tmp_path / "a.exr",), ("depth",))
    settings = SMALL.with_(aovs=True)
    assert Job(sky(), [Picture(View(), settings, output)], told).run()
    frame = dg.load_frame(tmp_path / "a.exr")
    np.testing.assert_array_equal(frame.rgb, dg.render(sky(), settings=SMALL).rgb)
    assert set(frame.aovs) == {"depth.Z"}
    assert told.progressed[-1] == 1
    assert [result.paths for result in told.done] == [(tmp_path / "a.exr",)]
    assert told.done[0].samples == 6


def test_a_stopped_job_goes_on_with_the_same_bits(tmp_path: Path) -> None:
    settings = SMALL.with_(spp=2048)
    output = Output((tmp_path / "a.exr",))
    told = Told()
    assert not Job(sky(), [Picture(View(), settings, output)], told, StopsAfter(told, 1e-3)).run()
    (stopped,) = told.given_up
    assert stopped.saved
    assert stopped.checkpoint == tmp_path / "a.checkpoint.exr"
    assert 0 < stopped.samples < stopped.total == 2048
    again = Told()
    assert Job(sky(), [Picture(View(), settings, output)], again).run(resume=True)
    assert again.notes[0].startswith("resuming at ") or "resuming at" in " ".join(again.notes)
    assert [path.name for path in tmp_path.iterdir()] == ["a.exr"]
    whole = dg.render(sky(), settings=settings).rgb
    np.testing.assert_array_equal(dg.load_frame(tmp_path / "a.exr").rgb, whole)


def test_pictures_of_rigs_and_frames_have_names_of_their_own(tmp_path: Path) -> None:
    output = Output((tmp_path / "s.##.exr",))
    views = [View.of("A", "left"), View.of(dg.Camera(lens_model="pinhole"), "right")]
    made = in_order([Picture(view, SMALL, output) for view in views], [1, 12])
    job = Job(sky(), made, Told())
    assert job.run()
    assert job.done == 4
    names = [f"s.{side}.{n}.exr" for n in ("01", "12") for side in ("left", "right")]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names)
    assert made[1].facts == {"frame": 1, "camera": "right"}
    again = Told()
    assert Job(sky(), made, again).run(resume=True)
    assert sum("is complete" in note for note in again.notes) == 4
    assert not again.done


def test_render_tells_progress_and_goes_on_from_its_checkpoint(tmp_path: Path) -> None:
    kept = tmp_path / "kept.exr"
    settings = SMALL.with_(spp=4096)

    def stop(status: Status) -> bool:
        return status.samples < 1

    part = dg.render(sky(), settings=settings, checkpoint=kept, progress=stop)
    assert 0 < part.metadata["samples"] < 4096
    assert kept.exists()
    seen: list[Status] = []
    frame = dg.render(sky(), settings=settings, checkpoint=kept, progress=seen.append)
    assert seen[0].samples >= part.metadata["samples"]
    assert seen[-1].fraction == 1
    assert not kept.exists()
    np.testing.assert_array_equal(frame.rgb, dg.render(sky(), settings=settings).rgb)


def test_a_checkpoint_of_another_picture_is_refused(tmp_path: Path) -> None:
    kept = tmp_path / "kept.exr"
    dg.render(sky(), settings=SMALL, checkpoint=kept, progress=lambda status: status.samples < 1)
    with pytest.raises(dg.MismatchError, match=r"seed 0 .wanted 5"):
        dg.render(sky(), settings=SMALL.with_(seed=5), checkpoint=kept)


def test_a_checkpoint_goes_on_in_rounds_until_a_noise(tmp_path: Path) -> None:
    kept = tmp_path / "kept.exr"
    scene = sky()
    scene.add_light(dg.SphereLight(luminance=(90, 90, 90), radius=0.1), np.eye(4))
    settings = RenderSettings.of(resolution=(12, 8), noise=0.002, spp=512)
    dg.render(
        scene, settings=settings, checkpoint=kept, progress=lambda status: status.samples < 16
    )
    frame = dg.render(scene, settings=settings, checkpoint=kept)
    np.testing.assert_array_equal(frame.rgb, dg.render(scene, settings=settings).rgb)


def test_merge_writes_what_the_passes_were_asked_for(tmp_path: Path) -> None:
    settings, files = SMALL.with_(aovs=True, gt_time="mid"), []
    for samples in ((0, 2), (2, 6)):
        files.append(tmp_path / f"{samples[0]}.exr")
        output = Output((files[-1],), ("depth", "object_id"), is_pass=True)
        assert Job(sky(), [Picture(View(), settings, output, samples)]).run()
    whole = dg.render(sky(), settings=settings)
    frame = dg.merge(reversed(files), tmp_path / "whole.exr", keep_sums=True)
    np.testing.assert_array_equal(frame.rgb, whole.rgb)
    assert set(frame.aovs) == {"depth.Z", "object_id"}
    np.testing.assert_array_equal(dg.merge([tmp_path / "whole.exr"]).rgb, whole.rgb)


@pytest.mark.parametrize("module", ["post", "rendering"])
def test_libraries_load_nothing_of_the_command_line(module: str) -> None:
    code = (
        f"import sys, daguerre.{module} as m; [getattr(m, n) for n in getattr(m, '__all__', ())];"
        "print([n for n in sys.modules if n.split('.')[0] in ('typer', 'rich', 'click')"
        " or n.startswith('daguerre.cli')])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


class Waits(Range):
    """Draws a sample, then waits for others that do not arrive, as those of a cluster."""

    def __init__(self, session: Session, waits: int) -> None:
        super().__init__(session, (0, 2))
        self._waits = waits

    def prepare(self, limit: float) -> float:
        self._waits -= bool(self.session.ranges)
        return 1e-9 if self.session.ranges and self._waits > 0 else super().prepare(1.0)

    def draw(self, progress: Callable[[float], bool]) -> bool:
        if self.session.ranges and self._waits > 0:
            return True
        return super().draw(progress)


def test_a_checkpoint_is_not_written_again_while_nothing_arrives(tmp_path: Path) -> None:
    told: list[float] = []

    class Saves(Reporter):
        def saved(self, path: Path, samples: float, *, rescued: bool) -> None:
            told.append(samples)

    session = Session(sky(), None, settings=RenderSettings.of(resolution=(12, 8), spp=2))
    checkpoint = Checkpoint(tmp_path / "a.checkpoint.exr", interval_s=1e-6)
    assert Loop(session, Waits(session, 20), checkpoint, Saves(), Control()).run()
    assert told == [1.0]


@pytest.mark.parametrize(("save_s", "least", "most"), [(0.0, 5, 64), (0.2, 1, 1)])
def test_checkpoints_take_a_small_share_of_the_time(
    tmp_path: Path, save_s: float, least: int, most: int
) -> None:
    saves: list[float] = []

    class Slow(Checkpoint):
        def save(self, session: Session) -> None:
            saves.append(session.ranges[-1][-1])
            time.sleep(save_s)

    class Drawn(Range):
        def prepare(self, limit: float) -> float:
            time.sleep(0.01)
            return super().prepare(1.0)

    session = Session(sky(), None, settings=RenderSettings.of(resolution=(12, 8), spp=64))
    checkpoint = Slow(tmp_path / "a.checkpoint.exr", interval_s=1e-6)
    assert Loop(session, Drawn(session, (0, 64)), checkpoint, Reporter(), Control()).run()
    assert least <= len(saves) <= most
