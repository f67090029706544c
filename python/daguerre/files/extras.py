"""Packages that not everyone needs: which extra brings each, and one error where one is missing."""

from __future__ import annotations

from importlib.util import find_spec

from daguerre.errors import UsageError

#: The name by which a package is imported: its name for pip, and the extra of Daguerre that has it.
EXTRAS = {
    "DracoPy": ("DracoPy", "compression"),
    "opengl_basisu": ("opengl_basisu", "compression"),
    "PyOpenColorIO": ("opencolorio", "color"),
    "matplotlib": ("matplotlib", "plot"),
    "mitsuba_oidn": ("mitsuba-oidn", "denoise"),
    "rawpy": ("rawpy", "raw"),
    "tifffile": ("tifffile", "raw"),
    "yaml": ("PyYAML", "calibration"),
}
#: Extensions of glTF that need a package, and its name as it is imported.
EXTENSIONS = {"KHR_draco_mesh_compression": "DracoPy", "KHR_texture_basisu": "opengl_basisu"}


def missing(module: str) -> bool:
    """Whether a package of an extra is not installed."""
    return find_spec(module) is None


def missing_for(extension: str) -> str:
    """The package that an extension of glTF needs and that is not installed; empty if none."""
    module = EXTENSIONS.get(extension, "")
    return module if module and missing(module) else ""


def hint(module: str) -> str:
    """The command that installs a package."""
    return f'pip install "daguerre[{EXTRAS[module][1]}]"'


def need(module: str, use: str) -> None:
    """Refuses what needs a package that is not installed.

    Args:
        module: The package, as it is imported.
        use: Task or file that needs it; the error begins with it.

    Raises:
        UsageError: It is not installed; the error says how to install it.
    """
    if missing(module):
        name = EXTRAS[module][0]
        raise UsageError(
            f"{use}: wanted the package {name}, which is not installed; install it with: "
            f"{hint(module)}"
        )
