"""Random changes to good files: of values in a tree, of words in a text, of bytes, of chunks."""

from __future__ import annotations

import copy
import json
import math
import struct
import zlib
from random import Random
from typing import Any

MOST = 200_000  # bytes of a file
#: Values that break things, in a tree.
JUNK: tuple[Any, ...] = (
    0, 1, -1, -0.0, 0.5, 1e-308, 1e308, math.nan, math.inf, -math.inf, 255, 256, 65536, 2**31 - 1,
    2**31, 2**32, 2**53, 2**63, 2**64, 10**40, -(2**31), True, False, None, "", "x" * 3000, "\0",
    "\ud800", "\x1b[2J", "../../../etc/passwd", "/dev/zero", "http://localhost/", "data:,", "NaN",
    [], {}, [[]], [{}], [None], [0, 0, 0], [1e308] * 4, {"": 0}, {"__proto__": {}},
)  # fmt: skip
#: Words that break things, in a text.
WORDS = (
    "", "0", "-0", "1", "-1", "1e-300", "1e300", "1e999", "nan", "inf", "-inf", ".", "-", "~",
    "null", "true", "9" * 20, "0x10", "1_0", "[", "]", "{", "}", ":", ",", "&a", "*a", "!!x",
    "!!python/object:os.system", "---", "#", "\t", "\0", "\ufeff", "'", '"', "\u2028", "<<: *a",
)  # fmt: skip
#: Whole numbers that break things, in bytes.
NUMBERS = (
    0,
    1,
    2,
    3,
    16,
    127,
    128,
    255,
    256,
    32767,
    32768,
    65535,
    65536,
    2**31 - 1,
    2**31,
    2**32 - 1,
)


def in_tree(rng: Random, value: Any) -> Any:
    """A copy of a value of JSON with one to four places of it changed."""
    made = copy.deepcopy(value)
    for _ in range(rng.choice((1, 1, 1, 2, 4))):
        places = _places(made)
        if not places:
            return rng.choice(JUNK)
        holder, key = rng.choice(places)
        _change(rng, places, holder, key)
    return made


def _places(value: Any) -> list[tuple[Any, Any]]:
    """Everything that a value holds, as what holds it and its key."""
    found, open_ = [], [value]
    while open_ and len(found) < 50_000:
        one = open_.pop()
        keys = list(one) if isinstance(one, dict) else range(len(one))
        for key in keys:
            found.append((one, key))
            if isinstance(one[key], dict | list):
                open_.append(one[key])
    return found


def _change(rng: Random, places: list[tuple[Any, Any]], holder: Any, key: Any) -> None:
    """Changes one place of a tree."""
    old = holder[key]
    match rng.randrange(9):
        case 0 | 1 | 2:
            holder[key] = copy.deepcopy(rng.choice(JUNK))
        case 3:
            other, name = rng.choice(places)
            holder[key] = copy.deepcopy(other[name])
        case 4:
            del holder[key]
        case 5 if isinstance(old, int | float) and not isinstance(old, bool):
            holder[key] = rng.choice((-old, old + 1, old - 1, old * 1e6, old * 1e-6, float(old)))
        case 5 if isinstance(old, list) and old:
            holder[key] = (old * rng.choice((2, 3, 500)))[:2000]
        case 6:
            holder[key] = rng.choice(([old], {"a": old}, [old, old]))
        case 7 if isinstance(holder, dict):
            holder[str(rng.choice(WORDS)) or key + "x"] = holder.pop(key)
        case _:
            deep: Any = old
            for _ in range(rng.choice((2, 40))):
                deep = [deep]
            holder[key] = deep


def dumped(rng: Random, value: Any) -> bytes:
    """A value as JSON; now and then with a place that is very deep."""
    text = json.dumps(value)
    if rng.random() < 0.01:
        at, deep = rng.randrange(len(text)), rng.choice((300, 3000, 100_000))
        text = text[:at] + "[" * deep + "]" * deep + text[at:]
    return text.encode("utf-8", "surrogatepass")


def in_text(rng: Random, text: str) -> str:
    """A text with words, lines or letters of it taken, doubled or replaced."""
    for _ in range(rng.choice((1, 1, 1, 2, 4))):
        lines = text.split("\n")
        i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
        match rng.randrange(6):
            case 0 | 1 | 2:
                words = lines[i].split(" ")
                words[rng.randrange(len(words))] = rng.choice(WORDS)
                lines[i] = " ".join(words)
            case 3:
                lines.insert(i, lines[j])
            case 4:
                del lines[i]
            case _:
                at = rng.randrange(len(lines[i]) + 1)
                lines[i] = lines[i][:at] + rng.choice(WORDS) + lines[i][at + rng.randrange(3) :]
        text = "\n".join(lines)[:MOST]
        if not text:
            return text
    return text


def in_bytes(rng: Random, data: bytes) -> bytes:
    """Bytes with some of them flipped, set, cut, doubled or put elsewhere."""
    made = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 4, 16))):
        if not made:
            break
        at, size = rng.randrange(len(made)), rng.choice((1, 2, 4, 8, 64))
        match rng.randrange(7):
            case 0:
                made[at] ^= 1 << rng.randrange(8)
            case 1 | 2:
                width = rng.choice((1, 2, 4))
                order = rng.choice(("little", "big"))
                number = rng.choice(NUMBERS) % (1 << 8 * width)
                made[at : at + width] = number.to_bytes(width, order)
            case 3:
                made[at : at + 4] = struct.pack(
                    "<f", rng.choice((math.nan, math.inf, -1.0, 1e38, 0.0))
                )
            case 4:
                del made[at : at + size]
            case 5:
                made[at:at] = made[at : at + size]
            case _ if rng.random() < 0.2:
                del made[at:]
            case _:
                made[at : at + size] = rng.randbytes(size)
    return bytes(made[: max(MOST, len(data))])


def in_part(rng: Random, data: bytes) -> bytes:
    """Bytes with some of them changed near the begin or the end, where files tell their sizes."""
    begin = rng.choice((0, 0, max(len(data) - 300, 0), rng.randrange(len(data) + 1)))
    part = slice(begin, begin + rng.choice((64, 300, 1000)))
    return data[:begin] + in_bytes(rng, data[part]) + data[part.stop :]


def in_glb(rng: Random, data: bytes, buffers: float) -> bytes:
    """A GLB with its tree, its container, or (in a share of ``buffers``) its buffer changed."""
    length = struct.unpack_from("<I", data, 12)[0]
    tree, rest = data[20 : 20 + length], data[20 + length :]
    if rng.random() < 0.1:
        return in_bytes(rng, data)
    if rng.random() < buffers:
        rest = rest[:8] + in_bytes(rng, rest[8:])
        rest = struct.pack("<I", len(rest) - 8) + rest[4:] if len(rest) >= 8 else rest
    else:
        tree = dumped(rng, in_tree(rng, json.loads(tree)))
        tree += b" " * (-len(tree) % 4)
    body = struct.pack("<I4s", len(tree), b"JSON") + tree + rest
    return data[:8] + struct.pack("<I", 12 + len(body)) + body


def in_exact(rng: Random, data: bytes) -> bytes:
    """A GLB with the tree or the arrays of the scene in its last chunk changed."""
    at = 12
    while at + 8 + (size := struct.unpack_from("<I", data, at)[0]) < len(data):
        at += 8 + size
    head, body, arrays = data[at + 8 :].split(b"\n", 2)
    if rng.random() < 0.3:
        arrays = in_bytes(rng, arrays)
    else:
        body = dumped(rng, in_tree(rng, json.loads(body)))
    chunk = b"\n".join([head, body, arrays])
    chunk = b" " * (-len(chunk) % 4) + chunk
    made = data[12:at] + struct.pack("<I", len(chunk)) + data[at + 4 : at + 8] + chunk
    return data[:8] + struct.pack("<I", 12 + len(made)) + made


def in_png(rng: Random, data: bytes) -> bytes:
    """A PNG with a chunk changed, whose check sum is right again; of pixels what was packed."""
    chunks, at = [], 8
    while at + 12 <= len(data):
        size = struct.unpack_from(">I", data, at)[0]
        chunks.append((data[at + 4 : at + 8], data[at + 8 : at + 8 + size]))
        at += size + 12
    i = rng.randrange(len(chunks))
    name, held = chunks[i]
    if name == b"IDAT" and rng.random() < 0.7:
        try:
            plain = zlib.decompress(held)
        except zlib.error:  # one of several
            plain = held
        chunks[i] = (name, zlib.compress(in_bytes(rng, plain)))
    elif rng.random() < 0.2:
        chunks.insert(rng.randrange(len(chunks) + 1), chunks.pop(i))
    else:
        chunks[i] = (name, in_bytes(rng, held))
    return data[:8] + b"".join(
        struct.pack(">I", len(held)) + name + held + struct.pack(">I", zlib.crc32(name + held))
        for name, held in chunks
    )


def in_attributes(rng: Random, text: str) -> str:
    """Puts words that break things, and words of other places, into attributes of an XML text."""
    parts = text.split('"')
    for _ in range(rng.randint(1, 3)):
        place = 2 * rng.randrange(max(len(parts) // 2, 1)) + 1
        if place < len(parts):
            other = parts[2 * rng.randrange(max(len(parts) // 2, 1)) + 1]
            word = rng.choice((rng.choice(WORDS), other, f"{parts[place]} {other}"))
            parts[place] = word.replace('"', "").replace("<", "&lt;").replace("&a", "&amp;a")
    return '"'.join(parts)[:MOST]
