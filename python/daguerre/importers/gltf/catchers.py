"""Reads catchers in ``extras`` of a glTF node, where Blender keeps custom properties.

``"catcher": true`` enables all effects; a text names some: ``"shadow,gi"`` or ``"holdout"``.
"""

from __future__ import annotations

from daguerre.errors import UsageError
from daguerre.files.json_item import Item, short
from daguerre.scene.catcher import EFFECTS, check_effects
from daguerre.scene.scene import Scene


def mark_catcher(scene: Scene, name: str, node: Item) -> None:
    """Makes a node a catcher if its extras have ``catcher``.

    Raises:
        InputError: An effect is unknown, or the node has no mesh.
    """
    extras = node.value.get("extras")
    value = extras.get("catcher") if isinstance(extras, dict) else None
    if value is None or value is False or value == 0:
        return
    if not (isinstance(value, str) or value is True or value == 1):
        node.fail(f"extras.catcher: wanted true or names of effects, got {short(value)}")
    try:
        effects = check_effects(value, "extras.catcher") if isinstance(value, str) else EFFECTS
        scene.set_catcher(name, effects)
    except UsageError as error:
        node.fail(str(error))
