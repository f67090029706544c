"""Recognizes JSON lens files of other programs, and names a way to convert them."""

from __future__ import annotations

from daguerre.files.json_item import Item

#: Formats that are read, for errors.
READ = (
    "lens files that are read: JSON of daguerre-lens/0.1, Zemax .zmx, CODE V .seq, Optical Bench "
    ".txt, pbrt .dat"
)
#: Members that all must be there, the program, and a way.
_SIGNS = (
    ({"surface_group"}, "optiland", "export it as Zemax .zmx or CODE V .seq"),
    ({"optical_model"}, "ray-optics", "export it as Zemax .zmx or CODE V .seq"),
    ({"surfaces", "d_sensor"}, "DeepLens", "its GeoLens.write_lens_zmx writes Zemax .zmx"),
    ({"surfaces", "r_sensor"}, "DeepLens", "its GeoLens.write_lens_zmx writes Zemax .zmx"),
)


def refuse(root: Item) -> None:
    """Refuses a file without a schema, by the name of its program if that is known.

    Raises:
        InputError: It has none; the message names the formats that are read.
    """
    if root.get("schema") is not None:
        return
    members = {str(item.key) for item in root.members()}
    for sign, name, way in _SIGNS:
        if sign <= members:
            root.fail(f"a lens of {name}, which is not read: {way}; {READ}")
    root.fail(f"schema: missing; {READ}")
