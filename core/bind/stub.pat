# What nanobind's stub generator leaves out.
_core.__suffix__:
    __version__: str
