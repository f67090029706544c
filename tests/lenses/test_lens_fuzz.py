"""Lens files that were changed at random: each is a lens that can be used, or one clear error."""

from __future__ import annotations

import json
import math
import re
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from daguerre import lenses
from daguerre.errors import InputError
from daguerre.lenses.errors import CODES, LensError
from tests.bad_files.lens_imports import ZOOM
from tests.lenses.test_lens_import import ANAMORPHIC, ASPHERE, ODD, PLACED
from tests.support.lenses import lens_writers as write
from tests.support.lenses.triplet import TRIPLET

#: Bytes that these formats give a meaning to, and numbers that break things.
TOKENS = tuple(
    re.split(
        " ",
        "0 -0 1 -1 1e-300 1e300 1e999 nan inf INFINITY 0x10 1_0 . - 99999999999999999999 \t \n ; & "
        "! ' \" # [ ] { } , : SURF TYPE STOP COORDBRK EVENASPH BICONICX TOROIDAL PARM XDAT GLAS "
        "MIRROR MNUM THIC TCOM S SO SI STO ZOO THI DAR REV ASP CYL XTO CIR PRV END AS CG d2 Bf "
        "[constants] \x00 \ufeff",
    )
)
SEEDS: list[tuple[str, str]] = [
    *((write.zmx(data), ".zmx") for data in (ZOOM, ASPHERE, ODD, PLACED, ANAMORPHIC)),
    *((write.seq(data), ".seq") for data in (ZOOM, ASPHERE, PLACED, ANAMORPHIC)),
    *((write.optical_bench(data), ".txt") for data in (ZOOM, ASPHERE)),
    (write.pbrt(TRIPLET), ".dat"),
    (json.dumps({"schema": "daguerre-lens/0.1", **ASPHERE}), ".json"),
]
LIMIT_S = 10.0


@st.composite
def broken(draw: Any) -> tuple[bytes, str]:
    """A good file with a few words, lines or bytes taken, doubled, or replaced."""
    text, suffix = draw(st.sampled_from(SEEDS))
    for _ in range(draw(st.integers(1, 4))):
        how = draw(st.sampled_from(("word", "word", "word", "line", "cut", "bytes", "other")))
        if how == "word":
            words = text.split(" ")
            words[draw(st.integers(0, len(words) - 1))] = draw(st.sampled_from(TOKENS))
            text = " ".join(words)
        elif how == "line":
            rows = text.split("\n")
            i, j = (draw(st.integers(0, len(rows) - 1)) for _ in range(2))
            rows.insert(i, rows[j]) if draw(st.booleans()) else rows.pop(i)
            text = "\n".join(rows)
        elif how == "cut":
            text = text[: draw(st.integers(0, len(text)))]
        elif how == "bytes":
            at = draw(st.integers(0, len(text)))
            text = text[:at] + draw(st.text(max_size=6)) + text[at:]
        else:
            text += draw(st.sampled_from(SEEDS))[0]
        text = text[:20_000]
    encoding = draw(st.sampled_from(("utf-8", "utf-8", "utf-16", "utf-16-le")))
    return text.encode(encoding, "replace"), suffix


def check(data: bytes, suffix: str) -> str:
    """The lens is one, or the error is; the code of the error."""
    started = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"lens{suffix}"
        path.write_bytes(data)
        try:
            lens = lenses.read(path)
        except LensError as error:
            code, text = error.code, str(error)
        else:
            code, text = "", ""
            order = lens.first_order()
            assert math.isfinite(order.efl)
            assert np.isfinite(lens.vertices).all()
            assert all(note and len(note) < 800 and note.isprintable() for note in lens.notes)
            repr(lens)
        assert time.process_time() - started < LIMIT_S
    if text:
        assert code in CODES
        assert text.startswith(str(path))
        assert text.endswith(f" [{code}]")
        assert len(text) < 800
        assert text.isprintable(), text
    return code


@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
@given(broken())
@example((b"[lens data]\n1\tAS\t1\n", ".txt"))
@example((b"SURF 0\nSURF 1\nSURF 2\n", ".zmx"))
@example((b"SO 0 1e14;S 0 0;SI 0 0", ".seq"))
@example((b"0 0 0 0", ".dat"))
@example((SEEDS[-1][0].replace('"a4"', r'"\u007f\u202e"').encode(), ".json"))
def test_broken_files_are_lenses_or_errors(case: tuple[bytes, str]) -> None:
    check(*case)


@pytest.mark.slow
@settings(max_examples=20_000, deadline=None, suppress_health_check=list(HealthCheck))
@given(broken())
def test_very_many_broken_files(case: tuple[bytes, str]) -> None:
    check(*case)


def test_the_seeds_themselves_are_lenses(tmp_path: Path) -> None:
    for text, suffix in SEEDS:
        assert check(text.encode(), suffix) == ""
    with pytest.raises(InputError):
        lenses.read(tmp_path / "none.zmx")


@pytest.mark.parametrize("suffix", [".zmx", ".seq", ".txt", ".dat"])
def test_large_files_are_refused_in_time(suffix: str) -> None:
    """16 MB of what makes each reader work: surfaces, unknown glasses, words, lines."""
    surface = {
        ".zmx": "SURF {i}\n  TYPE STANDARD\n  CURV 0.01\n  DISZ 1\n  GLAS Q{i} 0 0 1.6 50\n",
        ".seq": "S 50 1 Q{i}\n",
        ".txt": "{i}\t50\t1\t1.6\t9\t50\tQ{i}\n",
        ".dat": "50 1 1.6 9\n",
    }[suffix]
    head = {".zmx": "MODE SEQ\n", ".seq": "SO 0 1e14\n", ".txt": "[lens data]\n"}.get(suffix, "")
    for count in (1_900, 60_000):
        text = head + "".join(surface.replace("{i}", str(i)) for i in range(count))
        assert check(text[:15_900_000].encode(), suffix).startswith("lens-")
    words = " ".join(["1"] * 20_000) + "\n"
    assert check((head + words * 150)[:15_900_000].encode(), suffix).startswith("lens-")
