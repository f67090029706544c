"""Records with arrays print briefly: a user who looks at one sees names and shapes, no numbers."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import pkgutil
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import daguerre
from daguerre import analysis, lenses
from daguerre.analysis.ghosts import Ghosts
from daguerre.analysis.glare import VeilingGlare
from daguerre.files.value import BriefRecord

#: Rooms with records that users get; those of readers (`importers`, `blender`) stay inside.
ROOMS = (
    "analysis", "calibration", "camera", "charts", "development", "distortion", "export",
    "exposure", "frame", "labels", "lenses", "maps", "plates.match", "polynomial", "sensors",
    "setup", "stocks",
)  # fmt: skip
ARRAY = re.compile(r"NDArray|(Float|Bool|Int|Complex)Array|ndarray")


def records() -> Iterator[type]:
    """Data classes of these rooms with fields that are arrays."""
    for found in pkgutil.walk_packages(daguerre.__path__, "daguerre."):
        name = found.name.removeprefix("daguerre.")
        if any(f"{name}.".startswith(f"{room}.") for room in ROOMS):
            for kind in vars(importlib.import_module(found.name)).values():
                if inspect.isclass(kind) and kind.__module__ == found.name and _has_arrays(kind):
                    yield kind


def _has_arrays(kind: type) -> bool:
    annotations = vars(kind).get("__annotations__", {})
    return dataclasses.is_dataclass(kind) and any(
        ARRAY.search(str(a)) for a in annotations.values()
    )


def _dumps(kind: type) -> bool:
    """Whether a data class has the text that Python makes for it."""
    return not kind.__name__.startswith("_") and hasattr(kind.__repr__, "__wrapped__")


def test_no_record_dumps_its_arrays() -> None:
    found = list(records())
    assert len(found) > 30
    assert [kind.__qualname__ for kind in found if _dumps(kind)] == []


def test_a_record_that_dumps_is_found() -> None:
    @dataclasses.dataclass
    class Dumping:
        points: np.ndarray

    assert _has_arrays(Dumping)
    assert _dumps(Dumping)


@pytest.fixture(scope="module")
def light() -> analysis.Pencil:
    bench = analysis.set_up(lenses.load("tessar-50mm-f2.8"), f_stop=4, focus_m=3)
    found = analysis.pencil(bench, 12.0)
    assert found is not None
    return found


def test_results_of_the_bench_print_in_a_line(light: analysis.Pencil) -> None:
    bench = light.bench
    results: list[Any] = [
        bench, light, analysis.spot(light), analysis.point_spread(light),
        analysis.wavefront(light), analysis.seidel_sums(bench),
        analysis.relative_illumination(bench, np.linspace(0, 10, 9), grid=9),
        analysis.distortion(bench, np.linspace(0, 10, 9)), analysis.chief_rays(bench, [1.0, 2.0]),
        analysis.field_curvature(bench, np.linspace(0, 10, 9)),
        light.trace(light.grid(4)),
    ]  # fmt: skip
    for result in results:
        text = repr(result)
        assert text.startswith(type(result).__name__ + "(")
        assert len(text) < 400, text
        assert "\n" not in text
        assert "array(" not in text
    assert repr(bench).startswith("Bench(lens=<Tessar")
    assert "f_stop=4, " in repr(bench)
    assert ", film=[0, 12], " in repr(light)
    assert re.search(r"efl=49\.99\d*, .*entrance_pupil=Pupil\(z=", repr(bench.order))
    ghosts = Ghosts(bench, 15, rays=9)
    assert re.match(r"<Ghosts of Tessar .*: \d+, light from 15 deg>", repr(ghosts))
    assert re.match(r"<VeilingGlare \d.* %>", repr(VeilingGlare(bench, walks=600)))
    assert re.match(r"Spot\(points=<array \(\d+, 2\)>", repr(analysis.spot(light)))


def test_what_a_record_prints_of_its_parts() -> None:
    @dataclasses.dataclass(repr=False)
    class Part(BriefRecord):
        values: Any
        name: str = "usual"

    def text(value: Any) -> str:
        return repr(Part(value)).removeprefix("Part(values=").removesuffix(")")

    assert text(np.array([1.0, 1 / 3])) == "[1, 0.3333]"
    assert text(np.zeros(5)) == "<array (5,)>"
    assert text(np.zeros((2, 2))) == "<array (2, 2)>"
    assert text(1 / 3) == text(np.float64(1 / 3)) == "0.333333"
    assert text((1, 2 / 3)) == "(1, 0.666667)"
    assert text((1,)) == "(1,)"
    assert text((1, (2.0, 1 / 3))) == "(1, (2, 0.333333))"
    assert text(list(range(99))) == "<list of 99>"
    assert text(Part(3)) == "Part(values=3)"
    assert text(Part(Part("x" * 200, "y" * 200), "z" * 200)) == "<Part>"
    assert repr(Part(1, "other")) == "Part(values=1, name='other')"
