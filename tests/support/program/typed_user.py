"""A user's program for type checkers, never run; wrong lines are marked with their codes."""

from __future__ import annotations

from typing import assert_type

import numpy as np
from numpy.typing import NDArray

import daguerre as dg
from daguerre import analysis, lenses

scene = dg.load("scene.glb")
assert_type(scene, dg.Scene)
camera = scene.camera("Camera").with_(lens="double-gauss-50mm-f2", f_stop=2.0)
assert_type(camera, dg.Camera)
frame = dg.render(scene, camera, resolution=(96, 64), spp=4)
assert_type(frame, dg.Frame)
assert_type(frame.rgb, NDArray[np.float32])
lens = lenses.load("double-gauss-50mm-f2")
assert_type(lens, lenses.Lens)
spot: analysis.Spot
focal_length: float = lens.first_order().efl
material: dg.Diffuse = dg.Diffuse()

loaded = dg.load(3)  # wrong: arg-type
frame.save()  # wrong: call-arg
name = dg.no_such_name  # wrong: attr-defined
other = lenses.no_such_name  # wrong: attr-defined
