"""Passes (merge) and checkpoints (--resume)."""

from __future__ import annotations

import os
import struct
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg
from daguerre.importers.gltf import reader as gltf
from daguerre.rendering import passes
from daguerre.rendering.session import Session

from .bases import seen
from .case import Case

MERGE = ("merge", "{bad}", "-o", "{out}.exr")
RESUME = (
    *("render", "{folder}/scene.glb", "-o", "{folder}/out.exr", "--spp", "2", "--res", "16x9"),
    *("--sky", "1,1,1", "--threads", "1", "--resume"),
)


@cache
def _drawn() -> tuple[dg.Frame, passes.Pass]:
    """A small picture and its sums."""
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    session = Session(scene, dg.Camera(f_stop=8, focus_distance=2), resolution=(16, 9))
    session.draw(0, 1)
    drawn = passes.pass_of(session)
    state = {name: words.copy() for name, words in drawn.state.items()}
    return session.frame(), replace(drawn, state=state)


def written(change: Callable[[passes.Pass], passes.Pass]) -> Callable[[Path], Path]:
    """A pass that is whole, but says something wrong."""

    def make(folder: Path) -> Path:
        frame, drawn = _drawn()
        passes.write_pass(folder / "bad.exr", frame, change(drawn))
        return folder / "bad.exr"

    return make


def damaged(change: Callable[[bytes], bytes]) -> Callable[[Path], Path]:
    """A pass whose bytes are changed."""

    def make(folder: Path) -> Path:
        frame, drawn = _drawn()
        path = folder / "bad.exr"
        passes.write_pass(path, frame, drawn)
        path.write_bytes(change(path.read_bytes()))
        return path

    return make


def text(old: bytes, new: bytes) -> Callable[[Path], Path]:
    """Words of a header replaced by as many others."""
    assert len(old) == len(new)
    return damaged(lambda data: data.replace(old, new))


def facts(**values: Any) -> Callable[[Path], Path]:
    """Another member of the metadata."""
    return written(lambda p: replace(p, metadata={**p.metadata, **values}))


def window(data: bytes) -> bytes:
    """The sums' data window claims 2^31 pixels a side."""
    key = b"dataWindow\0box2i\0\x10\0\0\0"
    place = data.index(key, data.index(b"daguerre:words")) if data.count(key) > 2 else -1
    place = place if place >= 0 else data.rindex(key)
    at = place + len(key)
    return data[:at] + struct.pack("<4i", 0, 0, 2**31 - 2, 2**31 - 2) + data[at + 16 :]


D = "damaged pass file"
#: Metadata of the wrong type: a picture is written from it, so it must be looked at first.
FACTS: dict[str, dict[str, Any]] = {
    "crop is text": {"crop": "all"},
    "crop of one": {"crop": [1]},
    "crop of 1e300": {"crop": [1e300, 0, 1, 1]},
    "crop of 2^40": {"crop": [2**40, 0, 2**40 + 16, 9]},
    "crop is negative": {"crop": [-5, 0, 11, 9]},
    "crop of another size": {"crop": [0, 0, 4, 4]},
    "resolution is text": {"resolution": "16x9"},
    "resolution of 0": {"resolution": [0, 0]},
    "resolution of 2^40": {"resolution": [2**40, 2**40]},
    "resolution is a number": {"resolution": 16},
    "expTime is text": {"expTime": "long"},
    "aperture is a list": {"aperture": [1]},
    "matrix of one": {"worldToCamera": [1]},
    "matrix of text": {"worldToNDC": "x"},
    "photosites": {"sensorPhotositePitch": {}},
    "capture rate": {"captureRate": "25"},
    "h0 is text": {"h0": "a"},
    "lens model is a list": {"lensModel": [1]},
    "camera is a number": {"camera": 3},
    "aovs is a number": {"aovs": 3},
    "aovs of numbers": {"aovs": [3]},
}
STATES: dict[str, tuple[Callable[[np.ndarray], np.ndarray], str]] = {
    "all ones": (lambda words: np.full_like(words, 0xFFFFFFFF), "samples were NaN or infinite"),
    "all zeros": (np.zeros_like, ""),
    "noise": (
        lambda words: np.random.default_rng(1).integers(0, 2**32, words.shape, np.uint32),
        "samples were NaN or infinite",
    ),
}


def _state(make: Callable[[np.ndarray], np.ndarray]) -> Callable[[Path], Path]:
    return written(lambda p: replace(p, state={"sums": make(p.state["sums"])}))


def _picture(folder: Path) -> Path:
    _drawn()[0].save(folder / "bad.exr")
    return folder / "bad.exr"


def _bytes(data: bytes) -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        (folder / "bad.exr").write_bytes(data)
        return folder / "bad.exr"

    return make


def _pipe(folder: Path) -> Path:
    os.mkfifo(folder / "bad.exr")
    return folder / "bad.exr"


def checkpoint(change: Callable[[passes.Pass], passes.Pass]) -> Callable[[Path], Path]:
    """A checkpoint of the wall, which fits; 2 samples are wanted, 1 is there."""

    def make(folder: Path) -> Path:
        scene = gltf.read(seen().glb(folder / "scene.glb"))
        scene.set_environment(color=(1, 1, 1))
        session = Session(scene, scene.camera(), resolution=(16, 9))
        session.draw(0, 1)
        drawn = passes.pass_of(session)
        state = {name: words.copy() for name, words in drawn.state.items()}
        passes.write_pass(
            folder / "out.checkpoint.exr", session.frame(), change(replace(drawn, state=state))
        )
        return folder / "out.checkpoint.exr"

    return make


def _locked(drawn: passes.Pass) -> passes.Pass:
    """All words set: among them the lock that a pixel has while a thread writes to it."""
    full = np.full_like(drawn.state["sums"], 0xFFFFFFFF)
    return replace(drawn, state=drawn.state | {"sums": full})


def _two(folder: Path) -> Path:
    """The same samples twice."""
    frame, drawn = _drawn()
    for name in ("bad.exr", "other.exr"):
        passes.write_pass(folder / name, frame, drawn)
    return folder / "bad.exr"


def _objects_alone(folder: Path) -> Path:
    """Lists of objects, and no sums of coverage that they share."""
    frame, drawn = _drawn()
    state = {part: words for part, words in drawn.state.items() if part != "coverage"}
    state["objects"] = np.zeros((*drawn.state["sums"].shape[:2], 4), np.uint32)
    passes.write_pass(folder / "bad.exr", frame, replace(drawn, state=state))
    return folder / "bad.exr"


def _alien(folder: Path) -> Path:
    """Pass of another scene."""
    frame, drawn = _drawn()
    passes.write_pass(folder / "other.exr", frame, drawn)
    key = {**drawn.key, "scene": "0" * 64}
    passes.write_pass(folder / "bad.exr", frame, replace(drawn, key=key, ranges=[(1, 2)]))
    return folder / "bad.exr"


def _smaller(folder: Path) -> Path:
    """Pass of another size, whatever the key says."""
    frame, drawn = _drawn()
    passes.write_pass(folder / "other.exr", frame, drawn)
    small = {name: words[:, :8] for name, words in drawn.state.items()}
    small = {name: np.ascontiguousarray(words) for name, words in small.items()}
    other = replace(drawn, state=small, ranges=[(1, 2)])
    passes.write_pass(folder / "bad.exr", frame, other)
    return folder / "bad.exr"


TWO = ("merge", "{folder}/other.exr", "{bad}", "-o", "{out}.exr")
CASES = [
    *(
        Case(f"pass-{name}", make, error, command=MERGE)
        for name, make, error in (
            ("missing", lambda folder: folder / "none.exr", "^no such file"),
            ("objects alone", _objects_alone, f"{D}: film: objects: wanted coverage, got none"),
            ("pipe", _pipe, "not a regular file"),
            ("empty", _bytes(b""), "wanted an OpenEXR file"),
            ("text", _bytes(b"hello"), "wanted an OpenEXR file"),
            ("magic", _bytes(b"\x76\x2f\x31\x01\2\0\0\0"), "header: truncated or too long"),
            ("picture", _picture, "holds no sums, only a picture"),
            ("half", damaged(lambda d: d[: len(d) // 2]), "cut off or damaged"),
            ("cut end", damaged(lambda d: d[:-100]), "cut off or damaged"),
            ("header alone", damaged(lambda d: d[:800]), "header: truncated or too long"),
            ("zeroed end", damaged(lambda d: d[:-300] + bytes(300)), "damaged pixels"),
            ("window 2^31", damaged(window), "dataWindow: wanted corners"),
            ("ranges text", text(b"[[0, 1]]", b"[[0,'1']"), f"{D}: daguerre:ranges"),
            ("ranges empty", text(b"[[0, 1]]", b"[[0, 0]]"), f"{D}: daguerre:ranges"),
            ("ranges fall", text(b"[[0, 1]]", b"[[9, 1]]"), f"{D}: daguerre:ranges"),
            ("ranges minus", text(b"[[0, 1]]", b"[[-1,1]]"), f"{D}: daguerre:ranges"),
            ("ranges true", text(b"[[0, 1]]", b"[[0,true"[:8]), f"{D}: daguerre:ranges"),
            ("ranges 1e9", text(b"[[0, 1]]", b"[[0,1e9]"), f"{D}: daguerre:ranges"),
            ("ranges deep", written(lambda p: replace(p, ranges=[])), f"{D}: daguerre:ranges"),
            (
                "ranges 2^40",
                written(lambda p: replace(p, ranges=[(0, 2**40)])),
                f"{D}: daguerre:ranges",
            ),
            (
                "ranges twice",
                written(lambda p: replace(p, ranges=[(0, 2), (1, 3)])),
                f"{D}: daguerre:ranges",
            ),
            ("no key", written(lambda p: replace(p, key={})), f"{D}: daguerre:key"),
            (
                "key of numbers",
                written(lambda p: replace(p, key={"scene": 1})),  # type: ignore[dict-item]
                f"{D}: daguerre:key",
            ),
            (
                "has no data",
                text(b"daguerre:words\0int\0", b"daguerre:wordz\0int\0"),
                f"{D}: daguerre:w",
            ),
        )
    ),
    *(
        Case(f"pass-{name}", facts(**values), f"{D}: daguerre:metadata", command=MERGE)
        for name, values in FACTS.items()
    ),
    *(
        Case(f"pass-state of {name}", _state(make), warning=warning, command=MERGE)
        for name, (make, warning) in STATES.items()
    ),
    Case("pass-twice", _two, "samples 0:1 are also in", code=4, command=TWO),
    Case(
        "pass-alien", _alien, "does not belong to .*: they differ in the scene", code=4, command=TWO
    ),
    Case("pass-smaller", _smaller, f"{D}: daguerre:metadata: crop is 16x9", command=TWO),
    Case("checkpoint-locked", checkpoint(_locked), warning="NaN or infinite", command=RESUME),
    Case(
        "checkpoint-too many",
        checkpoint(lambda p: replace(p, ranges=[(0, 4)])),
        r"holds samples 0:4, wanted only 0:2",
        code=4,
        command=RESUME,
    ),
    Case(
        "checkpoint-alien",
        checkpoint(lambda p: replace(p, key={**p.key, "camera": "0"})),
        r"does not belong to .*: they differ in the camera",
        code=4,
        command=RESUME,
    ),
]
