"""Cameras and lights."""

from __future__ import annotations

from tests.support.formats.make_gltf import Builder

from .bases import full, seen
from .case import Case, Change, both, drawn, put, scenes

L = "extensions.KHR_lights_punctual.lights.0"


def lit(light: dict[str, object], **node: object) -> Change:
    """A lamp before the wall, in place of the sky."""

    def change(b: Builder) -> None:
        b.json["extensions"] = {"KHR_lights_punctual": {"lights": [light]}}
        b.node(extensions={"KHR_lights_punctual": {"light": 0}}, **node)

    return change


BAD: dict[str, tuple[Change, str]] = {
    "camera type": (put("cameras.0.type", "fisheye"), r"cameras\[0\]\.type: unknown value"),
    "no perspective": (put("cameras.0.perspective", ...), r"cameras\[0\]\.perspective: missing"),
    "yfov 0": (put("cameras.0.perspective.yfov", 0), r"yfov: out of range: wanted a number above"),
    "yfov 4": (put("cameras.0.perspective.yfov", 4), r"yfov: out of range: wanted less than pi"),
    "aspect": (put("cameras.0.perspective.aspectRatio", -1), r"aspectRatio: out of range"),
    "f-stop 0": (
        put("cameras.0.extras", {"daguerre": {"fStop": 0}}),
        r"cameras\[0\]\.extras\.daguerre\.fStop: out of range: .* \(for a pinhole set",
    ),
    "focus": (
        put("cameras.0.extensions", {"EXT_camera_physical": {"focusDistance": "far"}}),
        r"EXT_camera_physical\.focusDistance: wrong type: wanted a number, got 'far'",
    ),
    "sensor": (
        put("cameras.0.extensions", {"EXT_camera_physical": {"sensorSize": [36, 0]}}),
        r"sensorSize: out of range",
    ),
    "lens is a path": (
        put("cameras.0.extras", {"daguerre": {"lens": "../secret.json"}}),
        r"daguerre\.lens: refused",
    ),
    "camera scaled to nothing": (
        put("nodes.2.scale", [0, 0, 0]),
        r"nodes\[2\]: the node scales its camera by 0",
    ),
    "light out of range": (
        put("nodes.2.extensions.KHR_lights_punctual.light", 1),
        r"nodes\[2\]\.extensions\.KHR_lights_punctual\.light: index out of range",
    ),
    "light type": (put("extensions.KHR_lights_punctual.lights.0.type", "sun"), r"type: unknown va"),
    "light intensity": (
        put("extensions.KHR_lights_punctual.lights.0.intensity", -3),
        r"extensions\.KHR_lights_punctual\.lights\[0\]\.intensity: out of range",
    ),
    "cone": (
        put("extensions.KHR_lights_punctual.lights.0.spot", {"innerConeAngle": 1}),
        r"spot: wanted innerConeAngle below outerConeAngle, got 1 and 0\.785",
    ),
    "camera is null": (put("cameras", [None]), r"cameras\[0\]: wrong type"),
    "camera without type": (put("cameras.0.type", ...), r"cameras\[0\]\.type: missing"),
    "yfov is text": (put("cameras.0.perspective.yfov", "1"), r"yfov: wrong type"),
    "yfov is missing": (put("cameras.0.perspective.yfov", ...), r"yfov: missing"),
    "yfov is -1": (put("cameras.0.perspective.yfov", -1), r"yfov: out of range"),
    "yfov is 1e-300": (put("cameras.0.perspective.yfov", 1e-300), r"yfov: out of range"),
    "aspect is 0": (put("cameras.0.perspective.aspectRatio", 0), r"aspectRatio: out of range"),
    "lights is an object": (
        put("extensions.KHR_lights_punctual.lights", {}),
        r"KHR_lights_punctual\.lights: wrong type",
    ),
    "light is null": (put(L, None), r"lights\[0\]: wrong type"),
    "light colour": (put(L + ".color", [1, 1]), r"lights\[0\]\.color: wrong length"),
    "light colour negative": (put(L + ".color", [1, -1, 1]), r"color\[1\]: out of range"),
    "light range 0": (put(L + ".range", 0), r"lights\[0\]\.range: out of range"),
    "light range negative": (put(L + ".range", -1), r"lights\[0\]\.range: out of range"),
    "light range is text": (put(L + ".range", "far"), r"lights\[0\]\.range: wrong type"),
    "intensity is a list": (put(L + ".intensity", [1]), r"intensity: wrong type"),
    "spot without a cone": (put(L + ".spot", ...), r"lights\[0\]\.spot: missing"),
    "cone of 4": (put(L + ".spot", {"outerConeAngle": 4}), r"outerConeAngle: out of range"),
    "cone below 0": (put(L + ".spot", {"innerConeAngle": -1}), r"innerConeAngle: out of range"),
    "light index is text": (
        put("nodes.2.extensions.KHR_lights_punctual.light", "0"),
        r"KHR_lights_punctual\.light: wrong type",
    ),
    "light index missing": (
        put("nodes.2.extensions.KHR_lights_punctual", {}),
        r"KHR_lights_punctual\.light: missing",
    ),
    "light of 1e300 cd": (put(L + ".intensity", 1e300), r"lights\[0\]\.intensity: not finite"),
    "light times colour": (
        both(put(L + ".intensity", 3e38), put(L + ".color", [10, 1, 1])),
        r"lights\[0\]: out of range: wanted color x intensity",
    ),
    "yfov of a millidegree": (put("cameras.0.perspective.yfov", 2e-5), r"yfov: out of range"),
    "aspect of 1e30": (put("cameras.0.perspective.aspectRatio", 1e30), r"aspectRatio: out of"),
}

ODD: dict[str, tuple[Change, str]] = {
    "on the wall": (lit({"type": "point"}, translation=[0, 0, -2]), ""),
    "at the camera": (lit({"type": "point", "intensity": 1}), ""),
    "of 1e38 cd": (lit({"type": "point", "intensity": 1e38}), "samples were NaN or infinite"),
    "of 1e-300 cd": (lit({"type": "point", "intensity": 1e-300}), ""),
    "of 0 cd": (lit({"type": "point", "intensity": 0}), ""),
    "with a tiny range": (lit({"type": "point", "range": 1e-30}), ""),
    "with a huge range": (lit({"type": "point", "range": 1e38}), ""),
    "far away": (lit({"type": "point"}, translation=[1e17, 0, 0]), ""),
    "spot with an edge": (
        lit({"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.5000001}}),
        "",
    ),
    "spot of no width": (lit({"type": "spot", "spot": {"outerConeAngle": 1e-12}}), ""),
    "scaled to nothing": (lit({"type": "directional"}, scale=[0, 0, 0]), "scaled to zero"),
    "mirrored": (lit({"type": "directional"}, scale=[1, 1, -1]), ""),
    "camera of 179.9 degrees": (put("cameras.0.perspective.yfov", 3.14), ""),
    "znear beyond zfar": (put("cameras.0.perspective.zfar", 0.01), ""),
}
CASES: list[Case] = [*scenes("camera", BAD, full), *drawn("light", ODD, seen)]
