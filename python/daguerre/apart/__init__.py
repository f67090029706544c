"""Helper process for libraries that a file from a stranger may crash, stall or fill.

The helper is a fresh interpreter. It receives tasks, each the name of a function and plain values,
and answers with plain values (``files/packing.py``). If the helper ends, for any reason, the caller
gets an ``InputError``. ``helper.py`` keeps the process, ``process.py`` starts, watches and ends
it, ``link.py`` carries messages, ``shared.py`` large blocks of them, and ``serving.py`` runs in the
helper.
"""
