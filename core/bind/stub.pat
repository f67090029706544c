# What nanobind's stub generator leaves out.
_core.__suffix__:
    __version__: str

# Set on each exception when it is raised (bind_errors.cpp).
_core.Error.code:
    code: str | None

_core.Error.surface:
    surface: int | None

_core.LensError.code:
    code: str

_core.LensError.surface:
    surface: int | None

_core.FILM_LAYERS:
    FILM_LAYERS: dict[str, tuple[int, int]]

_core.FILM_AOVS:
    FILM_AOVS: tuple[str, ...]

_core.TRUTH_PLANES:
    TRUTH_PLANES: tuple[str, ...]
