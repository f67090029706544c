"""Cryptomatte: coverage of each pixel by the names of objects, for compositing programs.

A hash represents a name. Each pixel has pairs of hash and coverage, ranked by coverage. Source:
Friedman and Jones 2015, Fully automatic ID mattes with support for motion blur and transparency;
names of channels and attributes: Psyop, Cryptomatte specification 1.2.0.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import mmh3
import numpy as np
from numpy.typing import NDArray

from daguerre.checks import short
from daguerre.errors import InputError, UsageError, suggest
from daguerre.files.value import Value

#: Layers of a file by kind of name.
LAYERS = {"object": "CryptoObject", "material": "CryptoMaterial", "asset": "CryptoAsset"}
HASH, CONVERSION = "MurmurHash3_32", "uint32_to_float32"
MAX_RANKS = 64
#: Pairs of hash and coverage in one layer of four channels.
PAIRS = 2
_EXPONENT = 23


def hash_of(name: str) -> int:
    """Hash of a name; read as a float it is neither denormal, NaN nor infinity.

    Programs keep it in a float channel, and may change such numbers.
    """
    bits = int(mmh3.hash(name.encode("utf-8", "surrogateescape"), signed=False))
    return bits ^ (1 << _EXPONENT) if bits >> _EXPONENT & 255 in (0, 255) else bits


@dataclass(frozen=True, eq=False)
class Cryptomatte(Value):
    """Mattes of all names of one kind.

    Attributes:
        ids: Hashes of names, by falling coverage, uint32, shape (H, W, R); 0: none.
        coverage: Share of the pixel that each name covers, through lens, shutter and filter, shape
            (H, W, R).
        manifest: Hash of each name.
    """

    ids: NDArray[np.uint32]
    coverage: NDArray[np.float32]
    manifest: dict[str, int] = field(default_factory=dict)

    def mask(self, *names: str) -> NDArray[np.float32]:
        """Coverage of each pixel by objects of these names together, 0 to 1, shape (H, W).

        Raises:
            UsageError: No such name; the message suggests the nearest.
        """
        found = np.zeros(self.ids.shape[:2], np.float32)
        for name in dict.fromkeys(names):
            if name not in self.manifest:
                raise UsageError(
                    f"cryptomatte: no object named {name!r}{suggest(name, self.manifest, few=True)}"
                )
            found += np.where(self.ids == self.manifest[name], self.coverage, 0).sum(axis=2)
        return found

    def __repr__(self) -> str:
        height, width, ranks = self.ids.shape
        return f"<Cryptomatte {width}x{height}, {ranks} ranks, {len(self.manifest)} names>"


def check_layers(value: object, where: str) -> tuple[str, ...]:
    """Returns the chosen layers, in the order of ``LAYERS``.

    Args:
        value: Names, as a list or separated by commas; none or "": no layers.
        where: Name of the parameter, for the message.

    Raises:
        UsageError: No such layer.
    """
    names = value.split(",") if isinstance(value, str) else value
    if not isinstance(names, Iterable) or not all(isinstance(name, str) for name in names):
        raise UsageError(f"{where}: wanted some of {', '.join(LAYERS)}, got {short(value)}")
    asked = [name.strip() for name in names if name.strip()]
    for name in asked:
        if name not in LAYERS:
            raise UsageError(
                f"{where}: wanted some of {', '.join(LAYERS)}, got {short(name)}"
                f"{suggest(name, LAYERS)}"
            )
    return tuple(layer for layer in LAYERS if layer in asked)


def planes(mattes: Mapping[str, Cryptomatte]) -> dict[str, NDArray[np.float32]]:
    """Channels of a file: ``CryptoObject00.R`` and so on, hashes as the bits of floats."""
    found: dict[str, NDArray[np.float32]] = {}
    for kind, matte in mattes.items():
        hashes = matte.ids.view(np.float32)
        for rank in range(matte.ids.shape[2]):
            layer = f"{LAYERS[kind]}{rank // PAIRS:02d}"
            first, second = "RG" if rank % PAIRS == 0 else "BA"
            found[f"{layer}.{first}"] = hashes[:, :, rank]
            found[f"{layer}.{second}"] = matte.coverage[:, :, rank]
        if matte.ids.shape[2] % PAIRS:
            nothing = np.zeros(matte.ids.shape[:2], np.float32)
            found |= {f"{layer}.B": nothing, f"{layer}.A": nothing}
    return found


def attributes(mattes: Mapping[str, Cryptomatte]) -> dict[str, str]:
    """Attributes of a file, with the names of each layer."""
    found: dict[str, str] = {}
    for kind, matte in mattes.items():
        layer = LAYERS[kind]
        manifest = {name: f"{value:08x}" for name, value in sorted(matte.manifest.items())}
        facts = {
            "name": layer,
            "hash": HASH,
            "conversion": CONVERSION,
            "manifest": json.dumps(manifest, ensure_ascii=False, separators=(",", ":")),
        }
        key = f"{hash_of(layer):08x}"[:7]
        found |= {f"cryptomatte/{key}/{name}": value for name, value in facts.items()}
    return found


def taken(
    channels: dict[str, NDArray[Any]], facts: Mapping[str, Any], where: str
) -> dict[str, Cryptomatte]:
    """Takes the mattes of Daguerre's layers out of the channels of a file.

    Args:
        channels: Planes by name; the planes of mattes are removed from it.
        facts: Attributes of the file.
        where: Name of the file, for messages.

    Raises:
        InputError: A manifest is not a list of names and hashes.
    """
    found: dict[str, Cryptomatte] = {}
    for kind, layer in LAYERS.items():
        pairs: list[tuple[NDArray[Any], NDArray[Any]]] = []
        while all(f"{layer}{len(pairs) // PAIRS:02d}.{c}" in channels for c in "RGBA"):
            number = f"{layer}{len(pairs) // PAIRS:02d}"
            r, g, b, a = (channels.pop(f"{number}.{c}") for c in "RGBA")
            pairs += [(r, g), (b, a)]
        if pairs:
            hashes = np.stack([np.asarray(h, np.float32) for h, _ in pairs], axis=2)
            shares = np.stack([np.asarray(c, np.float32) for _, c in pairs], axis=2)
            found[kind] = Cryptomatte(
                hashes.view(np.uint32), shares, _manifest(layer, facts, where)
            )
    return found


def _manifest(layer: str, facts: Mapping[str, Any], where: str) -> dict[str, int]:
    """Hashes by name; empty if the file has none, as names may be elsewhere."""
    keys = [k for k, v in facts.items() if k.startswith("cryptomatte/") and v == layer]
    text = facts.get(f"{keys[0].rpartition('/')[0]}/manifest") if keys else None
    if text is None:
        return {}
    try:
        return {str(name): int(value, 16) for name, value in dict(json.loads(text)).items()}
    except (ValueError, TypeError, RecursionError) as error:
        raise InputError(f"{where}: cryptomatte: wanted names and hashes of {layer}") from error
