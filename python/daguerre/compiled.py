"""Loads the compiled core, or gives the reason why it cannot run here."""

from __future__ import annotations

import sys
from pathlib import Path

#: Instructions of x86-64-v2, the baseline of the build, missing in processors before 2009.
NEEDED = frozenset({"sse4_1", "sse4_2", "popcnt", "ssse3"})
CPU_INFO = Path("/proc/cpuinfo")


def missing_instructions(cpu_info: Path = CPU_INFO) -> list[str]:
    """Lists missing instructions of the processor; empty if the system does not report them."""
    try:
        with cpu_info.open() as file:
            first = file.read(8192)  # the first processor is enough
    except (OSError, UnicodeDecodeError):
        return []
    for line in first.splitlines():
        name, _, words = line.partition(":")
        if name.strip() == "flags":
            return sorted(NEEDED - set(words.split()))
    return []


def check() -> None:
    """Checks that the processor has all instructions of the build, before the core is loaded.

    Raises:
        ImportError: An instruction is missing; using it would end the process.
    """
    if absent := missing_instructions():
        raise _refused(
            f"this processor lacks {', '.join(absent)}; use an x86-64 processor of 2009 or later, "
            "or build Daguerre from source with -C cmake.define.DG_ARCH="
        )


def unloadable(error: ImportError) -> ImportError:
    """Turns the loader's error into an error that says how to solve the problem."""
    import platform  # not at every start of the program

    library, version = platform.libc_ver()
    text = str(error)
    if "GLIBC" in text and "not found" in text:
        return _refused(
            f"wanted glibc 2.34 or newer (Debian 12, Ubuntu 22.04, RHEL 9), got {library} "
            f"{version}; use a newer system, or build Daguerre from source here"
        )
    if "nanobind_backend" in text:
        return _refused(f"{text}; install it with: pip install nanobind-backend")
    return _refused(f"its compiled core cannot be loaded: {text}; install daguerre again with pip")


def _refused(reason: str) -> ImportError:
    """Makes the error to raise; on the command line, prints one line and exits with 70."""
    if Path(sys.argv[0] if sys.argv else "").stem == "daguerre":
        sys.stderr.write(f"daguerre: error: {reason}\n")
        sys.exit(70)
    return ImportError(f"daguerre: {reason}")


check()
try:
    from ._core import __version__ as __version__
except ImportError as error:
    raise unloadable(error) from None
