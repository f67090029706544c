"""Cancellation: another thread ends a render or the set-up of a lens, and nothing else."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import numpy as np
import pytest

import daguerre as dg
from daguerre.rendering import Cancelled, CancelToken
from daguerre.rendering.session import Session

#: Longest time from the wish to the end, s. Quiet machines take some ms; this one may be busy.
MOST_S = 0.5
DOUBLE_GAUSS = "double-gauss-50mm-f2"


def scene() -> dg.Scene:
    """A floor under an even sky."""
    found = dg.Scene()
    corners = np.array([[-2, -1, -6], [2, -1, -6], [2, -1, 0], [-2, -1, 0]], np.float32)
    found.add_mesh(corners, np.array([[0, 2, 1], [0, 3, 2]], np.uint32))
    found.set_environment(color=(1.0, 1.0, 1.0))
    return found


def ended_in(work: Callable[[], object], after: float) -> float:
    """Time from the cancellation of work to its end, s."""
    token, end = CancelToken(), []

    def run() -> None:
        with pytest.raises(Cancelled), token:
            work()
        end.append(time.monotonic())

    thread = threading.Thread(target=run)
    thread.start()
    time.sleep(after)
    wished = time.monotonic()
    token.cancel()
    thread.join(60)
    assert end, "the work was not cancelled"
    return end[0] - wished


@pytest.mark.parametrize("light_paths", ["off", "4"])
def test_a_render_ends(light_paths: str) -> None:
    session = Session(
        scene(), dg.Camera(lens=DOUBLE_GAUSS), resolution=(200, 120), light_paths=light_paths
    )
    assert ended_in(lambda: session.draw(0, 1 << 20), 0.2) < MOST_S


def test_the_set_up_of_a_lens_ends() -> None:
    camera = dg.Camera(lens=DOUBLE_GAUSS, lens_model="polynomial", degree=9)

    def set_up() -> None:
        for k in range(100):  # each is fitted anew, which takes tenths of a second
            focused = camera.with_(focus_distance=1 + 0.01 * k)
            Session(scene(), focused, resolution=(200, 120))

    assert ended_in(set_up, 0.15) < MOST_S


def test_what_was_cancelled_before_does_not_begin() -> None:
    token = CancelToken()
    token.cancel()
    session = Session(scene(), dg.Camera(), resolution=(20, 12))
    with pytest.raises(Cancelled), token:
        session.draw(0, 1)


def test_other_threads_go_on() -> None:
    alone = dg.render(scene(), dg.Camera(), resolution=(60, 40), spp=16, seed=3)
    found: list[dg.Frame] = []

    def run() -> None:
        found.extend(
            dg.render(scene(), dg.Camera(), resolution=(60, 40), spp=16, seed=3) for _ in range(8)
        )

    thread = threading.Thread(target=run)
    thread.start()
    for _ in range(5):
        session = Session(scene(), dg.Camera(), resolution=(200, 120))
        ended_in(lambda session=session: session.draw(0, 1 << 20), 0.01)  # type: ignore[misc]
    thread.join()
    assert len(found) == 8
    assert all(np.array_equal(one.rgb, alone.rgb) for one in found)


def test_a_token_ends_with_its_block() -> None:
    token = CancelToken()
    with token:
        pass
    token.cancel()
    dg.render(scene(), dg.Camera(), resolution=(20, 12), spp=1)
