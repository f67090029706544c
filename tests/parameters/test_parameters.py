"""A parameter is one row: flags, checks, pages and docstrings follow it."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import get_args, get_type_hints

import pytest
import typer.main
from typer.testing import CliRunner

import daguerre as dg
from daguerre import cli
from daguerre.camera.parameters import CAMERA, CAMERA_FLAGS, LIMITS, MOVABLE, SHUTTER
from daguerre.cli.flags.camera import CameraFlags
from daguerre.cli.flags.from_table import TableFlags, made_of
from daguerre.cli.flags.groups import with_flags
from daguerre.cli.flags.shutter import ShutterFlags
from daguerre.errors import InputError, UsageError
from daguerre.parameters.need import Need
from daguerre.parameters.parameter import REQUIRED, Parameter
from daguerre.parameters.table import Table
from daguerre.parameters.texts import attributes
from daguerre.setup.checks import check

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "script" / "docs" / "reference"))

from cli_reference import texts, with_attributes  # noqa: E402
from page_tables import page_table, put_between_marks  # noqa: E402

SQUINT = Parameter(
    "squint",
    "Angle by which the camera squints, degrees, instead of {focus_on}",
    "deg",
    0.5,
    low=0,
    high=9,
    flags=("--squint",),
    metavar="DEG",
    tells_default=True,
    more="It tires",
    rivals="focus",
    needs=(Need(("thin",), "wanted eyes, got {kind}"),),
)
PLANTED = Table(CAMERA, SQUINT)


@made_of(PLANTED)
class Flags(TableFlags):
    """Flags with one more."""


@with_flags(flags=Flags)
def shown(flags: Flags) -> None:
    """Shows what is given."""
    print(flags.given())


def test_pages_and_docstrings_are_made_from_the_tables() -> None:
    for path, text in texts(ROOT).items():
        assert (ROOT / path).read_text() == text, f"{path}: run script/docs/make-cli-reference"


def test_a_camera_has_a_row_for_each_field_and_its_default() -> None:
    assert {row.name for row in CAMERA} == set(dg.Camera.__dataclass_fields__)
    camera = dg.Camera()
    made = {"transform", "motion"}
    for row in CAMERA:
        assert row.name in made or getattr(camera, row.name) == row.default, row.name


def test_a_planted_row_is_a_flag() -> None:
    app = typer.Typer(add_completion=False)
    app.command()(shown)
    runner = CliRunner()
    assert "{'squint': 1.5" in runner.invoke(app, ["--squint", "1.5deg"]).output
    assert runner.invoke(app, []).output == "{}\n"
    page = runner.invoke(app, ["--help"], env={"COLUMNS": "200", "TERM": "dumb"}).output
    assert "Angle by which the camera squints, degrees, instead of --focus-on [0.5]." in page
    with pytest.raises(UsageError, match="--squint: wanted an angle"):
        Flags(squint="far").given()


def test_a_planted_row_is_checked() -> None:
    class Bad:
        squint = 10.0

    with pytest.raises(UsageError, match="camera: squint: wanted a number of at least 0 and at mo"):
        Table(SQUINT).check(Bad(), "camera")
    with pytest.raises(UsageError, match="camera: wanted either focus_at or squint, got both"):
        PLANTED.refuse_rivals({"squint", "focus_at"}, "camera")
    with pytest.raises(UsageError, match="--focus-at and --squint: wanted one of them, got both"):
        PLANTED.refuse_rivals({"squint", "focus_at"})
    with pytest.raises(UsageError, match="camera: squint: wanted eyes, got thick"):
        SQUINT.needs[0].check({"thick", "prescription"}, "thick", "camera: squint")
    assert SQUINT.takes("thin")
    assert not SQUINT.takes("projection")


def test_a_planted_row_is_on_the_page_and_in_the_docstring() -> None:
    line = "| `--squint DEG` | deg | Angle by which the camera squints, degrees, instead of "
    assert line + "`--focus-on` [0.5]. It tires |" in page_table(PLANTED, PLANTED)
    said = "squint: Angle by which the camera squints, degrees, instead of ``focus_on``; default:"
    assert said in attributes(PLANTED, ["squint"])
    text = (ROOT / "python" / "daguerre" / "camera" / "camera.py").read_text()
    names = [*dg.Camera.__dataclass_fields__, "squint"]
    assert said in with_attributes(text, "Camera", PLANTED, names)
    with pytest.raises(ValueError, match="marks"):
        put_between_marks("no marks", "flags", "text")


def test_a_table_knows_its_names() -> None:
    with pytest.raises(InputError, match=r"x: parameter 'squnt': .*did you mean 'squint'"):
        Table(SQUINT).find("squnt", "x", InputError)
    assert Table(SQUINT).values({"squint": "2"}, "x", InputError) == {"squint": 2.0}
    assert Table(SQUINT).values({}, "x", InputError) == {"squint": 0.5}
    with pytest.raises(UsageError, match="x: a: wanted a number, got no value"):
        Table(Parameter("a", "A", default=REQUIRED)).values({}, "x", UsageError)
    with pytest.raises(ValueError, match="one name"):
        Table(SQUINT, SQUINT)


@pytest.mark.parametrize("command", ["render", "info"])
def test_commands_take_the_flags_of_the_table(command: str) -> None:
    root = typer.main.get_command(cli.app)
    options = {name: p for p in root.commands[command].params for name in p.opts}
    for row in (*CAMERA_FLAGS.flagged, *SHUTTER.flagged):
        option = options[row.flag]
        assert option.help == row.help(CAMERA.flag)
        assert option.metavar == row.placeholder


@pytest.mark.parametrize("name", sorted(set(LIMITS) - {"degree"}))
def test_limits_of_rows_are_those_of_a_camera(name: str) -> None:
    row = CAMERA[name]
    pair = row.kind in ("numbers", "size")
    for bad in (row.low - abs(row.low) / 2 - 1, 2 * row.high + 1):
        value = (bad, bad) if pair else int(bad) if row.kind == "whole" else bad
        extra = {"lens_model": "exact"} if name == "sensor_reflectance" else {}
        with pytest.raises(UsageError, match=f"camera: {name}: wanted"):
            check(dg.Camera(**{name: value}, **extra), "thin", prescription=False)


@pytest.mark.parametrize("rivals", CAMERA.rivals())
def test_rivals_are_refused_wherever_they_are_given(rivals: tuple[str, ...]) -> None:
    values = {"focus_at": (1, 2), "focus_on": "a"}
    both = {name: values.get(name, 1.0) for name in rivals[:2]}
    words = f"camera: wanted either {rivals[0]} or {rivals[1]}, got both"
    with pytest.raises(UsageError, match=words):
        dg.Camera().with_(**both)
    with pytest.raises(UsageError, match=words):
        check(dg.Camera(**both), "thin", prescription=False)
    flags = ShutterFlags if rivals[0] in SHUTTER else CameraFlags
    given = {CAMERA[name].field: "1,2" if name == "focus_at" else "1" for name in rivals[:2]}
    shown = " and ".join(CAMERA[name].flag for name in rivals[:2])
    with pytest.raises(UsageError, match=f"{shown}: wanted one of them, got both"):
        flags(**given).changes()


def test_only_movable_parameters_take_keys() -> None:
    over_time = dg.keys([(0.0, 1.0), (1.0, 2.0)])
    assert dg.Camera(f_stop=over_time).motion.keys() == {"f_stop"}
    assert "fps" not in MOVABLE
    with pytest.raises(UsageError, match="camera: fps: cannot change over time"):
        dg.Camera(fps=over_time)


def test_pages_that_explain_exist() -> None:
    places = {place for row in (*CAMERA_FLAGS, *CAMERA) for place in row.explained}
    assert places
    for place in places:
        page, _, part = place.partition("#")
        text = (ROOT / "docs" / page).read_text()
        heads = {re.sub(r"[^\w-]", "", h.lower().replace(" ", "-")) for h in headings(text)}
        assert not part or part in heads | set(re.findall(r'<a name="(.*?)"', text)), place


def headings(text: str) -> list[str]:
    return re.findall(r"^#+ (.*)$", text, flags=re.MULTILINE)


def test_types_of_flags_follow_the_kinds() -> None:
    hints = get_type_hints(CameraFlags, include_extras=True)
    kinds = {name: str(get_args(hint)[0]) for name, hint in hints.items() if name != "table"}
    assert kinds["degree"] == str(int | None)
    assert kinds["iso"] == str(float | None)
    assert kinds["f_stop"] == str(str | None)
    assert kinds["decenter"] == str(list[str] | None)
    assert kinds["front_mask"] == str(Path | None)
