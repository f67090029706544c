"""Hub: connects the page that turns the dials, the pages that only watch, and the painter."""

from __future__ import annotations

import asyncio
import shlex
from collections.abc import Collection, Coroutine, Mapping, Sequence
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import Any

from daguerre.camera.exposure_mode import chosen_by
from daguerre.camera.ideal import IDEAL
from daguerre.errors import DaguerreError, UsageError
from daguerre.files import extras
from daguerre.frame.frame import Frame
from daguerre.rendering.denoise import denoise

from . import lens_list
from .clients import Client, Clients, Line
from .dials import Dials, texts_of_words
from .drawn import Drawn, PictureRequest
from .glass import drawing_of
from .history import History, Steps
from .image import Image, image_of
from .messages import (
    Change,
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
from .offers import offers
from .painter import Painter
from .previews import Previews
from .readings import readings_of
from .reasons import reason_of
from .saving import save, save_camera
from .sheet import Sheet
from .show import Show
from .stage import Stage
from .switches import on_in
from .watch import Watch
from .widest import opened_as_wide


class Hub:
    """State that all pages share.

    Args:
        stage: Scene, camera and settings.
        dials: Dials of the command line.
        words: Other words of the command line, with which the picture can be repeated; None: there
            is no command line.
        loop: Event loop of the server.
        folder: Folder for saved files.
        said: Text that pages show until something is turned.
    """

    def __init__(
        self,
        stage: Stage,
        dials: Dials,
        words: Sequence[str] | None,
        loop: asyncio.AbstractEventLoop,
        folder: Path = Path(),
        said: str = "",
    ) -> None:
        self._stage, self._words, self._loop, self._folder = stage, words, loop, folder
        self.number, self.error, self._note = -1, "", said
        self._history = self._drawn_history = History(dials)
        self._steps = Steps()
        self._first = dials
        self._show = Show(denoised=None, models=False)
        self._readings: dict[str, Any] = {}
        self._read = -1
        self._sheet: Sheet | None = None
        self._sheets = 0
        self._clients = Clients()
        self._tasks: set[asyncio.Task[None]] = set()
        self._shot = stage.shot(dials)
        self._previews = Previews()
        self._painter = Painter(self.publish, self._failed, self._ask_for_turn)
        self._request()
        self._watch = Watch(lambda: self._stage.files, self._clients)
        self._start(self._watch.run())

    def close(self) -> None:
        """Ends the painter."""
        for task in self._tasks:
            task.cancel()
        self._painter.close()
        self._previews.close()

    def join(self, line: Line) -> Client:
        """Lets a page in; the first one turns."""
        return self._clients.join(line)

    async def leave(self, client: Client) -> None:
        """Forgets a page; if it turned the dials, the next page does."""
        if client.turns:
            self._steps.let_go(self._loop.time())
        await self._clients.leave(client)

    async def welcome(self, client: Client) -> None:
        """Sends a page all that it shows at first."""
        await client.tell({"role": "turns" if client.turns else "watches"})
        await client.tell({"open": self._opened()})
        await client.tell(self._state())
        await self._watch.welcome(client)
        await client.offer(self._sheet)

    async def hear(self, client: Client, text: str | bytes) -> None:
        """Acts on a message of a page; answers a wrong message by the reason."""
        message = None
        try:
            message = parse(text)
            await self._act(client, message)
        except Exception as error:  # whatever it is, the page stays
            refused = {"refused": reason_of(error)}
            await client.tell(refused | {"heard": True} if isinstance(message, Change) else refused)

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

    async def _act(self, client: Client, message: Message) -> None:
        match message:
            case Got(number):
                if client.busy == number:
                    client.busy = None
                    await client.offer(self._sheet)
            case Probe():
                sheet = self._sheet
                value = None if sheet is None else await asyncio.to_thread(sheet.value, message)
                await client.tell({"value": value})
            case Section(x, y):
                found = await asyncio.to_thread(self._newest("section").section, x, y)
                await client.tell({"section": found})
            case Drawing(name):
                await client.tell({"drawing": await asyncio.to_thread(drawing_of, name)})
            case Facts():
                await client.tell({"facts": await asyncio.to_thread(lens_list.facts)})
            case Photograph(name):
                await client.tell({"photograph": lens_list.photograph(name)})
            case Find(words):
                await client.tell({"found": lens_list.found(words)})
            case _ if not client.turns:
                raise UsageError("view: read-only: another page controls the camera")
            case Turn(changes):
                await self._turn({**self._kept(changes), **changes}, changes, client=client)
            case Draw(samples):
                await self._turn({"spp": str(samples)}, client=client)
            case Undo():
                await self._go_back(self._history.undone, "undo: nothing was turned", client)
            case Redo():
                await self._go_back(self._history.redone, "redo: nothing was undone", client)
            case Hold(begins):
                (self._steps.hold if begins else self._steps.let_go)(self._loop.time())
            case Save(kind):
                path = await asyncio.to_thread(self._save, kind)
                await self._clients.tell({"saved": str(path)})
            case ShowOtherwise(changes):
                await self._show_otherwise(self._show.changed(changes), client)
            case Reload():
                self._stage = await asyncio.to_thread(self._stage.reload, self.dials)
                await self._go(self._history, client)
                await self._clients.tell({"open": self._opened()})
                await self._watch.begin()

    async def _turn(
        self,
        changes: Mapping[str, str | None],
        names: Collection[str] | None = None,
        *,
        client: Client,
    ) -> None:
        """Turns dials; ``names`` are the dials that tell undo steps apart."""
        dials = self.dials.turned(changes)
        step = self._steps.of_turn(names or changes, self._loop.time())
        await self._go(self._history.turned(dials, step), client)

    async def _go_back(self, history: History | None, nothing: str, client: Client) -> None:
        """Undoes or redoes a step; forgets a step that cannot be drawn any more."""
        if history is None:
            raise UsageError(nothing)
        try:
            await self._go(history, client)
        except DaguerreError:
            self._history = self._history.without(history.now)
            raise

    async def _go(self, history: History, client: Client) -> None:
        """Takes other dials; the page that asked hears so with the state."""
        shot = self._stage.shot(history.now)  # or an error, and everything stays as it is
        self._shot, self._history, self.error, self._note = shot, history, "", ""
        self._request()
        await self._tell_state(client)

    def _kept(self, changes: Mapping[str, str | None]) -> dict[str, str | None]:
        """Settings that a meter chose, where an automatic mode ends in ``manual``."""
        chosen = None if self._sheet is None else self._sheet.drawn.shot.chosen
        if changes.get("exposure") != "manual" or chosen is None:
            return {}
        return {**texts_of_words(chosen.words), "exposure": "manual"}

    def _request(self) -> None:
        """Has the picture drawn anew."""
        self.number += 1
        show = self._show
        self._painter.request(
            PictureRequest(
                self.number, self._stage, self.dials, self._shot, show.models, show.beside
            )
        )

    async def _show_otherwise(self, show: Show, client: Client) -> None:
        """Shows pictures in another way; denoising begins with the picture that is there."""
        if show.denoised:
            extras.need("mitsuba_oidn", "denoise")
        if show.models and self._shot.camera.lens in IDEAL:
            raise UsageError("show: models can be compared only for a lens of the library")
        before, self._show = self._show, show
        redraws = (show.models, show.beside) != (before.models, before.beside)
        if redraws:
            self._request()
        elif self._sheet is not None and self._sheet.drawn.request.number == self.number:
            await asyncio.to_thread(self.publish, self._sheet.drawn)
        await self._tell_state(client)

    def _newest(self, use: str) -> Sheet:
        """The newest picture; ``use`` begins the error when there is none yet."""
        if self._sheet is None:
            raise UsageError(f"{use}: the picture is not drawn yet; try again in a moment")
        return self._sheet

    def _save(self, kind: str) -> Path:
        drawn = self._newest("save").drawn
        if kind == "json":
            return save_camera(drawn, self._folder, self.command, self.dials.texts)
        return save(drawn, self._folder, kind)

    def _opened(self) -> dict[str, Any]:
        return offers(self._stage, self._first, self._shot)

    def _state(self) -> dict[str, Any]:
        camera = self._shot.camera
        mode, pattern = camera.exposure, camera.meter
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

    def _ask_for_turn(self, request: PictureRequest) -> None:
        """Lets the page send its next turn while a picture is developed."""
        message = {"drawn": request.number}
        self._loop.call_soon_threadsafe(lambda: self._start(self._clients.tell(message)))

    def publish(self, drawn: Drawn) -> None:
        """Develops a picture and sends it to the pages; may be called by any thread."""
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

    def _failed(self, request: PictureRequest, error: Exception) -> None:
        before = request.dials if self._sheet is None else self._sheet.drawn.request.dials
        try:
            widest = opened_as_wide(request, error, before)
        except Exception as other:  # whatever it is, the painter goes on
            widest, error = None, other
        if widest:
            self._loop.call_soon_threadsafe(self._open_less, request, widest)
        else:
            self._loop.call_soon_threadsafe(self._report, request, reason_of(error))

    # The server's thread

    def _hand_out(self, drawn: Drawn, image: Image, show: Show, readings: dict[str, Any]) -> None:
        number = drawn.request.number
        if self._sheet is not None and number < self._sheet.drawn.request.number:
            return  # a newer picture was faster
        if number == self.number:
            self._drawn_history = self._history
        self._sheet = self._sheet_of(
            drawn, image, show, denoised=bool(show.denoised) and drawn.is_one
        )
        for client in self._clients:
            self._start(client.offer(self._sheet))  # before the numbers, which take the page longer
        if (readings, number) != (self._readings, self._read):
            self._readings, self._read = readings, number
            self._start(self._tell_state())

    def _hand_out_preview(self, drawn: Drawn, image: Image, show: Show) -> None:
        """Hands out a preview, unless the picture rests or a page asked for another."""
        newest = None if self._sheet is None else self._sheet.drawn
        if newest is None or newest.rests or show is not self._show:
            return
        if drawn.request.number == newest.request.number == self.number:
            sheet = self._sheet_of(drawn, image, show, denoised=True)
            self._sheet = replace(sheet, drawn=newest)  # values and files are never denoised
            for client in self._clients:
                self._start(client.offer(self._sheet))

    def _sheet_of(self, drawn: Drawn, image: Image, show: Show, *, denoised: bool) -> Sheet:
        self._sheets += 1
        return Sheet.of(self._sheets, drawn, image, show, denoised=denoised)

    def _report(self, request: PictureRequest, text: str) -> None:
        """Reports why a request cannot be drawn, and goes back to the last request that could."""
        if request.number != self.number:
            return
        before = None if self._sheet is None else self._sheet.drawn.request
        if before is not None and before.asks != request.asks:
            if before.dials != request.dials:
                self._history = self._drawn_history.without(request.dials)
            self._show = replace(self._show, models=before.models, beside=before.beside)
            self._shot = before.shot
            self._request()
        self.error = text
        self._start(self._tell_state())

    def _open_less(self, request: PictureRequest, dials: Dials) -> None:
        """Goes on at a smaller stop, in the same step, and says so."""
        if request.number != self.number:
            return
        self._history = replace(self._history, now=dials)
        self._shot = self._stage.shot(dials)
        stop = dials.texts["f_stop"]
        self._note = f"This lens opens no wider than f/{stop}, so the aperture is there now."
        self._request()
        self._start(self._tell_state())

    def _start(self, work: Coroutine[Any, Any, None]) -> None:
        task = self._loop.create_task(work)
        self._tasks.add(task)  # the loop itself keeps no hold of it
        task.add_done_callback(self._tasks.discard)

    async def _tell_state(self, heard: Client | None = None) -> None:
        """Tells all pages the present state; an older state would undo a turn on the page."""
        await self._clients.tell(self._state(), heard)
