"""Work apart: a helper process for libraries that strangers' bytes may crash, stall or fill.

The helper is a fresh interpreter. It gets tasks, each the name of a function and plain values, and
answers with plain values (``files/packing.py``). Whatever ends it is one ``InputError`` here.
``helper.py`` keeps the process, ``process.py`` starts, watches and ends it, ``link.py`` carries
messages, ``shared.py`` large blocks of them, ``serving.py`` is the other side.
"""
