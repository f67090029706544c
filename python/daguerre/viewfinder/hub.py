"""Hub: one who turns, any number who watch, and the painter between them."""

from __future__ import annotations

import asyncio
import itertools
import json
import math
import shlex
from collections.abc import Collection, Coroutine, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Protocol

from daguerre import sensors, units
from daguerre.camera.exposure_mode import METERS, MODES, chosen_by, split_mode
from daguerre.camera.ideal import IDEAL
from daguerre.development.looks import LOOKS
from daguerre.errors import DaguerreError, UsageError
from daguerre.files import extras
from daguerre.frame.frame import Frame
from daguerre.rendering.denoise import denoise

from . import lens_list
from .dials import DIALS, Dials, texts_of_words
from .drawn import Drawn, Wish
from .glass import drawing_of, glass_at
from .history import History, Steps
from .image import Image, image_of, value_at
from .messages import (
    Draw,
    Drawing,
    Facts,
    Find,
    Got,
    Hold,
    Message,
    Photograph,
    Probe,
    Redo,
    Reload,
    Save,
    Section,
    ShowOtherwise,
    Turn,
    Undo,
    parse,
)
from .painter import Painter
from .previews import Previews
from .readings import readings_of
from .reasons import reason_of
from .rungs import MODELS
from .saving import save, save_camera
from .show import Show
from .sight import distance_at
from .stage import Stage
from .switches import on_in
from .tev import Tev
from .tint import legends
from .widest import opened_as_wide

#: Time between two looks at the scene's file, s.
_LOOK_S = 2.5
#: Looks from one sign of life to the next: browsers show pages no pings of the protocol.
_LOOKS = 4


class Line(Protocol):
    """Connection to a page."""

    async def send(self, message: str | bytes) -> None:
        """Sends a message."""


@dataclass(eq=False)
class Guest:
    """A page that is connected.

    Attributes:
        line: Its connection.
        turns: Whether it may turn the dials.
        busy: Number of the picture that is on its way; None: none.
        sent: Number of the newest picture that was sent.
    """

    line: Line
    turns: bool
    busy: int | None = None
    sent: int = 0


@dataclass(frozen=True)
class Sheet:
    """A picture as it goes to pages: its number, its head and its bytes."""

    number: int
    drawn: Drawn
    bytes: bytes


class Hub:
    """State that all pages share.

    Args:
        stage: Scene, camera and settings.
        dials: Dials of the command line.
        words: Other words of the command line, with which the picture can be repeated; None: there
            is no command line.
        loop: Event loop of the server.
        folder: Folder for saved files.
        tev: Viewer that gets each whole picture, too; None: none.
        said: Text that pages show until something is turned.
    """

    def __init__(
        self,
        stage: Stage,
        dials: Dials,
        words: Sequence[str] | None,
        loop: asyncio.AbstractEventLoop,
        folder: Path = Path(),
        tev: Tev | None = None,
        said: str = "",
    ) -> None:
        self._stage, self._words, self._loop, self._folder = stage, words, loop, folder
        self.number, self.error, self._note = -1, "", said
        self._history = self._drawn_history = History(dials)
        self._steps = Steps()
        self._first = dials
        self._show = Show(denoised=None, models=False)
        self._tev = tev
        self._readings: dict[str, Any] = {}
        self._read = -1
        self._sheet: Sheet | None = None
        self._sheets = 0
        self._guests: list[Guest] = []
        self._tasks: set[asyncio.Task[None]] = set()
        self._shot = stage.shot(dials)
        self._previews = Previews()
        self._painter = Painter(self.publish, self._failed)
        self._wish()
        self._start(self._watch())

    def close(self) -> None:
        """Ends the painter."""
        for task in self._tasks:
            task.cancel()
        self._painter.close()
        self._previews.close()
        if self._tev is not None:
            self._tev.close()

    def join(self, line: Line) -> Guest:
        """Lets a page in; the first one turns."""
        guest = Guest(line, not any(other.turns for other in self._guests))
        self._guests.append(guest)
        return guest

    async def leave(self, guest: Guest) -> None:
        """Forgets a page; if it turned, the next one does."""
        self._guests.remove(guest)
        if guest.turns:
            self._steps.let_go(self._loop.time())
        if guest.turns and self._guests:
            self._guests[0].turns = True
            await self._tell(self._guests[0], {"role": "turns"})

    async def welcome(self, guest: Guest) -> None:
        """Sends a page all that it shows at first."""
        await self._tell(guest, {"role": "turns" if guest.turns else "watches"})
        await self._tell(guest, {"open": self._opened()})
        await self._tell(guest, self._state())
        await self._offer(guest)

    async def hear(self, guest: Guest, text: str | bytes) -> None:
        """Acts on a message of a page; a wrong one is answered by its reason."""
        try:
            await self._act(guest, parse(text))
        except Exception as error:  # whatever it is, the page stays
            await self._tell(guest, {"refused": reason_of(error)})

    @property
    def dials(self) -> Dials:
        """Positions of the dials."""
        return self._history.now

    @property
    def command(self) -> str:
        """Command line that draws the picture of these dials; empty: there is none."""
        if self._words is None:
            return ""
        return shlex.join(["daguerre", "render", *self._words, *self.dials.words()])

    @property
    def picture(self) -> Drawn | None:
        """Newest picture; None: none is drawn yet."""
        return None if self._sheet is None else self._sheet.drawn

    async def _act(self, guest: Guest, message: Message) -> None:
        match message:
            case Got(number):
                if guest.busy == number:
                    guest.busy = None
                    await self._offer(guest)
            case Probe():
                await self._tell(guest, {"value": await asyncio.to_thread(self._value, message)})
            case Section(x, y):
                found = await asyncio.to_thread(self._section, x, y)
                await self._tell(guest, {"section": found})
            case Drawing(name):
                await self._tell(guest, {"drawing": await asyncio.to_thread(drawing_of, name)})
            case Facts():
                await self._tell(guest, {"facts": await asyncio.to_thread(lens_list.facts)})
            case Photograph(name):
                await self._tell(guest, {"photograph": lens_list.photograph(name)})
            case Find(words):
                await self._tell(guest, {"found": lens_list.found(words)})
            case _ if not guest.turns:
                raise UsageError("view: read-only: another page controls the camera")
            case Turn(changes):
                await self._turn({**self._kept(changes), **changes}, changes, guest)
            case Draw(samples):
                await self._turn({"spp": str(samples)})
            case Undo():
                await self._go_back(self._history.undone, "undo: nothing was turned")
            case Redo():
                await self._go_back(self._history.redone, "redo: nothing was undone")
            case Hold(begins):
                (self._steps.hold if begins else self._steps.let_go)(self._loop.time())
            case Save(kind):
                path = await asyncio.to_thread(self._save, kind)
                await self._tell_all({"saved": str(path)})
            case ShowOtherwise(changes):
                await self._show_otherwise(self._show.changed(changes))
            case Reload():
                self._stage = await asyncio.to_thread(self._stage.reload)
                await self._go(self._history)
                await self._tell_all({"open": self._opened()})

    async def _turn(
        self,
        changes: Mapping[str, str | None],
        names: Collection[str] | None = None,
        guest: Guest | None = None,
    ) -> None:
        """Turns dials; those of the names tell steps apart."""
        dials = self.dials.turned(changes)
        step = self._steps.of_turn(names or changes, self._loop.time())
        await self._go(self._history.turned(dials, step), guest)

    async def _go_back(self, history: History | None, nothing: str) -> None:
        """Undoes or redoes a step; one that cannot be drawn any more is forgotten."""
        if history is None:
            raise UsageError(nothing)
        try:
            await self._go(history)
        except DaguerreError:
            self._history = self._history.without(history.now)
            raise

    async def _go(self, history: History, guest: Guest | None = None) -> None:
        """Takes other dials; the page that asked hears so before the state, and updates once."""
        shot = self._stage.shot(history.now)  # or an error, and everything stays as it is
        self._shot, self._history, self.error, self._note = shot, history, "", ""
        self._wish()
        if guest is not None:
            await self._tell(guest, {"heard": True})
        await self._tell_state()

    def _kept(self, changes: Mapping[str, str | None]) -> dict[str, str | None]:
        """Settings that a meter chose, where an automatic mode ends in ``manual``."""
        chosen = None if self._sheet is None else self._sheet.drawn.shot.chosen
        if changes.get("exposure") != "manual" or chosen is None:
            return {}
        return {**texts_of_words(chosen.words), "exposure": "manual"}

    def _wish(self) -> None:
        """Has the picture drawn anew."""
        self.number += 1
        show = self._show
        self._painter.wish(
            Wish(self.number, self._stage, self.dials, self._shot, show.models, show.beside)
        )

    async def _show_otherwise(self, show: Show) -> None:
        """Shows pictures in another way; denoising begins with the picture that is there."""
        if show.denoised:
            extras.need("mitsuba_oidn", "denoise")
        if show.models and self._shot.camera.lens in IDEAL:
            raise UsageError("show: models can be compared only for a lens of the library")
        before, self._show = self._show, show
        redraws = (show.models, show.beside) != (before.models, before.beside)
        if redraws:
            self._wish()
        elif self._sheet is not None and self._sheet.drawn.wish.number == self.number:
            await asyncio.to_thread(self.publish, self._sheet.drawn)
        await self._tell_state()

    async def _watch(self) -> None:
        """Tells the pages when the scene's file changes, and at times that the server lives."""
        path = self._stage.scene.path
        known = _stamp(path)
        for look in itertools.count(1):
            await asyncio.sleep(_LOOK_S)
            now = _stamp(path)
            if now not in (known, None):
                known = now
                await self._tell_all({"changed": "" if path is None else path.name})
            if look % _LOOKS == 0:
                await self._tell_all({"ping": look})

    def _value(self, probe: Probe) -> dict[str, Any] | None:
        """Values under the pointer, of the picture that is there."""
        sheet = self._sheet  # the next one may come meanwhile
        if sheet is None or probe.part >= max(1, len(sheet.drawn.panels)):
            return None
        x, y, drawn = probe.x, probe.y, sheet.drawn
        shown = drawn.panels[probe.part] if drawn.panels else drawn
        width, height = drawn.wish.shot.settings.film.resolution
        own, (left, top, *_) = shown.session.prepared.setup.resolution, shown.session.crop
        found = value_at(shown.frame, x * own[0] // width - left, y * own[1] // height - top)
        distance = distance_at(
            shown.session, (x + 0.5) * own[0] / width, (y + 0.5) * own[1] / height
        )
        return found and {
            **found,
            "picture": sheet.number,
            "samples": drawn.samples,
            "distance_m": distance if math.isfinite(distance) else None,
        }

    def _section(self, x: float, y: float) -> dict[str, Any]:
        if self._sheet is None:
            raise UsageError("section: the picture is not drawn yet; try again in a moment")
        drawn = self._sheet.drawn
        width, height = drawn.wish.shot.settings.film.resolution
        own = drawn.session.prepared.setup.resolution
        return glass_at(drawn.session, x * own[0] / width, y * own[1] / height) | {"x": x, "y": y}

    def _save(self, kind: str) -> Path:
        if self._sheet is None:
            raise UsageError("save: the picture is not drawn yet; try again in a moment")
        if kind == "json":
            return save_camera(self._sheet.drawn, self._folder, self.command, self.dials.texts)
        return save(self._sheet.drawn, self._folder, kind)

    def _opened(self) -> dict[str, Any]:
        """All that the rings can choose from."""
        scene, settings = self._stage.scene, self._stage.settings
        return {
            "scene": "scene" if scene.path is None else scene.path.name,
            "lenses": lens_list.offered(),
            "shutter_types": list(DIALS["shutter_type"].choices),
            "sensors": [*units.SENSORS, *sensors.names()],
            "looks": list(LOOKS),
            "cameras": list(scene.cameras),
            "duration_s": scene.duration,
            "denoises": not extras.missing("mitsuba_oidn"),
            "models": list(MODELS),
            "modes": list(MODES),
            "meters": list(METERS),
            "legends": legends(),
            "dials": dict(self._first.texts),
            "resolution": settings.film.resolution,
            "window": self._shot.window,
            "spp": self._shot.settings.sampling.most,
            "lit": on_in(settings),
        }

    def _state(self) -> dict[str, Any]:
        camera = self._shot.camera
        mode, pattern = split_mode(camera.exposure, camera.meter)
        return {
            "state": {
                "turn": self.number,
                "read": self._read,
                "dials": dict(self.dials.texts),
                "mode": mode,
                "pattern": pattern,
                "chosen": list(chosen_by(mode)),
                "command": self.command,
                "lit": on_in(self._shot.settings),
                "readings": self._readings,
                "undoes": self._history.undone is not None,
                "redoes": self._history.redone is not None,
                "show": asdict(self._show),
                "error": self.error,
                "note": self._note,
            }
        }

    # The painter's thread

    def publish(self, drawn: Drawn) -> None:
        """Develops a picture and sends it to the pages; may be called by any thread."""
        if self._tev is not None:
            self._tev.send(drawn)
        show, readings = self._show, readings_of(drawn)
        clean = denoise(drawn.frame) if show.denoised and drawn.is_one else None
        image = image_of(drawn, clean=clean, tint=show.tint)
        self._loop.call_soon_threadsafe(self._hand_out, drawn, image, show, readings)
        if show.denoised is None:
            self._previews.offer(drawn, partial(self._publish_preview, drawn, show))

    def _publish_preview(self, drawn: Drawn, show: Show, clean: Frame) -> None:
        """Sends a picture on the way once more, denoised; called by the thread of previews."""
        image = image_of(drawn, clean=clean, tint=show.tint)
        self._loop.call_soon_threadsafe(self._hand_out_preview, drawn, image, show)

    def _failed(self, wish: Wish, error: Exception) -> None:
        before = wish.dials if self._sheet is None else self._sheet.drawn.wish.dials
        try:
            widest = opened_as_wide(wish, error, before)
        except Exception as other:  # whatever it is, the painter goes on
            widest, error = None, other
        if widest:
            self._loop.call_soon_threadsafe(self._open_less, wish, widest)
        else:
            self._loop.call_soon_threadsafe(self._report, wish, reason_of(error))

    # The server's thread

    def _hand_out(self, drawn: Drawn, image: Image, show: Show, readings: dict[str, Any]) -> None:
        if drawn.wish.number != self.number:
            return  # a newer wish came
        self._drawn_history = self._history
        self._sheet = self._sheet_of(
            drawn, image, show, denoised=bool(show.denoised) and drawn.is_one
        )
        for guest in self._guests:
            self._start(self._offer(guest))  # before the numbers, which take the page longer
        if (readings, self.number) != (self._readings, self._read):
            self._readings, self._read = readings, self.number
            self._start(self._tell_state())

    def _hand_out_preview(self, drawn: Drawn, image: Image, show: Show) -> None:
        """Hands out a preview, unless the picture rests or another one is asked for."""
        newest = None if self._sheet is None else self._sheet.drawn
        if newest is None or newest.rests or show is not self._show:
            return
        if drawn.wish.number == newest.wish.number == self.number:
            sheet = self._sheet_of(drawn, image, show, denoised=True)
            self._sheet = replace(sheet, drawn=newest)  # values and files are never denoised
            for guest in self._guests:
                self._start(self._offer(guest))

    def _sheet_of(self, drawn: Drawn, image: Image, show: Show, *, denoised: bool) -> Sheet:
        self._sheets += 1
        head = {
            "picture": self._sheets,
            "turn": drawn.wish.number,
            "size": image.size,
            "kind": image.kind,
            "samples": drawn.samples,
            "rests": drawn.rests,
            "whole": drawn.whole,
            "denoised": denoised,
            "previews": show.denoised is None,
            "panels": [panel.name for panel in drawn.panels],
            "main": drawn.main,
            "part": image.part,
            "divided": bool(drawn.panels) and drawn.wish.beside is not None,
            "histogram": image.histogram,
            "tint": image.tint,
        }
        text = json.dumps(head).encode()
        return Sheet(self._sheets, drawn, len(text).to_bytes(4, "little") + text + image.bytes)

    def _report(self, wish: Wish, text: str) -> None:
        """Says why a wish cannot be drawn, and goes back to what could: dials, models, beside."""
        if wish.number != self.number:
            return
        before = None if self._sheet is None else self._sheet.drawn.wish
        if before is not None and before.asks != wish.asks:
            if before.dials != wish.dials:
                self._history = self._drawn_history.without(wish.dials)
            self._show = replace(self._show, models=before.models, beside=before.beside)
            self._shot = before.shot
            self._wish()
        self.error = text
        self._start(self._tell_state())

    def _open_less(self, wish: Wish, dials: Dials) -> None:
        """Goes on at a smaller stop, in the same step, and says so."""
        if wish.number != self.number:
            return
        self._history = replace(self._history, now=dials)
        self._shot = self._stage.shot(dials)
        stop = dials.texts["f_stop"]
        self._note = f"This lens opens no wider than f/{stop}, so the aperture is there now."
        self._wish()
        self._start(self._tell_state())

    def _start(self, work: Coroutine[Any, Any, None]) -> None:
        task = self._loop.create_task(work)
        self._tasks.add(task)  # the loop itself keeps no hold of it
        task.add_done_callback(self._tasks.discard)

    async def _offer(self, guest: Guest) -> None:
        """Sends a page the newest picture, unless one is on its way."""
        sheet = self._sheet
        if sheet is None or guest.busy is not None or guest.sent == sheet.number:
            return
        guest.busy = guest.sent = sheet.number
        await guest.line.send(sheet.bytes)

    async def _tell(self, guest: Guest, message: dict[str, Any]) -> None:
        await guest.line.send(json.dumps(message))

    async def _tell_state(self) -> None:
        """Tells all pages the state of the moment: one from before a turn would undo it there."""
        await self._tell_all(self._state())

    async def _tell_all(self, message: dict[str, Any]) -> None:
        text = json.dumps(message)
        await asyncio.gather(*(guest.line.send(text) for guest in self._guests))


def _stamp(path: Path | None) -> tuple[int, int] | None:
    """Time and size of a file; None: there is none."""
    try:
        facts = None if path is None else path.stat()
    except OSError:
        return None
    return None if facts is None else (facts.st_mtime_ns, facts.st_size)
