"""Floors of python/daguerre: an import that points up, a circle, or a look inside is an error.

Every import counts: at the top of a file, for types alone, and inside functions. A value may hand
itself up (``frame.save(path)``) only in a method that is listed in ``HAND_OVERS`` and whose body is
one import and one call, so that nothing is decided there. A folder in ``FACES`` shows the modules
listed there, and nothing else. ``script/check-floors`` runs this.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

# Eight layers (docs/design.md), lowest first, and the floors of each. Rooms are folders, or files
# at the root. Rooms on one floor do not see each other.
LAYERS = {
    "ground": [
        {"errors", "cached", "compiled", "forks", "lazy_imports"},
        {"checks"},
        {"annotation_kinds"},
        {"argument_checks"},
    ],
    "tables": [{"units", "memory", "files"}, {"parameters", "apart"}],
    "optics and color": [{"color", "motion", "convolution"}, {"lenses", "sensors"}],
    "object model": [{"camera"}, {"scene", "frame"}],
    "formats": [{"pictures"}, {"shading"}, {"importers"}, {"exporters"}],
    "set-up and measures": [
        {"setup"},
        {"analysis"},
        {"plots"},
        {"distortion"},
        {"polynomial"},
        {"export"},
        {"calibration"},
    ],
    "rendering and pictures": [
        {"post"},
        {"exposure"},
        {"development"},
        {"stocks"},
        {"rendering"},
        {"maps", "labels", "charts"},
        {"plates"},
    ],
    "front ends": [{"viewfinder", "cluster", "blender"}, {"__init__"}, {"cli"}, {"__main__"}],
}
FLOORS = [rooms for floors in LAYERS.values() for rooms in floors]
LAYER = {room: name for name, floors in LAYERS.items() for rooms in floors for room in rooms}
#: A string that names a module of the package, or a function of one.
NAME = re.compile(r"daguerre\.([a-z_0-9.]+)(?::\w+)?")
#: Compiled module below all rooms.
FREE = {"_core"}
#: (file, method, module above, or a higher one of its room): a value that hands itself up, and why
#: the method is there. Methods with one underscore are the one way of several public ones.
HAND_OVERS = {
    ("analysis/plotted.py", "_drawn", "plots.results"): (
        "spot.plot() and notebooks: a result shows itself; analyses load without drawings"
    ),
    ("camera/camera.py", "_calibrated", "calibration.cameras"): (
        "Camera.from_opencv and four more: makers of a camera are found at Camera"
    ),
    ("frame/frame.py", "_before_sensor", "exposure.expose"): (
        "frame.expose() and exposure_truth(): the next step of a picture is found at the frame"
    ),
    ("frame/frame.py", "_on_screen", "development.shown"): (
        "frame.display() and encoded(): a frame is shown as its exposure mode develops it"
    ),
    ("frame/raw.py", "develop", "development.recipe"): (
        "raw.develop(): the next step of a picture is found at the raw picture"
    ),
    ("lenses/lens.py", "_repr_svg_", "plots.lens_section"): (
        "a notebook asks the lens itself for its section"
    ),
    ("lenses/lens.py", "_zoom", "lenses.zoom"): (
        "lens.at_zoom() and zoom_range_mm: a zoom sets lenses, so it is above Lens"
    ),
    ("lenses/lens.py", "focused", "lenses.focus"): (
        "lens.focused(): focusing moves and zooms lenses, so it is above Lens"
    ),
    ("rendering/render.py", "_on_cluster", "cluster.opened"): (
        "dg.render(cluster=...): one function draws here or there; the cluster drives sessions"
    ),
    ("stocks/stock.py", "expose", "stocks.negative"): (
        "stock.expose(frame): a negative keeps its stock, so it is above Stock"
    ),
}
#: At most as many hand-overs.
MOST_HAND_OVERS = 10
FLOOR = {room: number for number, rooms in enumerate(FLOORS) for room in rooms}
#: Modules that a folder shows to others; the rest is its inside. A format's exporter sees the
#: inside of its importer: both use one table of the format's names.
FACES = {
    "pictures.exr": {
        *("read", "write", "reader", "rows", "parts", "crops"),  # whole files, rows, parts
        *("header", "layout", "facts", "color_space"),  # their headers
    },
    "pictures.reading": {"read", "source", "kinds", "size"},
    "shading.materialx": {"document", "graph"},
    "importers.gltf": {"reader"},
    "importers.mitsuba": {"reader"},
    "importers.pbrt": {"reader"},
    "importers.usd": {"wall"},
    "importers.meshes": {"file_mesh", "obj", "ply", "serialized"},
    "importers.volumes": {"density", "vol"},
    "exporters.mitsuba": {"writer"},
    "exporters.pbrt": {"writer"},
    "exporters.usd": {"cameras"},
}
#: Folders for the other files of their room, which see all of them; other rooms see nothing.
WITHIN = {"exporters.outgoing"}
#: Rooms whose every folder is in one of these lists.
WALLED = ("pictures", "shading", "importers", "exporters")


@dataclass(frozen=True)
class Import:
    """One import statement: where it stands, the room it names, and the module, if a file."""

    line: int
    room: str
    module: str  # empty: no file of the package
    method: str = ""  # of one import and one call, if it stands in such a one
    typed: bool = False  # for types alone
    text: bool = False  # a string that names a module, as ``"daguerre.importers.ies:read"``


def targets(node: ast.AST, package: list[str]) -> Iterator[list[str]]:
    """Dotted names inside daguerre that an import statement of a file in `package` may mean."""
    if isinstance(node, ast.Import):
        for alias in node.names:
            name = alias.name.split(".")
            if name[0] == "daguerre":
                yield name[1:] or ["__init__"]
    elif isinstance(node, ast.ImportFrom):
        base = (node.module or "").split(".") if node.module else []
        if node.level:
            base = package[: len(package) - (node.level - 1)] + base
        if base[:1] == ["daguerre"]:
            for alias in node.names:
                yield [*base[1:], alias.name]


def hand_over(function: ast.AST) -> ast.stmt | None:
    """The import of a method that is one import and one call; None: it is something else."""
    if not isinstance(function, ast.FunctionDef):
        return None
    body = function.body
    if isinstance(body[0], ast.Expr) and isinstance(body[0].value, ast.Constant):
        body = body[1:]
    if len(body) != 2 or not isinstance(body[0], ast.ImportFrom):
        return None
    last = body[1].value if isinstance(body[1], ast.Return | ast.Expr) else None
    return body[0] if isinstance(last, ast.Call) else None


def for_types(node: ast.AST) -> bool:
    """Whether a statement is ``if TYPE_CHECKING``."""
    return isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING")


def named(node: ast.AST) -> list[str]:
    """Dotted name inside daguerre that a string is, as rows of tables have it; empty: none."""
    if not isinstance(node, ast.Constant) or not isinstance(node.value, str):
        return []
    found = NAME.fullmatch(node.value)
    return found.group(1).split(".") if found else []


class Package:
    """Imports of all files of a package folder."""

    def __init__(self, folder: Path) -> None:
        self.files = {
            self._module(path, folder): path.relative_to(folder).as_posix()
            for path in sorted(folder.rglob("*.py"))
        }
        self.imports = {
            module: list(self._imports(folder / file, module))
            for module, file in self.files.items()
        }

    @staticmethod
    def _module(path: Path, folder: Path) -> str:
        parts = path.relative_to(folder).with_suffix("").parts
        return ".".join(parts[:-1] if parts[-1] == "__init__" and len(parts) > 1 else parts)

    def _imports(self, path: Path, module: str) -> Iterator[Import]:
        stub = path.with_suffix(".pyi")
        if path.stem == "__init__" and stub.exists():  # names of the package, imported on first use
            yield from self._imports_of(stub, module)
        yield from self._imports_of(path, module)

    def _imports_of(self, path: Path, module: str) -> Iterator[Import]:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        within = module.split(".") if path.stem == "__init__" else module.split(".")[:-1]
        package = ["daguerre", *(part for part in within if part != "__init__")]
        nodes = list(ast.walk(tree))
        plain = {id(hand_over(node)): getattr(node, "name", "") for node in nodes}
        typed = {id(line) for node in nodes if for_types(node) for line in ast.walk(node)}
        for node in nodes:
            if name := named(node):
                yield Import(getattr(node, "lineno", 0), name[0], self._module_of(name), text=True)
            for name in targets(node, package):
                method = plain.get(id(node), "")
                yield Import(
                    getattr(node, "lineno", 0),
                    self._room(name),
                    self._module_of(name),
                    method,
                    id(node) in typed,
                )

    def _room(self, name: list[str]) -> str:
        """Room of a dotted name; a name of the face itself is the face."""
        return name[0] if name[0] in FLOOR or name[0] in FREE or len(name) > 1 else "__init__"

    def _module_of(self, name: list[str]) -> str:
        """Module that a dotted name loads: the longest beginning of it that is a file."""
        beginnings = (".".join(name[:end]) for end in range(len(name), 0, -1))
        return next((module for module in beginnings if module in self.files), "")


def upward(package: Package) -> list[str]:
    """Imports against the order of floors, as file:line: message."""
    errors = []
    for module, imports in package.imports.items():
        file = package.files[module]
        room = file.split("/")[0].removesuffix(".py")
        if room not in FLOOR:
            errors.append(f"{file}:1: room {room} is not in the table of floors")
            continue
        folder = ".".join(file.split("/")[:2])
        if room in WALLED and file.count("/") > 1 and folder not in {*FACES, *WITHIN}:
            errors.append(f"{file}:1: folder {folder} has no row in FACES")
        for found in imports:
            problem = judge_face(module, found.module)
            if problem is None and not found.text:
                problem = judge(file, room, found)
            if problem:
                errors.append(f"{file}:{found.line}: {problem}")
    return errors


def handed_over(file: str, found: Import) -> bool:
    """Whether a listed method hands over by an import, or names the type that comes back."""
    methods = {
        method for listed, method, above in HAND_OVERS if (listed, above) == (file, found.module)
    }
    return bool(methods) if found.typed else found.method in methods


def judge(file: str, room: str, found: Import) -> str | None:
    """Why a file must not have an import, or None."""
    other = found.room
    if other == room or other in FREE or handed_over(file, found):
        return None
    if other not in FLOOR:
        return f"{other} is not a room"
    if FLOOR[other] < FLOOR[room]:
        return None
    if any((file, found.module) == (listed, above) for listed, _, above in HAND_OVERS):
        return (
            f"hands over to {found.module}, but not in a listed method of one import and one call"
        )
    side = "is a neighbor of" if FLOOR[other] == FLOOR[room] else "stands above"
    higher = "" if LAYER[other] == LAYER[room] else f", {LAYER[other]} above {LAYER[room]}"
    return f"points up: {other} {side} {room}{higher}"


def judge_face(module: str, other: str) -> str | None:
    """Why a module must not see another one, which is the inside of a folder; or None."""
    folder = ".".join(other.split(".")[:2])
    if module == folder or module.startswith(folder + "."):
        return None
    if folder in WITHIN:
        room = folder.split(".")[0]
        return None if module.startswith(room + ".") else f"{folder} is for {room} alone"
    if folder not in FACES or other == folder:
        return None
    importer = "importers." + folder.split(".")[1]
    if folder == importer and module.startswith(importer.replace("importers", "exporters") + "."):
        return None
    face = ", ".join(sorted(FACES[folder]))
    inside = other.split(".")[2:] != [] and other.split(".")[2] not in FACES[folder]
    return f"{other} is the inside of {folder}, which shows {face}" if inside else None


def needless(package: Package) -> list[str]:
    """Rows of hand-overs that no method uses, or that are too many."""
    used = {
        (package.files[module], found.method, found.module)
        for module, imports in package.imports.items()
        for found in imports
    }
    errors = [
        f"{file}:1: {method} does not hand over to {above}: its row in HAND_OVERS is needless"
        for file, method, above in HAND_OVERS
        if file in package.files.values() and (file, method, above) not in used
    ]
    if len(HAND_OVERS) > MOST_HAND_OVERS:
        errors.append(f"hand-overs: wanted at most {MOST_HAND_OVERS}, got {len(HAND_OVERS)}")
    return errors


def circles(package: Package) -> list[str]:
    """Files that import each other in a loop, hand-overs left out; one line a loop."""
    arrows = {
        module: sorted(
            {
                found.module
                for found in imports
                if found.module
                and not found.text
                and not handed_over(package.files[module], found)
                and not holds(found.module, module)
            }
        )
        for module, imports in package.imports.items()
    }
    errors = []
    for group in strong_components(arrows):
        if len(group) > 1:
            names = ", ".join(sorted(package.files[module] for module in group))
            errors.append(f"circle of {len(group)} files: {names}")
    return errors


def holds(folder: str, module: str) -> bool:
    """Whether a module is another itself, or the face of its folder."""
    return folder in ("__init__", module) or module.startswith(folder + ".")


def strong_components(arrows: dict[str, list[str]]) -> list[list[str]]:
    """Strongly connected components; Tarjan, SIAM J. Comput. 1 (1972) 146."""
    number: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    found: list[list[str]] = []

    def visit(node: str) -> None:
        number[node] = low[node] = len(number)
        stack.append(node)
        for other in arrows.get(node, []):
            if other not in number:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in stack:
                low[node] = min(low[node], number[other])
        if low[node] == number[node]:
            start = stack.index(node)
            found.append(stack[start:])
            del stack[start:]

    for node in arrows:
        if node not in number:
            visit(node)
    return found


def check(folder: Path) -> tuple[int, list[str]]:
    """Number of files of a package folder, and all its faults."""
    package = Package(folder)
    return len(package.files), upward(package) + circles(package) + needless(package)
