"""Counts directives: each is used, or reported in a note."""

from __future__ import annotations

from daguerre.files.notes import Notes

from .parameters import Parameters
from .place import FilePlace, SceneFile

_Key = tuple[SceneFile, int]


class Ledger:
    """Counts of the directives of a scene.

    Args:
        notes: Receives a note for each directive that is not used.
    """

    def __init__(self, notes: Notes) -> None:
        self.notes = notes
        self._waiting: dict[_Key, FilePlace] = {}
        self._used: set[_Key] = set()
        self._noted: set[_Key] = set()

    def see(self, place: FilePlace) -> None:
        """Counts a directive that was read; it waits to be used or noted."""
        self._waiting[_key(place)] = place

    def include(self, place: FilePlace) -> None:
        """Counts a directive that includes a file."""
        self.see(place)
        self.use(place)

    def use(self, place: FilePlace) -> None:
        """Counts a directive as used; doing it again changes nothing."""
        key = _key(place)
        if self._waiting.pop(key, None) is not None:
            self._used.add(key)

    def note(self, place: FilePlace, sentence: str, name: str = "") -> None:
        """Notes that a directive is not used, by the name of its file, if any."""
        key = _key(place)
        if self._waiting.pop(key, None) is not None:
            self._noted.add(key)
        self.notes.add(sentence, name=name)

    def tell_unread(self, parameters: Parameters, place: FilePlace, kind: str) -> None:
        """Notes the parameters of a directive that nothing asked for."""
        for parameter in parameters.unread():
            name = parameter.name[:40]
            self.notes.add(f"{name!r} of {place.directive} {kind[:40]!r} is not read")

    def close(self) -> None:
        """Notes the directives that still wait: definitions that nothing names."""
        for place in list(self._waiting.values()):
            self.note(place, f"{place.directive}: one that the scene does not use is left out")

    @property
    def used(self) -> int:
        """Number of directives that are used."""
        return len(self._used)

    @property
    def noted(self) -> int:
        """Number of directives that are noted."""
        return len(self._noted)

    @property
    def waiting(self) -> int:
        """Number of directives that are neither used nor noted yet."""
        return len(self._waiting)


def _key(place: FilePlace) -> _Key:
    return place.source, place.offset
