"""A raw picture: digital numbers read from a sensor, and data of the shot."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.errors import InputError
from daguerre.files import formats
from daguerre.files.array_value import ArrayValue
from daguerre.sensors.sensor import Sensor

if TYPE_CHECKING:
    import os

    from .picture import Picture


@guarded(init=True)
@dataclass(eq=False)
class Raw(ArrayValue, array="mosaic"):
    """A raw picture: digital numbers behind a colour filter mosaic.

    NumPy takes it for its ``mosaic``.

    Attributes:
        mosaic: Digital numbers of the photosites, uint16, shape (H, W).
        sensor: Sensor that took the picture.
        iso: ISO setting.
        black_level: DN without light.
        white_level: DN at which a photosite is saturated.
        gain: DN per electron.
        neutral: Signal of a white surface above black under the light of the white balance, its
            strongest channel 1, shape (C,): the "as shot neutral" of DNG.
        white_balance: White point of the white balance, chromaticity (x, y).
        metadata: Data of the shot: ``expTime`` (s), ``aperture``, ``lensModel``, ...
        clipped: True where the photosite was full or the number the highest, shape (H, W); None:
            derived from the numbers.
        luminance_exposure: Luminance exposure of each photosite, lux s, shape (H, W); None:
            unknown.
        notes: Remarks for the user.
    """

    mosaic: NDArray[np.uint16]
    sensor: Sensor
    iso: float
    black_level: int
    white_level: int
    gain: float
    neutral: NDArray[np.float64]
    white_balance: tuple[float, float]
    metadata: dict[str, Any] = field(default_factory=dict)
    clipped: NDArray[np.bool_] | None = None
    luminance_exposure: NDArray[np.float32] | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.mosaic.ndim != 2 or self.mosaic.dtype != np.uint16:
            raise InputError(
                f"raw: mosaic: wanted uint16 of shape (H, W), got {self.mosaic.dtype} of shape "
                f"{self.mosaic.shape}"
            )
        if not self.black_level < self.white_level:
            raise InputError(
                f"raw: white_level: wanted more than the black level of {self.black_level} DN, "
                f"got {self.white_level}"
            )

    @property
    def width(self) -> int:
        """Columns, px."""
        return int(self.mosaic.shape[1])

    @property
    def height(self) -> int:
        """Rows, px."""
        return int(self.mosaic.shape[0])

    @property
    def saturated(self) -> NDArray[np.bool_]:
        """Mask of photosites that were full or at the highest number, shape (H, W)."""
        if self.clipped is not None:
            return self.clipped
        return np.asarray(self.mosaic >= self.white_level)

    def exposure(self) -> NDArray[np.float32]:
        """True luminance exposure of each photosite, without noise, lux s, shape (H, W).

        Raises:
            InputError: It is unknown, as the picture was read from a file.
        """
        if self.luminance_exposure is None:
            raise InputError("raw: exposure: unknown, as the picture was read from a file")
        return self.luminance_exposure

    def electrons(self) -> NDArray[np.float32]:
        """Numbers of the file converted to electrons, with their noise, shape (H, W)."""
        above = self.mosaic.astype(np.float32) - np.float32(self.black_level)
        return np.asarray(above / np.float32(self.gain), np.float32)

    def channel_map(self) -> NDArray[np.uint8]:
        """Index of the channel of every photosite, shape (H, W)."""
        return self.sensor.pattern.channel_map(self.height, self.width)

    def develop(self, **look: object) -> Picture:
        """Develops the raw picture; see ``daguerre.development.develop``."""
        from daguerre.development.recipe import develop

        return develop(self, **dict[str, Any](look))

    def save(self, path: str | os.PathLike[str], **look: object) -> None:
        """Writes the raw picture atomically; the suffix chooses the format.

        Args:
            path: ``.dng`` keeps the numbers; other formats are developed first.
            look: Look of developed files; see ``daguerre.development.develop``.
        """
        formats.write("raw", path, self, **look)

    def __repr__(self) -> str:
        return f"<Raw {self.width}x{self.height}, {self.sensor.name}, ISO {self.iso:g}>"
