"""Small stages with a camera, and the camera that the reader makes of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.files.notes import Notes

pytest.importorskip("pxr")

from pxr import Usd, UsdGeom

from daguerre.importers.usd.cameras import read_camera
from daguerre.importers.usd.stage_facts import StageFacts
from daguerre.importers.usd.values import Clock

PATH = "/World/Cam"
FILE = "shot.usda"


def camera_prim(lines: str = "", schemas: str = "", codes: float = 24.0) -> Usd.Prim:
    """A camera with attributes, given as lines of a .usda file."""
    applied = f"(prepend apiSchemas = [{schemas}])" if schemas else ""
    layer = (
        f"#usda 1.0\n(\n timeCodesPerSecond = {codes}\n metersPerUnit = 1\n)\n"
        f'def Xform "World"\n{{\n def Camera "Cam" {applied}\n {{\n{lines}\n }}\n}}\n'
    )
    stage = Usd.Stage.CreateInMemory()
    assert stage.GetRootLayer().ImportFromString(layer)
    KEPT.append(stage)  # a prim does not keep its stage
    return stage.GetPrimAtPath(PATH)


KEPT: list[Usd.Stage] = []


def facts(**changes: Any) -> StageFacts:
    """Facts of a stage in centimetres, at time 0, unless they say something else."""
    given: dict[str, Any] = {"file": FILE, "clock": Clock(FILE, 24.0, 0.0), "metres": 0.01}
    return StageFacts(**given | changes)


def read(prim: Usd.Prim, **changes: Any) -> dg.Camera:
    """The camera of a prim, which has one."""
    made = noted(prim, **changes)[0]
    assert made is not None
    return made


def noted(prim: Usd.Prim, **changes: Any) -> tuple[dg.Camera | None, list[str]]:
    """The camera of a prim, and the reader's notes."""
    notes = Notes()
    made = read_camera(prim, np.eye(4), facts(**changes), notes)
    return made, notes.sentences()


def opened(path: Path) -> list[Usd.Prim]:
    """Cameras of a stage in a file."""
    stage = Usd.Stage.Open(str(path))
    KEPT.append(stage)
    return [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Camera)]


def again(prim: Usd.Prim, folder: Path) -> dg.Camera:
    """A camera that was written in metres, read with its pose over time."""
    stage = prim.GetStage()
    clock = Clock(FILE, stage.GetTimeCodesPerSecond(), 0.0)

    def resolve(place: str, asset: str) -> Path:
        return folder / asset

    codes = sorted({code for op in UsdGeom.Xformable(prim).GetOrderedXformOps()
                    for code in op.GetTimeSamples()})  # fmt: skip
    pose: Any = _world(prim, clock.code)
    if codes:
        pose = dg.keys([(code / clock.rate, _world(prim, Usd.TimeCode(code))) for code in codes])
    notes = Notes()
    made = read_camera(prim, pose, StageFacts(FILE, clock, resolve=resolve), notes)
    assert made is not None
    assert notes.sentences() == []
    return made


def _world(prim: Usd.Prim, code: Usd.TimeCode) -> np.ndarray:
    world = UsdGeom.XformCache(code).GetLocalToWorldTransform(prim)
    return np.array(world, np.float64).T
