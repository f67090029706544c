"""Messages from the page: JSON texts, checked before anything reads them."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from daguerre import lenses
from daguerre.checks import short
from daguerre.errors import UsageError
from daguerre.lenses.search import MOST

from .dials import DIALS
from .show import check_changes

#: Longest message, bytes.
MAX_BYTES = 64 << 10
#: Highest number of a picture side by side with others.
MOST_PARTS = 9
#: File types that a page may save.
SAVED = ("exr", "png", "jpg", "dng", "json")


@dataclass(frozen=True)
class Turn:
    """Dials that the user turned; None: back to the scene's value."""

    changes: Mapping[str, str | None]


@dataclass(frozen=True)
class Got:
    """Number of a picture that the page has shown, so that the next may follow."""

    picture: int


@dataclass(frozen=True)
class Probe:
    """Asks for the values of a pixel of the whole picture.

    Attributes:
        x: Pixel from the left.
        y: Pixel from the top.
        part: Number of the picture among pictures side by side.
    """

    x: int
    y: int
    part: int = 0


@dataclass(frozen=True)
class Save:
    """File type to save the picture in."""

    kind: str


@dataclass(frozen=True)
class Draw:
    """Number of samples per pixel to draw here."""

    samples: int


@dataclass(frozen=True)
class Undo:
    """Request to undo a step."""


@dataclass(frozen=True)
class Redo:
    """Request to do the step again that was undone last."""


@dataclass(frozen=True)
class Hold:
    """Begin or end of a gesture: all turns of the same dials between are one step."""

    begins: bool


@dataclass(frozen=True)
class Section:
    """Asks for a point's rays through the lens and its spread on the film."""

    x: float
    y: float


@dataclass(frozen=True)
class Reload:
    """Request to load the scene again, after its file changed."""


@dataclass(frozen=True)
class ShowOtherwise:
    """Changes of the way in which pictures are shown: attributes of ``Show`` and their values."""

    changes: Mapping[str, Any]


@dataclass(frozen=True)
class Drawing:
    """Asks for the drawing of a lens of the library."""

    lens: str


@dataclass(frozen=True)
class Facts:
    """Request for the facts of all lenses, by which the page filters them."""


@dataclass(frozen=True)
class Photograph:
    """Asks for the photograph of a lens of the library, from a page without a server."""

    lens: str


@dataclass(frozen=True)
class Find:
    """Words of lenses that the page searches for."""

    words: str


#: Messages that change the picture; each is answered, as pages count the answers.
Change = Turn | Draw | Undo | Redo | Reload | ShowOtherwise

Message = Change | Got | Probe | Save | Hold | Section | Drawing | Facts | Photograph | Find


def parse(text: str | bytes) -> Message:
    """Parses a message.

    Raises:
        UsageError: The message has another form.
    """
    if isinstance(text, bytes):
        raise UsageError("message: wanted text, got bytes")
    if len(text) > MAX_BYTES:
        raise UsageError(f"message: wanted at most {MAX_BYTES} characters, got {len(text)}")
    try:
        data = json.loads(text, parse_constant=_no_constant, object_pairs_hook=_once)
    except (ValueError, RecursionError) as error:
        raise UsageError(f"message: wanted JSON, got {short(text)}") from error
    if not isinstance(data, dict) or len(data) != 1:
        raise UsageError(f"message: wanted one request, got {short(text)}")
    ((name, value),) = data.items()
    if name not in _READERS:
        raise UsageError(f"message: wanted one of {', '.join(_READERS)}, got {short(name)}")
    return _READERS[name](value)


def _turn(value: object) -> Turn:
    if not isinstance(value, dict):
        raise UsageError(f"turn: wanted dials by name, got {short(value)}")
    for name, text in value.items():
        DIALS.find(name, "turn", UsageError)
        if text is not None and not isinstance(text, str):
            raise UsageError(f"turn: {name}: wanted a text or null, got {short(text)}")
    return Turn(value)


def _save(value: object) -> Save:
    if value not in SAVED:
        raise UsageError(f"save: wanted one of {', '.join(SAVED)}, got {short(value)}")
    return Save(value)


def _draw(value: object) -> Draw:
    return Draw(_whole(value, "draw", 1, 1 << 20))


def _got(value: object) -> Got:
    return Got(_whole(value, "got", 0, 1 << 53))


def _probe(value: object) -> Probe:
    part = 0
    if isinstance(value, list) and len(value) == 3:
        part = _whole(value.pop(), "probe: picture", 0, MOST_PARTS)
    x, y = _pair(value, "probe")
    return Probe(int(x), int(y), part)


def _section(value: object) -> Section:
    return Section(*_pair(value, "section"))


def _plain(name: str, message: Message) -> Callable[[Any], Message]:
    """Reader of a message that says nothing but its name."""

    def read(value: object) -> Message:
        if value is not True:
            raise UsageError(f"{name}: wanted true, got {short(value)}")
        return message

    return read


def _hold(value: object) -> Hold:
    if not isinstance(value, bool):
        raise UsageError(f"hold: wanted true or false, got {short(value)}")
    return Hold(value)


def _show(value: object) -> ShowOtherwise:
    return ShowOtherwise(check_changes(value))


def _drawing(value: object) -> Drawing:
    return Drawing(_lens(value, "drawing"))


def _photograph(value: object) -> Photograph:
    return Photograph(_lens(value, "photograph"))


def _lens(value: object, where: str) -> str:
    if not isinstance(value, str) or value not in lenses.names():
        raise UsageError(f"{where}: wanted a lens of the library, got {short(value)}")
    return value


def _find(value: object) -> Find:
    if not isinstance(value, str) or len(value) > MOST:
        raise UsageError(f"find: wanted words of at most {MOST} characters, got {short(value)}")
    return Find(value)


def _whole(value: object, where: str, low: int, high: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise UsageError(f"{where}: wanted a whole number of {low} to {high}, got {short(value)}")
    return value


def _pair(value: Any, where: str) -> tuple[float, float]:
    fits = isinstance(value, list) and len(value) == 2
    if not fits or not all(
        isinstance(v, int | float) and not isinstance(v, bool) and abs(v) < 1e6 for v in value
    ):
        raise UsageError(f"{where}: wanted a pixel [x, y], got {short(value)}")
    return float(value[0]), float(value[1])


def _no_constant(name: str) -> float:
    raise ValueError(name)  # NaN and infinities are no JSON


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        raise ValueError("a name twice")
    return found


_READERS: dict[str, Callable[[Any], Message]] = {
    "turn": _turn,
    "got": _got,
    "probe": _probe,
    "save": _save,
    "draw": _draw,
    "section": _section,
    "undo": _plain("undo", Undo()),
    "redo": _plain("redo", Redo()),
    "hold": _hold,
    "reload": _plain("reload", Reload()),
    "show": _show,
    "drawing": _drawing,
    "facts": _plain("facts", Facts()),
    "photograph": _photograph,
    "find": _find,
}
