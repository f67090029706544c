"""Notebook: the viewfinder's panel in a cell of JupyterLab or another front end for widgets."""

from __future__ import annotations

import asyncio
import re
import threading
from typing import TYPE_CHECKING, Any

from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.files import extras
from daguerre.rendering.settings import RenderSettings
from daguerre.scene.scene import Scene

from .bundle import PAGE, bundled
from .clients import Client
from .dials import Dials
from .hub import Hub
from .opening import opened
from .stage import Stage

if TYPE_CHECKING:
    from anywidget import AnyWidget

_STYLE = re.compile(r'<link rel="stylesheet" href="([\w.]+)">')
_SIZE = (640, 360)


class View:
    """A viewfinder in a notebook; its panel shows itself.

    Attributes:
        widget: The panel.
    """

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._loop = asyncio.new_event_loop()
        threading.Thread(target=self._loop.run_forever, name="viewfinder", daemon=True).start()
        self._hub: Hub = asyncio.run_coroutine_threadsafe(self._open(), self._loop).result()
        self.widget = _widget(self)

    @property
    def camera(self) -> Camera:
        """Camera with all that was turned."""
        shot = self._stage.shot(self._hub.dials)
        return shot.camera

    def close(self) -> None:
        """Ends the drawing."""
        self._hub.close()
        self._loop.call_soon_threadsafe(self._loop.stop)

    async def _open(self) -> Hub:
        dials, said = opened(self._stage, Dials())
        return Hub(self._stage, dials, None, self._loop, said=said)

    def _hear(self, line: _Comm, message: dict[str, Any]) -> None:
        """Takes a message of the panel, in the kernel's thread."""
        work = line.begin(self._hub) if "begin" in message else line.hear(self._hub, message)
        asyncio.run_coroutine_threadsafe(work, self._loop)

    def _repr_mimebundle_(self, **options: Any) -> Any:
        return self.widget._repr_mimebundle_(**options)


class _Comm:
    """The line to a panel; a panel that shows itself anew begins anew."""

    def __init__(self, widget: AnyWidget) -> None:
        self._widget = widget
        self._client: Client | None = None

    async def begin(self, hub: Hub) -> None:
        if self._client is not None:
            await hub.leave(self._client)
        self._client = hub.join(self)
        await hub.welcome(self._client)

    async def hear(self, hub: Hub, message: dict[str, Any]) -> None:
        if self._client is not None:
            await hub.hear(self._client, str(message.get("text", "")))

    async def send(self, message: str | bytes) -> None:
        if isinstance(message, str):
            self._widget.send({"text": message})
        else:
            self._widget.send({}, [message])


@guarded
def view(
    scene: Scene,
    camera: Camera | None = None,
    *,
    resolution: tuple[int, int] = _SIZE,
    **settings: object,
) -> View:
    """Shows the viewfinder in a notebook: the picture of a camera, and its rings to turn.

    Args:
        scene: The scene.
        camera: The camera; None: the scene's.
        resolution: Width and height of the picture, px.
        **settings: Settings as for ``render``, such as ``spp=64``.

    Returns:
        The viewfinder; its ``camera`` has all that was turned.

    Raises:
        UsageError: The extra ``notebook`` is not installed, or a setting is wrong.
    """
    for package in ("anywidget", "simplejpeg"):
        extras.need(package, "view")
    made = RenderSettings.of(resolution=resolution, **settings)
    return View(Stage(scene, scene.camera() if camera is None else camera, made))


def _widget(shown: View) -> AnyWidget:
    from anywidget import AnyWidget
    from traitlets import Unicode

    class Panel(AnyWidget):
        _esm = bundled("widget") + "export default {render: module_widget.render};\n"
        panel = Unicode((PAGE / "index.html").read_text("utf-8")).tag(sync=True)
        style = Unicode(_styles()).tag(sync=True)

    made = Panel()
    line = _Comm(made)
    made.on_msg(lambda _, message, __: shown._hear(line, message))
    return made


def _styles() -> str:
    """All styles of the page, in its order."""
    files = _STYLE.findall((PAGE / "index.html").read_text("utf-8"))
    return "".join((PAGE / name).read_text("utf-8") for name in files)
