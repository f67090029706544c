"""Development: white balance, highlights, colours, tone, sharpening, in this order."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import NDArray

from daguerre._core import Development, develop_picture
from daguerre._core import sharpen as sharpen_picture
from daguerre.argument_checks import guarded
from daguerre.camera.exposure_mode import meter_of, retaken_mode
from daguerre.checks import shown
from daguerre.color import illuminants, spaces
from daguerre.color.adaptation import adaptation
from daguerre.color.encodings import encoding_of_space, rec709_from
from daguerre.color.spectra import rgb_from_xyz
from daguerre.errors import UsageError
from daguerre.files import formats
from daguerre.frame.picture import Picture
from daguerre.parameters.keywords import takes

from .channels import XY, Channels, Demosaic, check_method, of_frame, of_raw
from .looks import encode_table, look_of, saturation, tone_table
from .parameters import DEVELOP, RecipeKeywords
from .white import white_of

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame
    from daguerre.frame.raw import Raw

FloatArray = NDArray[np.float64]
#: Standard deviation of the unsharp mask's Gaussian, px, about the blur of demosaicing.
SHARPEN_RADIUS = 0.8


@dataclass(frozen=True)
class Recipe:
    """Parameters of development; see ``develop``."""

    wb: Any
    look: str
    ev: float
    exposure: str | None
    meter: str
    colour_space: str
    sharpen: float
    grain: float
    highlights: str
    demosaic: str
    colour_noise: int
    seed: int

    @classmethod
    def of(cls, **keywords: Unpack[RecipeKeywords]) -> Recipe:
        """Makes a recipe from keywords, checked; others get defaults."""
        return cls(**DEVELOP.filled(keywords, "develop"))

    def __post_init__(self) -> None:
        if not isinstance(self.look, str):
            raise UsageError(f"develop: look: wanted a name, got {shown(self.look)}")
        check_method(self.demosaic)
        for name, parse in (("exposure", retaken_mode), ("meter", meter_of)):
            if (text := getattr(self, name)) is not None:
                if not isinstance(text, str):
                    raise UsageError(f"develop: {name}: wanted a name, got {shown(text)}")
                parse(f"develop: {name}", text)
        if not self.view:
            look_of(self.look)
        else:
            from .ocio import check_view

            check_view(self.view, self.colour_space)
        if spaces.COLOR_SPACES[self.colour_space].is_linear and self.look != "neutral":
            raise UsageError(
                f"develop: look {self.look}: colour_space {self.colour_space} is linear light, "
                "without a tone curve"
            )
        if self.grain and self.colour_space == spaces.CAMERA:
            raise UsageError("develop: grain: colour_space camera has no film; leave one out")

    @property
    def view(self) -> str:
        """Name of the OCIO view; empty: none."""
        return self.look.removeprefix("ocio:") if self.look.startswith("ocio:") else ""

    @property
    def demosaicing(self) -> Demosaic:
        """Options of demosaicing."""
        return Demosaic(self.demosaic, self.colour_noise, clip=self.highlights == "clip")


@takes(DEVELOP, RecipeKeywords)
@guarded(but=("source",))
def develop(source: Raw | Frame | Channels, **keywords: Unpack[RecipeKeywords]) -> Picture:
    """Develops a raw picture, or a frame as if from a perfect sensor (without sensor noise).

    In the exposure mode ``light`` a frame's 1 becomes white. In the others, and for raw pictures,
    brightness follows ISO 12232: an exposure of 10 / ISO lux s becomes middle grey, 118 of 255 in
    sRGB. Compensation acts in every mode. Colours outside the colour space are moved toward the
    grey of the same luminance.

    Args:
        source: Raw picture, frame, or channels.
        {keywords}

    Raises:
        UsageError: A parameter is wrong.
        InputError: A frame lacks exposure metadata; the message has the field.
    """
    recipe = Recipe.of(**keywords)
    source, recipe = _exposed(source, recipe)
    if recipe.colour_space == spaces.CAMERA:
        _check_camera(source)
    source = _channels(source, recipe.demosaicing)
    white = white_of(source, recipe.wb)
    if recipe.view or recipe.grain:
        pixels = _by_light(source, white, recipe)
    else:
        pixels = _shown(source, white, recipe)
    if recipe.sharpen:
        luminance = _luminance(recipe.colour_space).tolist()
        sharpen_picture(pixels, luminance, recipe.sharpen, SHARPEN_RADIUS)
    return Picture(pixels, recipe.colour_space, dict(source.metadata))


def _check_camera(source: object) -> None:
    """Checks that a source has colours of a camera.

    Raises:
        UsageError: It is a frame, which no sensor has taken.
    """
    from daguerre.frame.frame import Frame

    if isinstance(source, Frame):
        raise UsageError(
            "develop: colour_space camera: wanted a raw picture, got a frame, which no sensor has "
            "taken (--sensor takes it; in Python frame.expose)"
        )


def _exposed(source: object, recipe: Recipe) -> tuple[Any, Recipe]:
    """A frame in the mode of a recipe, and the rest of the recipe."""
    from daguerre.frame.frame import Frame

    if isinstance(source, Frame):
        from daguerre.exposure.retaken import retaken

        frame = retaken(source, recipe.exposure, recipe.meter, recipe.ev).frame
        return frame, replace(recipe, ev=0.0)
    if recipe.exposure is not None:
        raise UsageError("develop: exposure: a raw picture is already exposed; ev brightens it")
    return source, recipe


def _channels(source: object, demosaic: Demosaic) -> Channels:
    from daguerre.frame.frame import Frame
    from daguerre.frame.raw import Raw

    if isinstance(source, Raw):
        return of_raw(source, demosaic)
    if isinstance(source, Channels):
        return source
    if isinstance(source, Frame):
        return of_frame(source.without_overscan())
    raise UsageError(f"develop: source: wanted a raw picture or a frame, got {source!r:.60}")


@guarded
def save_raw(path: str | os.PathLike[str], raw: Raw, **look: object) -> None:
    """Writes a raw picture, as ``.dng`` or developed; see ``Raw.save``."""
    formats.write("raw", path, raw, **look)


def _balance(source: Channels, white: XY) -> FloatArray:
    """Factors that scale the white's values to 1 in each channel."""
    neutral = np.linalg.solve(source.xyz_from(white), illuminants.xyz_of_xy(white))
    return np.asarray(1 / (source.unit * np.maximum(neutral, 1e-6)))


def _rgb_from_balanced(source: Channels, white: XY, space: str) -> FloatArray:
    """Matrix from balanced channels to linear light of a colour space; equal channels are grey."""
    if space == spaces.CAMERA:
        return np.eye(3)
    balanced = source.unit * _balance(source, white)
    rgb = _space_from_709(space) @ rgb_from_xyz() @ adaptation(white, illuminants.D65_XY)
    return np.asarray(rgb @ source.xyz_from(white) / balanced)


def _space_from_709(space: str) -> FloatArray:
    if spaces.COLOR_SPACES[space].is_linear:
        return np.linalg.inv(np.array(rec709_from(encoding_of_space(space))))
    to, of = spaces.COLOR_SPACES[space], spaces.COLOR_SPACES["srgb"]
    return np.asarray(np.linalg.solve(spaces.xyz_from_rgb(to), spaces.xyz_from_rgb(of)))


def _luminance(space: str) -> FloatArray:
    if space == spaces.CAMERA:
        return np.full(3, 1 / 3)
    return np.asarray(spaces.xyz_from_rgb(spaces.COLOR_SPACES[space])[1])


def _shown(source: Channels, white: XY, recipe: Recipe) -> NDArray[np.float32]:
    """Develops in one pass over the pixels."""
    space, look = recipe.colour_space, look_of(recipe.look)
    luminance, gain = _luminance(space), 2.0**recipe.ev
    balance = _balance(source, white)
    matrix = gain * saturation(look.color, luminance) @ _rgb_from_balanced(source, white, space)
    full = float((source.full * balance).min()) * gain
    return _pass(source, balance, matrix, recipe, tone_table(look, full), encode_table(space))


def _pass(
    source: Channels,
    balance: FloatArray,
    matrix: FloatArray,
    recipe: Recipe,
    tone: list[float] | None,
    encode: list[float] | None,
) -> NDArray[np.float32]:
    out = np.empty(source.pixels.shape, np.float32)
    how = Development(
        balance=balance.tolist(),
        full=source.full.tolist(),
        highlights=recipe.highlights,
        rgb_from_balanced=matrix.ravel().tolist(),
        luminance=_luminance(recipe.colour_space).tolist(),
        tone=tone,
        encode=encode,
    )
    develop_picture(source.pixels, out, how)
    return out


def _by_light(source: Channels, white: XY, recipe: Recipe) -> NDArray[np.float32]:
    """Develops in two passes, with scene light in between, as grain and OCIO need."""
    gain = 2.0**recipe.ev
    balance = _balance(source, white)
    matrix = gain * _rgb_from_balanced(source, white, "srgb")
    light = _pass(source, balance, matrix, recipe, None, None)
    if recipe.grain:
        light = _with_grain(light, recipe, source)
    if recipe.view:
        from .ocio import view_of

        return view_of(light, recipe.view, recipe.colour_space)
    space, look = recipe.colour_space, look_of(recipe.look)
    full = float((source.full * balance).min()) * gain
    matrix = saturation(look.color, _luminance(space)) @ _space_from_709(space)
    grained = Channels(
        light, np.ones(3), np.full(3, math.inf), source.xyz_from, white, source.metadata
    )
    tone = tone_table(look, full)
    return _pass(grained, np.ones(3), matrix, recipe, tone, encode_table(space))


def _with_grain(
    light: NDArray[np.float32], recipe: Recipe, source: Channels
) -> NDArray[np.float32]:
    from daguerre.post.effects.grain import grain

    size = source.metadata.get("sensorOverallDimensions")
    if size is None:
        raise UsageError(
            "develop: grain: wanted the sensor's size in the frame's metadata "
            "(sensorOverallDimensions), got none"
        )
    sensor = tuple(float(value) for value in size)
    # Colours outside Rec.709 are negative here; grain needs light of at least 0.
    positive = np.maximum(light, 0)
    return grain(positive, size=recipe.grain, sensor=sensor, seed=recipe.seed)
