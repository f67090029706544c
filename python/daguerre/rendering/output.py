"""Output of a picture: its channels, its development, and its files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.errors import OutputError, UsageError
from daguerre.files import extras, formats
from daguerre.frame.aovs import Source, names_of

from .parameters import PLATE
from .photograph import Photograph, is_raw, shows_exposure
from .reporter import PreviewPicture, Reporter

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame

    from .rounds import Judge
    from .session import Session

(DISPARITY,) = names_of(Source.STEREO)
EXPOSED = names_of(Source.EXPOSURE)


@dataclass(frozen=True)
class Output:
    """Files of a picture.

    Attributes:
        paths: Files to write, .exr, .png and so on; a bracket writes several files for each.
        aovs: Groups of channels to keep, see ``daguerre.frame.aovs``.
        denoise: Whether to denoise the picture.
        noisy: Files for the picture before denoising.
        tone: Tone curve of pictures that are not developed.
        photograph: Exposure and development of pictures.
        is_pass: Whether an .exr keeps the sums, so that it can be merged.
        baseline: Distance between the cameras of a stereo pair, m; 0: no stereo.
        beside: Further files that the front end writes, such as maps.
    """

    paths: tuple[Path, ...] = ()
    aovs: tuple[str, ...] = ()
    denoise: bool = False
    noisy: tuple[Path, ...] = ()
    tone: str = "srgb"
    photograph: Photograph = field(default_factory=Photograph)
    is_pass: bool = False
    baseline: float = 0.0
    beside: tuple[Path, ...] = ()

    @property
    def exposed(self) -> bool:
        """Whether channels of the true exposure are requested."""
        return any(name in self.aovs for name in EXPOSED)

    @property
    def files(self) -> tuple[Path, ...]:
        """All pictures to write: with a bracket, each exposure."""
        paths = (*self.paths, *self.noisy)
        return tuple(file for path in paths for file, _ in self.photograph.files(path))

    @property
    def written(self) -> tuple[Path, ...]:
        """All files to write, including the files of the front end."""
        return (*self.files, *self.beside)

    def renamed(self, name: Callable[[Path], Path]) -> Output:
        """Returns a copy with other file names."""
        given = (self.paths, self.noisy, self.beside)
        paths, noisy, beside = (tuple(map(name, files)) for files in given)
        return replace(self, paths=paths, noisy=noisy, beside=beside)

    @property
    def checkpoint(self) -> Path:
        """File that keeps the sums until the picture is complete."""
        if not self.paths:
            raise OutputError("output: wanted a file, got none")
        return self.paths[0].with_suffix(".checkpoint.exr")

    @property
    def judge(self) -> Judge | None:
        """Function for the error after denoising, to compare with ``noise``; None: not denoised."""
        if not self.denoise:
            return None
        from .denoise import noise_after

        return lambda session: noise_after(session.frame(truth=False, plate=False))

    def check(self, metadata: dict[str, Any], tell: Reporter) -> None:
        """Checks, before anything is drawn, that the camera can provide the output."""
        self._load_writers()
        self.photograph.check(metadata, self.paths, tell)
        pictures = [path for path in self.files if shows_exposure(path) and not is_raw(path)]
        if self.tone != "srgb" and pictures and self.photograph.develops(metadata):
            raise UsageError(
                f"--tone {self.tone}: {pictures[0]} is developed, so its tone curve is set by "
                "--look"
            )
        if metadata.get("background") == PLATE:
            self._check_plate(metadata)
        origin = metadata.get("world_origin")
        if origin and "P" in self.aovs and any(path.suffix == ".exr" for path in self.paths):
            tell.note(
                f"P in the file is relative to {origin} m (daguerre:world_origin in its header): "
                "its 32-bit numbers would be too coarse"
            )
        if DISPARITY in self.aovs:
            from .rig import check_straight

            check_straight(metadata)
        if self.exposed:
            from daguerre.exposure.lux_seconds import exposure_of_one

            exposure_of_one(metadata, 100.0)  # raises an error that names missing metadata

    def _load_writers(self) -> None:
        """Imports the libraries that write, as memory may be short after hours of drawing.

        Raises:
            UsageError: The package of an extra is not installed.
        """
        for path in self.files:
            formats.load_writer("frame", path)
            for package in self.photograph.packages(path):
                extras.need(package, str(path))
                import_module(package)

        if any(path.suffix != ".exr" for path in self.files):
            import OpenImageIO  # noqa: F401
        if self.is_pass:
            from . import passes  # noqa: F401

    def _check_plate(self, metadata: dict[str, Any]) -> None:
        """Refuses outputs that would process the plate twice, or lose it.

        Raises:
            UsageError: The message says how to avoid it.
        """
        developed = [
            path
            for path in self.paths
            if is_raw(path) or (shows_exposure(path) and self.photograph.develops(metadata))
        ]
        if self.is_pass or developed:
            what = "a pass" if self.is_pass else f"{developed[0]}, which is exposed and developed,"
            raise UsageError(
                f"background: plate: {what} does not contain the plate; use --background "
                "transparent, then `daguerre composite`"
            )

    def frame(self, session: Session, samples: float, tell: Reporter) -> Frame:
        """Returns the picture so far, with the requested channels."""
        frame = session.frame(truth=False, plate=False)
        facts = {
            "resolution": (session.width, session.height),
            "crop": session.crop,
            "samples": samples,
            "aovs": list(self.aovs),
            "colorspace": self.photograph.colorspace,
        }
        frame = replace(frame, metadata={**frame.metadata, **facts})
        if self.denoise:
            from .denoise import denoise

            frame = denoise(frame)  # by means over the samples, blurred as the picture is
            if self.photograph.sensor is not None:
                tell.note("denoised: the sensor's channels are fitted to the denoised colours")
        frame = session.with_truth(session.over_plate(frame))
        if cut := frame.metadata.get("mattes_cut"):
            tell.note(
                f"cryptomatte: {cut['pixels']} pixels have more names than ranks and lose up to "
                f"{cut['share']:.2g} of their coverage; raise --cryptomatte-ranks to keep it"
            )
        if DISPARITY in self.aovs:
            from .rig import disparity

            apart = disparity(frame, self.baseline)
            frame = replace(frame, aovs={**frame.aovs, f"{DISPARITY}.X": apart})
        if self.exposed:
            truth = frame.exposure_truth(self.photograph.sensor)
            frame = replace(frame, aovs=frame.aovs | truth)
        return only(frame, self.aovs)

    def unfinished(self, session: Session) -> Frame:
        """Returns the picture so far for previews: not denoised, and without diffraction."""
        frame = session.frame(truth=False, waves=False)
        facts = {"resolution": (session.width, session.height), "crop": session.crop}
        return replace(frame, metadata={**frame.metadata, **facts}, aovs={})

    def look(self, frame: Frame, *, complete: bool = False) -> PreviewPicture:
        """Makes a preview of an incomplete picture, developed like the complete picture."""
        photograph = replace(self.photograph, bracket=())

        def write(path: Path) -> None:
            photograph.write(frame, [path], self.tone, Reporter())

        return PreviewPicture(frame, self.preview, write, complete)

    @property
    def preview(self) -> Path:
        """File for previews."""
        return self.checkpoint.with_name(
            self.checkpoint.name.removesuffix(".checkpoint.exr") + ".preview.png"
        )

    def write_noisy(self, session: Session, samples: float, paths: Sequence[Path]) -> None:
        """Writes the picture before denoising."""
        if paths:
            plain, silent = replace(self, denoise=False), Reporter()
            plain.write(session, plain.frame(session, samples, silent), paths, silent)

    def write(self, session: Session, frame: Frame, paths: Sequence[Path], tell: Reporter) -> None:
        """Writes the picture to these files."""
        passes = [p for p in paths if self.is_pass and p.suffix.lower() == ".exr"]
        for path in passes:
            from .passes import pass_of, write_pass

            write_pass(path, frame, replace(pass_of(session), metadata=frame.metadata))
        pictures = [path for path in paths if path not in passes]
        self.photograph.write(frame, pictures, self.tone, tell)
        if any(path.suffix.lower() == ".exr" for path in pictures):
            self._tell_no_container(frame, tell)

    def _tell_no_container(self, frame: Frame, tell: Reporter) -> None:
        """Notes channels that keep a file of ACES from being an image container."""
        from daguerre.pictures.exr.color_space import ACES, beside_color

        if self.photograph.colorspace == ACES and (names := beside_color(frame)):
            tell.note(
                "the .exr is not an ACES image container (ST 2065-4), which holds R, G, B and A "
                f"alone: it has {', '.join(names)}"
            )


def only(frame: Frame, groups: Sequence[str]) -> Frame:
    """Returns the frame with only these groups of channels."""
    keep = {name: plane for name, plane in frame.aovs.items() if name.split(".")[0] in groups}
    return replace(frame, aovs=keep)
