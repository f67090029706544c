"""``--stats``: counts and times of a picture."""

from __future__ import annotations

import resource
from typing import TYPE_CHECKING

from daguerre.rendering.film_parts import area
from daguerre.rendering.light_paths import show_plan
from daguerre.rendering.progress import quantity
from daguerre.rendering.reporter import Finished

if TYPE_CHECKING:
    from daguerre.rendering.session import Session


def stats(result: Finished) -> dict[str, str]:
    """Counts and times by name."""
    usage, session, seconds = (
        resource.getrusage(resource.RUSAGE_SELF),
        result.session,
        result.seconds,
    )
    drawn = round(result.drawn * area(session.crop))
    rays = int(session.counters.rays)
    return {
        "set-up": f"{result.setup_s:.2f} s",
        "drawing": f"{seconds:.2f} s",
        "processor": f"{usage.ru_utime + usage.ru_stime:.2f} s",
        "camera samples": f"{drawn} ({quantity(drawn / seconds)} per s)",
        "stopped": _stopped(session),
        "rays": f"{rays} ({quantity(rays / seconds)} per s)",
        **_light(session),
        **_flare(session),
        **_scatter(session),
        "bad samples": str(session.bad_samples[0]),
        "peak memory": f"{usage.ru_maxrss / 1024:.0f} MB",
    }


def _stopped(session: Session) -> str:
    """Share of the camera's rays that carry no light."""
    counters = session.counters
    share = counters.stopped_rays / max(1, counters.camera_rays)
    return f"{share:.1%} of the camera's rays, by lens, iris or edge of the field"


def _light(session: Session) -> dict[str, str]:
    """Number of light paths, and of light paths that passed the lens and missed the frame."""
    counters, plan = session.counters, show_plan(session.light_paths)
    if plan is None:
        return {"light paths": "off"}
    return {
        "light paths": f"{counters.light_paths} ({plan} per sample), "
        f"{counters.splats_off_film} beside the frame"
    }


def _flare(session: Session) -> dict[str, str]:
    """Ghosts: number of paths, share of rays on the frame, bright spots."""
    counters = session.counters
    if not counters.flare_rays:
        return {}
    share = counters.flare_hits / counters.flare_rays
    return {
        **_flare_maps(session),
        "flare": f"{counters.flare_paths} paths, {share:.0%} of their rays on the frame",
        "highlights": f"{session.flare_spots} bright spots, by {session.survey_rays} rays",
    }


def _flare_maps(session: Session) -> dict[str, str]:
    """Ghosts drawn from maps, and the error of the maps by exact rays."""
    core, arrivals = session.light_plan.core, session.counters.flare_arrivals
    if not arrivals:
        return {}
    rays = core.flare_ghosts_by_rays
    beside = f", {rays} ghosts by rays alone" if rays else ""
    return {"flare maps": f"{arrivals} arrivals, maps off by {core.flare_map_error:.1%}{beside}"}


def _scatter(session: Session) -> dict[str, str]:
    """Paths of light scattered by the lens."""
    count = session.counters.scatter_paths
    if not count:
        return {}
    share = session.counters.scatter_hits / count
    return {"scatter": f"{count} paths, {share:.1%} of them to the frame"}
