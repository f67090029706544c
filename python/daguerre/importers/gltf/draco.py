"""Unpacks KHR_draco_mesh_compression: triangles and attributes of a primitive.

The accessors of such a primitive describe the unpacked arrays, and receive them. DracoPy (the extra
``compression``) unpacks the stream, and checks counts against its bytes.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.files import extras
from daguerre.files.json_item import Item
from daguerre.files.notes import Notes

from .accessors import Accessors

NAME = "KHR_draco_mesh_compression"
_MAX_BYTES = 8 << 30


def supply(
    primitive: Item, mode: int, attributes: dict[str, Item], accessors: Accessors, notes: Notes
) -> bool:
    """Gives the accessors of a compressed primitive their arrays.

    Args:
        primitive: The primitive.
        mode: Mode of the primitive.
        attributes: Attributes of the primitive, by name.
        accessors: Receive the arrays.
        notes: Receives a note if the file's uncompressed data are used.

    Returns:
        Whether the triangles are now a list, whatever the mode.

    Raises:
        InputError: The stream is damaged or does not fit the accessors, or DracoPy is missing.
    """
    extension = primitive.extension(NAME)
    if extension is None:
        return False
    package = extras.missing_for(NAME)
    if package:
        if not accessors.has_bytes(attributes["POSITION"]):
            extension.fail(extras.lack(package))
        notes.add(f"uncompressed data are used: {NAME} {extras.lack(package)}")
        return False
    if mode < 4 or mode > 5:
        primitive.need("mode").fail(f"wanted 4 or 5 with {NAME}, got {mode}")
    view = extension.need("bufferView")
    source = NAME, view.integer()
    uses = [*extension.need("attributes").members()]
    indices = primitive.get("indices")
    wanted = [attributes[str(use.key)] for use in uses if str(use.key) in attributes]
    if all(accessors.supplied(use, source) for use in wanted) and (
        indices is None or accessors.supplied(indices, source)
    ):
        return True
    accessors.check_size([*wanted, *([indices] if indices else [])], _MAX_BYTES)
    mesh = _decode(bytes(accessors.view_bytes(view)), extension)
    arrays = {a["unique_id"]: np.asarray(a["data"]) for a in mesh.attributes}
    for use in uses:
        name, identity = str(use.key), use.integer(0)
        if identity not in arrays:
            known = ", ".join(map(str, sorted(arrays)))
            use.fail(f"no such attribute in the stream: wanted one of {known}, got {identity}")
        if name in attributes:
            data = arrays[identity]
            accessors.supply(attributes[name], data.reshape(len(data), -1), source)
    if indices is not None:
        corners: NDArray[Any] = np.asarray(mesh.faces, np.uint32).reshape(-1, 1)
        accessors.supply(indices, corners, source, any_count=mode == 5)
    return True


def _decode(data: bytes, extension: Item) -> Any:
    try:
        mesh = import_module("DracoPy").decode(data)
    except Exception as error:  # DracoPy raises several types
        raise InputError(
            f"{extension.file}: {extension.path}: cannot be decoded: {error}"
        ) from None
    if not hasattr(mesh, "faces"):
        extension.fail("the stream is a point cloud, wanted triangles")
    return mesh
