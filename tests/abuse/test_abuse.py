"""Public calls under random arguments: a right result or an error of ours, and nothing else.

No crash, no other class of error, at most 10 s on two cores and 1 GB. A wrong name of a keyword,
or a wrong count of arguments, may stay Python's own ``TypeError``: cases use names that exist. A
case is found again by its path and number: ``python -m tests.abuse PATH NUMBER``.
"""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre import analysis

from . import calls
from .calls import targets
from .runner import outcomes
from .world import LENS

#: Cases of each public call: in every run of the tests, and in the long one.
FEW, MANY = 4, 60
#: Good arguments that are refused all the same, and why.
REFUSED = {
    "dg.Session.draw_round": "a round is planned by a driver",
    "dg.ClusterSession.draw_round": "a round is planned by a driver",
}


def bench() -> analysis.Bench:
    return analysis.set_up(dg.lenses.load(LENS))


def faults(numbers: range, paths: list[str] | None = None) -> list[str]:
    """A line for each case that is no right result and no error of ours."""
    cases = [(path, n) for path in paths or targets() for n in numbers]
    return [
        f"{path} {n}: {outcome.kind}: {outcome.call}: {outcome.where}"
        for (path, n), outcome in outcomes(cases)
        if not outcome.good
    ]


def test_good_arguments_are_accepted() -> None:
    """Else random ones would be refused for another reason."""
    found = {path: outcome for (path, _), outcome in outcomes((path, 0) for path in targets())}
    assert len(found) > 350
    refused = {path: f"{o.kind}: {o.where}" for path, o in found.items() if o.kind != "accepted"}
    assert {path: why for path, why in refused.items() if path not in REFUSED} == {}
    assert all(found[path].good for path in REFUSED)


def test_random_arguments() -> None:
    assert faults(range(1, 1 + FEW)) == []


@pytest.mark.slow
def test_many_random_arguments() -> None:
    assert faults(range(1, 1 + MANY)) == []


@pytest.mark.parametrize(
    ("body", "kind"),
    [
        ("raise AttributeError('deep inside')", "AttributeError"),
        ("raise dg.UsageError('')", "an error without words"),
        ("import os; os.abort()", "crash: SIGABRT"),
        ("while True: pass", "hang"),
        ("kept = bytearray(2_000_000_000)", "memory"),
    ],
)
def test_each_kind_of_fault_is_seen(body: str, kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A fault that is planted in the worker fails one case, named; the next one runs."""
    monkeypatch.setenv("DG_ABUSE_PLANT", body)
    if kind == "hang":
        monkeypatch.setenv("DG_ABUSE_SECONDS", "1")
    found = [outcome for _, outcome in outcomes([("dg.keys", 0), ("dg.spin", 0)])]
    assert found[0].kind.startswith(kind)
    assert found[0].call.startswith("dg.keys(")
    assert found[1].kind == "accepted"


def test_cases_are_the_same_in_each_run() -> None:
    """Also in another process: a number says which values."""
    cases = [("dg.raymap", n) for n in range(1, 30)]
    first, second = ([outcome.call for _, outcome in outcomes(cases)] for _ in range(2))
    assert first == second
    assert len(set(first)) > 20


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: dg.raymap(dg.Camera(), (8, 6), scene=3), "raymap: scene: wanted a Scene or None"),
        (lambda: dg.lenses.load(3), "load: name_or_path: wanted a path or a Lens, got 3"),
        (lambda: dg.stereo_pair(dg.Camera(), "x"), "stereo_pair: baseline: wanted a number"),
        (lambda: dg.load("a\0b"), "load: path: wanted a path"),
        (
            lambda: dg.post.star(np.ones((6, 8, 3)), f_number=8, sensor=(36, 24)),
            "star: wanted a kernel that reaches beyond the star's core",
        ),
        (
            lambda: analysis.lateral_colour(bench(), [5.0], [0.0, 550.0]),
            "rays: wavelength_nm: wanted wavelengths of 1 to 1e6 nm, got 0",
        ),
        (lambda: dg.Scene().at(float("nan")), "at: time: wanted a number, got nan"),
    ],
)
def test_errors_name_argument_wanted_and_got(call, words) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(dg.UsageError, match=words):
        call()


def test_every_skipped_call_says_why() -> None:
    assert all(calls.SKIPPED.values())
