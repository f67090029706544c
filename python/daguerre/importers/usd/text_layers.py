"""Checks text layers before USD parses them, as its parser recurses at each bracket.

Some thousand nested brackets end the process. Here brackets outside of strings,
names of files, paths and comments are counted, in time proportional to the length of the text.

Source: OpenUSD, ``pxr/usd/sdf/textFileFormatParser.h`` (lexemes).
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from daguerre.errors import InputError

#: Most nested brackets: of prims, variants, dictionaries, lists and tuples.
DEEPEST = 1000
#: Bytes that are counted at once.
_PIECE = 1 << 20
#: Strings, files, paths and comments. A lexeme without its end reaches as far as the parser looks
#: for the end; no part is read twice, so that the time stays linear.
_LEXEME = re.compile(
    rb"""["'@<\#/](?:  # a single class of first bytes is fastest
    (?<=") (?: "" (?: [^"\\]++ | \\. | "(?!"") )*+ (?: "{3} | \Z )
             | (?: [^"\\\r\n]++ | \\[^\r\n] )*+ "? )
  | (?<=') (?: '' (?: [^'\\]++ | \\. | '(?!'') )*+ (?: '{3} | \Z )
             | (?: [^'\\\r\n]++ | \\[^\r\n] )*+ '? )
  | (?<=@) (?: @@ (?: \\@{3} | [^@\r\n] | @(?!@@) )*+ (?: @{3,5} )?
             | [^@\r\n]*+ @? )
  | (?<=<) [^<>\r\n]*+ >?
  | (?<=\#) [^\n]*+
  | (?<=/) (?: / [^\n]*+ | \* (?: [^*]++ | \*(?!/) )*+ (?: \*/ | \Z ) | )
    )""",
    re.VERBOSE | re.DOTALL,
)
#: A file that an expression names, or a file inside of a package; more may match.
_ODD_ASSET = re.compile(rb"@[^@\r\n]*[\[`]")
_NESTED_TARGETS = re.compile(rb"<(?:[^<>\[\r\n]*\[){%d}" % DEEPEST)
#: Brackets as bytes 1 and -1; and all other bytes.
_STEPS = bytes.maketrans(b"([{)]}", b"\x01\x01\x01\xff\xff\xff")
_OTHERS = bytes(set(range(256)) - set(b"([{)]}"))


def check_text(data: bytes, file: str) -> bool:
    """Checks a text layer.

    Args:
        data: The text.
        file: File, for messages.

    Returns:
        Whether the layer may name files by expressions, or files inside of packages.

    Raises:
        InputError: Brackets are nested too deeply.
    """
    expressions = b"pathExpression" in data
    if expressions and any(too_deep(match[0]) for match in _LEXEME.finditer(data)):
        raise too_deep_error(file)  # in a string, which is parsed separately
    if _NESTED_TARGETS.search(data) or too_deep(_LEXEME.sub(b"", data)):
        raise too_deep_error(file)
    return _ODD_ASSET.search(data) is not None


def too_deep_error(file: str) -> InputError:
    """Error of a layer with brackets that are nested too deeply."""
    return InputError(f"{file}: brackets are nested too deeply: the limit is {DEEPEST}")


def too_deep(text: bytes) -> bool:
    """Whether brackets of a text without strings are nested too deeply."""
    if len(text) <= DEEPEST:
        return False
    return any(most > DEEPEST for most in _depths(text.translate(_STEPS, _OTHERS)))


def _depths(steps: bytes) -> Iterator[int]:
    """Most brackets that are open in each piece of a row of steps."""
    depth = 0
    for begin in range(0, len(steps), _PIECE):
        piece = np.frombuffer(steps[begin : begin + _PIECE], np.int8)
        depths = depth + np.cumsum(piece, dtype=np.int32)
        yield int(depths.max())
        depth = int(depths[-1])
