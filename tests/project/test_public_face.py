"""Names, signatures, commands and flags are those of the golden list, but for listed differences.

The list was made by ``script/public-face`` before the package got its rooms. A difference that is
meant goes into ``data/public_face_changes.json`` and into the CHANGELOG: what happened (``added``,
``removed`` or ``changed``), the name (``*`` stands for any text), what stands there ``now`` where
it changed, and why.
"""

from __future__ import annotations

import json
import re
import runpy
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parents[1]
ROOT = next(folder for folder in HERE.parents if (folder / "script").is_dir())
Face = dict[str, str]


def differences(before: Face, now: Face) -> dict[str, tuple[str, str]]:
    """Differences by name: what happened, and what stands there now."""
    found = dict.fromkeys(before.keys() - now.keys(), ("removed", ""))
    found |= {name: ("added", now[name]) for name in now.keys() - before.keys()}
    both = before.keys() & now.keys()
    return found | {n: ("changed", now[n]) for n in both if before[n] != now[n]}


def meant(row: dict[str, Any], name: str, what: str, now: str) -> bool:
    """Whether a row of the table speaks of this difference."""
    pattern = re.escape(row["name"]).replace(r"\*", ".*")
    value = row.get("now", now)
    return row["what"] == what and bool(re.fullmatch(pattern, name)) and value == now


def unexplained(before: Face, now: Face, rows: list[dict[str, Any]]) -> list[str]:
    """Differences without a reason, and reasons without a difference."""
    found = differences(before, now)
    lines = [
        f"{what}: {name}: {before.get(name, '')!r} -> {value!r}"
        for name, (what, value) in sorted(found.items())
        if not any(meant(row, name, what, value) for row in rows)
    ]
    return lines + [
        f"no such difference: {row}"
        for row in rows
        if not any(meant(row, name, *found[name]) for name in found)
    ]


def read(name: str) -> Any:
    return json.loads((ROOT / "tests" / "data" / name).read_text())


def test_the_public_face_is_that_of_the_list() -> None:
    now = runpy.run_path(str(ROOT / "script" / "public-face"))["face"]()
    rows = read("public_face_changes.json")
    assert all(row["why"] and ("now" in row or row["what"] != "changed") for row in rows)
    assert unexplained(read("public_face.json"), now, rows) == []


def test_each_kind_of_difference_is_seen() -> None:
    before = read("public_face.json")
    assert len(before) > 2000
    for name in ("dg.render(spp)", "dg.Camera.f_stop", "daguerre render --fstop", "dg.InputError"):
        assert name in before
        rest = {key: value for key, value in before.items() if key != name}
        assert unexplained(before, rest, []) == [f"removed: {name}: {before[name]!r} -> ''"]
        assert unexplained(rest, before, []) == [f"added: {name}: '' -> {before[name]!r}"]
        other = before | {name: "another"}
        assert unexplained(before, other, [])[0].startswith(f"changed: {name}: ")
        row = {"what": "changed", "name": name, "now": "another", "why": "a reason"}
        assert unexplained(before, other, [row]) == []
        assert len(unexplained(before, other, [row | {"now": "else"}])) == 2
    stale = {"what": "added", "name": "dg.merge*", "why": "a reason"}
    assert unexplained(before, before, [stale]) == [f"no such difference: {stale}"]
    assert unexplained(before, before | {"dg.merge": "", "dg.merge(a)": ""}, [stale]) == []


def test_each_public_name_is_listed_and_loads() -> None:
    """Completion reads `dir`; names are imported on first use."""
    import daguerre as dg

    assert set(dg.__all__) <= set(dir(dg))
    assert [name for name in dg.__all__ if not hasattr(dg, name)] == []
