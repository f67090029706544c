"""Exact lenses that are ready at once when the same lens was set up before."""

from __future__ import annotations

import daguerre._core as _core


def exact_lens(
    prescription: _core.Prescription,
    f_stop: float,
    iris: _core.Iris,
    focus_distance_m: float,
    half_diagonal_mm: float,
    *,
    focus_from_sensor: bool = False,
    film_z_mm: float = float("nan"),
    tilt_deg: tuple[float, float] = (0.0, 0.0),
    film_center_mm: tuple[float, float] = (0.0, 0.0),
    film_half_mm: tuple[float, float] = (0.0, 0.0),
) -> _core.ExactLens:
    """A lens at one focus and f-stop, ready to draw rays.

    Args:
        prescription: The lens, its gaps set for zoom and focus.
        f_stop: 0 for as wide as it opens.
        iris: Shape of the iris.
        focus_distance_m: Not used if ``film_z_mm`` is given.
        half_diagonal_mm: Farthest film point, shift included.
        focus_from_sensor: Whether the distance is from the film, else from the entrance pupil.
        film_z_mm: Place of the film in the lens frame; NaN: solved for the distance.
        tilt_deg: Turn of the lens about x, then y of the camera's frame, about its entrance pupil.
        film_center_mm: Middle of the part of the film that is used, upright.
        film_half_mm: Half its size; (0, 0): all within ``half_diagonal_mm``.

    Returns:
        The lens.

    Raises:
        ValueError: If the lens cannot open or focus like that.
    """
    return _core.ExactLens(
        prescription,
        f_stop,
        iris,
        focus_distance_m,
        focus_from_sensor,
        half_diagonal_mm,
        film_z_mm=film_z_mm,
        tilt_deg=tilt_deg,
        film_center_mm=film_center_mm,
        film_half_mm=film_half_mm,
    )
