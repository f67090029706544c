"""Makes stages of small layers that refer to one another at random."""

from __future__ import annotations

from pathlib import Path
from random import Random

_KINDS = ("references", "payload", "inherits")


def write_stage(folder: Path, seed: int, layers: int = 3, prims: int = 5) -> Path:
    """Writes layers ``0.usda`` ... of a stage; returns the first, which is the stage.

    References, inherits and the like lead to later prims and layers alone, so that none is a loop.
    """
    rng = Random(seed)
    for i in range(layers):
        subs = [f"@{j}.usda@" for j in range(i + 1, layers) if rng.random() < 0.2]
        head = f"#usda 1.0\n( subLayers = [{', '.join(subs)}]\n metersPerUnit = 1 )\n"
        made = _Made(rng, i, layers, prims)
        body = "".join(made.prim(k, f"p{k}", 0) for k in range(prims))
        (folder / f"{i}.usda").write_text(head + body)
    return folder / "0.usda"


class _Made:
    def __init__(self, rng: Random, layer: int, layers: int, prims: int) -> None:
        self._rng, self._layer, self._layers, self._prims = rng, layer, layers, prims

    def prim(self, top: int, name: str, depth: int) -> str:
        """Text of a prim below the root prim ``top``, or of that one itself."""
        rng, inside, more = self._rng, "", ""
        if depth < 2:
            for k in range(3):
                if rng.random() < 0.4:
                    inside += self.prim(top, f"c{k}", depth + 1)
        if rng.random() < 0.15 and depth < 2:
            more = 'variants = { string v = "x" }\nprepend variantSets = "v"'
            inside += 'variantSet "v" = {\n'
            for choice in "xy":
                child = self.prim(top, "c0", depth + 1)
                inside += f'"{choice}" (\n{self._arcs(top)}\n) {{\n{child}}}\n'
            inside += "}\n"
        word = rng.choice(("def", "def", "over", "class"))
        return f'{word} "{name}" (\n{self._arcs(top)}\n{more}\n) {{\n{inside}}}\n'

    def _arcs(self, top: int) -> str:
        rng, found = self._rng, []
        for kind in _KINDS:
            if rng.random() < 0.15:
                file, first = "", top + 1
                outside = kind in ("references", "payload") and rng.random() < 0.6
                if outside and self._layer + 1 < self._layers:
                    file, first = f"@{rng.randrange(self._layer + 1, self._layers)}.usda@", 0
                if first < self._prims:
                    names = [f"p{rng.randrange(first, self._prims)}"]
                    names += [f"c{rng.randrange(3)}" for _ in range(rng.choice((0, 0, 1, 2)))]
                    found.append(f"prepend {kind} = {file}</{'/'.join(names)}>")
        return "\n".join(found)
