# SPDX-License-Identifier: GPL-3.0-or-later
"""Items of the menus: lenses, sensors and modes, with what a user needs to choose."""

from daguerre import sensors
from daguerre.camera.exposure_mode import AUTOMATIC, CHOICES, METERS, MODES
from daguerre.camera.parameters import CAMERA
from daguerre.development.looks import LOOKS
from daguerre.frame.aovs import Source, made_by
from daguerre.lenses import library
from daguerre.lenses.kinds import diagonal_mm, kinds_of

#: (identifier, name, description), or with icon and number for flags.
Item = tuple[str, str, str]


def _lens(entry: library.Entry) -> Item:
    """One lens: its name and year; widest stop, focal length and image circle."""
    year = f" ({entry.year})" if entry.year else ""
    facts = [f"{entry.type}, {entry.focal_length}, f/{entry.f_number:.3g} wide open"]
    if circle := diagonal_mm(entry):
        facts.append(f"image circle {circle:.3g} mm")
    return entry.name, entry.title + year, "; ".join([*facts, entry.patent])


def _searched(entry: library.Entry) -> Item:
    """One lens as the search shows it, in one line; Blender looks for words in it, such as zoom."""
    name, title, words = _lens(entry)
    circle = diagonal_mm(entry)
    facts = [title, f"f/{entry.f_number:.3g}", *([f"circle {circle:.3g} mm"] if circle else [])]
    facts += [kind.words[0] for kind in kinds_of(entry)]
    return name, ", ".join(facts), words


def _named(words: dict[str, str]) -> list[Item]:
    return [(name, name.replace("_", " ").capitalize(), text) for name, text in words.items()]


def _sensor(name: str) -> Item:
    """One sensor: its make and model, and the size of its film."""
    made = sensors.load(name)
    title = " ".join(part for part in (made.make, made.model) if part)
    return name, title or name, "{:.3g} x {:.3g} mm".format(*made.size)


#: Effects that lens models compute.
_MODELS = {
    "exact": "Traces light through every surface of the glass",
    "polynomial": "Exact, by polynomials fitted to it: faster for lenses of many surfaces",
    "thick": "Focal length and pupils of the lens, without its aberrations",
    "thin": "Focal length of the lens and depth of field, without its aberrations",
    "pinhole": "Framing of the lens, with everything sharp",
}
#: How shutters open.
_SHUTTERS = {
    "box": "Opens and closes at once",
    "leaf": "The iris itself opens and closes, so that blurred lamps have soft edges",
    "focal_plane": "A slit between two curtains crosses the film",
    "rotary": "The edge of a turning disc crosses the film, as in a film camera",
    "electronic": "Lines are read out one after another, as in a phone",
}
_LOOKS = {
    "neutral": "Light as it is, up to white",
    "standard": "Contrast of a camera's own picture",
    "film": "Contrast, faint blacks and calmer colours of a print",
    "filmic": "Soft contrast that keeps bright lights",
}


_PLAIN: list[Item] = [
    ("blender", "Blender's lens", "Thin lens with Blender's depth of field, or else a pinhole"),
    ("thin", "Thin lens", "Lens without thickness, of the focal length in Blender's Lens panel"),
    ("pinhole", "Pinhole", "Camera without depth of field"),
    ("file", "Lens file", "Lens from a file: Daguerre, Zemax, CODE V, Optical Bench or pbrt"),
]
LENSES = [*_PLAIN, *map(_lens, library.entries())]
#: The same lenses, with all that matters in the name.
SEARCHED = [*_PLAIN, *map(_searched, library.entries())]
MODELS: list[Item] = [
    ("auto", "Automatic", "Exact, for a lens of the library or a file"),
    *_named({name: _MODELS.get(name, "") for name in CAMERA["lens_model"].choices}),
]
FOCUS: list[Item] = [
    ("blender", "Blender's", "Distance or object of Blender's Depth of Field panel"),
    ("auto", "Autofocus", "Focus on the middle of the picture"),
]
SENSORS: list[Item] = [
    ("blender", "Blender's size", "Perfect sensor of the size in Blender's Camera panel"),
    *map(_sensor, sensors.names()),
]
_MODES = {
    "light": "A value of 1 is white; ISO sets the noise alone",
    "manual": "Exposure by ISO, shutter and stop",
    **{mode: f"A meter chooses {CHOICES[mode]}" for mode in AUTOMATIC},
}
#: Numbers of modes in files; before 1.0 they were manual, 0, and metering patterns.
_NUMBERS = dict(zip(MODES, (10, 0, 11, 12, 13, 14), strict=True))
OLD_METERS = {1: "centre", 2: "spot", 3: "matrix"}
EXPOSURE = [(mode, mode.capitalize(), _MODES[mode], "NONE", _NUMBERS[mode]) for mode in MODES]
METER: list[Item] = _named(
    {
        "centre": "Mean luminance, three quarters of it from the middle",
        "spot": "A small circle at the point in focus",
        "matrix": "Zones of the picture, with most weight on the point in focus and on highlights",
        "highlight": "All but a hundredth of the picture stays below white",
    }
)


def mode_number(number: int) -> int:
    """Number of an exposure mode that a file names; an old metering pattern is ``auto``."""
    return _NUMBERS["auto"] if number in OLD_METERS else number


def meter_number(number: int, *, named: bool, old: str | None) -> int:
    """Number of a metering pattern: the named one, else that of an old file."""
    return number if named or old is None else METERS.index(old)


SHUTTER: list[Item] = [
    ("blender", "Blender's", "Shutter of Blender's Motion Blur panel"),
    ("time", "Time", "Exposure time in seconds"),
    ("angle", "Angle", "Exposure time as a shutter angle"),
]
SHUTTER_TYPES: list[Item] = _named(
    {name: _SHUTTERS.get(name, "") for name in CAMERA["shutter_type"].choices}
)
ROLLING: list[Item] = [
    ("off", "Global", "All lines are exposed at once"),
    *(
        (side, f"From the {side}", "Lines are exposed one after another")
        for side in ("top", "bottom", "left", "right")
    ),
]
LIGHT_PATHS: list[Item] = [
    ("auto", "Automatic", "As many as make the picture less noisy in the same time"),
    ("off", "Off", "None: all paths start at the camera"),
]
LOOK: list[Item] = _named({name: _LOOKS.get(name, "") for name in LOOKS})
#: Groups of channels of the film that may become passes, as flags.
PASSES = [
    (
        row.name,
        row.name,
        f"Channels {', '.join(row.channels)}{row.unit and f'; {row.unit}'}",
        0,
        1 << bit,
    )
    for bit, row in enumerate(made_by(Source.FILM, Source.GUIDES))
]
