"""The pictures of docs/blender.md: menus, panels, viewport and render in Blender's own window.

    Xvfb :7 -screen 0 1280x800x24 & export DISPLAY=:7
    blender --factory-startup --enable-event-simulate --window-geometry 0 0 1280 800 \
        --python script/docs/blender_screenshots.py -- docs

Needs Blender with the extension installed, and ImageMagick.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy

FOLDER = Path(sys.argv[-1])
ADDON = "bl_ext.user_default.daguerre"
LENS = "asahi-super-takumar-50mm-f1.4"
#: Time that Blender gets to draw its window, and the viewport its picture, s.
DRAWN_S, RENDERED_S = 2.0, 240.0
#: Height of the screen, px, and width of the Properties editor.
SCREEN, WIDE = 800, 400
DIGITS = ["ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE"]
#: Colours of the balls, from near to far.
COLOURS = [(0.8, 0.1, 0.05), (0.9, 0.5, 0.05), (0.1, 0.5, 0.15), (0.05, 0.2, 0.7)]

Box = tuple[int, int, int, int]
Steps = Iterator[float]


def window() -> Any:
    """Newest window of Blender."""
    return bpy.context.window_manager.windows[-1]


def area(kind: str) -> Any:
    """Largest area of a kind in the first window."""
    areas = bpy.context.window_manager.windows[0].screen.areas
    return max((one for one in areas if one.type == kind), key=lambda one: one.height)


def box_of(thing: Any) -> Box:
    """Left, bottom, width and height of an area or a region, px."""
    return thing.x, thing.y, thing.width, thing.height


def photograph(name: str, box: Box | None = None) -> None:
    """Writes a part of the newest window, or all of it, as a picture; its ending is its format."""
    shown = window()
    x, y, width, height = box or (0, 0, shown.width, shown.height)
    left, top = shown.x + x, SCREEN - shown.y - y - height
    crop = f"{width}x{height}+{left}+{top}"
    command = ["import", "-window", "root", "-crop", crop, "+repage", "-strip", "-quality", "85"]
    subprocess.run([*command, str(FOLDER / f"blender-{name}")], check=True)


def mouse(x: int, y: int, kind: str = "MOUSEMOVE", value: str = "NOTHING") -> None:
    """Moves the mouse or presses its button."""
    window().event_simulate(type=kind, value=value, x=x, y=y)


def click(x: int, y: int) -> Steps:
    """Clicks at a place of the window."""
    mouse(x, y)
    yield 0.5
    mouse(x, y, "LEFTMOUSE", "PRESS")
    yield 0.2
    mouse(x, y, "LEFTMOUSE", "RELEASE")
    yield DRAWN_S


def write(text: str) -> Steps:
    """Types digits."""
    for letter in text:
        for value in ("PRESS", "RELEASE"):
            more = {"unicode": letter} if value == "PRESS" else {}
            window().event_simulate(type=DIGITS[int(letter)], value=value, **more)
            yield 0.1


def escape() -> Steps:
    """Closes a menu."""
    for value in ("PRESS", "RELEASE"):
        window().event_simulate(type="ESC", value=value)
        yield 0.5


def material(name: str, colour: tuple[float, float, float], **values: float) -> Any:
    """Principled material."""
    made = bpy.data.materials.new(name)
    if made.node_tree is None:  # before Blender 5
        made.use_nodes = True
    node = made.node_tree.nodes["Principled BSDF"]
    node.inputs["Base Color"].default_value = (*colour, 1)
    for key, value in values.items():
        node.inputs[key].default_value = value
    return made


def ball(place: tuple[float, float, float], radius: float, skin: Any) -> None:
    """Smooth ball."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=radius, location=place)
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(skin)


def build() -> None:
    """Balls in a row, out of focus before and behind, and small lights far away."""
    scene = bpy.context.scene
    for one in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[one])
    bpy.ops.mesh.primitive_plane_add(size=40)
    bpy.context.object.data.materials.append(material("floor", (0.35, 0.33, 0.3)))
    for number, colour in enumerate(COLOURS):
        skin = material(f"ball {number}", colour, Roughness=0.3)
        ball((-0.45 + 0.32 * number, 0.9 * number, 0.2), 0.2, skin)
    for number in range(14):
        glow = material(f"glow {number}", (1, 0.7, 0.4))
        node = glow.node_tree.nodes["Principled BSDF"]
        node.inputs["Emission Color"].default_value = (1, 0.6 + 0.05 * (number % 5), 0.35, 1)
        node.inputs["Emission Strength"].default_value = 25
        ball((-3.4 + 0.55 * number, 7, 0.6 + 0.45 * (number * 5 % 4)), 0.03, glow)
    bpy.ops.object.light_add(type="AREA", location=(-2, -2, 3.5), rotation=(0.5, -0.4, 0))
    bpy.context.object.data.energy, bpy.context.object.data.size = 150, 1.5
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.02, 0.03, 0.06, 1)
    _camera(scene)


def _camera(scene: Any) -> None:
    camera = scene.camera
    camera.location, camera.rotation_euler = (0, -2.2, 0.5), (1.48, 0, 0)
    camera.data.dof.use_dof, camera.data.dof.focus_distance = True, 3.1
    ours = camera.data.daguerre
    ours.lens, ours.f_stop, ours.sensor = LENS, 1.4, "blender"
    scene.render.engine = "DAGUERRE"
    scene.render.resolution_x, scene.render.resolution_y = 640, 400
    scene.daguerre.spp = 32
    bpy.ops.object.select_all(action="DESELECT")
    camera.select_set(True)
    bpy.context.view_layer.objects.active = camera


def tidy() -> Steps:
    """Gives the Properties editor the whole height, and a width at which names are whole."""
    for kind in ("OUTLINER", "DOPESHEET_EDITOR"):
        with bpy.context.temp_override(window=window(), area=area(kind)):
            bpy.ops.screen.area_close()
        yield DRAWN_S
    space = area("PROPERTIES")
    x, y, width, height = box_of(space)
    bpy.ops.screen.area_move(x=x - 1, y=y + height // 2, delta=width - WIDE)
    yield DRAWN_S


def engine_menu() -> Steps:
    """Menu of engines over the panel Sampling."""
    space = area("PROPERTIES")
    space.spaces[0].context = "RENDER"
    yield DRAWN_S
    x, y, width, height = box_of(space)
    shown = (x, y + height - 350, width, 350)
    yield from click(x + int(0.75 * width), y + height - 83)
    photograph("engine.png", shown)
    yield from escape()


def camera_panels() -> Steps:
    """Panels of the camera; Blender's own above them are closed."""
    space = area("PROPERTIES")
    space.spaces[0].context = "DATA"
    yield DRAWN_S
    x, y, _, height = box_of(space)
    yield from click(x + 100, y + height - 117)
    photograph("camera.png", box_of(space))
    for _ in range(30):
        mouse(x + 100, y + height // 2, "WHEELDOWNMOUSE", "PRESS")
        yield 0.05
    yield DRAWN_S
    photograph("camera-body.png", box_of(space))


def lens_search() -> Steps:
    """Search for a lens."""
    x, y, width, height = box_of(area("VIEW_3D"))
    middle = x + width // 2, y + height // 2
    mouse(*middle)
    yield 1
    bpy.ops.daguerre.choose_lens("INVOKE_DEFAULT")
    yield DRAWN_S
    yield from write("50")
    yield DRAWN_S
    photograph("lens-search.png", (middle[0] - 17, middle[1] - 272, 284, 288))
    yield from escape()


def viewport() -> Steps:
    """Picture in the viewport through the lens."""
    view = area("VIEW_3D")
    space = view.spaces[0]
    space.region_3d.view_perspective = "CAMERA"
    bpy.context.scene.daguerre.light_paths = "off"  # much faster, for a picture in a minute
    space.shading.type = "RENDERED"
    for name in ("show_floor", "show_axis_x", "show_axis_y", "show_extras", "show_cursor"):
        setattr(space.overlay, name, False)
    yield RENDERED_S
    x, y, width, height = box_of(view)
    photograph("viewport.jpg", (x, y + height // 5, width, height - height // 5))
    space.shading.type = "SOLID"


def render() -> Steps:
    """Window of the render."""
    bpy.ops.render.render("INVOKE_DEFAULT")
    yield RENDERED_S
    photograph("render.jpg")


def everything() -> Steps:
    """All pictures, one after the other."""
    bpy.ops.preferences.addon_enable(module=ADDON)
    build()
    yield from tidy()
    for part in (engine_menu, camera_panels, lens_search, viewport, render):
        yield from part()
    bpy.ops.wm.quit_blender()


STEPS = everything()


def tick() -> float | None:
    """Takes the next step in the newest window, and tells when the one after is due, s."""
    with bpy.context.temp_override(window=window()):
        return next(STEPS, None)


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(tick, first_interval=5)
