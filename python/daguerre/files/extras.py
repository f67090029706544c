"""Packages that not every file needs: the extra ``compression``."""

from __future__ import annotations

from importlib.util import find_spec

HINT = 'pip install "daguerre[compression]"'
#: Extensions of glTF that need a package, and its name as it is imported.
PACKAGES = {"KHR_draco_mesh_compression": "DracoPy", "KHR_texture_basisu": "opengl_basisu"}


def missing(extension: str) -> str:
    """The package that an extension needs and that is not installed; empty if none."""
    package = PACKAGES.get(extension, "")
    return package if package and find_spec(package) is None else ""
