"""Files of pictures that many threads write at once."""

import subprocess
import sys

from PIL import Image

WRITE = """
import threading
import numpy as np
from daguerre.pictures import picture_files

pixels = np.random.default_rng(1).random((200, 300, 3), np.float32)

def save(name):
    for _ in range(50):
        picture_files.write_picture(f"{folder}/{name}", pixels, "srgb", {})

threads = [threading.Thread(target=save, args=(f"{n}.{kind}",)) for n, kind in enumerate(kinds)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
"""


def test_threads_that_save_pictures_do_not_wait_for_each_other_for_ever(tmp_path):
    """A library that wrote into a full pipe with the interpreter's lock held never came back."""
    kinds = ["jpg", "jpg", "png"]
    program = f"folder, kinds = {str(tmp_path)!r}, {kinds}\n{WRITE}"
    subprocess.run([sys.executable, "-c", program], check=True, timeout=120)
    assert len(list(tmp_path.iterdir())) == len(kinds)
    with Image.open(tmp_path / "0.jpg") as one, Image.open(tmp_path / "1.jpg") as other:
        assert one.tobytes() == other.tobytes()  # the files hold their time of writing, too
