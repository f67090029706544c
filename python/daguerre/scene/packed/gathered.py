"""A scene that is read only to be packed: instances by the million stay arrays."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.scene.parts import Instance
from daguerre.scene.scene import Scene


class Instances(list[Instance]):
    """Instances in order: single instances, and blocks with one mesh, material and name.

    The length counts the instances of blocks; readers of files use nothing else.
    """

    def __init__(self) -> None:
        super().__init__()
        self._rows: list[tuple[int, int, str, NDArray[np.float64]]] = []
        self._count = 0
        #: numbers of hidden instances
        self.hidden: list[int] = []

    def add(self, mesh: int, material: int, worlds: NDArray[np.float64], name: str) -> None:
        """Appends a block; ``worlds`` has shape (N, 4, 4)."""
        self._rows.append((mesh, material, name, worlds))
        self._count += len(worlds)

    def append(self, one: Instance) -> None:
        """Appends an instance, which is no catcher."""
        if not one.shown:
            self.hidden.append(self._count)
        self.add(one.mesh, one.material, one.transform[None], one.name)

    def extend(self, all_of_them: Iterable[Instance]) -> None:
        """Appends instances."""
        for one in all_of_them:
            self.append(one)

    def __len__(self) -> int:
        return self._count

    def __bool__(self) -> bool:
        return self._count > 0

    def __iter__(self) -> Iterator[Instance]:
        raise TypeError("a gathered scene has no single instances")

    def __getitem__(self, key: object) -> Any:
        raise TypeError("a gathered scene has no single instances")

    def columns(self) -> dict[str, Any]:
        """Columns of all instances, as in ``parts.parts_of``."""
        names: dict[str, int] = {}
        counts = [len(worlds) for *_, worlds in self._rows]
        rows = [
            (mesh, material, names.setdefault(name, len(names)))
            for mesh, material, name, _ in self._rows
        ]
        each = np.repeat(np.array(rows, np.int64).reshape(-1, 3), counts, axis=0)
        worlds = [worlds for *_, worlds in self._rows]
        return {
            "meshes": each[:, 0],
            "materials": each[:, 1],
            "transforms": np.concatenate([np.zeros((0, 4, 4)), *worlds]),
            "names": list(names),
            "named": each[:, 2],
            "hidden": self.hidden,
            "catchers": [],
        }


class Gathered(Scene):
    """A scene with ``Instances``; its arrays may be views of memory of an ``owner``."""

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        self.owner: Any = None
        self.instances: Instances = Instances()

    def _place(self, mesh: int, material: int, worlds: NDArray[np.float64], name: str) -> None:
        self.instances.add(mesh, material, worlds, name)
