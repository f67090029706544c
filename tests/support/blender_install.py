"""Installs the extension's zip in Blender, renders with it, and prints where its modules lie.

Called with the zip. The package of this checkout is hidden, so that the zip's own is used.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import bpy

CHECKOUT = str(Path(__file__).resolve().parents[2])


def hide_checkout() -> None:
    """Forgets the editable package of this checkout."""
    others = [one for one in sys.meta_path if not type(one).__module__.startswith("_editable_")]
    sys.meta_path[:] = others
    sys.path[:] = [path for path in sys.path if not path.startswith(CHECKOUT + "/python")]


def main() -> None:
    hide_checkout()
    done = bpy.ops.extensions.package_install_files(
        filepath=sys.argv[1], repo="user_default", enable_on_install=True
    )
    import daguerre

    bpy.context.scene.render.engine = "DAGUERRE"
    facts = {
        "done": sorted(done),
        "package": daguerre.__file__,
        "core": sys.modules["daguerre._core"].__file__,
        "engine": bpy.context.scene.render.engine,
        "lens": bpy.context.scene.camera.data.daguerre.lens,
    }
    print("FACTS " + json.dumps(facts))


main()
