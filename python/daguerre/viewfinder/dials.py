"""Dials: settings that a user changed, as texts of the command line's flags.

One value serves the page (as JSON), the command line that repeats the picture, and the camera. The
rows that parse the flags parse the texts of dials, so all three mean the same, to the bit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from daguerre import lenses
from daguerre.camera.camera import Camera
from daguerre.camera.exposure_mode import chosen_by
from daguerre.camera.ideal import IDEAL, WITHOUT_IRIS
from daguerre.camera.parameters import CAMERA, CAMERA_FLAGS, SHUTTER
from daguerre.camera.parameters.needs import OPENING
from daguerre.camera.placement import Placement
from daguerre.checks import short
from daguerre.development.parameters import DEVELOP
from daguerre.errors import UsageError
from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table
from daguerre.rendering.parameters import DEFAULT, FLAGS, of_flags
from daguerre.rendering.settings import RenderSettings

from .switches import COMPANIONS, SWITCHES, is_on, possible, stranded, without

#: Longest text of a dial.
MAX_TEXT = 200
TIME = Parameter("time", "Time in the scene's animation, s", "s", flags=("--time",))
#: Parameters that read files, which no page may name.
_FILES = ("aperture_image", "front_mask", "iris_mask")
_PICTURE = ("spp", "seed", "max_depth", "light_paths", *SWITCHES, *COMPANIONS)
#: Dials that a new lens takes back.
_OF_LENS = ("zoom", "decenter", "ripple", "focal_length", "aperture_diameter", "degree")

DIALS = Table(
    (row for row in (*CAMERA_FLAGS, *SHUTTER) if row.flags and row.name not in _FILES),
    (FLAGS[name] for name in _PICTURE),
    DEVELOP["look"],
    TIME,
)


#: Dials with flags that also take files: the texts that a page may give.
_FROM_LIBRARY: dict[str, Callable[[str], bool]] = {
    "lens": lambda text: text in IDEAL or text in lenses.names(),
    "sensor": lambda text: not text.lower().endswith(".json"),
    "shutter_curve": lambda text: text == "box" or text.startswith("trapezoid:"),
}


@dataclass(frozen=True)
class Dials:
    """Texts of the dials that are not where the scene has them.

    Attributes:
        texts: Text of each dial by the name of its parameter.
        given: Texts of the command line, which a page may set again though they name files.
    """

    texts: Mapping[str, str] = field(default_factory=dict)
    given: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, texts: Mapping[str, str]) -> Dials:
        """Makes the dials of a command line."""
        return cls(dict(texts), dict(texts))

    def turned(self, changes: Mapping[str, str | None]) -> Dials:
        """Returns the dials after a turn; None resets a dial to the scene's value.

        A turned dial resets the dials that it excludes. An exposure mode resets the values that it
        chooses; a lens without an iris, the stop; a lens without surfaces, ghosts and flare.

        Raises:
            UsageError: No such dial, or a text that its flag would not accept.
        """
        texts = dict(self.texts)
        # Resets come first, so that they cannot undo a dial turned in the same call.
        for name, text in sorted(changes.items(), key=lambda change: change[1] is not None):
            row = DIALS.find(name, "view", UsageError)
            if text is not None:
                self._check(row, text)
            for other in _taken_back(row, text):
                texts.pop(other, None)
            if text is not None:
                texts[name] = text
        lit = _lit(texts)
        for name in stranded(lit):
            if {*COMPANIONS[name]} & (_lit(self.texts) - lit):
                texts.pop(name, None)
        return Dials(texts, self.given)

    def values(self) -> dict[str, Any]:
        """Parsed values by the name of their parameter."""
        return {name: _value(DIALS[name], text) for name, text in self.texts.items()}

    def camera(self, camera: Camera) -> Camera:
        """Returns the camera with the dials."""
        values = {name: v for name, v in self.values().items() if name in _CAMERA}
        if isinstance(values.get("sensor"), tuple):
            values["sensor_size"] = values.pop("sensor")
        place = _parts(values, "place.")
        if scatter := _parts(values, "scatter."):
            from daguerre.camera.lens_scatter import LensScatter

            values["scatter"] = LensScatter(**scatter)
        return Placement(**place).of(camera).with_(**values)

    def settings(self, settings: RenderSettings) -> RenderSettings:
        """Returns the settings with the dials."""
        values = {name: v for name, v in self.values().items() if name in _PICTURE}
        off = [name for name in SWITCHES if name in values and not is_on(name, values[name])]
        return without(settings, off).with_(**of_flags(values))

    @staticmethod
    def before(settings: RenderSettings) -> RenderSettings:
        """Returns the settings as they are without any dial."""
        return settings.with_(**{name: DEFAULT[name] for name in _PICTURE if name in DEFAULT})

    def words(self) -> list[str]:
        """Words of the command line that has these dials."""
        words: list[str] = []
        for row in DIALS:
            if (text := self.texts.get(row.name)) is None:
                continue
            if row.kind == "flag":
                on, *off = row.flags[0].split("/")
                words += [on] if _value(row, text) else off
            else:
                words.append(f"{row.flag}={text}")  # a minus in front would be another flag
        return words

    def _check(self, row: Parameter, text: str) -> None:
        if len(text) > MAX_TEXT:
            raise UsageError(
                f"{row.flag}: wanted a text of at most {MAX_TEXT} characters, got {short(text)}"
            )
        allowed = _FROM_LIBRARY.get(row.name)
        if allowed and text != self.given.get(row.name) and not allowed(text):
            raise UsageError(f"{row.flag}: wanted a name of the library, got {short(text)}")
        row.check(_value(row, text), row.flag)


_CAMERA = {row.name for row in (*CAMERA_FLAGS, *SHUTTER)} - {"camera", *_PICTURE}


def texts_of_words(words: str) -> dict[str, str]:
    """Texts of dials from the words of a command line: flags, each with a value."""
    names = {row.flag: row.name for row in DIALS}
    parts = words.split()
    return {names[flag]: text for flag, text in zip(parts[::2], parts[1::2], strict=True)}


def _taken_back(row: Parameter, text: str | None) -> list[str]:
    """Names of dials that a turn of one takes back."""
    taken = next((names for names in DIALS.rivals() if row.name in names), (row.name,))
    if row.name == "lens":
        taken = (*taken, *_OF_LENS)
    if text in WITHOUT_IRIS and row.name in ("lens", "lens_model"):
        taken = (*taken, *(one.name for one in CAMERA if OPENING in one.needs))
    if text in IDEAL and row.name in ("lens", "lens_model"):
        taken = (*taken, *SWITCHES.keys() - possible(text))
    if row.name == "exposure" and text is not None:
        taken = (*taken, *chosen_by(text))
    return list(taken)


def _lit(texts: Mapping[str, str]) -> set[str]:
    """Switches that texts turn on."""
    return {
        name for name in SWITCHES if name in texts and is_on(name, _value(FLAGS[name], texts[name]))
    }


def _value(row: Parameter, text: str) -> Any:
    """Parses the text of a dial as its flag does."""
    if row.repeated:
        return tuple(row.from_text(part) for part in text.split(" "))
    if row.parser is None and row.kind in ("whole", "number", "flag", "choice"):
        return row.read(text, row.flag, UsageError)
    return row.from_text(text)


def _parts(values: dict[str, Any], prefix: str) -> dict[str, Any]:
    """Takes the parts of one field out of values."""
    names = [name for name in values if name.startswith(prefix)]
    return {name.removeprefix(prefix): values.pop(name) for name in names}
