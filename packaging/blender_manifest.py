"""Manifest of the extension for Blender: filled in, and checked against the documented schema.

Source: Blender 5.0 manual, "Creating Extensions", manifest schema 1.0.0.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import PurePosixPath
from typing import Any

#: Longest tagline and reason of a permission.
MOST = 64
PERMISSIONS = {"files", "network", "clipboard", "camera", "microphone"}
PLATFORMS = {"windows-x64", "windows-arm64", "macos-x64", "macos-arm64", "linux-x64"}
_VERSION = re.compile(r"\d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?(\+[0-9A-Za-z.-]+)?")
#: name, version, (build), Python, ABI and platform
_WHEEL = re.compile(r"[^-]+-[^-]+(-\d[^-]*)?-[^-]+-[^-]+-[^-]+\.whl")


def filled(text: str, version: str, wheels: list[str]) -> str:
    """Returns the text of a manifest with its version, and wheels in its folder ``wheels``."""
    listed = "".join(f'    "./wheels/{name}",\n' for name in sorted(wheels))
    text = re.sub(r'^version = ".*"$', f'version = "{semantic(version)}"', text, flags=re.M)
    return re.sub(r"^wheels = \[\]$", f"wheels = [\n{listed}]", text, flags=re.M)


def semantic(version: str) -> str:
    """Turns a version of Python, such as 1.0.0rc1, into a semantic one: 1.0.0-rc1."""
    return re.sub(r"^(\d+\.\d+\.\d+)([a-z].*)$", r"\1-\2", version)


def faults(manifest: Mapping[str, Any], files: set[str]) -> list[str]:
    """Faults of a manifest, one line each.

    Args:
        manifest: Its values.
        files: Paths of the files beside it.
    """
    return [
        f"{name}: wanted {wanted}, got {manifest.get(name, 'nothing')!r}"
        for name, (wanted, good) in _RULES.items()
        if not good(manifest.get(name))
    ] + [*_permission_faults(manifest.get("permissions", {})), *_wheel_faults(manifest, files)]


def _is_text(value: Any) -> bool:
    return isinstance(value, str) and bool(value) and value == value.strip()


def _is_phrase(value: Any) -> bool:
    """Whether a value is a short text that does not end in punctuation."""
    return _is_text(value) and len(value) <= MOST and (value[-1].isalnum() or value[-1] in ")]")


def _is_version(value: Any) -> bool:
    return isinstance(value, str) and bool(_VERSION.fullmatch(value))


def _is_id(value: Any) -> bool:
    return (
        isinstance(value, str)
        and bool(re.fullmatch(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*", value))
        and "blender" not in value.lower()
    )


def _are_texts(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(map(_is_text, value))


def _are_licences(value: Any) -> bool:
    return _are_texts(value) and all(one.startswith("SPDX:") for one in value)


def _are_platforms(value: Any) -> bool:
    return _are_texts(value) and set(value) <= PLATFORMS


_RULES: dict[str, tuple[str, Callable[[Any], bool]]] = {
    "schema_version": ("1.0.0", lambda value: value == "1.0.0"),
    "id": ("letters, digits and underscores, without the word Blender", _is_id),
    "version": ("a semantic version", _is_version),
    "name": ("a text", _is_text),
    "tagline": (f"at most {MOST} characters that end without punctuation", _is_phrase),
    "maintainer": ("a text", _is_text),
    "type": ("add-on", lambda value: value == "add-on"),
    "blender_version_min": (
        "three numbers, at least 4.2.0",
        lambda value: _is_version(value) and tuple(map(int, value.split("."))) >= (4, 2, 0),
    ),
    "license": ("names of licences with SPDX: in front", _are_licences),
    "platforms": ("platforms such as linux-x64", _are_platforms),
    "tags": ("texts", _are_texts),
}


def _permission_faults(permissions: Any) -> Iterator[str]:
    if not isinstance(permissions, dict):
        yield f"permissions: wanted a table, got {permissions!r}"
        return
    for name, reason in permissions.items():
        if name not in PERMISSIONS:
            yield f"permissions: wanted {', '.join(sorted(PERMISSIONS))}, got {name}"
        if not _is_phrase(reason):
            yield f"permissions.{name}: wanted a reason without a full stop, got {reason!r}"


def _wheel_faults(manifest: Mapping[str, Any], files: set[str]) -> Iterator[str]:
    wheels = manifest.get("wheels", [])
    if not isinstance(wheels, list):
        yield f"wheels: wanted a list, got {wheels!r}"
        return
    for wheel in wheels:
        path = PurePosixPath(str(wheel))
        if not _WHEEL.fullmatch(path.name):
            yield f"wheels: wanted the name of a wheel, got {wheel!r}"
        elif path.as_posix() not in files:
            yield f"wheels: {wheel}: wanted a file of the extension, got none"
    listed = {PurePosixPath(str(wheel)).as_posix() for wheel in wheels}
    for name in sorted(files - listed):
        if name.endswith(".whl"):
            yield f"wheels: {name}: wanted it in the list"
