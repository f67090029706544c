"""Optional packages: the extra that has each, and the error if a package is missing."""

from __future__ import annotations

import sys
from importlib.util import find_spec
from pathlib import Path

from daguerre.errors import UsageError

#: Import name of a package: its name for pip, and the extra of Daguerre that has it.
EXTRAS = {
    "DracoPy": ("DracoPy", "compression"),
    "opengl_basisu": ("opengl_basisu", "compression"),
    "blosc": ("blosc", "compression"),
    "anywidget": ("anywidget", "notebook"),
    "PyOpenColorIO": ("opencolorio", "color"),
    "distributed": ("distributed", "cluster"),
    "lensfunpy": ("lensfunpy", "compare"),
    "matplotlib": ("matplotlib", "plot"),
    "mitsuba_oidn": ("mitsuba-oidn", "denoise"),
    "rawpy": ("rawpy", "raw"),
    "simplejpeg": ("simplejpeg", "view"),
    "tifffile": ("tifffile", "raw"),
    "pxr": ("usd-core", "usd"),
    "websockets": ("websockets", "view"),
    "yaml": ("PyYAML", "calibration"),
}
#: Extensions of glTF that need a package, with its import name.
EXTENSIONS = {"KHR_draco_mesh_compression": "DracoPy", "KHR_texture_basisu": "opengl_basisu"}


def missing(module: str) -> bool:
    """Whether a package of an extra is not installed."""
    return find_spec(module) is None


def missing_for(extension: str) -> str:
    """Package that an extension of glTF needs and that is not installed; empty if none."""
    module = EXTENSIONS.get(extension, "")
    return module if module and missing(module) else ""


def hint(module: str) -> str:
    """Command that installs a package: into the clone of an editable install, or beside a wheel."""
    from shlex import quote

    extra = EXTRAS[module][1]
    clone = _clone()
    if clone is None:
        return f'pip install "daguerre[{extra}]"'
    pip = Path(sys.prefix) / "bin" / "pip"
    if pip.is_relative_to(clone):
        pip = pip.relative_to(clone)
    command = f"{quote(str(pip))} install -e '.[{extra}]'"
    return command if clone == Path.cwd() else f"cd {quote(str(clone))} && {command}"


def _clone() -> Path | None:
    """Folder of an editable install, by the record that pip keeps (PEP 610); None for a wheel."""
    import json
    from importlib.metadata import PackageNotFoundError, distribution
    from urllib.parse import unquote, urlsplit

    try:
        record = json.loads(distribution("daguerre").read_text("direct_url.json") or "{}")
        if record["dir_info"]["editable"]:
            return Path(unquote(urlsplit(record["url"]).path))
    except (PackageNotFoundError, ValueError, KeyError):
        pass
    return None


def lack(module: str) -> str:
    """Says which package is needed, for messages, and how to install it."""
    name = EXTRAS[module][0]
    return f"needs the package {name}, which is not installed; install it with: {hint(module)}"


def need(module: str, use: str) -> None:
    """Checks that an optional package is installed.

    Args:
        module: Import name of the package.
        use: Task or file that needs it; the message begins with it.

    Raises:
        UsageError: The package is not installed; the message says how to install it.
    """
    if missing(module):
        raise UsageError(f"{use}: {lack(module)}")
