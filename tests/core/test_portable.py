"""The core calls no function of the C library whose bits differ between its releases."""

from __future__ import annotations

import re
from pathlib import Path

CORE = Path(__file__).resolve().parents[2] / "core"
CHANGED = re.compile(r"std::(acos|asin|asinh|atan|atan2|hypot|acosh|atanh|cbrt|tgamma|erf)f?\(")


def test_arc_functions_come_from_portable_h() -> None:
    found = [
        f"{path.relative_to(CORE)}: {match[0]}"
        for path in sorted(CORE.rglob("*.[ch]*"))
        if path.name != "portable.h" and not path.stem.endswith("_test")
        for match in CHANGED.finditer(path.read_text())
    ]
    assert found == []
