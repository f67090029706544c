"""Order of ``--crop``: four plain numbers were left, right, top, bottom before 1.0.0."""

from __future__ import annotations

from daguerre.camera.overscan import check_overscan
from daguerre.cli import console
from daguerre.errors import UsageError
from daguerre.rendering.pixels import Box, Crop, check_crop, crop_within
from daguerre.rendering.settings import Film, RenderSettings
from daguerre.units import edges_text

#: Version in which the old order may go (docs/stability.md).
GOES = "1.2.0"
_FAR = 1 << 31  # px


def placed(settings: list[RenderSettings], text: str | None, *, tell: bool) -> list[RenderSettings]:
    """Checks that a crop lies in each picture and its overscan, as far as they are known yet.

    Plain numbers that only fit the old order are taken in that order.

    Args:
        settings: Settings of all pictures; the crop is as typed.
        text: Value of ``--crop``; None: not given.
        tell: Whether to print the note or the warning on the order.

    Raises:
        UsageError: The crop lies outside of a picture, or is empty.
    """
    if text is None:
        return settings
    films, crop = [one.film for one in settings], check_crop(settings[0].film.crop)
    if "=" in text:
        _check(films, crop)
        return settings
    first, second, third, fourth = crop
    old = first, third, second, fourth
    if not _fits(films, crop) and _fits(films, old):
        if tell:
            console.warn(
                f"--crop {text}: the order left,right,top,bottom is deprecated and goes in {GOES}; "
                f"write --crop {edges_text(old)}"
            )
        return [one.with_(crop=old) for one in settings]
    _check(films, crop)
    if tell:
        console.note(
            f"--crop {text} is {edges_text(crop)}; before 1.0.0 the order was left,right,top,bottom"
        )
    return settings


def _fits(films: list[Film], crop: Crop) -> bool:
    try:
        _check(films, crop)
    except UsageError:
        return False
    return True


def _check(films: list[Film], crop: Crop) -> None:
    for film in films:
        crop_within(crop, _region(film), "--crop")


def _region(film: Film) -> Box:
    """Picture and overscan; as far as can be if the camera decides."""
    beside = check_overscan(film.overscan, film.resolution, "--overscan")
    return (-_FAR, -_FAR, _FAR, _FAR) if beside is None else beside.region(film.resolution)
