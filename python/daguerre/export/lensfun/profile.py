"""A profile of a lens: models of lensfun at its focal lengths, f-stops and distances."""

from __future__ import annotations

from dataclasses import dataclass

from daguerre.argument_checks import guarded
from daguerre.files.value import BriefRecord

from .frame import Frame
from .models import Fit
from .traced import Geometry, Vignetting

WELL = 0.3  # px RMS at 24 MP; a model with a larger residual does not fit well


@guarded
@dataclass(frozen=True, repr=False)
class LensfunProfile(BriefRecord):
    """A profile of a lens for lensfun.

    Attributes:
        maker: Maker of the lens.
        name: Name of the lens.
        frame: Frame of the film that it is for.
        model: Model of distortion, the same at all focal lengths: ``poly5`` or ``ptlens``.
        geometry: Distortion and lateral colour by focal length, ascending.
        vignetting: Vignetting by focal length, f-stop and distance.
    """

    maker: str
    name: str
    frame: Frame
    model: str
    geometry: tuple[Geometry, ...]
    vignetting: tuple[Vignetting, ...]

    @property
    def distortion(self) -> tuple[Fit, ...]:
        """Distortion by focal length, with residuals in px at 24 MP."""
        return tuple(setting.distortion[self.model] for setting in self.geometry)

    @property
    def residual_px(self) -> float:
        """Residual of distortion: RMS over the frame, px at 24 MP, at the worst focal length."""
        return max(fit.rms for fit in self.distortion)

    @property
    def fits(self) -> bool:
        """Whether the residual of distortion is below 0.3 px."""
        return self.residual_px < WELL
