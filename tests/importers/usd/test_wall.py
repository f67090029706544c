"""The wall around USD: whatever ends it is one error, and the next stage is read."""

from __future__ import annotations

import os
import pickle
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.apart.helper import Helper
from daguerre.apart.limits import Limits
from daguerre.cli import main
from daguerre.errors import InputError
from daguerre.files.value import same
from daguerre.importers.usd import wall
from daguerre.motion.values import Composite

ROOT = Path(__file__).resolve().parents[3]
STAGE = '#usda 1.0\n(\n metersPerUnit = 1\n)\ndef Sphere "S"\n{\n double radius = 2\n}\n'
#: A prim that two references each bring twice: 2^20 of them, within the limit of prims.
BOMB = "".join(
    f'def "b{k}"\n{{\n'
    + "".join(f'  def "{c}" (references = </b{k + 1}>)\n  {{\n  }}\n' for c in "xy")
    + "}\n"
    for k in range(20)
)


@pytest.fixture
def stage(tmp_path: Path) -> Path:
    """A small stage."""
    path = tmp_path / "s.usda"
    path.write_text(STAGE)
    return path


@pytest.fixture
def own(monkeypatch: pytest.MonkeyPatch) -> Iterator[Helper]:
    """A helper for one test."""
    made = Helper()
    monkeypatch.setattr(wall, "_helper", made)
    yield made
    made.end()


def slow(limits: dict[str, float], monkeypatch: pytest.MonkeyPatch) -> None:
    """Sets limits of small stages."""
    for name, value in limits.items():
        monkeypatch.setattr(wall, name, value)


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        ({"_SECONDS": 1.0}, "the helper process took longer than 1 s"),
        ({"_MEMORY": 2.5e8}, "the helper process took more than 250 MB of memory"),
    ],
)
def test_a_bomb_of_references_is_one_error(
    tmp_path: Path,
    stage: Path,
    own: Helper,
    limits: dict[str, float],
    words: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    path = tmp_path / "bomb.usda"
    path.write_text(f"#usda 1.0\n{BOMB}")
    with monkeypatch.context() as patch:
        slow(limits, patch)
        with pytest.raises(InputError, match=re.escape(words)) as error:
            wall.read(path)
    assert str(error.value).startswith(f"{path}: cannot read: ")
    assert len(wall.read(stage).instances) == 1


def test_a_stack_that_overflows_is_one_error(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    deep = 12000
    path = tmp_path / "deep.usda"
    nest = "(" * deep + "/a" + ")" * deep
    path.write_text(f'#usda 1.0\ndef "W" {{\n pathExpression x = "{nest}"\n}}\n')
    assert main(["info", str(path)]) == 3
    printed = capsys.readouterr()
    assert printed.err.count("\n") == 1
    assert "Traceback" not in printed.err


def test_limits_grow_with_files_and_pictures(tmp_path: Path) -> None:
    uses = wall._Uses()
    small = uses.limits
    assert small.seconds == 10
    file = tmp_path / "large.usdc"
    with file.open("wb") as stream:
        stream.truncate(11_000_000)
    grown = uses.heard(f"file {file}")
    assert grown.seconds == pytest.approx(20)
    assert uses.heard(f"file {file}") == grown
    assert uses.heard(f"file {tmp_path / 'none.usdc'}") == grown
    assert uses.heard("file \0") == grown
    assert uses.heard("pixels " + 40 * "9") == grown
    assert uses.heard("pixels 100000000").seconds == pytest.approx(24)
    assert uses.heard("pixels 10000000000000").seconds < 400


def test_the_parent_does_not_load_usd(stage: Path) -> None:
    code = (
        "import sys, daguerre as dg\n"
        "from daguerre.files import formats\n"
        f"dg.load({str(stage)!r})\n"
        f"assert formats.time_of_code({str(stage)!r}, 24) == 1\n"
        "assert 'pxr' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)


def test_relative_paths_begin_where_the_parent_is(
    stage: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(stage.parent)
    assert dg.load("s.usda").path == Path("s.usda")
    with pytest.raises(InputError, match=r"^t\.usda: no such file$"):
        dg.load("t.usda")


def test_scenes_pickle_and_fork(stage: Path) -> None:
    scene = dg.load(stage)
    assert same(pickle.loads(pickle.dumps(scene)), scene)


def test_an_edited_stage_is_read_anew(stage: Path) -> None:
    first = dg.load(stage)
    stage.write_text(STAGE.replace("radius = 2", "radius = 3"))
    again = wall.read(stage)
    assert again.meshes[0].positions.max() == pytest.approx(3, rel=1e-3)
    assert first.meshes[0].positions.max() == pytest.approx(2, rel=1e-3)


def test_one_bad_stage_leaves_the_others(tmp_path: Path) -> None:
    stages = []
    for k in range(20):
        path = tmp_path / f"{k}.usda"
        path.write_text(STAGE if k != 7 else STAGE.replace("{", "{ (((", 1))
        stages.append(path)
    found = []
    for path in stages:
        try:
            found.append(len(wall.read(path).instances))
        except InputError:
            found.append(0)
    assert found == [1] * 7 + [0] + [1] * 12


def test_without_a_helper_a_stage_is_refused_or_read_here(
    stage: Path, own: Helper, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "executable", "")
    assert main(["info", str(stage)]) == 3
    assert "no helper process" in (words := capsys.readouterr().err)
    assert "--usd-in-process reads a stage that you trust without one" in words
    assert main(["info", str(stage), "--usd-in-process", "--time-code", "24"]) == 0


class _Answers(Helper):
    """A helper that was taken over: it sends what it likes."""

    def __init__(self, parts: Any) -> None:
        super().__init__()
        self._parts = parts

    def answer(self, task: str, request: Any, limits: Limits, **more: Any) -> Any:
        return super().answer("tests.apart.tasks:echo", self._parts, limits, where=more["where"])


def _parts(stage: Path) -> dict[str, Any]:
    from daguerre.scene.packed.parts import parts_of

    return parts_of(wall.read(stage, in_process=True))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda parts: parts["meshes"][0].update(indices=np.full((1, 3), 1 << 20)), "indices"),
        (lambda parts: parts["instances"].update(named=np.array([7])), "names"),
        (lambda parts: parts.pop("nodes"), "damaged: KeyError"),
        (lambda parts: parts.update(fog=Limits(1.0, 1)), "unknown kind of value"),
        (lambda parts: parts["instances"].update(motion=[[0, "x"]]), "wanted values over time"),
        (lambda parts: parts.update(meshes=Composite(3)), "damaged"),
    ],
)
def test_a_helper_that_was_taken_over_is_not_trusted(
    stage: Path, change: Any, words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    parts = _parts(stage)
    change(parts)
    lying = _Answers(parts)
    monkeypatch.setattr(wall, "_helper", lying)
    try:
        with pytest.raises(InputError, match=words) as error:
            wall.read(stage)
        assert str(error.value).startswith(f"{stage}: cannot read: ")
        assert str(error.value).count("cannot read") == 1
    finally:
        lying.end()


def test_nothing_stays_in_temporary_folders(stage: Path, tmp_path: Path) -> None:
    folder = tmp_path / "temporary"
    folder.mkdir()
    before = set(Path("/var/tmp").iterdir())
    deep = tmp_path / "deep.usda"
    nest = "(" * 12000 + "/a" + ")" * 12000
    deep.write_text(f'#usda 1.0\ndef "W" {{\n pathExpression x = "{nest}"\n}}\n')
    for path in (stage, deep):
        words = [sys.executable, "-m", "daguerre", "info", str(path)]
        subprocess.run(
            words, env={**os.environ, "TMPDIR": str(folder)}, check=False, timeout=120,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
    assert list(folder.iterdir()) == []
    assert not [one for one in set(Path("/var/tmp").iterdir()) - before if "st_" in one.name]
