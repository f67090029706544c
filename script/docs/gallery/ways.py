"""A sheet of pictures, and the commands that make the same picture three ways."""

from __future__ import annotations

from dataclasses import dataclass

OUT = "out/imperfections"


@dataclass(frozen=True)
class Panel:
    """One picture of a sheet.

    Attributes:
        caption: Drawn above it.
        file: Name of the .exr that the last command writes, without folder and ending.
        commands: Commands, in order; empty if another panel's commands write the file.
        layer: Layer of the file that is shown in place of R, G and B.
        none: Why there is no such picture; the place stays empty.
    """

    caption: str
    file: str = ""
    commands: tuple[str, ...] = ()
    layer: str = ""
    none: str = ""


@dataclass(frozen=True)
class Word:
    """One word of the list.

    Attributes:
        name: Name of the picture's file.
        heading: Heading of its section.
        text: Caption: the effect and its cause, Markdown.
        rows: Panels from left to right; the first of a row is what the others are held against.
        exposure: By which all panels are multiplied to be shown.
        quality: Quality of the JPEG.
        fringes: Whether the table says how far red and blue lie from green.
    """

    name: str
    heading: str
    text: str
    rows: tuple[tuple[Panel, ...], ...]
    exposure: float = 1.0
    quality: int = 88
    fringes: bool = False


def render(scene: str, flags: str, file: str) -> str:
    """A command that renders."""
    return f"daguerre render {scene} {flags} -o {OUT}/{file}.exr"


def post(source: str, file: str, *effects: str) -> str:
    """A command that puts effects on a picture."""
    given = " ".join(f"--effect {effect}" for effect in effects)
    return f"daguerre post {OUT}/{source}.exr -o {OUT}/{file}.exr {given}"


@dataclass(frozen=True)
class Ways:
    """The same picture three ways: through the glass, its polynomials, and in 2D.

    Attributes:
        file: Beginning of the names of the files.
        scene: A .glb.
        lens: Flags of the lens and its focus.
        stop: Flags of its stop, which a pinhole has none of.
        view: Flags of size and samples that all have in common.
        effects: Effects of the darkroom, on the picture of a pinhole.
        degree: Degree of the polynomials.
        wide: Flags of size of the pinhole's picture where it has to reach farther.
        more: Flags of the first two.
        needs: Flags of the pinhole's alone.
        note: After each caption.
    """

    file: str
    scene: str
    lens: str
    stop: str
    view: str
    effects: tuple[str, ...]
    degree: int = 9
    wide: str = ""
    more: str = ""
    needs: str = ""
    note: str = ""

    def panels(self) -> tuple[Panel, ...]:
        """The three of them."""
        traced, fitted, pinhole, flat = (
            f"{self.file}_{way}" for way in ("traced", "polynomial", "pinhole", "2d")
        )
        common = f"{self.lens} {self.stop} {self.view} {self.more}".strip()
        needs = f"{self.needs} --light-paths off".strip()
        plain = f"{self.lens} --lens-model pinhole {self.wide or self.view} {needs}"
        polynomial = f"{common} --lens-model polynomial --degree {self.degree}"
        return (
            Panel(f"traced{self.note}", traced, (render(self.scene, common, traced),)),
            Panel(f"polynomial{self.note}", fitted, (render(self.scene, polynomial, fitted),)),
            Panel(
                f"2D{self.note}",
                flat,
                (render(self.scene, plain, pinhole), post(pinhole, flat, *self.effects)),
            ),
        )
