"""Layers of catchers: light that objects take from a plate, and add to it.

F is the light of the set beside the objects, with the objects in the scene; F0 is the light of the
set in the whole pixel without objects; A is the coverage of the objects. A plate P is F0 as a
camera saw it. The picture over it is F plus the objects' own light, and with the usual *over* both
layers give exactly that:

    picture = RGB + (1 - A) P + catcher            catcher = F - (1 - A) F0
    picture = RGB + (1 - A) P catcher_ratio        catcher_ratio = F / ((1 - A) F0)

They differ where P is not F0: the ratio keeps details of the plate's materials that the scene
lacks, the difference keeps light that objects add where the plate is dark. Source of differential
rendering: Debevec 1998, Rendering Synthetic Objects into Real Scenes, section 6.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Plane = NDArray[np.float32]

#: Light below which a ratio is meaningless, relative exposure.
DARK = 1e-9


def layers(
    with_objects: Plane, without: Plane, alpha: Plane
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Returns the difference and the ratio.

    Args:
        with_objects: F, shape (H, W, C).
        without: F0, shape (H, W, C).
        alpha: A, shape (H, W).
    """
    left = (1 - alpha)[..., None] * without
    lit = left > DARK
    ratio = np.ones_like(left)
    np.divide(with_objects, left, out=ratio, where=lit)
    return np.asarray(with_objects - left), np.maximum(ratio, 0)
