"""URIs in scene files: data URIs are decoded, paths must stay in the scene's folder.

Scenes are untrusted. Without this check, a file could make the renderer read any file of the user
and leak it through a texture.
"""

from __future__ import annotations

import base64
import binascii
import os
import re
from collections.abc import Iterable
from pathlib import Path
from urllib.parse import unquote, unquote_to_bytes, urlsplit

from .in_use import note_read
from .json_item import Item, short
from .reading import MISSING, fault_of


class Folder:
    """Folder of a scene and further allowed folders, both with links resolved.

    Args:
        scene: Path of the scene file, or of another file that names files.
        allow_dirs: Further folders from which files may be read.
        what: Kind of the file that names files, for messages.
        way: Advice on naming files elsewhere, for messages.
    """

    def __init__(
        self,
        scene: Path,
        allow_dirs: Iterable[str | os.PathLike[str]] = (),
        *,
        what: str = "scene",
        way: str = "--allow-dir allows more folders",
    ) -> None:
        if isinstance(allow_dirs, (str, os.PathLike)):
            allow_dirs = (allow_dirs,)
        self._what, self._way = what, way
        self.base = Path(os.path.realpath(scene.parent))
        self.allowed = [self.base, *(Path(os.path.realpath(d)) for d in allow_dirs)]

    def resolve(self, uri: Item) -> Path:
        """Returns the existing regular file of a URI.

        Raises:
            InputError: The URI leaves the allowed folders, or no such file exists.
        """
        path = self.find(uri)
        if path is None:
            uri.fail(f"{short(str(self._path(uri)), 200)}: {MISSING}")
        return path

    def find(self, uri: Item) -> Path | None:
        """Returns the regular file of a URI; None: no such file exists.

        Raises:
            InputError: The URI leaves the allowed folders, or is no name of a regular file.
        """
        path = self._path(uri)
        if not any(path.is_relative_to(directory) for directory in self.allowed):
            uri.fail(
                f"leaves the {self._what}'s folder: wanted a file under {str(self.base)!r} "
                f"({self._way}), got {short(uri.text())}"
            )
        # Only regular files: a pipe or a device would never end.
        fault = fault_of(path)
        if fault and fault != MISSING:
            uri.fail(f"{short(str(path), 200)}: {fault}")
        note_read([path])  # also a missing file, which may come
        return None if fault else path

    def _path(self, uri: Item) -> Path:
        text = uri.text()
        name = unquote(text)
        scheme = re.match(r"([A-Za-z][A-Za-z0-9+.-]*):", text)
        if scheme and scheme[1].lower() == "file":
            try:
                parts = urlsplit(text)
            except ValueError as error:  # half an IPv6 address
                uri.fail(f"refused: wanted a local file, got {short(text)} ({error})")
            if parts.netloc not in ("", "localhost"):
                uri.fail(f"refused: wanted a local file, got {short(text)}")
            name = unquote(parts.path)
        elif scheme:
            uri.fail(f"refused: wanted a relative path or a data URI, got {short(text)}")
        # Some exporters write backslashes; read as separators they cannot hide a way up.
        name = name.replace("\\", "/")
        if not name or "\0" in name:
            uri.fail(f"refused: wanted the name of a file, got {short(text)}")
        try:
            return Path(os.path.realpath(self.base / name))
        except (OSError, ValueError) as error:
            uri.fail(f"refused: wanted the name of a file, got {short(text)} ({error})")


def is_data(uri: Item) -> bool:
    """Whether the URI contains its data."""
    return uri.text()[:5].lower() == "data:"


def data_bytes(uri: Item) -> bytes:
    """Decodes a data URI (RFC 2397), base64 or percent-encoded."""
    header, comma, body = uri.text().partition(",")
    if not comma:
        uri.fail(f"broken data URI: wanted 'data:...;base64,...', got {short(uri.text())}")
    try:
        raw = unquote_to_bytes(body) if "%" in body else body.encode("ascii")
        if not header.lower().endswith(";base64"):
            return unquote_to_bytes(body)
        return base64.b64decode(raw, validate=True)
    except (binascii.Error, ValueError) as error:
        uri.fail(f"broken data URI: wanted base64, got {short(uri.text())} ({error})")
