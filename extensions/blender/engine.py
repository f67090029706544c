# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine: final pictures by F12, and pictures in the viewport."""

import weakref
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import bpy
import numpy as np

from daguerre.camera.exposure_mode import is_automatic
from daguerre.errors import DaguerreError, InputError
from daguerre.frame.frame import Frame
from daguerre.rendering import Cancelled
from daguerre.rendering.pixels import crop_box

from . import metering, passes, photograph, taking, translation
from .drawing import Drawing, check_denoiser
from .reports import told
from .viewport import Viewport

ENGINE = "DAGUERRE"


class DaguerreEngine(bpy.types.RenderEngine):
    """Renders a scene through a real lens."""

    bl_idname = ENGINE
    bl_label = "Daguerre"
    bl_use_preview = False
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True
    bl_use_postprocess = True

    viewport: Viewport | None = None

    def update_render_passes(self, scene: Any, renderlayer: Any) -> None:
        """Names the passes of the picture."""
        for name, count, letters, kind in passes.registered(scene):
            self.register_pass(scene, renderlayer, name, count, letters, kind)

    def render(self, depsgraph: Any) -> None:
        """Draws the final picture, or gives it to who takes it."""
        if taking.taker is not None:
            taking.taker.take(depsgraph, self._go)
            return
        try:
            self._render(depsgraph)
        except Cancelled:
            pass
        except Exception as error:  # whatever it is, the user gets a sentence
            self.report({"ERROR"}, told(error))
            self.error_set(told(error))

    def _render(self, depsgraph: Any) -> None:
        self.update_stats("", "Reading the scene")
        scene = translation.scene_of(depsgraph, self._go)
        for warning in scene.warnings:
            self.report({"WARNING"}, f"Daguerre: {warning}")
        denoises = self._denoises(depsgraph.scene)
        for view in _views(depsgraph.scene.render):
            self.active_view_set(view)
            self._view(depsgraph, scene, view, denoises=denoises)

    def _go(self, frame: int, part: float) -> None:
        """Goes to a frame and a fraction of one."""
        self.frame_set(frame, subframe=part)

    def _denoises(self, scene: Any) -> bool:
        """Whether to denoise; a denoiser that is missing costs a warning, not the picture."""
        if not scene.daguerre.denoise:
            return False
        try:
            check_denoiser()
        except DaguerreError as error:
            self.report({"WARNING"}, f"Daguerre: not denoised: {error}")
            return False
        return True

    def _view(self, depsgraph: Any, scene: Any, view: str, *, denoises: bool) -> None:
        """Draws one eye of the picture, or all of it."""
        camera = self.camera_override or depsgraph.scene.camera
        if camera is None:
            raise InputError("scene: wanted a camera, got none")
        shot = translation.shot_of(depsgraph, scene, camera, self._eye(camera) if view else None)
        middle = shot
        if view and is_automatic(shot.camera.exposure):
            middle = translation.shot_of(depsgraph, scene, camera)
        layer = depsgraph.view_layer_eval.name
        rows = passes.asked(depsgraph.scene)
        crop = translation.region_of(depsgraph.scene.render, shot.settings.film.resolution)
        settings = shot.settings.with_(aovs=bool(rows) or denoises, crop=crop)
        shot = replace(shot, settings=settings)
        result = self._begin(shot, layer, view)

        def show(frame: Frame) -> None:
            self._write(result, passes.planes(frame, rows, shot))
            self.update_result(result)

        finished = False
        try:
            name = camera.name_full
            drawing = Drawing(
                self, shot, show, lambda: metering.session_of(shot, middle.camera, name)
            )
            show(frame := drawing.run(denoises=denoises))
            finished = True
        finally:
            self.end_result(result, cancel=not finished)
        if depsgraph.scene.daguerre.photograph:
            self._tell_exposure(camera)
            files = photograph.paths(depsgraph.scene, numbered=self.is_animation)
            photograph.write(frame, shot.camera, depsgraph.scene, camera.data.daguerre, files)

    def _tell_exposure(self, camera: Any) -> None:
        """Reports what a meter chose, and the mode of an old file."""
        if (old := metering.old_meter(camera.data.daguerre)) is not None:
            self.report(
                {"WARNING"},
                f"Daguerre: the exposure mode {old!r} of before 1.0 is now auto with the metering "
                f"pattern {old}; choose a mode to keep it",
            )
        for text in metering.words_of(camera.name_full):
            self.report({"INFO"}, f"Daguerre: {text}")

    def _eye(self, camera: Any) -> translation.Eye:
        """Eye of the active view."""
        matrix = np.array(self.camera_model_matrix(camera), np.float64)
        return translation.Eye(matrix, float(self.camera_shift_x(camera)))

    def _begin(self, shot: translation.Shot, layer: str, view: str) -> Any:
        """Result of the picture's size."""
        film = shot.settings.film
        x0, y0, x1, y1 = crop_box(film.crop, (0, 0, *film.resolution))
        return self.begin_result(0, 0, x1 - x0, y1 - y0, layer=layer, view=view)

    def _write(self, result: Any, planes: Iterator[tuple[str, Any]]) -> None:
        """Writes passes into a result."""
        kept = result.layers[0].passes
        for name, pixels in planes:
            if name in kept:
                kept[name].rect.foreach_set(passes.flat(pixels))

    def view_update(self, context: Any, depsgraph: Any) -> None:
        """Takes over a changed scene."""
        if self.viewport is None:
            self.viewport = Viewport(self.tag_redraw)
            weakref.finalize(self, self.viewport.close)  # Blender frees its part of self first
        try:
            self.viewport.update(context, depsgraph)
        except Exception as error:  # whatever it is, the user gets a sentence
            self.viewport.refuse(error)

    def view_draw(self, context: Any, depsgraph: Any) -> None:
        """Shows the newest picture, and asks for another one if the view changed."""
        viewport = self.viewport
        if viewport is None:
            return
        try:
            viewport.draw(self, context, depsgraph)
        except Exception as error:  # whatever it is, the user gets a sentence
            viewport.refuse(error)
        self.update_stats("Daguerre", viewport.words)


def _views(render: Any) -> list[str]:
    """Names of the views of a picture; a single one has no name."""
    return [view.name for view in render.views if view.use] if render.use_multiview else [""]


def register() -> None:
    """Adds the engine."""
    bpy.utils.register_class(DaguerreEngine)


def unregister() -> None:
    """Removes the engine."""
    bpy.utils.unregister_class(DaguerreEngine)
