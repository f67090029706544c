"""Words of docs/glossary.md have one meaning: their types exist, others have longer names."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "python" / "daguerre"
#: Modules that may define a class with this name alone.
OWNERS = {
    "Look": {"development/looks.py"},
    "Picture": {"frame/picture.py", "rendering/picture.py"},
    "Place": {"scene/over_time/operations.py"},
    "Placing": {
        "blender/placing.py",
        *(f"importers/{name}/placing.py" for name in ("gltf", "mitsuba", "pbrt", "usd")),
    },
    "Source": {"frame/aovs.py"},
    "Surface": set(),
    "View": {"rendering/picture.py", "viewfinder/notebook.py"},
    "Walk": set(),
    "_Reader": set(),
}


def classes(package: Path) -> Iterator[tuple[str, str]]:
    """Name of each class at the top of a module, and the module."""
    for path in sorted(package.rglob("*.py")):
        for node in ast.parse(path.read_text("utf-8")).body:
            if isinstance(node, ast.ClassDef):
                yield node.name, path.relative_to(package).as_posix()


def owners(package: Path) -> dict[str, set[str]]:
    """Modules that define classes with the names in ``OWNERS``."""
    found: dict[str, set[str]] = {name: set() for name in OWNERS}
    for name, module in classes(package):
        if name in found:
            found[name].add(module)
    return found


def test_short_name_has_one_meaning() -> None:
    assert owners(PACKAGE) == OWNERS


def test_second_class_with_a_short_name_is_found(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("class _Reader:\n    pass\n\n\nclass Other:\n    pass\n")
    assert {name for name, found in owners(tmp_path).items() if found} == {"_Reader"}


def test_glossary_has_twenty_words_with_types_of_the_code() -> None:
    rows = [row for row in (ROOT / "docs/glossary.md").read_text().split("\n") if row[:2] == "| "]
    assert len(rows) == 21  # with the head
    names = set(re.findall(r"`(\w+)`", "\n".join(rows)))
    sources = [p for folder in (ROOT / "core", PACKAGE) for p in folder.rglob("*")]
    text = "\n".join(p.read_text("utf-8") for p in sources if p.suffix in {".h", ".py"})
    assert not [n for n in names if not re.search(rf"\b(?:class|struct|def) {n}\b|\b{n}\(", text)]
