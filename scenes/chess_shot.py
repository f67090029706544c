#!/usr/bin/env python3
"""Photographs the Open Chess Set of USD with the lens, stop, focus and shutter of its stage.

    python scenes/chess_shot.py PICTURE CHESS_SET.usda [PANORAMA.hdr] [--spp N]

Writes a stage beside PICTURE that has the chess set as a reference, a camera and a sky; renders
it, exposes a sensor to it by the camera's ``exposure:*``, and develops the photograph. The
chess set is full_assets/OpenChessSet/chess_set.usda of https://github.com/usd-wg/assets.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux, UsdUtils

import daguerre as dg
from daguerre.rendering.denoise import denoise

EYE, AIM = (0.31, 0.17, 0.68), (0.0, 0.045, 0.08)
#: Luminance of a value of 1 in the panorama, cd/m2.
SKY = 80.0


def write_stage(path: Path, chess: Path, panorama: Path | None) -> None:
    """Writes the stage of the shot, in metres."""
    silence = UsdUtils.CoalescingDiagnosticDelegate()  # USD by itself does not read .mtlx
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, "Y")
    stage.DefinePrim("/Set").GetReferences().AddReference(str(chess.resolve()))
    sky = UsdLux.DomeLight.Define(stage, "/Sky")
    sky.CreateIntensityAttr(SKY)
    if panorama is not None:
        sky.CreateTextureFileAttr(Sdf.AssetPath(str(panorama.resolve())))
    camera = UsdGeom.Camera.Define(stage, "/Cam")
    camera.AddTransformOp().Set(Gf.Matrix4d(np.asarray(dg.look_at(EYE, AIM)).T))
    camera.CreateFocalLengthAttr(0.5)  # tenths of a metre
    camera.CreateHorizontalApertureAttr(0.36)
    camera.CreateVerticalApertureAttr(0.24)
    camera.CreateFStopAttr(2.8)
    camera.CreateFocusDistanceAttr(float(np.linalg.norm(np.subtract(EYE, (0.03, 0.06, 0.22)))))
    camera.CreateShutterOpenAttr(0.0)
    camera.CreateShutterCloseAttr(0.4)  # 1/60 s at 24 frames per second
    camera.CreateExposureIsoAttr(400.0)
    camera.CreateExposureTimeAttr(1 / 60)
    camera.CreateExposureFStopAttr(2.8)
    prim = camera.GetPrim()
    lens = prim.CreateAttribute("daguerre:lens:name", Sdf.ValueTypeNames.String)
    lens.Set("double-gauss-50mm-f2")
    stage.GetRootLayer().Save()
    silence.TakeUncoalescedDiagnostics()


def main() -> None:
    """Makes the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("picture", type=Path)
    parser.add_argument("chess", type=Path)
    parser.add_argument("panorama", type=Path, nargs="?")
    parser.add_argument("--spp", type=int, default=96)
    given = parser.parse_args()
    shot = given.picture.with_suffix(".usda")
    shot.unlink(missing_ok=True)
    write_stage(shot, given.chess, given.panorama)
    folders = [given.chess.parent, *([given.panorama.parent] if given.panorama else [])]
    scene = dg.load(shot, allow_dirs=[folder.resolve() for folder in folders])
    frame = denoise(dg.render(scene, resolution=(750, 500), spp=given.spp, aovs=True))
    frame.expose("sony-a7r-ii", seed=1).develop().save(given.picture)


if __name__ == "__main__":
    main()
