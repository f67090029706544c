"""The order of floors holds in python/daguerre, and its check catches planted faults."""

from __future__ import annotations

import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
GOOD = {
    "__init__.py": "from .scene.scene import Scene",
    "errors.py": "class Bad(Exception): pass",
    "checks.py": "from .errors import Bad",
    "lenses/__init__.py": "from .lens import Lens",
    "lenses/lens.py": """
from typing import TYPE_CHECKING
if TYPE_CHECKING:
    from .zoom import Zoom
class Lens:
    def _zoom(self) -> "Zoom":
        '''Returns the lens as a zoom.'''
        from .zoom import Zoom
        return Zoom(self)
    def focused(self):
        from .focus import focused
        return focused(self)
    def _repr_svg_(self):
        from daguerre.plots.lens_section import draw
        return draw(self)
""",
    "lenses/zoom.py": "from daguerre.checks import Bad\nfrom .lens import Lens",
    "lenses/focus.py": "from .lens import Lens",
    "plots/lens_section.py": "def draw(lens): pass",
    "scene/scene.py": "import numpy\nfrom daguerre._core import Scene as Core",
    "files/formats.py": 'ROW = "daguerre.importers.gltf.reader:read"',
    "importers/gltf/reader.py": "from daguerre.scene.scene import Scene\nfrom .nodes import f",
    "importers/gltf/nodes.py": "def f(): pass",
    "importers/pbrt/names.py": "def f(): pass",
    "exporters/pbrt/names.py": "from daguerre.importers.pbrt.names import f",
    "exporters/pbrt/writer.py": "from daguerre.exporters.outgoing.media import f",
    "exporters/outgoing/media.py": "def f(): pass",
    "rendering/job.py": "from daguerre import errors\nfrom daguerre.importers.gltf import reader",
    "cli/main.py": "from daguerre.rendering.job import Job\nfrom daguerre import Scene",
}


def checked(folder: Path, planted: dict[str, str]) -> tuple[int, str]:
    """Checks a small package that is in order but for what is planted."""
    core = folder / "core"
    (core / "math").mkdir(parents=True)
    (core / "math" / "vec.h").write_text("#include <cmath>\n")
    package = folder / "daguerre"
    for name, text in (GOOD | planted).items():
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text(text + "\n")
    command = [sys.executable, str(ROOT / "script" / "check-floors"), str(core), str(package)]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    return found.returncode, found.stdout + found.stderr


def test_package_is_in_order() -> None:
    command = [sys.executable, str(ROOT / "script" / "check-floors")]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stdout + found.stderr


def test_design_has_a_row_for_every_room() -> None:
    """Rows stand in the order of floors."""
    floors = runpy.run_path(str(ROOT / "script" / "floors_python.py"))["FLOORS"]
    table = (ROOT / "docs" / "design.md").read_text().split("## The rooms of Python")[1]
    rows = re.findall(r"^\| `(\w+)/?` \|", table, re.MULTILINE)
    assert sorted(rows) == sorted(room for rooms in floors for room in rooms if room != "__main__")
    heights = [next(i for i, rooms in enumerate(floors) if room in rooms) for room in rows]
    assert heights == sorted(heights)


def test_design_names_the_layers() -> None:
    """Each stands above the rows of its rooms."""
    layers = runpy.run_path(str(ROOT / "script" / "floors_python.py"))["LAYERS"]
    table = (ROOT / "docs" / "design.md").read_text().split("## The rooms of Python")[1]
    rows = re.findall(r"^\| (?:\*\*([\w -]+)\*\*|`(\w+)/?`) \|", table, re.MULTILINE)
    found: dict[str, set[str]] = {}
    for layer, room in rows:
        if layer:
            found[layer] = set()
        else:
            list(found.values())[-1].add(room)
    wanted = {name: set().union(*floors) - {"__main__"} for name, floors in layers.items()}
    assert list(found.items()) == list(wanted.items())
    assert len(layers) == 8


def test_hand_overs_are_few_and_have_reasons() -> None:
    script = runpy.run_path(str(ROOT / "script" / "floors_python.py"))
    assert len(script["HAND_OVERS"]) <= script["MOST_HAND_OVERS"] == 10
    assert all(len(reason.split()) > 5 for reason in script["HAND_OVERS"].values())


def test_order_without_fault_passes(tmp_path: Path) -> None:
    assert checked(tmp_path, {}) == (
        0,
        "check-floors: 1 files of C++ and 18 of Python, 0 faults against the order of floors\n",
    )


LOOP = {
    "importers/gltf/nodes.py": "def f():\n    from . import meshes",
    "importers/gltf/meshes.py": "from daguerre.importers.gltf.nodes import f",
}
TYPED = "import typing\nif typing.TYPE_CHECKING:\n    import daguerre.pictures.exr"
DECIDES = GOOD["lenses/lens.py"].replace(
    "        return Zoom", "        self.x = 1\n        return Zoom"
)
ELSEWHERE = GOOD["lenses/lens.py"].replace("def _zoom", "def zoomed")


@pytest.mark.parametrize(
    ("planted", "message"),
    [
        (
            {"scene/bad.py": "from daguerre.rendering.job import Job"},
            "bad.py:1: points up: rendering",
        ),
        (
            {"scene/bad.py": "def f():\n    from ..importers.gltf import reader"},
            "bad.py:2: points up: importers",
        ),
        ({"scene/bad.py": TYPED}, "bad.py:3: points up: pictures"),
        (
            {
                "scene/__init__.py": "",
                "scene/__init__.pyi": "\nfrom daguerre.rendering.job import Job as Job",
            },
            "scene/__init__.py:2: points up: rendering",
        ),
        ({"checks.py": "import daguerre"}, "checks.py:1: points up: __init__"),
        (
            {"scene/bad.py": "from daguerre import Scene"},
            "points up: __init__ stands above scene, front ends above object model",
        ),
        ({"maps/a.py": "from daguerre.charts import b"}, "charts is a neighbor of maps"),
        ({"cellar/a.py": "x = 1"}, "room cellar is not in the table of floors"),
        ({"cli/bad.py": "from daguerre.attic import x"}, "attic is not a room"),
        (LOOP, "circle of 2 files: importers/gltf/meshes.py, importers/gltf/nodes.py"),
        ({"lenses/lens.py": DECIDES}, "circle of 2 files: lenses/lens.py, lenses/zoom.py"),
        ({"lenses/lens.py": ELSEWHERE}, "circle of 2 files: lenses/lens.py, lenses/zoom.py"),
        (
            {"cli/bad.py": "def f():\n    from daguerre.importers.gltf.nodes import f"},
            "bad.py:2: importers.gltf.nodes is the inside of importers.gltf, which shows reader",
        ),
        (
            {"importers/usd/bad.py": "from daguerre.importers.gltf import nodes"},
            "bad.py:1: importers.gltf.nodes is the inside of importers.gltf, which shows reader",
        ),
        (
            {"exporters/usd/bad.py": "from daguerre.importers.gltf.nodes import f"},
            "bad.py:1: importers.gltf.nodes is the inside of importers.gltf, which shows reader",
        ),
        (
            {"files/formats.py": 'ROW = "daguerre.importers.gltf.nodes:f"'},
            "formats.py:1: importers.gltf.nodes is the inside of importers.gltf",
        ),
        (
            {"cli/bad.py": "from daguerre.exporters.outgoing.media import f"},
            "bad.py:1: exporters.outgoing is for exporters alone",
        ),
        (
            {"importers/stl/reader.py": "def read(): pass"},
            "importers/stl/reader.py:1: folder importers.stl has no row in FACES",
        ),
        (
            {"lenses/lens.py": "class Lens: pass"},
            "lenses/lens.py:1: _zoom does not hand over to lenses.zoom: its row in HAND_OVERS is",
        ),
        (
            {"lenses/bad.py": "def _zoom(x):\n    from daguerre.plots import a\n    return a(x)"},
            "points up: plots stands above lenses",
        ),
    ],
)
def test_fault_is_found(tmp_path: Path, planted: dict[str, str], message: str) -> None:
    code, said = checked(tmp_path, planted)
    assert code == 1, said
    assert message in said
