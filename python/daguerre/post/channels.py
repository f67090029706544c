"""Finds the channels of a file that hold depth or motion; renderers name them differently."""

from __future__ import annotations

from daguerre.errors import InputError

from .picture import Canvas

#: Usual names by role, Daguerre's first; case does not matter.
USUAL = {
    "depth": ("depth.Z", "Z", "depth.V", "depth.R", "depth", "ViewLayer.Depth.Z"),
    "motion.u": ("motion.U", "motion.X", "Vector.X", "velocity.X", "forward.u", "motionvector.R"),
    "motion.v": ("motion.V", "motion.Y", "Vector.Y", "velocity.Y", "forward.v", "motionvector.G"),
}
BACK: tuple[str, ...] = ("motion_back.U", "motion_back.V")  # to the frame before
PARTS = {"motion": ("motion.u", "motion.v")}


def roles_of(need: str) -> tuple[str, ...]:
    """Roles of the channels for a need; "motion" needs two."""
    return PARTS.get(need, (need,))


def find(canvas: Canvas, role: str) -> str:
    """Finds the channel for a role: the channel that the user named, else one of a usual name.

    Raises:
        InputError: There is no such channel; the message lists the channels of the file.
    """
    given = canvas.roles.get(role)
    wanted = (given,) if given is not None else USUAL[role]
    names = {name.lower(): name for name in canvas.planes}
    for name in wanted:
        if name.lower() in names:
            return names[name.lower()]
    have = ", ".join(canvas.planes[:24]) or "only colour"
    raise InputError(
        f"{canvas.where}: channel for {role}: wanted {' or '.join(wanted)}, got {have} "
        f"(--channel {role}=NAME sets another)"
    )
