"""Opens pictures in the desktop's viewer of images."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path

from daguerre.errors import OutputError

#: Programs that open a picture on a desktop, the usual one first.
VIEWERS = ("xdg-open", "eog", "gwenview", "feh", "display")
#: Time for which the file stays after the viewer was started or closed, s.
KEPT_S = 60
#: Time in which a viewer that cannot open the picture ends, s.
_FAILS_IN_S = 1.0
#: Opens the file $3 by $1 and removes it, $2 seconds later if it was opened.
_OPEN = '"$1" "$3"; code=$?; [ $code = 0 ] && sleep "$2"; rm -f "$3"; exit $code'
_INSTEAD = "save the picture to a file instead"


def open_picture(png: Callable[[], bytes]) -> None:
    """Opens a picture, made once a viewer is found.

    Raises:
        OutputError: There is no desktop, or no viewer for its pictures.
    """
    viewer = _viewer()
    _open(viewer, png())


def _viewer() -> str:
    """Program that opens pictures on this desktop."""
    if sys.platform == "darwin":
        return "open"
    if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise OutputError(
            "show: wanted a notebook or a desktop, got neither (DISPLAY and WAYLAND_DISPLAY are "
            f"not set); {_INSTEAD}"
        )
    for name in VIEWERS:
        if shutil.which(name):
            return name
    raise OutputError(f"show: wanted one of {', '.join(VIEWERS)}, got none of them; {_INSTEAD}")


def _open(viewer: str, png: bytes) -> None:
    """Opens a picture in a viewer that outlives this process; its file is removed afterwards."""
    handle, path = tempfile.mkstemp(prefix="daguerre-", suffix=".png")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(png)
        process = subprocess.Popen(
            ["sh", "-c", _OPEN, "sh", viewer, str(KEPT_S), path],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,  # Ctrl-C here is not meant for it
        )
    except OSError as error:
        Path(path).unlink(missing_ok=True)
        raise OutputError(f"show: {path}: cannot write: {error.strerror or error}") from error
    try:
        code = process.wait(_FAILS_IN_S)
    except subprocess.TimeoutExpired:  # it shows the picture
        threading.Thread(target=process.wait, name="picture viewer", daemon=True).start()
        return
    raise OutputError(f"show: {viewer} cannot open the picture (exit code {code}); {_INSTEAD}")
