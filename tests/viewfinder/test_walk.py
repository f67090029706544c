"""Random turns of all dials: no unhandled error, memory stays flat, and the bits are a render's."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.stage import Stage

from .live import live, page
from .test_painter import scene

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")
SIZE = (48, 32)
DIALS: dict[str, tuple[str | None, ...]] = {
    "lens": (
        "double-gauss-50mm-f2",
        "canon-ef-24-70mm-f2.8",
        "tessar-50mm-f2.8",
        "thin",
        None,
    ),
    "exposure": ("light", "manual", "auto", "A", "S", "P", None),
    "meter": ("centre", "spot", "matrix", "highlight"),
    "iso": ("50", "125", "6400", None),
    "exposure_compensation": ("-3", "0.333333", "2", None),
    "white_balance": ("2800", "6500", None),
    "look": ("standard", "neutral", None),
    "f_stop": ("1", "2.8", "11", None),
    "shutter_time": ("1/8000", "1/50", "2", None),
    "focus_distance": ("0.3", "2", "inf", None),
    "zoom": ("24", "70", None),
    "blades": ("0", "5", None),
    "sensor": ("ideal", "36x24", None),
    "place.position": ("0.5,1.5,2", None),
    "focus_at": ("10,10", "47,31", None),
    "time": ("0", "0.5", None),
}
#: Growth of memory that buffers of the size of pictures and caches of lenses explain, MB.
SLACK_MB = 40


def memory_mb() -> float:
    """Resident memory of this process."""
    text = Path("/proc/self/status").read_text()
    return int(text.split("VmRSS:")[1].split()[0]) / 1024


def turn_of(chance: random.Random) -> dict[str, str | None]:
    """One or two dials at random."""
    names = chance.sample(sorted(DIALS), chance.choice((1, 1, 2)))
    return {name: chance.choice(DIALS[name]) for name in names}


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="needs /proc")
@pytest.mark.parametrize("count", [60, pytest.param(1000, marks=pytest.mark.slow)])
def test_random_turns(count: int) -> None:
    chance = random.Random(57)
    made = scene()
    made.set_environment(color=(200.0, 200.0, 200.0))
    stage = Stage(
        made, made.camera().with_(f_stop=None), dg.RenderSettings.of(resolution=SIZE, spp=2)
    )
    after: list[float] = []
    with live(stage) as server, page(server) as one:
        one.until_rest(0)
        for number in range(count):
            before = len(one.refused)
            one.send(turn=turn_of(chance))
            one.send(probe=[3, 3])
            seen = len(one.values)
            while len(one.values) == seen:
                one.step()
            assert not any("internal error" in text for text in one.refused[before:])
            assert "internal error" not in one.state.get("error", "")
            if number % 20 == 19:
                check(one, server, stage)
                after.append(memory_mb())
    # The first half fills what is kept, such as lenses.
    assert after[-1] - after[len(after) // 2] < SLACK_MB, after


def check(one: Any, server: Any, stage: Stage) -> None:
    """The picture at rest is a render's of the dials."""
    # A turn that cannot be drawn never rests: the one that puts it back does.
    while not (one.heads[-1]["rests"] and one.heads[-1]["turn"] == server.hub.number):
        one.step(60)
    seen = server.hub.picture
    shot = stage.exposed(stage.shot(Dials(server.hub.dials.texts)))
    alone = dg.render(shot.scene, shot.camera, settings=shot.settings)
    assert np.array_equal(seen.frame.rgb, alone.rgb)
    pixels = seen.shot.photograph.shown(seen.frame, seen.shot.tone)
    assert np.array_equal(pixels, shot.photograph.shown(alone, shot.tone))
