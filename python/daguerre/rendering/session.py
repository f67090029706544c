"""Sessions: draw ranges of samples into one film; ``render`` is a complete session."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.cached import cached_property
from daguerre.camera.camera import Camera
from daguerre.camera.exposure_mode import is_automatic
from daguerre.checks import MAX_SAMPLES, shown, whole
from daguerre.errors import InputError, MismatchError, UsageError, core_errors
from daguerre.frame.frame import Frame
from daguerre.parameters.keywords import takes
from daguerre.scene.scene import Scene
from daguerre.setup.built_scene import BuiltScene
from daguerre.setup.metadata import camera_metadata

from . import identity
from .adaptive import PARTS, Round
from .backdrop import behind, over, shows_plate
from .columns import Columns, add_columns
from .film_frame import frame_of, set_film_state
from .film_parts import area
from .keywords import SettingsKeywords, settings_of
from .light_plan import plan_film, plan_light
from .parameters import TABLE
from .picture_truth import ground_truth, truth_planes
from .prepare import prepare
from .ranges import join_ranges
from .settings import RenderSettings
from .truth import GroundTruth, Moment

if TYPE_CHECKING:
    from .diffraction import Kernels

Progress = Callable[[float], bool]


@guarded(init=True)
@takes(TABLE, SettingsKeywords)
class Session:
    """A render in progress: scene, camera and a film of exact sums.

    The result is bit-identical for any split of the samples into ranges, in any order and on any
    number of threads.

    Args:
        scene: The scene.
        camera: Camera, or its name in the scene; default: the scene's own.
        settings: Render settings; the keywords override them.
        built: ``Session.built`` of another session of the same, unchanged scene; it is reused if
            both expose at the same time.
        piloted: ``light_plan.piloted`` of another session of the same picture; default: a pilot
            render finds how many light paths pay off, if their number is ``"auto"``.
        origin: Origin of the core's scene in the world, m, which pictures of a rig share; default:
            near the camera.
        {keywords}

    Raises:
        UsageError: A parameter is out of its range.
        InputError: The scene or the lens cannot be used.
    """

    @core_errors(InputError, "render")
    def __init__(
        self,
        scene: Scene,
        camera: Camera | str | None = None,
        *,
        settings: RenderSettings | None = None,
        built: BuiltScene | None = None,
        piloted: tuple[float, float] | None = None,
        origin: tuple[float, float, float] | None = None,
        **keywords: Unpack[SettingsKeywords],
    ) -> None:
        self.settings = settings_of(settings, keywords)
        self.metering: Mapping[str, Any] = {}
        metered: list[str] = []
        camera = camera if isinstance(camera, Camera) else scene.camera(camera)
        if is_automatic(camera.exposure):
            from .auto_exposure import choose

            chosen, built = choose(scene, camera, self.settings, built)
            camera, self.metering = chosen.of(camera), chosen.facts
            metered = [text for text in (chosen.note, chosen.warning) if text]
        self.prepared = prepared = prepare(scene, camera, self.settings, built, origin)
        self.light_plan = plan_light(prepared, piloted)
        self.scene, self.camera, self.built = prepared.scene, prepared.camera, prepared.built
        self.width, self.height = prepared.size
        self.crop, self.overscan, self.interval = (
            prepared.crop,
            prepared.overscan,
            prepared.interval,
        )
        self.notes = [*metered, *prepared.notes, *self.light_plan.notes]
        self.warnings = list(prepared.built.warnings)
        self.light_paths = self.light_plan.light_paths
        self.flare, self.scatter = self.light_plan.flare, self.light_plan.scatter
        self.flare_spots, self.survey_rays = self.light_plan.core.flare_survey
        self.counters = _core.RenderCounters()
        self.ranges: list[tuple[int, int]] = []
        self.round: Round | None = None  # of adaptive sampling, instead of more ranges
        self._film_plan = plan_film(prepared, self.light_plan)
        self._plate: NDArray[np.float32] | None = None  # background of all frames, made on demand
        self._kernels: Kernels = {}  # of diffraction, cached between frames
        self._torn = False  # a pass was stopped midway: the sums are of no use

    @property
    def focused_camera(self) -> Camera:
        """Camera with its resolved focus."""
        return self.prepared.focused_camera

    @property
    def torn(self) -> bool:
        """Whether a pass was stopped midway, which makes the sums invalid."""
        return self._torn

    @cached_property
    def _film(self) -> _core.Film:
        return self._film_plan.film()

    def _whole_film(self) -> _core.Film:
        if self._torn:
            raise UsageError(
                "session: a pass was stopped midway; restore saved sums with set_state, or make "
                "a new session"
            )
        return self._film

    def draw(self, begin: int, end: int, progress: Progress | None = None) -> bool:
        """Draws samples [begin, end) of every pixel.

        Args:
            begin: First sample index.
            end: One past the last.
            progress: Called with the fraction done, from any thread; returning False stops.

        Returns:
            False if stopped. The sums then contain part of the pass, so the session refuses to
            draw or to return a picture until ``set_state`` restores complete sums.
        """
        begin, end = self._new_range(begin, end)
        if self.round is not None:
            raise MismatchError("samples: wanted another round of adaptive sampling, got a range")
        if not self._add(_core.render, (begin, end), progress):
            return False
        self.ranges = join_ranges([*self.ranges, (begin, end)])
        return True

    def _new_range(self, begin: int, end: int) -> tuple[int, int]:
        """Checks a range of samples; samples already drawn are an error."""
        begin = whole(begin, "samples", 0, MAX_SAMPLES)
        end = whole(end, "samples", 0, MAX_SAMPLES)
        if not begin < end:
            raise UsageError(f"samples: wanted 0 <= a < b <= 2^31, got {begin}:{end}")
        for a, b in self.ranges:
            if begin < b and a < end:
                raise MismatchError(
                    f"samples: {begin}:{end} overlaps {a}:{b}, which is drawn already"
                )
        return begin, end

    def _planned_round(self) -> Round:
        """Round that is under way.

        Raises:
            UsageError: No round is under way.
        """
        if self.round is None:
            raise UsageError("draw_round: wanted a planned round, got none")
        return self.round

    def draw_round(self, until: int, progress: Progress | None = None) -> bool:
        """Draws the parts of ``round`` up to ``until``; see ``daguerre.rendering.adaptive``.

        Returns:
            False if stopped, see ``draw``.
        """
        now = self._planned_round()
        round = _core.SampleRound(now.begin, now.count, now.drawn, until)
        if not self._add(_core.render_round, (round,), progress):
            return False
        self._drew_round(now, until)
        return True

    def _drew_round(self, now: Round, until: int) -> None:
        self.round = replace(now, drawn=until)
        self.ranges = join_ranges([(0, int(self.sample_counts().min()))])

    @core_errors(InputError, "render")
    def _add(self, draw: Callable[..., Any], which: tuple[Any, ...], progress: Any) -> bool:
        film = self._whole_film()
        self._torn = True  # until the pass is complete; a second film would take as much memory
        all_pixels, done, counters = area(self.crop), 0, self.counters
        for part in self.light_plan.parts:
            report = _scaled(progress, done / all_pixels, part.pixels / all_pixels)
            corner = self.crop[0], self.crop[1]
            complete, found = part.draw(draw, self.prepared.core_scene, film, corner, which, report)
            if not complete:
                return False
            done += part.pixels
            counters += found
        self._torn, self.counters = False, counters
        return True

    @core_errors(InputError, "render")
    def frame(self, *, truth: bool = True, waves: bool = True, plate: bool = True) -> Frame:
        """Returns the picture of the samples drawn so far, with all requested channels.

        Args:
            truth: Whether to add ground truth.
            waves: Whether to add diffraction, which takes time.
            plate: Whether to composite over the plate, if that is the background.
        """
        aovs = self.settings.film.aovs
        frame = frame_of(
            self._whole_film(), self.metadata, aovs=aovs, waves=waves, kernels=self._kernels
        )
        frame = self.over_plate(frame) if plate else frame
        return self.with_truth(frame) if truth else frame

    def over_plate(self, frame: Frame) -> Frame:
        """Composites a frame over the scene's plate, if that is the background."""
        if not shows_plate(self.settings):
            return frame
        if self._plate is None:
            self._plate = behind(frame, self.scene.plate)
        return over(frame, self._plate)

    def with_truth(self, frame: Frame) -> Frame:
        """Adds channels of ground truth to a frame, made from scene and camera, not the sums."""
        if self.settings.truth.moment is None:
            return frame
        frame = replace(frame, aovs=frame.aovs | self._truth)
        if frame.motion is not None:
            missing = int(np.isnan(frame.motion[:, :, 0]).sum())
            frame.metadata["motion_missing"] = missing
        return frame

    @cached_property
    def ground_truth(self) -> GroundTruth:
        """Ground truth of scene and camera, at ``gt_time`` or else at mid-exposure."""
        return ground_truth(self.prepared, self.crop, self.overscan)

    @cached_property
    def _truth(self) -> dict[str, NDArray[Any]]:
        return truth_planes(self.prepared, self.ground_truth)

    def object_ids(self, moment: Moment) -> NDArray[np.uint32]:
        """Index + 1 of the instance that each pixel sees by ground truth, (H, W); 0: none.

        ``moment`` is the moment of ``ground_truth``, for reuse.
        """
        known = self.settings.truth.moment is not None
        return self._truth["object_id"] if known else self.ground_truth.object_ids(moment)

    @property
    def bad_samples(self) -> tuple[int, list[tuple[int, int, int]]]:
        """Number of dropped (NaN, Inf) samples, and (x, y, sample) of the first of them."""
        film = self._whole_film()
        return film.bad_sample_count, list(film.bad_samples)

    def sample_counts(self) -> NDArray[np.uint32]:
        """Number of samples drawn of each pixel, shape (H, W)."""
        return np.asarray(self._whole_film().sample_counts())

    def relative_variance(self, dark: float) -> NDArray[np.float32]:
        """Variance of one sample of each pixel over (its mean^2 + dark), shape (H, W)."""
        return np.asarray(self._whole_film().relative_variance(dark))

    def state(self) -> dict[str, NDArray[np.uint32]]:
        """Exact sums of the film as 32-bit words, (H, W, words) of the crop, by part.

        They are views of the film, not copies, so they change with further samples.
        """
        film = self._whole_film()
        return {part: film.state(part) for part in film.state_parts()}

    def set_state(
        self,
        state: dict[str, NDArray[np.uint32]],
        ranges: list[tuple[int, int]],
        round: Round | None = None,
    ) -> None:
        """Restores sums from ``state``, drawn from these sample ranges, or in rounds.

        Raises:
            MismatchError: A part is missing, unknown or of another size.
        """
        set_film_state(self._film, state, "film state")
        self._torn = False
        self.ranges = join_ranges(ranges)
        self.round = round

    def clear(self) -> None:
        """Forgets all samples."""
        self._film.clear()
        self._torn, self.ranges, self.round = False, [], None
        self.counters = _core.RenderCounters()

    @core_errors(InputError, "render")
    def add(
        self,
        sums: Mapping[str, Columns],
        samples: Sequence[tuple[int, int]] = (),
        until: int | None = None,
    ) -> None:
        """Adds sums that another session of the same picture drew.

        Args:
            sums: Columns of its ``state``, by part.
            samples: Ranges [begin, end) of samples of every pixel that it drew.
            until: End of the parts of ``round`` that it drew, which follow those drawn here.

        Raises:
            UsageError: The sums are not ``Columns``, or a range is empty or invalid.
            MismatchError: The sums have another layout, or samples are drawn already.
        """
        if not all(isinstance(one, Columns) for one in sums.values()):
            raise UsageError(f"sums: wanted columns by part, got {shown(sums)}")
        ranges = [self._new_range(begin, end) for begin, end in samples]
        until = None if until is None else whole(until, "until", 0, PARTS)
        add_columns(self._whole_film(), sums, "sums")
        if ranges:
            self.ranges = join_ranges([*self.ranges, *ranges])
        elif until is not None and self.round is not None:
            self._drew_round(self.round, until)

    @cached_property
    def key(self) -> dict[str, str]:
        """Key that passes must share to be added: hashes of scene, camera, settings, build."""
        return identity.key(self)

    def expose(self, camera: Camera, metering: Mapping[str, Any] | None = None) -> None:
        """Applies the exposure of another camera to later frames; keeps the samples.

        Args:
            camera: Camera that sees the same light.
            metering: Facts of the meter that chose its exposure; None: none did.

        Raises:
            MismatchError: The camera sees other light.
        """
        prepared = self.prepared.exposed(camera)
        self.prepared, self.camera, self.metering = prepared, prepared.camera, metering or {}
        self.notes = [*prepared.notes, *self.light_plan.notes]

    def exposed(self, frame: Frame) -> Frame:
        """Returns an earlier frame of this session with the current exposure."""
        prepared = self.prepared
        facts = camera_metadata(prepared.camera, prepared.setup, prepared.size[0])
        found = {**frame.metadata, **facts, "metering": None, **self.metering}
        kept = {name: value for name, value in found.items() if value is not None}
        return replace(frame, metadata=kept)

    @property
    def metadata(self) -> dict[str, Any]:
        """Camera and picture facts, in the names and units of the EXR attributes."""
        return {**identity.metadata(self), **self.metering}


def _scaled(progress: Progress | None, done: float, share: float) -> Progress | None:
    """Scales progress of a part of the film to the whole of it."""
    return None if progress is None else lambda fraction: progress(done + share * fraction)
