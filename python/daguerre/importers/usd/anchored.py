"""Makes asset paths absolute, from the layer that names them."""

from __future__ import annotations

import re
from pathlib import Path

from pxr import Ar, Sdf

#: Beginning of a URI, which names no file here.
SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+:")


def anchored(layer: Sdf.Layer, name: str) -> str:
    """Absolute path of an asset that a layer names, whether a file is there or not.

    A URI stays as it is. The path is empty for a layer without a file.
    """
    plain, _ = Sdf.Layer.SplitIdentifier(name)
    if not plain or Sdf.Layer.IsAnonymousLayerIdentifier(plain):
        return ""
    if SCHEME.match(plain):
        return str(plain)
    found = Sdf.ComputeAssetPathRelativeToLayer(layer, plain)
    if not Path(found).is_absolute():
        # A name without ./ is searched for, beside the stage as well; if in vain it stays as it is.
        found = str(Ar.GetResolver().Resolve(found)) or found
    return str(found if Path(found).is_absolute() else Path(layer.realPath).parent / found)
