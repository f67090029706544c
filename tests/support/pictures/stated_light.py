"""Files of light that state their colours, and published matrices to linear Rec.709."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR

#: x and y of red, green, blue and white: SMPTE ST 2065-1; Academy S-2014-004; ITU-R BT.2020-2;
#: SMPTE EG 432-1; ISO 22028-2 (ProPhoto); ITU-R BT.709-6.
AP0 = (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.0770, 0.32168, 0.33767)
AP1 = (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767)
REC2020 = (0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290)
P3 = (0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290)
PROPHOTO = (0.7347, 0.2653, 0.1596, 0.8404, 0.0366, 0.0001, 0.3457, 0.3585)
REC709 = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)
XYZ = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1 / 3, 1 / 3)
#: Matrices to linear Rec.709. AP0 and AP1: aces-dev, "ACES to Rec.709" with Bradford from the ACES
#: white to D65; BT.2020: ITU-R BT.2407; P3: CSS Color 4; ProPhoto: CSS Color 4 (Bradford from D50);
#: XYZ: IEC 61966-2-1, to the digits of D65 in BT.709.
TO_REC709 = {
    AP0: [(2.52169, -1.13413, -0.38756), (-0.27648, 1.37272, -0.09624),
          (-0.01538, -0.15298, 1.16835)],
    AP1: [(1.70505, -0.62179, -0.08326), (-0.13026, 1.14080, -0.01055),
          (-0.02400, -0.12897, 1.15297)],
    REC2020: [(1.66049, -0.58764, -0.07285), (-0.12455, 1.13290, -0.00835),
              (-0.01815, -0.10058, 1.11873)],
    P3: [(1.22494, -0.22494, 0.0), (-0.04206, 1.04206, 0.0), (-0.01964, -0.07864, 1.09827)],
    PROPHOTO: [(2.03438, -0.72763, -0.30674), (-0.22880, 1.23173, -0.00293),
               (-0.00856, -0.15327, 1.16183)],
    XYZ: [(3.24097, -1.53738, -0.49861), (-0.96924, 1.87597, 0.04156),
          (0.05563, -0.20398, 1.05697)],
}  # fmt: skip


def exr(path: Path, pixels: Any, names: str = "RGB", **header: Any) -> Path:
    """Writes an OpenEXR file of floats, shape (H, W, C)."""
    planes = {
        name: np.ascontiguousarray(pixels[:, :, i], np.float32) for i, name in enumerate(names)
    }
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **header}
    with OpenEXR.File(header, planes) as file:
        file.write(str(path))
    return path


def hdr(path: Path, pixel: tuple[float, ...], lines: str = "", kind: str = "rgbe") -> Path:
    """Writes a Radiance picture of 4 x 2 equal pixels; their mantissas have 8 bits."""
    fraction, exponent = math.frexp(max(pixel))
    stored = bytes(round(c * fraction * 256 / max(pixel)) for c in pixel) + bytes([exponent + 128])
    head = f"#?RADIANCE\n{lines}FORMAT=32-bit_rle_{kind}\n\n-Y 2 +X 4\n"
    path.write_bytes(head.encode() + stored * 8)
    return path
