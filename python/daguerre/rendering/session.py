"""Pictures: a session draws ranges of samples into one film; ``render`` is the whole of it."""

from __future__ import annotations

import hashlib
import json
import math
import operator
import platform
import time
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre import sensors
from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.camera.exposure import without_exposure
from daguerre.camera.overscan import NONE, Overscan, check_overscan
from daguerre.checks import MAX_RESOLUTION, MAX_SAMPLES, short, whole
from daguerre.distortion.overscan import note as overscan_note
from daguerre.distortion.overscan import to_undistort
from daguerre.distortion.rectified import RectifiedView
from daguerre.errors import InputError, MismatchError, UsageError, suggest
from daguerre.frame.frame import Frame
from daguerre.frame.seen_by import sensor_metadata
from daguerre.scene.scene import Scene
from daguerre.sensors.bands import check_bands, responses
from daguerre.setup.body import scatter_facts
from daguerre.setup.built_scene import BuiltScene
from daguerre.setup.camera import set_up
from daguerre.setup.checks import check_surfaces
from daguerre.setup.metadata import camera_metadata, facts_of

from .adaptive import Round
from .diffraction import Diffraction, check_diffraction, with_bands
from .diffraction import plan as plan_waves
from .film_frame import frame_of, set_film_state
from .film_parts import Box, FilmPart, area, core_settings, frame_around, inside
from .light_paths import (
    OFF,
    TECHNIQUES,
    Plan,
    check_highlights,
    check_light_paths,
    check_paths,
    check_used,
    show_plan,
)
from .light_paths import PER_PIXEL as FLARE_PER_PIXEL
from .light_paths import PER_PIXEL as SCATTER_PER_PIXEL
from .ranges import join_ranges
from .truth import GroundTruth, Moment, check_gt_lens, check_gt_time, focused

Progress = Callable[[float], bool]
FILTERS = ("box", "gaussian", "blackman_harris", "mitchell")


class Session:
    """A render in progress: scene, camera and a film of exact sums.

    Any split of the samples into ranges, in any order and on any number of threads, gives the same
    bits.

    Args:
        scene: The scene.
        camera: Camera, or its name in the scene; default: the scene's own.
        resolution: Width and height of the picture, px.
        seed: Seed of all random numbers.
        filter: box, gaussian, blackman_harris or mitchell; ``"name:radius"`` sets the radius in px.
        aovs: Whether to keep depth, normal, position, albedo and object id.
        crop: Pixel region (x0, y0, x1, y1) to draw, end exclusive; default: all.
        overscan: Pixels to draw beside the picture (``docs/plates.md``): a number for all sides,
            ``"10%"``, (left, top, right, bottom), or ``"undistort"``: as many as a later
            undistortion needs. The picture keeps its bits.
        threads: Number of threads; 0: all cores.
        max_depth: Largest number of surfaces at which a path scatters.
        strategy: mis, or light or bsdf alone (to check one against the other).
        gt_time: open, mid or close: depth, distance, P, N, object_id and material_id are exact
            values at that moment of each pixel's exposure (``docs/ground-truth.md``), instead of
            means over the samples.
        gt_lens: Rays for ground truth: chief, the one of the pixel's centre; mean: means over those
            that expose the pixel then, with their share that meets a surface as ``coverage.Y``.
        gt_rays: Rays per pixel for ``gt_lens="mean"``; default: 64, the same ones each time.
        motion: Whether to add ``motion`` and ``motion_back``, where things go and come from, px;
            at mid unless ``gt_time`` is given.
        dispersion: Treatment of a path's other wavelengths by an exact lens: reproject, or
            end_secondary (the plain reference; noisier).
        light_paths: Light followed from the emitters to the film, beside the paths from the
            lens (``docs/light-paths.md``): auto, off, or paths per sample index, straight to the
            lens and with bounces, as (M1, M2).
        flare: Ghosts of an exact lens (``docs/flare.md``): off, auto, or paths per sample index.
        flare_order: Number of reflections of ghosts: 2, or 4 for both 2 and 4.
        flare_highlights: Whether light that mirrors, glass and walls send to the lens has ghosts,
            too: on or off.
        scatter: Light that barrel, blades and surfaces of an exact lens scatter
            (``docs/scatter.md``): off, auto, or paths per sample index.
        diffraction: Whether light is a wave at the iris (``docs/diffraction.md``): True, or a
            ``Diffraction`` with the number of bands and zones.
        bands: Number of wavelength bands that the frame keeps (``frame.bands``), from which any
            sensor's channels can be made later; 0: none.
        technique: Technique for light that both could find: both, or camera or light alone (to
            check one against the other).
        built: ``Session.built`` of another session of this scene, unchanged since: it is reused
            where both look at the same time.

    Raises:
        UsageError: A parameter is out of its range.
        InputError: The scene or the lens cannot be used.
    """

    def __init__(
        self,
        scene: Scene,
        camera: Camera | str | None = None,
        *,
        resolution: tuple[int, int] = (960, 540),
        seed: int = 0,
        filter: str = "blackman_harris",
        aovs: bool = False,
        gt_time: str | None = None,
        gt_lens: str = "chief",
        gt_rays: int | None = None,
        motion: bool = False,
        crop: tuple[int, int, int, int] | None = None,
        overscan: Any = None,
        threads: int = 0,
        max_depth: int = 16,
        strategy: str = "mis",
        dispersion: str = "reproject",
        light_paths: str | float | tuple[float, float] = "auto",
        flare: str | float = "off",
        flare_order: int = 2,
        flare_highlights: bool | str = True,
        scatter: str | float = "off",
        technique: str = "both",
        diffraction: bool | Diffraction = False,
        bands: int = 0,
        built: BuiltScene | None = None,
    ) -> None:
        self.width, self.height = size = check_resolution(resolution)
        wanted_overscan = check_overscan(overscan, size)
        kind, radius = _filter(filter)
        seed = whole(seed, "seed", 0, (1 << 64) - 1, "0 .. 2^64 - 1")
        threads = whole(threads, "threads", 0, 1024, "0 (all) .. 1024")
        max_depth = whole(max_depth, "max_depth", 1, 4096)
        wanted = check_light_paths(light_paths)
        flare_paths = check_paths(flare, "flare")
        if flare_order not in (2, 4):
            raise UsageError(f"flare_order: wanted 2 or 4, got {short(flare_order)}")
        flare_highlights = check_highlights(flare_highlights)
        scatter_paths = check_paths(scatter, "scatter")
        check_used(
            {"flare_order": flare_order != 2, "flare_highlights": not flare_highlights},
            flare=flare_paths != 0,
            scatter=scatter_paths != 0,
        )
        self.bands = check_bands(bands)
        self.diffraction = with_bands(check_diffraction(diffraction), self.bands)
        if technique not in TECHNIQUES:
            raise UsageError(f"technique: wanted {', '.join(TECHNIQUES)}; got {short(technique)}")
        if not isinstance(scene, Scene):
            raise UsageError(f"scene: wanted a Scene, got {short(scene)}")
        self.scene = scene
        self.camera = camera if isinstance(camera, Camera) else scene.camera(camera)
        if not isinstance(aovs, bool | np.bool_):
            raise UsageError(f"aovs: wanted True or False (all of them or none), got {short(aovs)}")
        self.aovs = bool(aovs)
        self.gt_lens, self.gt_rays = gt_lens, check_gt_lens(gt_lens, gt_rays)
        wanted_truth = motion or gt_lens == "mean"
        self.gt_time, self.motion = check_gt_time(gt_time, wanted=wanted_truth), motion
        started = time.perf_counter()
        self.interval = shutter.interval(self.camera, scene.time, (self.width, self.height))
        if built is None or not built.shows(scene, self.interval):
            built = BuiltScene(scene, self.interval)
        self.built, self._core_scene = built, built.core
        self.warnings = list(built.warnings)
        self._setup = set_up(scene, self.camera, size, self._core_scene)
        self.notes = list(self._setup.notes)
        self.overscan = self._to_undistort() if wanted_overscan is None else wanted_overscan
        self.crop = _crop(crop, self.overscan.region(size))
        self.sensor = None if self.camera.sensor is None else sensors.load(self.camera.sensor)
        self._pupils = self._plan_waves()
        self.setup_seconds = time.perf_counter() - started
        options = {
            "seed": seed,
            "threads": threads,
            "filter": _core.Filter(kind, radius),
            "max_depth": max_depth,
            "strategy": strategy,
            "dispersion": dispersion,
            "technique": technique,
            "flare_order": flare_order,
            "flare_highlights": flare_highlights,
        }
        core_shutter = shutter.core_shutter(self.camera, size)
        try:
            self._settings = core_settings(self._setup, size, core_shutter, NONE, options)
        except ValueError as error:
            raise UsageError(str(error)) from None
        self._window = inside(self.crop, size)
        plan = self._plan() if wanted is None else wanted
        # The frame decides which plan pays; a crop gets the share that it has of its pixels.
        shared = self._share(area(self._window)) if wanted is None else 1.0
        self.light_paths = (plan[0] * shared, plan[1] * shared)
        self._settings.light_paths = self.light_paths
        self._settings.prepare_light(self._core_scene, self._setup.core)
        dark = "no light of this scene makes a ghost in this lens"
        self.flare = self._prepare("flare", flare_paths, FLARE_PER_PIXEL, dark)
        dark = "the scene has no lights, or the lens scatters nothing"
        self.scatter = self._prepare("scatter", scatter_paths, SCATTER_PER_PIXEL, dark)
        self._parts = self._parts_of(plan, wanted is None, core_shutter, options)
        self._film = self._new_film()
        self._torn = False  # a pass was stopped midway: the sums are of no use
        self.ranges: list[tuple[int, int]] = []
        self.round: Round | None = None  # of adaptive sampling, instead of more ranges
        self.rays = self.camera_rays = self.stopped_rays = self.samples = 0
        self.light_path_count = self.splats_off_film = 0
        self.flare_spots, self.survey_rays = self._settings.flare_survey
        self.flare_path_count = self.flare_rays = self.flare_hits = 0
        self.scatter_path_count = self.scatter_hits = 0
        self._identity = {
            "resolution": [self.width, self.height],
            "crop": list(self.crop),
            "seed": seed,
            "filter": kind,
            "filter_radius": radius,
            "max_depth": max_depth,
            "aovs": aovs,
            "strategy": strategy,
            "dispersion": dispersion,
            "light_paths": list(self.light_paths),
            "technique": technique,
        }
        if self.flare > 0:
            self._identity |= {"flare": self.flare, "flare_order": flare_order}
        if self.scatter > 0:
            self._identity |= {"scatter": self.scatter, "scatters": self._scatters()}
        if self.flare > 0 or self.scatter > 0:
            self._identity |= {"flare_highlights": flare_highlights}
        if self._pupils is not None:
            self._identity["pupils"] = _hash_json(self._pupils)
        if self.sensor is not None:
            self._identity["sensor"] = self.sensor.hash
        if self.bands:
            self._identity["bands"] = self.bands
        if self.overscan:
            self._identity["overscan"] = str(self.overscan)

    @property
    def focused_camera(self) -> Camera:
        """Camera with the focus that autofocus found."""
        return focused(self.camera, self._setup.lens.focus_distance_m)

    def _plan(self) -> Plan:
        """Chooses the light paths that pay in this scene."""
        m1, m2 = _core.pilot(self._core_scene, self._setup.core, self._settings)
        return m1, m2

    def _share(self, pixels: int) -> float:
        return pixels / (self.width * self.height)

    def _to_undistort(self) -> Overscan:
        size = (self.width, self.height)
        found = to_undistort(RectifiedView(self.focused_camera, size, scene=self.scene))
        self.notes.append(overscan_note(found))
        return found

    def _parts_of(
        self, plan: Plan, shared: bool, core_shutter: _core.Shutter, options: dict[str, Any]
    ) -> list[FilmPart]:
        """The picture, and what lies around it, where the crop has any of them."""
        size, inner = (self.width, self.height), area(self._window)
        parts = []
        if inner:
            if self.overscan:
                self._settings.window = self._window
            parts.append(FilmPart(self._setup.core, self._settings, (0, 0), inner))
        outer = area(self.crop) - inner
        if not outer:
            return parts
        setup = set_up(self.scene, self.focused_camera, size, self._core_scene, self.overscan)
        settings = core_settings(setup, size, core_shutter, self.overscan, options)
        grown = self._share(area(self.overscan.region(size)))
        times = self._share(outer) if shared else grown
        settings.light_paths = (plan[0] * times, plan[1] * times)
        settings.prepare_light(self._core_scene, setup.core)
        for name in ("flare", "scatter"):
            paths = getattr(self, name)
            if paths and getattr(settings, f"prepare_{name}")(self._core_scene, setup.core):
                setattr(settings, name, paths * grown)
        parts.append(FilmPart(setup.core, settings, (self.overscan.left, self.overscan.top), outer))
        return parts

    def _prepare(self, name: str, paths: float | None, per_pixel: float, dark: str) -> float:
        """Paths per sample index of flare or scatter, of a crop those of its frame; 0: none."""
        if paths == 0:
            return 0.0
        check_surfaces(self._setup.lens.model, name)
        prepare = getattr(self._settings, f"prepare_{name}")
        try:
            shines = prepare(self._core_scene, self._setup.core)
        except ValueError as error:
            raise InputError(f"{name}: {error}") from None
        if not shines:
            self.notes.append(f"{name}: {dark}")
            return 0.0
        wanted = per_pixel * self.width * self.height if paths is None else paths
        setattr(self._settings, name, wanted)
        return float(wanted)

    def _scatters(self) -> dict[str, Any]:
        """Scatter of the parts of the lens."""
        return scatter_facts(self.camera)

    def _plan_waves(self) -> dict[str, Any] | None:
        """The pupils of mid-shutter, if light is diffracted."""
        if self.diffraction is None:
            return None
        camera = self.camera.frozen_at(0.5 * (self.interval[0] + self.interval[1]))
        resolution = (self.width, self.height)
        frame, middle = frame_around(self._setup, resolution, self.overscan)
        setup = replace(self._setup, frame_size_mm=frame, shift_mm=middle)
        grown = self.overscan.grown(resolution)
        return plan_waves(self.diffraction, camera, setup, grown, self.sensor)

    def _new_film(self) -> _core.Film:
        x0, y0, x1, y1 = self.crop
        followed = any(part.settings.light_paths != OFF for part in self._parts)
        layers = (self.aovs, followed, self.flare > 0 or self.scatter > 0)
        bands = self.diffraction.bands if self.diffraction is not None else self.bands
        region = (x1 - x0, y1 - y0, x0, y0)
        if self.sensor is None:
            return _core.Film(*region, *layers, bands=bands)
        curves = responses(self.sensor)
        film = _core.Film(*region, *layers, bands=bands, channels=len(curves))
        film.set_responses(curves)
        return film

    def _whole_film(self) -> _core.Film:
        if self._torn:
            raise UsageError(
                "session: a pass was stopped midway; wanted set_state with saved sums, or a new one"
            )
        return self._film

    def draw(self, begin: int, end: int, progress: Progress | None = None) -> bool:
        """Draws samples [begin, end) of every pixel.

        Args:
            begin: First sample index.
            end: One past the last.
            progress: Called with the fraction done, from any thread; returning False stops.

        Returns:
            False if stopped. Part of the pass is in the sums then, so the session refuses to go
            on, or to give a picture, until ``set_state`` brings sums that are whole.
        """
        begin = whole(begin, "samples", 0, MAX_SAMPLES)
        end = whole(end, "samples", 0, MAX_SAMPLES)
        if not begin < end:
            raise UsageError(f"samples: wanted 0 <= a < b <= 2^31, got {begin}:{end}")
        for a, b in self.ranges:
            if begin < b and a < end:
                raise MismatchError(
                    f"samples: {begin}:{end} overlaps {a}:{b}, which is drawn already"
                )
        if self.round is not None:
            raise MismatchError("samples: wanted another round of adaptive sampling, got a range")
        if not self._add(_core.render, (begin, end), progress):
            return False
        self.ranges = join_ranges([*self.ranges, (begin, end)])
        return True

    def draw_round(self, until: int, progress: Progress | None = None) -> bool:
        """Draws the parts of ``round`` up to ``until``; see ``daguerre.rendering.adaptive``.

        Returns:
            False if stopped, see ``draw``.
        """
        if self.round is None:
            raise UsageError("draw_round: wanted a planned round, got none")
        begin, count, drawn = self.round.begin, self.round.count, self.round.drawn
        if not self._add(_core.render_round, (begin, count, drawn, until), progress):
            return False
        self.round = replace(self.round, drawn=until)
        self.ranges = join_ranges([(0, int(self.sample_counts().min()))])
        return True

    def _add(self, draw: Callable[..., Any], which: tuple[Any, ...], progress: Any) -> bool:
        film = self._whole_film()
        self._torn = True  # until the pass is complete; a second film would take as much memory
        all_pixels, done, counts = area(self.crop), 0, np.zeros(10, np.int64)
        for part in self._parts:
            told = _share_of(progress, done / all_pixels, part.pixels / all_pixels)
            corner = self.crop[0], self.crop[1]
            complete, found = part.draw(draw, self._core_scene, film, corner, which, told)
            if not complete:
                return False
            done += part.pixels
            counts += found
        self._torn = False
        camera_rays, stopped, rays, light_paths, off_film, *flare = counts.tolist()
        self.camera_rays += camera_rays
        self.stopped_rays += stopped
        self.rays += rays
        self.light_path_count += light_paths
        self.splats_off_film += off_film
        self.flare_path_count += flare[0]
        self.flare_rays += flare[1]
        self.flare_hits += flare[2]
        self.scatter_path_count += flare[3]
        self.scatter_hits += flare[4]
        self.samples += camera_rays
        return True

    def frame(self, *, truth: bool = True, waves: bool = True) -> Frame:
        """Returns the picture of the samples drawn so far, with all channels asked for.

        Args:
            truth: Whether to add ground truth.
            waves: Whether to add diffraction, which takes time.
        """
        frame = frame_of(self._whole_film(), self.metadata, aovs=self.aovs, waves=waves)
        return self.with_truth(frame) if truth else frame

    def with_truth(self, frame: Frame) -> Frame:
        """Adds the channels of ``gt_time`` to a frame: by scene and camera, not by the sums."""
        if self.gt_time is None:
            return frame
        frame = replace(frame, aovs=frame.aovs | self._truth)
        if frame.motion is not None:
            missing = int(np.isnan(frame.motion[:, :, 0]).sum())
            frame.metadata["motion_missing"] = missing
        return frame

    @cached_property
    def ground_truth(self) -> GroundTruth:
        """Ground truth of scene and camera, without samples: at ``gt_time``, or at mid."""
        return self._truth_of(self.crop, self.overscan)

    def _truth_of(self, region: Box, overscan: Overscan) -> GroundTruth:
        return GroundTruth(
            self.scene,
            self.focused_camera,
            (self.width, self.height),
            region,
            self.gt_time or "mid",
            self.gt_lens,
            self.gt_rays,
            self._settings.threads,
            None if self.scene.motion else self._core_scene,
            overscan,
        )

    @cached_property
    def _truth(self) -> dict[str, NDArray[Any]]:
        planes = self.ground_truth.planes(motion=self.motion)
        if self.overscan and area(self._window):  # has the bits that it has without overscan
            (left, top), (x0, y0, x1, y1) = self.crop[:2], self._window
            part = np.s_[y0 - top : y1 - top, x0 - left : x1 - left]
            own = self._truth_of(self._window, NONE).planes(motion=self.motion)
            for name, plane in own.items():
                planes[name][part] = plane
        return planes

    def object_ids(self, moment: Moment) -> NDArray[np.uint32]:
        """Index + 1 of the instance that each pixel sees, by ground truth, (H, W); 0: none.

        ``moment`` is that of ``ground_truth``, so that it need not be built again.
        """
        return self._truth["object_id"] if self.gt_time else self.ground_truth.object_ids(moment)

    @property
    def bad_samples(self) -> tuple[int, list[tuple[int, int, int]]]:
        """Number of dropped (NaN, Inf) samples, and (x, y, sample) of the first ones."""
        film = self._whole_film()
        return film.bad_sample_count, list(film.bad_samples)

    def sample_counts(self) -> NDArray[np.uint32]:
        """Samples drawn of each pixel, shape (H, W)."""
        return np.asarray(self._whole_film().sample_counts())

    def relative_variance(self, dark: float) -> NDArray[np.float32]:
        """Variance of one sample of each pixel over (its mean^2 + dark), shape (H, W)."""
        return np.asarray(self._whole_film().relative_variance(dark))

    def state(self) -> dict[str, NDArray[np.uint32]]:
        """The film's exact sums as 32-bit words, (H, W, words) of the crop, by part.

        Views of the film, without a copy: they show what is drawn later, too.
        """
        film = self._whole_film()
        return {part: film.state(part) for part in film.state_parts()}

    def set_state(
        self,
        state: dict[str, NDArray[np.uint32]],
        ranges: list[tuple[int, int]],
        round: Round | None = None,
    ) -> None:
        """Restores sums that ``state`` returned, drawn in these sample ranges, or in rounds.

        Raises:
            MismatchError: A part is missing, unknown or of another size.
        """
        set_film_state(self._film, state, "film state")
        self._torn = False
        self.ranges = join_ranges(ranges)
        self.round = round

    @cached_property
    def key(self) -> dict[str, str]:
        """Facts that passes must share to be added: hashes of scene, camera, settings, build."""
        return {
            "scene": self.built.hash,
            "camera": _hash_json(without_exposure(facts_of(self._setup))),
            "settings": _hash_json(self._identity),
            "build": f"{_core.__version__} {platform.machine()} {_core.simd_target()} "
            f"{self._core_scene.intersector}",
        }

    @property
    def metadata(self) -> dict[str, Any]:
        """Camera and picture facts, in the names and units of the EXR attributes."""
        out: dict[str, Any] = {
            "time": self.scene.time,
            **camera_metadata(self.camera, self._setup, self.width),
            "seed": self._identity["seed"],
            **self._sample_facts(),
            "resolution": (self.width, self.height),
            "crop": self.crop,
            "overscan": str(self.overscan) if self.overscan else None,
            "filter": self._identity["filter"],
            "light_paths": show_plan(self.light_paths),
            "flare": f"{self.flare:.17g}" if self.flare else None,
            "scatter": f"{self.scatter:.17g}" if self.scatter else None,
            "lens_scatter": self._scatters() if self.scatter else None,
            "diffraction": self.diffraction.words if self.diffraction else None,
            "pupils": self._pupils,
            "bands": self.bands or None,
            **sensor_metadata(self.sensor),
            "scene_hash": self.key["scene"],
            "bad_samples": self.bad_samples[0],
            "bad_sample_places": [list(place) for place in self.bad_samples[1]],
            "gt_time": self.gt_time,
            "gt_lens": self.gt_lens if self.gt_time else None,
            "gt_rays": self.gt_rays if self.gt_time and self.gt_lens == "mean" else None,
            "version": _core.__version__,
            "intersector": self._core_scene.intersector,
        }
        return {name: value for name, value in out.items() if value is not None}

    def _sample_facts(self) -> dict[str, Any]:
        """Samples per pixel; of adaptive sampling mean and bounds, and the noise reached."""
        if self.round is None:
            return {"samples": sum(b - a for a, b in self.ranges)}
        counts = self.sample_counts()
        return {
            "samples": float(counts.mean()),
            "samples_min": int(counts.min()),
            "samples_max": int(counts.max()),
            "noise": self.round.noise if self.round.complete else None,
        }


def check_resolution(resolution: tuple[int, int]) -> tuple[int, int]:
    """Width and height in px, checked."""
    try:
        width, height = resolution
    except (TypeError, ValueError):
        raise UsageError(
            f"resolution: wanted (width, height) in px, got {short(resolution)}"
        ) from None
    size = [
        whole(v, "resolution", 1, MAX_RESOLUTION, f"1 .. {MAX_RESOLUTION} px a side")
        for v in (width, height)
    ]
    return size[0], size[1]


def _share_of(progress: Progress | None, done: float, share: float) -> Progress | None:
    """Scales a progress callback to one film part."""
    return None if progress is None else lambda fraction: progress(done + share * fraction)


def _crop(crop: Box | None, region: Box) -> Box:
    if crop is None:
        return region
    left, top, right, bottom = region
    try:
        x0, y0, x1, y1 = (operator.index(v) for v in crop)
    except (TypeError, ValueError):
        raise UsageError(
            f"crop: wanted whole numbers (x0, y0, x1, y1), got {short(crop)}"
        ) from None
    if not (left <= x0 < x1 <= right and top <= y0 < y1 <= bottom):
        within = f"{right}x{bottom}" if left == top == 0 else f"({left}, {top}, {right}, {bottom})"
        raise UsageError(
            f"crop: wanted (x0, y0, x1, y1) with x0 < x1 and y0 < y1 within {within}, "
            f"got ({x0}, {y0}, {x1}, {y1})"
        )
    return x0, y0, x1, y1


def _filter(text: str) -> tuple[str, float]:
    kind, _, radius = str(text).replace("-", "_").partition(":")
    if kind not in FILTERS:
        raise UsageError(
            f"filter: wanted {', '.join(FILTERS)}, got {kind!r}{suggest(kind, FILTERS)}"
        )
    try:
        value = float(radius) if radius else 0.0
    except ValueError:
        value = math.nan
    if radius and not 0.25 <= value <= 16:
        raise UsageError(f"filter: radius: wanted 0.25 .. 16 px, got {radius!r}")
    return kind, value


def _hash_json(value: Any) -> str:
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()
