"""Output of a picture: the channels that are kept, its development, and its files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.errors import OutputError, UsageError
from daguerre.files import extras
from daguerre.frame.aovs import Source, names_of

from .parameters import PLATE
from .photograph import Photograph
from .reporter import Look, Reporter

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
        paths: Files to write, .exr, .png and so on; of a bracket each stands for several.
        aovs: Groups of channels to keep, see ``daguerre.frame.aovs``.
        denoise: Whether the picture is denoised.
        noisy: Files of the picture before that.
        tone: Curve of pictures that are not developed.
        photograph: How pictures are exposed and developed.
        is_pass: Whether an .exr keeps the sums, so that it can be merged.
        baseline: Distance of the cameras of a stereo pair, m; 0: there is none.
        beside: Files that the front end writes beside them, such as maps.
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
        """Whether truth about the exposure is asked for."""
        return any(name in self.aovs for name in EXPOSED)

    @property
    def files(self) -> tuple[Path, ...]:
        """All that is written: of a bracket each exposure."""
        paths = (*self.paths, *self.noisy)
        return tuple(file for path in paths for file, _ in self.photograph.files(path))

    @property
    def written(self) -> tuple[Path, ...]:
        """The same, with those beside them."""
        return (*self.files, *self.beside)

    def renamed(self, name: Callable[[Path], Path]) -> Output:
        """The same into other files."""
        given = (self.paths, self.noisy, self.beside)
        paths, noisy, beside = (tuple(map(name, files)) for files in given)
        return replace(self, paths=paths, noisy=noisy, beside=beside)

    @property
    def checkpoint(self) -> Path:
        """Where the sums are kept until the picture is complete."""
        if not self.paths:
            raise OutputError("output: wanted a file, got none")
        return self.paths[0].with_suffix(".checkpoint.exr")

    @property
    def judge(self) -> Judge | None:
        """The error that a denoised picture will have, on which ``noise`` counts; None: its own."""
        if not self.denoise:
            return None
        from .denoise import noise_after

        return lambda session: noise_after(session.frame(truth=False, plate=False))

    def check(self, metadata: dict[str, Any], tell: Reporter) -> None:
        """Refuses a camera that cannot give what is asked for, before anything is drawn."""
        self._load_writers()
        self.photograph.check(metadata, self.paths, tell)
        if metadata.get("background") == PLATE:
            self._check_plate()
        if DISPARITY in self.aovs:
            from .rig import check_straight

            check_straight(metadata)
        if self.exposed:
            from daguerre.exposure.lux_seconds import luminance_exposure

            luminance_exposure(metadata)  # or an error that names what is missing

    def _load_writers(self) -> None:
        """Imports the libraries that will write: after hours of drawing, memory may be short.

        Raises:
            UsageError: One of an extra is not installed.
        """
        import OpenEXR  # noqa: F401

        for path in self.files:
            for package in self.photograph.packages(path):
                extras.need(package, str(path))
                import_module(package)

        if any(path.suffix != ".exr" for path in self.files):
            import OpenImageIO  # noqa: F401

    def _check_plate(self) -> None:
        """Refuses what a plate in the picture would go through twice, or get lost in.

        Raises:
            UsageError: The message says what to do instead.
        """
        exposed = [path for path in self.paths if self.photograph.exposes(path)]
        if self.is_pass or exposed:
            what = "a pass" if self.is_pass else f"{exposed[0]}, which is exposed and developed,"
            raise UsageError(
                f"background: plate: {what} holds no plate; wanted --background transparent, and "
                "daguerre composite after it"
            )

    def frame(self, session: Session, samples: float, tell: Reporter) -> Frame:
        """The picture so far, with the channels that were asked for."""
        frame = session.frame(truth=False, plate=False)
        facts = {
            "resolution": (session.width, session.height),
            "crop": session.crop,
            "samples": samples,
            "aovs": list(self.aovs),
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
                f"{cut['share']:.2g} of coverage; more --cryptomatte-ranks keep it"
            )
        if DISPARITY in self.aovs:
            from .rig import disparity

            apart = disparity(frame, self.baseline)
            frame = replace(frame, aovs={**frame.aovs, f"{DISPARITY}.X": apart})
        frame = self.photograph.metered(frame, self.paths, tell)
        if self.exposed:
            truth = frame.exposure_truth(self.photograph.sensor)
            frame = replace(frame, aovs=frame.aovs | truth)
        return only(frame, self.aovs)

    def unfinished(self, session: Session) -> Frame:
        """The picture so far as it is shown meanwhile: not denoised, and not diffracted."""
        frame = session.frame(truth=False, waves=False)
        facts = {"resolution": (session.width, session.height), "crop": session.crop}
        frame = replace(frame, metadata={**frame.metadata, **facts}, aovs={})
        return self.photograph.metered(frame, self.paths, Reporter())

    def look(self, frame: Frame, *, complete: bool = False) -> Look:
        """A picture in the making, developed as the one that comes."""
        one = replace(self.photograph, bracket=())

        def write(path: Path) -> None:
            one.write(frame, [path], self.tone, Reporter())

        return Look(frame, self.preview, write, complete)

    @property
    def preview(self) -> Path:
        """File of a picture that is not complete."""
        return self.checkpoint.with_name(
            self.checkpoint.name.removesuffix(".checkpoint.exr") + ".preview.png"
        )

    def write_noisy(self, session: Session, samples: float, paths: Sequence[Path]) -> None:
        """Writes the picture before it was denoised."""
        if paths:
            plain, silent = replace(self, denoise=False), Reporter()
            plain.write(session, plain.frame(session, samples, silent), paths, silent)

    def write(self, session: Session, frame: Frame, paths: Sequence[Path], tell: Reporter) -> None:
        """Writes the picture to these files."""
        from .passes import pass_of, write_pass

        passes = [p for p in paths if self.is_pass and p.suffix.lower() == ".exr"]
        for path in passes:
            write_pass(path, frame, replace(pass_of(session), metadata=frame.metadata))
        pictures = [path for path in paths if path not in passes]
        self.photograph.write(frame, pictures, self.tone, tell)


def only(frame: Frame, groups: Sequence[str]) -> Frame:
    """The frame with these groups of channels alone."""
    keep = {name: plane for name, plane in frame.aovs.items() if name.split(".")[0] in groups}
    return replace(frame, aovs=keep)
