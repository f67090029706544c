"""Files that a stage may read: files in its folder and in further allowed folders."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from pxr import Ar, Sdf, Usd

from daguerre.checks import short
from daguerre.errors import InputError
from daguerre.files.reading import is_input
from daguerre.files.uris import Folder

from .anchored import SCHEME, anchored


class Assets:
    """Files that a stage may read: files in its folder and in allowed folders.

    Args:
        path: File of the stage.
        allow_dirs: Further folders.
    """

    def __init__(self, path: Path, allow_dirs: Iterable[str | os.PathLike[str]]) -> None:
        self._file = str(path)
        self._folders = Folder(path, allow_dirs).allowed

    def check(self, place: str, name: str) -> str:
        """Returns the absolute path of an asset; of a file inside of a package, with brackets.

        Args:
            place: Prim or layer that names it, for messages.
            name: Path of the asset, anchored to its layer.

        Raises:
            InputError: The asset is outside of the folders.
        """
        if SCHEME.match(name):
            raise InputError(
                f"{self._file}: {place}: refused: wanted a file, got {short(name, 200)}"
            )
        package = package_of(name)
        if "\0" in package:
            raise InputError(f"{self._file}: {place}: refused: wanted a file, got {short(name)}")
        real = Path(os.path.realpath(package))
        if not any(real.is_relative_to(folder) for folder in self._folders):
            raise InputError(
                f"{self._file}: {place}: leaves the stage's folder: wanted a file under "
                f"{str(self._folders[0])!r} (--allow-dir allows more folders), got "
                f"{short(name, 200)}"
            )
        return str(real) + name[len(package) :]

    def file_of(self, place: str, name: str) -> Path:
        """Returns the file of an anchored asset path, which need not exist.

        Raises:
            InputError: The asset is outside of the folders.
        """
        return Path(self.check(place, name))

    def resolve(
        self, place: str, asset: Sdf.AssetPath, attribute: Usd.Attribute | None = None
    ) -> Path | None:
        """Returns the file of an asset; None: no such file.

        Args:
            place: Prim and attribute, for messages.
            asset: The asset.
            attribute: Attribute; a relative path starts from its layer.

        Raises:
            InputError: The file is outside of the folders.
        """
        name = asset.resolvedPath
        if not name and attribute is not None and asset.path:
            specs = attribute.GetPropertyStack(Usd.TimeCode.Default())
            name = anchored(specs[0].layer, asset.path) if specs else ""
        if not name:
            return None
        found = Path(self.check(place, name))
        if Ar.IsPackageRelativePath(str(found)):
            return found
        return found if is_input(found) else None


def package_of(name: str) -> str:
    """File of an asset; for a file inside of a package, the package."""
    return name.partition("[")[0] if Ar.IsPackageRelativePath(name) else name
